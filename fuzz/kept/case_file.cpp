#include "fuzz/kept/case_file.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "fuzz/base/case_text.h"
#include "fuzz/oracle/query_property.h"
#include "io/file/atomic_file.h"

namespace selvage::fuzz {
namespace {

/// Of a file: more would be memory that a wrong digit asks for.
constexpr std::uint32_t kMaxInBatch = 1U << 20;

std::string_view point_names(PairKind kind) {
  switch (kind) {
    case PairKind::kVf:
      return "pabc";
    case PairKind::kEe:
      return "abcd";
    case PairKind::kSelf:
      break;
  }
  return "pab";
}

std::string format_point(const Vec3& point) { return hex(point.x()) + " " + hex(point.y()) + " " + hex(point.z()); }

std::string_view option_value(CaseLines& lines, std::string_view key) {
  const std::string_view word = lines.word();
  if (!word.starts_with(key) || word.size() <= key.size() || word[key.size()] != '=') {
    lines.fail("expected '" + std::string(key) + "=...'; copy the case again");
  }
  return word.substr(key.size() + 1);
}

std::int32_t parse_count(CaseLines& lines, std::string_view word) {
  std::int32_t count = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (error != std::errc() || end != word.data() + word.size() || count < 1) {
    lines.fail("'" + std::string(word) + "' is not a positive count; correct it");
  }
  return count;
}

std::string parse_property(const CaseLines& lines, std::string_view word) {
  const auto known = std::ranges::find(query_properties(), word, &QueryProperty::name);
  if (known == query_properties().end()) lines.fail("there is no property '" + std::string(word) + "' of queries");
  return std::string(word);
}

std::vector<std::uint32_t> parse_choices(const CaseLines& lines, std::string_view list) {
  std::vector<std::uint32_t> choices;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string_view word = list.substr(begin, end - begin);
    choices.push_back(static_cast<std::uint32_t>(lines.integer(word, 0, 0xffffffff, "choices")));
    begin = end + 1;
  }
  return choices;
}

PairKind parse_kind(CaseLines& lines, std::string_view word) {
  const auto* kind = std::find_if(kPairKinds.begin(), kPairKinds.end(), [&](PairKind k) { return name_of(k) == word; });
  if (kind == kPairKinds.end())
    lines.fail("the kind of pair is vf, ee, self or overlap, not '" + std::string(word) + "'");
  return *kind;
}

BatchSize parse_batch(const CaseLines& lines, std::string_view how) {
  constexpr std::string_view kBatch = "batch";
  if (how == "alone") return std::nullopt;
  if (how == kBatch) return kUsualBatch;
  if (!how.starts_with("batch=")) {
    lines.fail("plugin: 'alone', 'batch' or 'batch=NUMBER' is wanted, not '" + std::string(how) + "'");
  }
  return static_cast<std::uint32_t>(lines.integer(how.substr(kBatch.size() + 1), 0, kMaxInBatch, "batch"));
}

PluginRecord parse_plugin(CaseLines& lines, PairKind kind) {
  if (kind == PairKind::kSelf) lines.fail("plugin: none is asked about self");
  PluginRecord plugin;
  plugin.failure = lines.word();
  plugin.batch = parse_batch(lines, lines.word());
  plugin.library = lines.unescaped(lines.rest_of_line());
  if (plugin.library.empty()) lines.fail("plugin: its file is missing");
  return plugin;
}

double parse_tolerance(CaseLines& lines) {
  const std::string_view word = option_value(lines, "tolerance");
  const double tolerance = lines.number(word);
  if (!(tolerance >= 0)) lines.fail("tolerance: " + std::string(word) + " is negative; it is a distance, from 0 up");
  return tolerance;
}

Vec3 parse_point(CaseLines& lines) {
  Vec3 point;
  for (double& coordinate : point) coordinate = lines.number(lines.word());
  return point;
}

}  // namespace

std::string format_case(const Case& kept) {
  const MotionQuery& query = kept.query;
  std::string text = "selvage-case 1 " + std::string(name_of(query.kind)) + "\n";
  text += "seed " + kept.seed + "\n";
  text += "options tolerance=" + hex(query.options.tolerance) +
          " max_intervals=" + std::to_string(query.options.max_intervals);
  if (kept.property != Case().property) text += " property=" + kept.property;
  for (std::size_t i = 0; i < kept.choices.size(); ++i) {
    text += (i == 0 ? " choices=" : ",") + std::to_string(kept.choices[i]);
  }
  text += "\n";
  if (kept.plugin) {
    const PluginRecord& plugin = *kept.plugin;
    text += "plugin " + (plugin.failure.empty() ? "none" : plugin.failure) + " " +
            (plugin.batch ? "batch=" + std::to_string(*plugin.batch) : "alone") + " " + escaped(plugin.library) + "\n";
  }
  const std::string_view names = point_names(query.kind);
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += std::string(1, names[i]) + " " + format_point(query.x_t0[i]) + "  " + format_point(query.x_t1[i]) + "\n";
  }
  return text + (kept.touches ? "expect touches\n" : "expect apart\n");
}

Case parse_case(std::string_view text, const std::string& name) {
  CaseLines lines(text, name);
  Case kept;
  lines.expect_head();
  kept.query.kind = parse_kind(lines, lines.word());
  lines.expect_end_of_line();
  lines.advance();
  lines.expect_word("seed");
  kept.seed = lines.word();
  lines.expect_end_of_line();
  lines.advance();
  lines.expect_word("options");
  kept.query.options.tolerance = parse_tolerance(lines);
  kept.query.options.max_intervals = parse_count(lines, option_value(lines, "max_intervals"));
  if (!lines.is_at_end_of_line()) kept.property = parse_property(lines, option_value(lines, "property"));
  if (!lines.is_at_end_of_line()) kept.choices = parse_choices(lines, option_value(lines, "choices"));
  lines.expect_end_of_line();
  const std::string_view names = point_names(kept.query.kind);
  for (std::size_t i = 0; i < names.size(); ++i) {
    lines.advance();
    std::string_view word = lines.word();
    if (i == 0 && word == "plugin") {
      kept.plugin = parse_plugin(lines, kept.query.kind);
      lines.advance();
      word = lines.word();
    }
    if (word != names.substr(i, 1))
      lines.fail("expected '" + std::string(names.substr(i, 1)) + "'; copy the case again");
    kept.query.x_t0[i] = parse_point(lines);
    kept.query.x_t1[i] = parse_point(lines);
    lines.expect_end_of_line();
  }
  if (kept.query.kind == PairKind::kSelf) {
    kept.query.x_t0[3] = kept.query.x_t0[0];
    kept.query.x_t1[3] = kept.query.x_t1[0];
  }
  kept.touches = lines.last_answer();
  return kept;
}

Case read_case(const std::filesystem::path& file) { return parse_case(io::read_file(file, 1 << 16), file.string()); }

std::vector<std::filesystem::path> case_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  std::filesystem::directory_iterator entries(folder, error);
  if (error) throw io::Error(io::ErrorKind::kFile, folder.string() + ": " + error.message());
  for (const auto& entry : entries) {
    if (entry.path().extension() == ".case") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace selvage::fuzz
