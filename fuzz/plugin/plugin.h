// A user's collision code in a shared library, called with care: what it does besides answering is seen and undone.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fuzz/base/choice_source.h"
#include "fuzz/base/motion_query.h"
#include "fuzz/kept/case_file.h"
#include "fuzz/selvage-plugin.h"

namespace selvage::fuzz {

/// What a plugin says about itself.
struct PluginInfo {
  char name[64] = {};  ///< UTF-8 that a terminal shows, cut behind a whole character
  DeclaredGap gap;
  bool has_toi = false, has_batch = false;
};

/// Loads it in a child process, so that nothing it does on the way stays. Throws io::Error(kBadInput): no library, no
/// entry, another version, or it does not survive, or takes longer than `seconds`, counted as those of a case
/// (case_clock.h).
[[nodiscard]] PluginInfo probe_plugin(const std::filesystem::path& library, double seconds);

/// Of the file, by which a library is known again. Throws io::Error(kFile).
[[nodiscard]] std::uint32_t crc32_of_plugin(const std::filesystem::path& library);

/// A batch that is answered otherwise than its queries alone, which are answered as before when they are asked again.
inline constexpr const char* kBatchDiffers = "batch-differs";
/// An answer that depends on what was asked before, or on chance.
inline constexpr const char* kUnsteady = "unsteady";

/// From 0 up: all whole vectors and tails of up to 16 lanes, then the powers of two up to 2^10, with one less and one
/// more, where kernels that work in blocks end one.
[[nodiscard]] const std::vector<std::uint32_t>& batch_sizes();
/// One of the former in seven of eight draws.
[[nodiscard]] std::uint32_t draw_batch_size(ChoiceSource& source);

/// As a plugin is asked it.
[[nodiscard]] selvage_query plain(const MotionQuery& query);

/// "separated", "collides at t = 0x1p-1".
[[nodiscard]] std::string words_of(const selvage_answer& answer, bool has_toi);

class Plugin {
 public:
  /// Throws io::Error(kBadInput).
  explicit Plugin(const std::filesystem::path& library);
  [[nodiscard]] const PluginInfo& info() const { return info_; }

  struct Answer {
    /// forked, changed-rounding-mode, set-flush-to-zero, wrote-out-of-bounds, changed-the-query, invalid-verdict,
    /// invalid-time, kBatchDiffers, kUnsteady; or nothing.
    std::string misdeed;
    selvage_answer answer{};
    std::int64_t nanoseconds = 0;
    std::string difference = {};  ///< of kBatchDiffers: where, and what it said, for a person
  };
  /// REQUIRES vf or ee. Where there is a batch, asks it with queries made of it in one of that size as well, each first
  /// alone.
  [[nodiscard]] Answer ask(const MotionQuery& query, BatchSize batch) const;
  /// The bare call, whose time is the plugin's alone: within watch(), and of what it has answered to ask().
  [[nodiscard]] selvage_answer answer(PairKind kind, const selvage_query& query) const {
    selvage_answer answer{};
    plugin_->answer(kind == PairKind::kVf ? SELVAGE_VF : SELVAGE_EE, &query, &answer);
    return answer;
  }
  /// Runs `calls` in a clean environment; a child that the plugin forks ends at once. What the plugin did meanwhile
  /// that shows in the end: forked, changed-rounding-mode, set-flush-to-zero; or nothing.
  [[nodiscard]] std::string watch(const std::function<void()>& calls) const;
  /// Called before it is asked anything: a case may take as long as every answer may.
  void before_asking(std::function<void()> call) { before_asking_ = std::move(call); }
  /// Whether it says the same again, bit for bit, with the same misdeed at the same place in a batch and none alone.
  [[nodiscard]] bool stands_by(const MotionQuery& query, const Answer& before, BatchSize batch) const;
  /// What loading did besides: a misdeed, or nothing.
  [[nodiscard]] const std::string& load_misdeed() const { return load_misdeed_; }

 private:
  [[nodiscard]] Answer ask_alone(std::int32_t kind, const selvage_query& query) const;
  /// Adds a misdeed to `result`, which has what it gave to the query alone.
  void ask_batch(std::int32_t kind, const selvage_query& query, std::uint32_t count, Answer& result) const;
  [[nodiscard]] bool answers_alike(std::int32_t kind, const std::array<selvage_query, 5>& queries,
                                   const std::array<selvage_answer, 5>& answers) const;

  const selvage_plugin* plugin_ = nullptr;  // stays loaded until the process ends
  PluginInfo info_;
  std::string load_misdeed_;
  std::function<void()> before_asking_ = [] {};
};

}  // namespace selvage::fuzz
