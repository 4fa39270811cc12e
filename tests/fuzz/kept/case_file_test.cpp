#include "fuzz/kept/case_file.h"

#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "fuzz/draw/generators.h"
#include "io/error.h"
#include "tests/fuzz/spoilt_text.h"

namespace selvage::fuzz {
namespace {

const char* const kGood =
    "selvage-case 1 vf  # a comment\n"
    "\n"
    "seed somewhere:7\n"
    "options tolerance=0x1p-20 max_intervals=64\n"
    "p 0x1.9p+6 -0x1.2p+3 0x0p+0   0x1.8p+6 -0x0p+0 0x0.0000000000001p-1022\n"
    "a 0 1 2   3 4 5.5\n"
    "b 0x1p+0 0x1p+0 0x1p+0 0x1p+0 0x1p+0 0x1p+0\n"
    "c 0x1p+1000 -0x1p+1000 0x1p+0 0x1p+0 0x1p+0 0x1p+0\n"
    "expect touches\n";

void expect_bad_case(const std::string& text, const std::string& words) {
  testing::expect_bad_input([&] { (void)parse_case(text, "x.case"); }, text, words);
}

TEST(CaseFile, ReadsWhatPeopleWrite) {
  const Case kept = parse_case(kGood, "x.case");
  EXPECT_EQ(kept.query.kind, PairKind::kVf);
  EXPECT_EQ(kept.seed, "somewhere:7");
  EXPECT_EQ(kept.query.options.tolerance, 0x1p-20);
  EXPECT_EQ(kept.query.options.max_intervals, 64);
  EXPECT_EQ(kept.query.x_t0[0], Vec3(100, -9, 0));
  EXPECT_TRUE(std::signbit(kept.query.x_t1[0].y()));
  EXPECT_EQ(kept.query.x_t1[0].z(), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(kept.query.x_t1[1], Vec3(3, 4, 5.5));
  EXPECT_EQ(kept.query.x_t0[3].y(), -0x1p+1000);
  EXPECT_TRUE(kept.touches);
}

TEST(CaseFile, KeepsEveryBitOfEveryClass) {
  for (const QueryClass& query_class : query_classes()) {
    for (const PairKind kind : kPairKinds) {
      if (!query_class.band(kind)) continue;
      for (std::uint64_t seed = 0; seed < 20; ++seed) {
        ChoiceSource source = ChoiceSource::from_seed(seed);
        const Case kept{make_query(query_class, kind, source), query_class.name, source.coin()};
        const Case again = parse_case(format_case(kept), "again");
        ASSERT_EQ(again.query.kind, kind);
        ASSERT_EQ(again.seed, kept.seed);
        ASSERT_EQ(again.touches, kept.touches);
        ASSERT_EQ(again.query.options.max_intervals, kept.query.options.max_intervals);
        const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
        ASSERT_EQ(bits(again.query.options.tolerance), bits(kept.query.options.tolerance));
        for (std::size_t i = 0; i < 4; ++i) {
          for (int axis = 0; axis < 3; ++axis) {
            ASSERT_EQ(bits(again.query.x_t0[i][axis]), bits(kept.query.x_t0[i][axis]));
            ASSERT_EQ(bits(again.query.x_t1[i][axis]), bits(kept.query.x_t1[i][axis]));
          }
        }
      }
    }
  }
}

TEST(CaseFile, KeepsWhichPluginFailed) {
  Case kept = parse_case(kGood, "x.case");
  EXPECT_FALSE(kept.plugin);
  const std::string hostile = " my # kernel\n\\\xc3\xa9.so ";
  kept.plugin = PluginRecord{hostile, "missed", 130};
  const std::string text = format_case(kept);
  const Case again = parse_case(text, "again");
  ASSERT_TRUE(again.plugin);
  EXPECT_EQ(again.plugin->library, hostile);
  EXPECT_EQ(again.plugin->failure, "missed");
  EXPECT_EQ(again.plugin->batch, 130);
  EXPECT_EQ(parse_case(testing::replaced(text, "batch=130", "batch"), "again").plugin->batch, kUsualBatch);
  EXPECT_EQ(parse_case(testing::replaced(text, "batch=130", "alone"), "again").plugin->batch, std::nullopt);
  expect_bad_case(testing::replaced(text, "missed batch", "missed often"),
                  "x.case:4: plugin: 'alone', 'batch' or 'batch=NUMBER' is wanted, not 'often=130'");
  expect_bad_case(testing::replaced(text, "batch=130", "batch="), "x.case:4: batch: '' is not an integer");
  expect_bad_case(testing::replaced(text, "batch=130", "batch=1048577"),
                  "x.case:4: batch: '1048577' is not an integer");
  expect_bad_case(testing::replaced(kGood, "p 0x1.9", "plugin missed alone\np 0x1.9"),
                  "x.case:5: plugin: its file is missing");
}

TEST(CaseFile, KeepsThePropertyAndWhatItChose) {
  Case kept = parse_case(kGood, "x.case");
  EXPECT_EQ(kept.property, "ccd");
  kept.property = "scale";
  EXPECT_EQ(parse_case(format_case(kept), "again").choices, std::vector<std::uint32_t>());
  kept.choices = {1403, 0, 4294967295};
  const Case again = parse_case(format_case(kept), "again");
  EXPECT_EQ(again.property, "scale");
  EXPECT_EQ(again.choices, kept.choices);
}

TEST(CaseFile, NamesTheLineOfWhatIsWrong) {
  expect_bad_case(testing::replaced(kGood, "=64", "=64 property=scala"),
                  "x.case:4: there is no property 'scala' of queries");
  expect_bad_case(testing::replaced(kGood, "=64", "=64 choices=1"), "x.case:4: expected 'property=...'");
  expect_bad_case(testing::replaced(kGood, "=64", "=64 property=scale choices=1,"),
                  "x.case:4: choices: '' is not an integer");
  expect_bad_case(testing::replaced(kGood, "=64", "=64 property=scale choices=1,-2"),
                  "x.case:4: choices: '-2' is not an integer");
  expect_bad_case("", "x.case:1: the case ends too early");
  expect_bad_case(testing::replaced(kGood, "selvage-case 1", "selvage-case 2"),
                  "x.case:1: cases of version '2' are not known here");
  expect_bad_case(testing::replaced(kGood, " vf", " fv"), "x.case:1: the kind of pair");
  expect_bad_case(testing::replaced(kGood, "seed somewhere:7", "seed"), "x.case:3: a word is missing");
  expect_bad_case(testing::replaced(kGood, "tolerance=0x1p-20", "tolerance="), "x.case:4: ");
  expect_bad_case(testing::replaced(kGood, "max_intervals=64", "max_intervals=0"),
                  "x.case:4: '0' is not a positive count");
  expect_bad_case(testing::replaced(kGood, "0x1.9p+6", "0x1.9q+6"), "x.case:5: '0x1.9q+6' is not a finite number");
  expect_bad_case(testing::replaced(kGood, "0x1.9p+6", "nan"), "x.case:5: ");
  expect_bad_case(testing::replaced(kGood, "0x1.9p+6", "--1"), "x.case:5: ");
  expect_bad_case(testing::replaced(kGood, "0x1.9p+6", "1e999"), "x.case:5: ");
  expect_bad_case(testing::replaced(kGood, "5.5", "5.5 6"), "x.case:6: unexpected '6'");
  expect_bad_case(testing::replaced(kGood, "a 0 1 2", "b 0 1 2"), "x.case:6: expected 'a'");
  expect_bad_case(testing::replaced(kGood, "touches", "maybe"), "x.case:9: the answer is");
  expect_bad_case(testing::replaced(kGood, "touches", "touches apart"), "x.case:9: unexpected 'apart'");
  expect_bad_case(testing::replaced(kGood, "expect ", "except "), "x.case:9: expected 'expect'");
  expect_bad_case(kGood + std::string("more\n"), "x.case:10: nothing may follow");
}

TEST(CaseFile, EveryTruncationIsAnError) {
  const std::string whole = kGood;
  for (std::size_t length = 0; length + 3 < whole.size(); ++length) {
    EXPECT_THROW((void)parse_case(whole.substr(0, length), "cut"), io::Error) << length;
  }
}

}  // namespace
}  // namespace selvage::fuzz
