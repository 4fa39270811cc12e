// `selvage bench queries --plugin`: somebody's kernel on query files, beside Selvage's and judged alike.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"

namespace selvage {
namespace {

using testing::expect_text;
using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

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

Measured measure(const TemporaryFolder& folder, const std::string& library, const std::string& queries) {
  const auto file = folder.path() / "a_vf.csv", json = folder.path() / "report.json";
  spit(file, queries);
  std::filesystem::remove(json);
  Measured measured{run_program(folder, {"bench", "queries", file, "--plugin", library, "--repeat", "30", "--case-time",
                                         "0.3", "--json", json}),
                    {}};
  if (std::filesystem::exists(json)) measured.report = nlohmann::json::parse(slurp(json));
  return measured;
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

}  // namespace selvage
