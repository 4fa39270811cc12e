// `selvage bench queries --plugin` and `bench ccd --plugin`: somebody's kernel beside Selvage's, and judged alike.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/cli/two_faces.h"

namespace selvage {
namespace {

using testing::expect_text;
using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;
using testing::two_faces;

std::string bad_plugin(const std::string& misdeed) {
  return std::string(SELVAGE_BAD_PLUGINS) + "/plugin_" + misdeed + ".so";
}

/// A whole number in full, as a rational.
std::string rational(double whole) {
  const std::string digits = std::to_string(whole);
  return digits.substr(0, digits.find('.')) + ",1";
}

/// A point that moves from height `from` to height `to` (rationals: "1,2"), above a triangle at rest with legs of
/// 4 `unit`.
std::string falling(const std::string& from, const std::string& to, double unit = 1) {
  const std::string one = rational(unit), four = rational(4 * unit);
  std::string rows;
  for (const std::string& height : {from, to}) {
    rows += one + "," + one + "," + height + "\n0,1,0,1,0,1\n" + four + ",0,1,0,1\n0,1," + four + ",0,1\n";
  }
  return rows;
}

const std::string kThrough = falling("1,1", "-1,1"), kAbove = falling("1,1", "1,2");
/// Its cube is beyond the doubles, which the textbook method does not see.
constexpr double kHuge = 0x1p+345;
const std::string kLarge = falling(rational(kHuge), rational(-kHuge), kHuge);

struct Measured {
  testing::ProgramResult program;
  nlohmann::json report;  ///< null where none was written
};

Measured measure(const TemporaryFolder& folder, const std::string& library, std::vector<std::string> bench) {
  const auto json = folder.path() / "report.json";
  std::filesystem::remove(json);
  bench.insert(bench.begin(), "bench");
  bench.insert(bench.end(), {"--plugin", library, "--repeat", "30", "--case-time", "0.3", "--json", json});
  Measured measured{run_program(folder, bench), {}};
  if (std::filesystem::exists(json)) measured.report = nlohmann::json::parse(slurp(json));
  return measured;
}

Measured measure(const TemporaryFolder& folder, const std::string& library, const std::string& queries) {
  const auto file = folder.path() / "a_vf.csv";
  spit(file, queries);
  return measure(folder, library, {"queries", file});
}

/// The motion of a mesh from `t0` to `t1`, as OBJ. What comes within `tolerance` is a candidate as well.
Measured measure_motion(const TemporaryFolder& folder, const std::string& library, const std::string& t0,
                        const std::string& t1, const std::string& tolerance = "0") {
  const auto file_t0 = folder.path() / "a.obj", file_t1 = folder.path() / "b.obj";
  spit(file_t0, t0);
  spit(file_t1, t1);
  return measure(folder, library, {"ccd", file_t0, file_t1, "--tolerance", tolerance});
}

/// What the table says under "late toi" in the first row that begins with `method`.
std::string late_in_table(const std::string& table, const std::string& method) {
  constexpr std::string_view kColumn = "late toi";
  const std::size_t head = table.find("\nmethod "), row = table.find("\n" + method + " ");
  const std::size_t column = table.find(kColumn, head) - head;
  if (head == table.npos || row == table.npos || row + column + kColumn.size() > table.size()) return "no such cell";
  const std::string cell = table.substr(row + column, kColumn.size());
  return cell.substr(cell.find_last_of(' ') + 1);
}

}  // namespace

TEST(BenchPlugin, ARightOneHasNoMissesAndTheRowOfAMethod) {
  const TemporaryFolder folder;
  const auto [program, report] = measure(folder, SELVAGE_KERNEL_PLUGIN, kThrough + kAbove + kLarge);
  EXPECT_EQ(program.exit_code, 0) << program.err;
  expect_text(program.out, "\nplugin selvage kernel ");
  expect_text(program.out, std::string("plugin selvage kernel: ") + SELVAGE_KERNEL_PLUGIN + ", CRC-32 ");
  const auto& row = report.at("methods").at("plugin");
  for (const auto& [key, value] : report["methods"]["kernel"].items()) EXPECT_TRUE(row.contains(key)) << key;
  for (const char* none : {"false_negatives", "false_positives", "late_toi", "false_positives_beyond_gap"}) {
    EXPECT_EQ(row.at(none), 0) << none;
  }
  EXPECT_LT(row.at("toi_error").at("early_max"), 1e-9) << "its times were compared";
  for (const char* time : {"mean", "median", "p99", "max"}) EXPECT_GT(row.at("ns").at(time), 0) << time;
  const auto& plugin = report.at("plugin");
  EXPECT_EQ(plugin.at("name"), "selvage kernel");
  EXPECT_EQ(plugin.at("file"), SELVAGE_KERNEL_PLUGIN);
  EXPECT_TRUE(plugin.at("crc32").is_number_unsigned());
  EXPECT_EQ(plugin.at("has_toi"), true);
  EXPECT_EQ(plugin.at("tolerance"), 0x1p-1071);
  EXPECT_EQ(plugin.at("relative_tolerance"), 0x1p-38);
}

TEST(BenchPlugin, AMissIsCountedAndIsAViolation) {
  const TemporaryFolder folder;
  const auto [program, report] = measure(folder, SELVAGE_TEXTBOOK_PLUGIN, kThrough + kAbove + kLarge);
  EXPECT_EQ(program.exit_code, 1) << program.err;
  auto row = report.at("methods").at("plugin"), ours = report.at("methods").at("textbook");
  EXPECT_EQ(row.at("false_negatives"), 1);
  row.erase("ns"), ours.erase("ns"), row.erase("false_positives_beyond_gap");
  EXPECT_EQ(row, ours) << "the same method";
}

TEST(BenchPlugin, ALateTimeIsAViolation) {
  const TemporaryFolder folder;
  const auto [program, report] = measure(folder, bad_plugin("answers_late"), kThrough + kAbove);
  EXPECT_EQ(program.exit_code, 1) << program.err;
  const auto& row = report.at("methods").at("plugin");
  EXPECT_EQ(row.at("false_negatives"), 0);
  EXPECT_EQ(row.at("late_toi"), 1);
  EXPECT_EQ(row.at("toi_error").at("late_max"), 0.5);
}

// Its alarms are false all the same, as those of a method with a fixed tolerance are.
TEST(BenchPlugin, FalseAlarmsBeyondTheDeclaredGapAreToldFromThoseWithin) {
  const TemporaryFolder folder;
  const std::string within = falling("1,1", "1,131072"), beyond = falling("1,1", "3,262144");  // of 1e-5
  const auto [program, report] = measure(folder, bad_plugin("alarms_a_quarter_too_far"), within + beyond + kAbove);
  EXPECT_EQ(program.exit_code, 0) << program.err;
  const auto& row = report.at("methods").at("plugin");
  EXPECT_EQ(row.at("false_positives"), 2);
  EXPECT_EQ(row.at("false_positives_beyond_gap"), 1);
  expect_text(program.out, ", no times of impact; 1 of its false alarms beyond that");
}

TEST(BenchPlugin, OneThatMisbehavesIsNamedWithTheQueryAndHasNoFigures) {
  const TemporaryFolder folder;
  const std::string first = " at the query " + (folder.path() / "a_vf.csv").string() + ":1; ";
  const std::pair<const char*, std::string> kBad[] = {
      {"crashes", "crashed-SIGSEGV" + first},
      {"sleeps", "hung" + first},
      {"exits", "exited" + first},
      {"throws", "threw" + first},
      {"gives_no_verdict", "invalid-verdict" + first},
      {"gives_no_time", "invalid-time" + first},
      {"sets_ftz", "set-flush-to-zero" + first},
      {"writes_out_of_bounds", "wrote-out-of-bounds" + first},
      {"remembers", "unsteady at the query " + (folder.path() / "a_vf.csv").string() + ":"},
      {"forks", "forked while it was timed; "}};
  for (const auto& [misdeed, words] : kBad) {
    SCOPED_TRACE(misdeed);
    const std::string library = bad_plugin(misdeed);
    const auto [program, report] = measure(folder, library, kThrough + kThrough);
    EXPECT_EQ(program.exit_code, 1) << program.out;
    EXPECT_EQ(program.out, "");
    EXPECT_TRUE(report.is_null());
    expect_text(program.err, "selvage: " + library + ": " + words);
    expect_text(program.err, "nothing was measured: mend it");
  }
}

TEST(BenchPlugin, TheQueryAtWhichItDiesIsTheOneInHand) {
  const TemporaryFolder folder;
  const auto [program, report] =
      measure(folder, bad_plugin("crashes_at_rest"), kThrough + kAbove + falling("0,1", "0,1"));
  EXPECT_EQ(program.exit_code, 1) << program.out;
  expect_text(program.err, ": crashed-SIGSEGV at the query " + (folder.path() / "a_vf.csv").string() + ":17; ");
}

// One that takes milliseconds, as in rational numbers, may take longer in all than an answer may.
TEST(BenchPlugin, SlowAnswersAreNoHang) {
  const TemporaryFolder folder;
  const auto [program, report] = measure(folder, bad_plugin("naps"), kThrough + kAbove + kThrough + kAbove);
  EXPECT_EQ(program.exit_code, 0) << program.err;
  EXPECT_GT(report.at("methods").at("plugin").at("ns").at("median"), 2e6);
}

TEST(BenchPlugin, WhatIsNoPluginIsRefusedAsByACampaign) {
  const TemporaryFolder folder;
  const std::string missing = folder.path() / "missing.so", other = bad_plugin("is_of_another_version"),
                    stuck = bad_plugin("hangs_at_load");
  const struct {
    std::string library;
    int exit_code;
    std::string words;
  } kCases[] = {{missing, 4, missing + ": cannot open"},
                {SELVAGE_PROGRAM, 3, std::string(SELVAGE_PROGRAM) + ": cannot be loaded"},
                {other, 3, other + ": is built for version 2 of selvage-plugin.h, this is version 1"},
                {stuck, 3, stuck + ": does not survive being loaded: hung; give it more time with --case-time"}};
  for (const auto& c : kCases) {
    const auto [program, report] = measure(folder, c.library, kThrough);
    EXPECT_EQ(program.exit_code, c.exit_code) << program.err;
    expect_text(program.err, c.words);
    EXPECT_TRUE(report.is_null());
  }
}

TEST(BenchPlugin, IsNotAskedBeyondTheDomainOfItsInterface) {
  const TemporaryFolder folder;
  const auto [program, report] =
      measure(folder, SELVAGE_KERNEL_PLUGIN, kThrough + falling(rational(0x1p+1001), "-1,1"));
  EXPECT_EQ(program.exit_code, 3) << program.out;
  expect_text(program.err, "a_vf.csv:9: a coordinate is beyond 2^1000");
}

TEST(BenchPlugin, ItsFileIsNoPlaceForTheReport) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a_vf.csv", library = folder.path() / "plugin.so";
  spit(file, kThrough);
  std::filesystem::copy_file(SELVAGE_KERNEL_PLUGIN, library);
  EXPECT_EQ(run_program(folder, {"bench", "queries", file, "--plugin", library, "--json", library}).exit_code, 2);
}

