// One table of a TOML file that is read key by key. A reader says first which keys the table may hold, so that what is
// misspelt is not reported as what is missing. Every error names file and line. Internal to the scene reader: keeps
// toml++ out of the public headers.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/error.h"
#include "kernel/types.h"
#include "sim/scene/scene.h"
#include "sim/scene/scene_ranges.h"
#include "sim/scene/toml_parser.h"

namespace selvage::sim {

/// Where tables come from: the name that errors give, and which of two values holds where a file has
/// {draft = ..., full = ...}.
struct TomlSource {
  std::string file;
  Quality quality = Quality::kDraft;
};

class TomlTable {
 public:
  /// `name` is how errors call the table: "cloth 'curtain'". Both references outlive it.
  TomlTable(const toml::table& table, std::string name, const TomlSource& source)
      : table_(table), name_(std::move(name)), source_(source) {}

  /// Before all below: the table may hold these keys, and those of earlier calls.
  void know(std::initializer_list<std::string_view> keys);
  /// And no others: throws at the first of them, with the known key that it may be meant for.
  void know_only(std::initializer_list<std::string_view> keys);

  /// All below REQUIRE a known key.
  [[nodiscard]] bool has(std::string_view key) const;
  /// The functions below throw io::Error(kBadInput) if the key is absent, of another type, or outside its range; with
  /// `fallback` an absent key is that.
  double number(std::string_view key, const Range& range, std::optional<double> fallback = std::nullopt);
  std::int64_t integer(std::string_view key, std::int64_t lower, std::int64_t upper,
                       std::optional<std::int64_t> fallback = std::nullopt);
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::optional<std::string> fallback = std::nullopt);
  /// The index of the value in `choices`; the first is the fallback.
  std::size_t choice(std::string_view key, const std::vector<std::string_view>& choices);
  Vec3 vector(std::string_view key, const Range& range, std::optional<Vec3> fallback = std::nullopt);
  std::vector<std::int64_t> integers(std::string_view key, std::int64_t lower, std::int64_t upper);
  /// The table `key`, or none; the tables of the array `key`, none if absent.
  std::optional<TomlTable> table(std::string_view key);
  std::vector<TomlTable> tables(std::string_view key);

  /// Of the key, where it is; of the table, where it is not.
  [[nodiscard]] std::size_t line(std::string_view key) const;

  void rename(std::string name) { name_ = std::move(name); }
  /// REQUIRES that the reader has asked for every key that is there: none is known and ignored.
  void finish() const;
  /// Throws "FILE:LINE: NAME: message" with the line of `key`, or of the table.
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  using TwoNodes = std::pair<const toml::node*, const toml::node*>;

  [[nodiscard]] const toml::node& node_or_table(std::string_view key) const;
  void note_asked(std::string_view key) const;
  [[nodiscard]] std::string_view meant_by(std::string_view written) const;
  const toml::node* find(std::string_view key, bool required, std::string_view what);
  const toml::node* find_for_quality(std::string_view key);
  [[nodiscard]] static std::optional<TwoNodes> by_quality(const toml::node& node);
  /// read(node), or both of {draft = ..., full = ...}; the one that holds.
  template <class Read>
  auto value_of(std::string_view key, const toml::node& node, const Read& read) const;
  [[noreturn]] void fail_at(const toml::node& node, const std::string& message) const;

  const toml::table& table_;
  std::string name_;
  const TomlSource& source_;
  std::vector<std::string_view> known_;
  mutable std::vector<std::string_view> asked_;
};

}  // namespace selvage::sim
