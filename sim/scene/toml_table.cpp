#include "sim/scene/toml_table.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "io/fail.h"
#include "io/file/text.h"
#include "kernel/assert.h"

namespace selvage::sim {
namespace {

std::string describe(const Range& range) {
  const bool bounded_below = range.lower > -1e300, bounded_above = range.upper < 1e300;
  if (bounded_below && bounded_above) {
    return fmt::format("a number {} {} and at most {}", range.lower_open ? "above" : "of at least", range.lower,
                       range.upper);
  }
  if (bounded_below) return fmt::format("a number {} {}", range.lower_open ? "above" : "of at least", range.lower);
  return "a finite number";
}

// Integers are numbers too: "duration_s = 4".
std::optional<double> as_number(const toml::node& node) {
  return node.is_number() ? node.value<double>() : std::nullopt;
}

/// How far what is written is from a key, in letters that differ, are missing or too many (Levenshtein's distance, row
/// by row); nothing where it is too far for a slip: more than a third of the letters, also with units or more left out.
std::optional<std::size_t> misspelling(std::string_view key, std::string_view written) {
  std::vector<std::size_t> row(key.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < written.size(); ++i) {
    std::size_t before = std::exchange(row[0], i + 1);  // the distance of both without their last letters
    for (std::size_t j = 0; j < key.size(); ++j) {
      const std::size_t changed = before + (written[i] == key[j] ? 0 : 1);
      before = std::exchange(row[j + 1], std::min({changed, row[j] + 1, row[j + 1] + 1}));
    }
  }
  for (std::size_t length = 1; length <= key.size(); ++length) {
    const bool is_whole_words = length == key.size() || key[length] == '_';
    if (is_whole_words && 3 * row[length] <= written.size()) return row.back();
  }
  return std::nullopt;
}

}  // namespace

void TomlTable::fail_at(const toml::node& node, const std::string& message) const {
  io::bad_input_at_line(source_.file, node.source().begin.line, message);
}

const toml::node& TomlTable::node_or_table(std::string_view key) const {
  const toml::node* node = table_.get(key);
  return node != nullptr ? *node : static_cast<const toml::node&>(table_);
}

std::size_t TomlTable::line(std::string_view key) const { return node_or_table(key).source().begin.line; }

void TomlTable::fail(std::string_view key, const std::string& message) const {
  fail_at(node_or_table(key), fmt::format("{}: {}", name_, message));
}

void TomlTable::fail(const std::string& message) const { fail_at(table_, fmt::format("{}: {}", name_, message)); }

// The two of {draft = ..., full = ...}, or none.
std::optional<TomlTable::TwoNodes> TomlTable::by_quality(const toml::node& node) {
  const toml::table* table = node.as_table();
  if (table == nullptr || table->size() != 2) return std::nullopt;
  const toml::node *draft = table->get("draft"), *full = table->get("full");
  if (draft == nullptr || full == nullptr) return std::nullopt;
  return TwoNodes(draft, full);
}

void TomlTable::know(std::initializer_list<std::string_view> keys) {
  known_.insert(known_.end(), keys.begin(), keys.end());
}

void TomlTable::know_only(std::initializer_list<std::string_view> keys) {
  know(keys);
  for (const auto& [key, node] : table_) {
    if (std::ranges::find(known_, key.str()) != known_.end()) continue;
    const std::string_view meant = meant_by(key.str());
    const std::string hint = meant.empty() ? ""
                                           : fmt::format(" it may be meant for {}{};", meant,
                                                         table_.contains(meant) ? ", which is there too" : "");
    fail_at(node,
            fmt::format("{}: unknown key \"{}\";{} known here: {}", name_, key.str(), hint, fmt::join(known_, ", ")));
  }
}

/// The nearest known key, the first of several; empty where none is near.
std::string_view TomlTable::meant_by(std::string_view written) const {
  std::string_view nearest;
  std::optional<std::size_t> least;
  for (const std::string_view key : known_) {
    const std::optional<std::size_t> distance = misspelling(key, written);
    if (!distance || (least && *least <= *distance)) continue;
    nearest = key;
    least = distance;
  }
  return nearest;
}

void TomlTable::note_asked(std::string_view key) const {
  const auto known = std::ranges::find(known_, key);
  SELVAGE_REQUIRE(known != known_.end());
  asked_.push_back(*known);
}

bool TomlTable::has(std::string_view key) const {
  note_asked(key);
  return table_.contains(key);
}

const toml::node* TomlTable::find(std::string_view key, bool required, std::string_view what) {
  note_asked(key);
  const toml::node* node = table_.get(key);
  if (node != nullptr || !required) return node;
  fail(fmt::format("{} is missing; add {} = {}", key, key, what));
}

const toml::node* TomlTable::find_for_quality(std::string_view key) {
  const toml::node* node = find(key, false, "");
  const auto both = node == nullptr ? std::nullopt : by_quality(*node);
  if (!both) return node;
  return source_.quality == Quality::kDraft ? both->first : both->second;
}

// What is wrong in the value of the other quality is wrong as well.
template <class Read>
auto TomlTable::value_of(std::string_view key, const toml::node& node, const Read& read) const {
  const auto both = by_quality(node);
  if (!both && node.is_table()) {
    fail(key, fmt::format("{} is a table; give one value, or {{draft = ..., full = ...}} with both", key));
  }
  if (!both) return read(node);
  auto draft = read(*both->first), full = read(*both->second);
  return source_.quality == Quality::kDraft ? draft : full;
}

double TomlTable::number(std::string_view key, const Range& range, std::optional<double> fallback) {
  const toml::node* node = find(key, !fallback, describe(range));
  if (node == nullptr) return *fallback;
  return value_of(key, *node, [&](const toml::node& one) {
    const std::optional<double> value = as_number(one);
    if (!value || !inside(*value, range)) fail(key, fmt::format("{} must be {}", key, describe(range)));
    return *value;
  });
}

std::int64_t TomlTable::integer(std::string_view key, std::int64_t lower, std::int64_t upper,
                                std::optional<std::int64_t> fallback) {
  const std::string what = fmt::format("an integer from {} to {}", lower, upper);
  const toml::node* node = find(key, !fallback, what);
  if (node == nullptr) return *fallback;
  return value_of(key, *node, [&](const toml::node& one) {
    const std::optional<std::int64_t> value = one.is_integer() ? one.value<std::int64_t>() : std::nullopt;
    if (!value || *value < lower || *value > upper) fail(key, fmt::format("{} must be {}", key, what));
    return *value;
  });
}

bool TomlTable::boolean(std::string_view key, bool fallback) {
  const toml::node* node = find(key, false, "");
  if (node == nullptr) return fallback;
  return value_of(key, *node, [&](const toml::node& one) {
    if (!one.is_boolean()) fail(key, fmt::format("{} must be true or false", key));
    return *one.value<bool>();
  });
}

std::string TomlTable::text(std::string_view key, std::optional<std::string> fallback) {
  const toml::node* node = find(key, !fallback, "\"...\"");
  if (node == nullptr) return *fallback;
  return value_of(key, *node, [&](const toml::node& one) {
    if (!one.is_string()) fail(key, fmt::format("{} must be a string in quotes", key));
    const std::string value = *one.value<std::string>();
    // Names are shown on terminals, which would obey them. TOML is UTF-8.
    if (io::printable(value) != value) fail(key, fmt::format("{} holds a control character; remove it", key));
    return value;
  });
}

std::size_t TomlTable::choice(std::string_view key, const std::vector<std::string_view>& choices) {
  const toml::node* node = find(key, false, "");
  if (node == nullptr) return 0;
  return value_of(key, *node, [&](const toml::node& one) {
    if (!one.is_string()) fail(key, fmt::format("{} must be a string in quotes", key));
    const std::string value = *one.value<std::string>();
    const auto found = std::ranges::find(choices, value);
    if (found == choices.end()) {
      fail(key, fmt::format("{} is \"{}\"; choose one of \"{}\"", key, value, fmt::join(choices, "\", \"")));
    }
    return static_cast<std::size_t>(found - choices.begin());
  });
}

Vec3 TomlTable::vector(std::string_view key, const Range& range, std::optional<Vec3> fallback) {
  const toml::node* node = find(key, !fallback, "[x, y, z]");
  if (node == nullptr) return *fallback;
  return value_of(key, *node, [&](const toml::node& one) {
    const toml::array* array = one.as_array();
    if (array == nullptr || array->size() != 3) fail(key, fmt::format("{} must be three numbers [x, y, z]", key));
    Vec3 value;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::optional<double> number = as_number((*array)[k]);
      if (!number || !inside(*number, range)) {
        fail(key, fmt::format("{}[{}] must be {}", key, k, describe(range)));
      }
      value[static_cast<Eigen::Index>(k)] = *number;
    }
    return value;
  });
}