TEST(BenchPlugin, OnAMotionItHasTheRowOfAMethod) {
  const TemporaryFolder folder;
  const auto [program, report] = measure_motion(folder, SELVAGE_KERNEL_PLUGIN, two_faces(1), two_faces(-1));
  EXPECT_EQ(program.exit_code, 0) << program.err;
  expect_text(program.out, "\nplugin selvage kernel ");
  expect_text(program.out, std::string("plugin selvage kernel: ") + SELVAGE_KERNEL_PLUGIN + ", CRC-32 ");
  auto row = report.at("methods").at("plugin"), ours = report.at("methods").at("kernel_scalar");
  for (const char* time : {"mean", "vf", "ee"}) EXPECT_GT(row.at("ns").at(time), 0) << time;
  row.erase("ns"), ours.erase("ns");
  EXPECT_GT(row.at("toi_examined"), 0);
  EXPECT_EQ(row, ours) << "the same method";
  EXPECT_GT(report.at("ratio_to_textbook").at("plugin"), 0);
  EXPECT_EQ(report.at("plugin").at("name"), "selvage kernel");
}

TEST(BenchPlugin, OnAMotionAMissAndALateTimeAreViolations) {
  const TemporaryFolder folder;
  const auto missed = measure_motion(folder, SELVAGE_TEXTBOOK_PLUGIN, two_faces(1, kHuge), two_faces(-1, kHuge));
  EXPECT_EQ(missed.program.exit_code, 1) << missed.program.err;
  const auto& contacts = missed.report.at("contacts");
  EXPECT_EQ(missed.report.at("methods").at("plugin").at("false_negatives"),
            contacts.at("vf").get<int>() + contacts.at("ee").get<int>());
  const auto late = measure_motion(folder, bad_plugin("answers_late"), two_faces(1), two_faces(-1));
  EXPECT_EQ(late.program.exit_code, 1) << late.program.err;
  EXPECT_EQ(late.report.at("methods").at("plugin").at("false_negatives"), 0);
  EXPECT_GT(late.report.at("methods").at("plugin").at("late_toi"), 0);
}

