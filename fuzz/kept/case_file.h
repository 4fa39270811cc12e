// A query kept as bits: text with hex floats, so that a failure survives compilers, generators and shrinkers (F3).
//   selvage-case 1 vf                                   format version, kind of pair
//   seed prop_ccd_no_miss:77123                         where it came from
//   options tolerance=0x1p-20 max_intervals=4096        and, where it is about another promise than K1 to K3,
//                                                       property=scale, and what that chose: choices=1403
//   plugin missed alone ./mine.so                       where it is a plugin's: its failure; whether the query was
//                                                       asked alone or in a batch=21; the library, as it was named
//   p 0x1.9p+6 -0x1.2p+3 0x0p+0  0x1.8p+6 0x0p+0 0x1p-4 a point at t = 0, then at t = 1; vf: p a b c, ee: a b c d,
//   ...                                                 self: p a b
//   expect touches                                      the exact answer: touches, or apart
// Everything from '#' to the end of a line is a comment.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/base/motion_query.h"
#include "io/error.h"

namespace selvage::fuzz {

/// The queries of the batch that one is asked in as well; absent: alone.
using BatchSize = std::optional<std::uint32_t>;
/// Of a case that does not say it: two vectors of 8 or one of 16 and a tail of 5, five of 4 and a tail of 1.
inline constexpr std::uint32_t kUsualBatch = 21;

/// A plugin that failed.
struct PluginRecord {
  std::string library;  ///< as it was named
  std::string failure;  ///< in a word; or "none"
  BatchSize batch;
};

struct Case {
  MotionQuery query;
  std::string seed;
  bool touches = false;                     ///< whether the features touch at some t in [0,1], exactly
  std::string property = "ccd";             ///< one of query_properties()
  std::vector<std::uint32_t> choices = {};  ///< what the property chooses besides the query; others are 0
  std::optional<PluginRecord> plugin = {};
};

[[nodiscard]] std::string format_case(const Case& kept);
/// Throws io::Error naming `name` and the line.
[[nodiscard]] Case parse_case(std::string_view text, const std::string& name);
[[nodiscard]] Case read_case(const std::filesystem::path& file);
/// All *.case files of a folder, by name. Throws io::Error where one cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> case_files(const std::filesystem::path& folder);

}  // namespace selvage::fuzz
