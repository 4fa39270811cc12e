// docs/formats.md lists every key of the JSON reports, and no other.
#include <set>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/squeeze_scene.h"

namespace selvage {
namespace {

using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;
using Keys = std::set<std::string>;

/// "a.b" for the key b of the object a, "a[].b" for the key b of the objects in the list a.
void collect(const nlohmann::json& value, const std::string& path, Keys& keys) {
  if (value.is_array()) {
    for (const auto& item : value) {
      if (item.is_object()) collect(item, path + "[]", keys);
    }
  }
  if (!value.is_object()) return;
  for (const auto& [key, member] : value.items()) {
    const std::string name = path.empty() ? key : path + "." + key;
    const bool has_keys_of_its_own =
        member.is_object() || (member.is_array() && !member.empty() && member[0].is_object());
    if (!has_keys_of_its_own) keys.insert(name);
    collect(member, name, keys);
  }
}

Keys keys_of(const std::filesystem::path& json) {
  Keys keys;
  collect(nlohmann::json::parse(slurp(json)), "", keys);
  return keys;
}

/// What is in backquotes in the first column of the table under `heading`.
Keys documented(const std::string& heading) {
  const std::string page = slurp(SELVAGE_SOURCE_DIR "/docs/formats.md");
  const std::size_t begin = page.find("\n## " + heading + "\n");
  if (begin == page.npos) return {};
  std::istringstream section(page.substr(begin + 1, page.find("\n## ", begin + 1) - begin));
  Keys keys;
  for (std::string line; std::getline(section, line);) {
    if (!line.starts_with("| `")) continue;
    const std::string cell = line.substr(0, line.find('|', 1));
    for (std::size_t open = cell.find('`'); open != cell.npos;) {
      const std::size_t close = cell.find('`', open + 1);
      keys.insert(cell.substr(open + 1, close - open - 1));
      open = cell.find('`', close + 1);
    }
  }
  return keys;
}

}  // namespace

TEST(ReportKeys, OfSimAreDocumented) {
  const TemporaryFolder folder;
  const auto scene = folder.path() / "scene.toml", out = folder.path() / "out";
  spit(scene, testing::squeeze_scene_text("yield"));  // in which a body waits
  ASSERT_EQ(run_program(folder, {"sim", scene, "-o", out}).exit_code, 0);
  Keys keys;
  collect(nlohmann::json::parse(slurp(out / "run.json")), "", keys);
  EXPECT_EQ(keys, documented("The report of `selvage sim`"));
}

TEST(ReportKeys, OfVerifyAreDocumented) {
  const TemporaryFolder folder;
  const auto before = folder.path() / "a.obj", after = folder.path() / "b.obj", json = folder.path() / "report.json";
  const std::string lower = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n", rest = "v 9 9 9\nf 1 5 7\nf 2 5 7\nf 3 5 7\n";
  spit(before, lower + "v 1 1 1\nv 2 1 1\nv 1 2 1\nf 4 5 6\n" + rest);
  spit(after, lower + "v 1 1 0\nv 2 1 0\nv 1 2 0\nf 4 5 6\n" + rest);
  ASSERT_EQ(run_program(folder, {"verify", "--motion", before, after, "--json", json, "--cases",
                                 folder.path() / "cases", "--second-opinion", "--gap", "--weld", "--group", "a=2:4",
                                 "--group", "b=4:5", "--exempt", "a,a", "--ignore", "b"})
                .exit_code,
            1);
  const Keys keys = keys_of(json);
  EXPECT_TRUE(keys.contains("violations[].t")) << "a frame";
  EXPECT_TRUE(keys.contains("violations[].t.lower")) << "a motion";
  EXPECT_EQ(keys, documented("The report of `selvage verify --json`"));
}

TEST(ReportKeys, OfReplayAreDocumented) {
  const TemporaryFolder folder;
  const auto frame = folder.path() / "a.obj", cases = folder.path() / "cases", json = folder.path() / "report.json";
  spit(frame, "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 0\nv 2 1 0\nv 1 2 0\nf 4 5 6\n");
  ASSERT_EQ(run_program(folder, {"verify", frame, "--cases", cases}).exit_code, 1);
  const char* kept_cases = SELVAGE_SOURCE_DIR "/tests/fuzz/cases";  // motions of all kinds, some without a touch
  const auto file = cases / "file.case";
  spit(file, "selvage-case 1 file\nseed files:obj:1:2\nfailure unsound\nformat obj\n| v 0 0 0\\n\n");
  const auto plugins = cases / "plugins.case";  // which the textbook answers rightly
  spit(plugins,
       "selvage-case 1 vf\nseed hand\noptions tolerance=0x0p+0 max_intervals=64\nplugin missed alone x.so\n"
       "p 1 1 2  1 1 1\na 0 0 0  0 0 0\nb 4 0 0  4 0 0\nc 0 4 0  0 4 0\nexpect apart\n");
  const auto replayed =
      run_program(folder, {"replay", cases, kept_cases, "--json", json, "--plugin", SELVAGE_TEXTBOOK_PLUGIN});
  ASSERT_EQ(replayed.exit_code, 1) << "the textbook misses some of those kept" << replayed.err;
  const Keys keys = keys_of(json);
  EXPECT_EQ(keys, documented("The report of `selvage replay --json`"));
}

/// The tables of the benches name the last part of a key: most are of many methods.
void expect_in_tables(const Keys& keys, std::string_view from, std::string_view to) {
  const std::string page = slurp(SELVAGE_SOURCE_DIR "/docs/formats.md");
  const std::size_t begin = page.find(from), end = page.find(to);
  ASSERT_TRUE(begin < end && end != page.npos);
  const std::string tables = page.substr(begin, end - begin);
  for (const std::string& key : keys) {
    const std::string word = key.substr(key.rfind('.') + 1);
    EXPECT_TRUE(word == "schema" || tables.find("`" + word + "`") != tables.npos) << key;
  }
}

TEST(ReportKeys, OfBenchQueriesAreDocumented) {
  const TemporaryFolder folder;
  const auto queries = folder.path() / "a_vf.csv", json = folder.path() / "report.json";
  const std::string at_rest = "1,4,1,4,0,1\n0,1,0,1,0,1\n1,1,0,1,0,1\n0,1,1,1,0,1\n";  // a vertex on a face
  spit(queries, at_rest + at_rest);
  ASSERT_EQ(run_program(folder, {"bench", "queries", queries, "--repeat", "1", "--json", json, "--plugin",
                                 SELVAGE_TEXTBOOK_PLUGIN})
                .exit_code,
            0);
  const Keys keys = keys_of(json);
  EXPECT_TRUE(keys.contains("methods.plugin.false_positives_beyond_gap"));
  expect_in_tables(keys, "| keys of `bench queries` |", "| keys of `bench ccd` |");
}

TEST(ReportKeys, OfBenchCcdAreDocumented) {
  const TemporaryFolder folder;
  const auto json = folder.path() / "report.json";
  ASSERT_EQ(run_program(folder, {"bench", "ccd", "--sheet", "10", "--repeat", "1", "--json", json, "--plugin",
                                 SELVAGE_KERNEL_PLUGIN})
                .exit_code,
            0);
  const Keys keys = keys_of(json);
  EXPECT_TRUE(keys.contains("methods.plugin.toi_examined"));
  expect_in_tables(keys, "| keys of `bench queries` |", "The others hold lists of the rows that they print");
}

TEST(ReportKeys, OfDoctorAreDocumented) {
  const TemporaryFolder folder;
  const auto json = folder.path() / "report.json";
  ASSERT_EQ(run_program(folder, {"doctor", "--json", json}).exit_code, 0);
  const Keys keys = keys_of(json);
  EXPECT_EQ(keys, documented("The report of `selvage doctor --json`"));
}

}  // namespace selvage
