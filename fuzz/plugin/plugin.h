// A user's collision code in a shared library, called with care: what it does besides answering is seen and undone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "fuzz/base/motion_query.h"
#include "fuzz/selvage-plugin.h"

namespace selvage::fuzz {

/// What a plugin says about itself.
struct PluginInfo {
  char name[64] = {};  ///< UTF-8 that a terminal shows, cut behind a whole character
  double tolerance = 0, relative_tolerance = 0;
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
  };
  /// REQUIRES vf or ee. Where `in_batch`, asks it in one batch with queries made of it as well, each first alone.
  [[nodiscard]] Answer ask(const MotionQuery& query, bool in_batch) const;
  /// Whether it says the same again, bit for bit, with the same misdeed in a batch and none alone.
  [[nodiscard]] bool stands_by(const MotionQuery& query, const Answer& before, bool in_batch) const;
  /// What loading did besides: a misdeed, or nothing.
  [[nodiscard]] const std::string& load_misdeed() const { return load_misdeed_; }

 private:
  [[nodiscard]] Answer ask_alone(std::int32_t kind, const selvage_query& query) const;
  /// A misdeed, or nothing. `answer` is what it gave to the query alone.
  [[nodiscard]] std::string ask_batch(std::int32_t kind, const selvage_query& query,
                                      const selvage_answer& answer) const;

  const selvage_plugin* plugin_ = nullptr;  // stays loaded until the process ends
  PluginInfo info_;
  std::string load_misdeed_;
};

}  // namespace selvage::fuzz
