#include "fuzz/kept/overlap_case.h"

#include <charconv>
#include <system_error>

#include "fuzz/base/case_text.h"

namespace selvage::fuzz {
namespace {

constexpr std::string_view kCornerNames = "abcdef";

std::int32_t parse_vertex(const CaseLines& lines, std::string_view word) {
  std::int32_t vertex = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), vertex);
  if (error != std::errc() || end != word.data() + word.size() || vertex < 0) {
    lines.fail("'" + std::string(word) + "' is not the number of a vertex; correct it");
  }
  return vertex;
}

/// A vertex has one position, and a face three vertices.
void require_mesh(const CaseLines& lines, const OverlapCase& kept) {
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (kept.faces[i / 3][i % 3] != kept.faces[j / 3][j % 3]) continue;
      if (i / 3 == j / 3) lines.fail("a face names a vertex twice; correct it");
      if (kept.x[i / 3][i % 3] != kept.x[j / 3][j % 3]) lines.fail("a vertex has two positions; correct one");
    }
  }
}

}  // namespace

std::string format_overlap_case(const OverlapCase& kept) {
  std::string text = "selvage-case 1 overlap\nseed " + kept.seed + "\n";
  for (std::size_t i = 0; i < 6; ++i) {
    text += std::string(1, kCornerNames[i]) + " " + std::to_string(kept.faces[i / 3][i % 3]);
    for (const double coordinate : kept.x[i / 3][i % 3]) text += " " + hex(coordinate);
    text += "\n";
  }
  return text + (kept.touches ? "expect touches\n" : "expect apart\n");
}

OverlapCase parse_overlap_case(std::string_view text, const std::string& name) {
  CaseLines lines(text, name);
  OverlapCase kept;
  lines.advance();
  for (const char* wanted : {"selvage-case", "1", "overlap"}) lines.expect_word(wanted);
  lines.expect_end_of_line();
  lines.advance();
  lines.expect_word("seed");
  kept.seed = lines.word();
  lines.expect_end_of_line();
  for (std::size_t i = 0; i < 6; ++i) {
    lines.advance();
    lines.expect_word(kCornerNames.substr(i, 1));
    kept.faces[i / 3][i % 3] = parse_vertex(lines, lines.word());
    for (double& coordinate : kept.x[i / 3][i % 3]) coordinate = lines.number(lines.word());
    lines.expect_end_of_line();
  }
  require_mesh(lines, kept);
  kept.touches = lines.last_answer();
  return kept;
}

}  // namespace selvage::fuzz