TEST(BenchPlugin, OnAMotionFalseAlarmsBeyondTheDeclaredGapAreToldFromThoseWithin) {
  const TemporaryFolder folder;
  for (const auto& [gap, beyond] : {std::pair{0x1p-17, false}, std::pair{3 * 0x1p-18, true}}) {  // of 1e-5
    const auto [program, report] =
        measure_motion(folder, bad_plugin("alarms_a_quarter_too_far"), two_faces(1), two_faces(gap), "1e-4");
    EXPECT_EQ(program.exit_code, 0) << program.err;
    const auto& row = report.at("methods").at("plugin");
    EXPECT_GT(row.at("false_positives"), 0);
    EXPECT_EQ(row.at("false_positives_beyond_gap"), beyond ? row.at("false_positives").get<int>() : 0);
    EXPECT_EQ(late_in_table(program.out, "kernel"), "0");
    EXPECT_EQ(late_in_table(program.out, "plugin"), "-") << "it gives no times";
  }
}

TEST(BenchPlugin, OnAMotionOneThatMisbehavesIsNamedWithThePairAndHasNoFigures) {
  const TemporaryFolder folder;
  // Of the second face one edge rests, across the first face, and no vertex of either rests on the other.
  const std::string across = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 2 -1 0\nv 2 5 0\nf 4 5 6\n";
  const struct {
    const char* misdeed;
    std::string t0, t1, words;
  } kCases[] = {{"crashes", two_faces(1), two_faces(-1), "crashed-SIGSEGV at the query of vertex 3 and face 0; "},
                {"crashes_at_rest", across + "v 8 2 9\n", across + "v 8 2 8\n",
                 "crashed-SIGSEGV at the query of edges 0-1 and 3-4; "},
                {"remembers", two_faces(1), two_faces(-1), "unsteady at the query of "},
                {"forks", two_faces(1), two_faces(-1), "forked while it was timed; "}};
  for (const auto& c : kCases) {
    SCOPED_TRACE(c.misdeed);
    const std::string library = bad_plugin(c.misdeed);
    const auto [program, report] = measure_motion(folder, library, c.t0, c.t1);
    EXPECT_EQ(program.exit_code, 1) << program.out;
    EXPECT_EQ(program.out, "");
    EXPECT_TRUE(report.is_null());
    expect_text(program.err, "selvage: " + library + ": " + c.words);
  }
}

}  // namespace selvage