std::vector<std::int64_t> TomlTable::integers(std::string_view key, std::int64_t lower, std::int64_t upper) {
  const toml::node* node = find(key, true, "[...]");
  return value_of(key, *node, [&](const toml::node& one) {
    const toml::array* array = one.as_array();
    if (array == nullptr) fail(key, fmt::format("{} must be a list of integers", key));
    if (array->empty()) fail(key, fmt::format("{} is empty; it must hold at least one integer", key));
    std::vector<std::int64_t> values;
    for (const toml::node& item : *array) {
      const std::optional<std::int64_t> value = item.is_integer() ? item.value<std::int64_t>() : std::nullopt;
      if (!value || *value < lower || *value > upper) {
        fail_at(item, fmt::format("{}: {} must hold integers from {} to {}", name_, key, lower, upper));
      }
      values.push_back(*value);
    }
    return values;
  });
}

std::optional<TomlTable> TomlTable::table(std::string_view key) {
  const toml::node* node = find_for_quality(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) fail(key, fmt::format("{} must be a table", key));
  return TomlTable(*node->as_table(), std::string(key), source_);
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  const toml::node* node = find_for_quality(key);
  std::vector<TomlTable> found;
  if (node == nullptr) return found;
  const toml::array* array = node->as_array();
  if (array == nullptr) fail(key, fmt::format("{} must be a list of tables: [[{}]]", key, key));
  for (const toml::node& item : *array) {
    if (!item.is_table()) fail_at(item, fmt::format("{}: {} must hold tables only", name_, key));
    found.emplace_back(*item.as_table(), std::string(key), source_);
  }
  return found;
}

void TomlTable::finish() const {
  for (const auto& [key, node] : table_) SELVAGE_REQUIRE(std::ranges::find(asked_, key.str()) != asked_.end());
}

}  // namespace selvage::sim
