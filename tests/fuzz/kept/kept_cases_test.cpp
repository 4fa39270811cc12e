// Every failure ever kept is replayed: the checker's answer must be the recorded one, and every promise must hold (F3).
#include <gtest/gtest.h>

#include "fuzz/kept/case_file.h"
#include "fuzz/kept/kept_case.h"
#include "fuzz/oracle/query_property.h"
#include "fuzz/run/redraw.h"
#include "tests/cli/run_program.h"

namespace selvage::fuzz {
namespace {

const char* const kFolder = SELVAGE_SOURCE_DIR "/tests/fuzz/cases";
const char* const kLevels = SELVAGE_SOURCE_DIR "/tests/fuzz/cases/levels";  // of all levels but the query's

TEST(KeptCases, EveryPromiseHoldsOnThem) {
  const std::vector<std::filesystem::path> files = case_files(kFolder);
  ASSERT_FALSE(files.empty());
  for (const std::filesystem::path& file : files) {
    const Case kept = read_case(file);
    EXPECT_EQ(exact_motion(kept.query, verify::Detail::kDecision).touches, kept.touches) << file;
    for (const QueryProperty& property : query_properties()) {
      for (std::uint64_t seed = 0; seed < 20; ++seed) {  // for what a property chooses besides the query
        ChoiceSource source = ChoiceSource::from_seed(seed);
        EXPECT_EQ(property.check(kept.query, selvage_kernel, source).failure, "") << file << " " << property.name;
      }
    }
  }
}

TEST(KeptCases, NoLevelBreaksItsPromiseOnThem) {
  const std::vector<std::filesystem::path> files = case_files(kLevels);
  ASSERT_FALSE(files.empty());
  for (const std::filesystem::path& file : files) {
    const std::string text = testing::slurp(file);
    const ParsedCase parsed = parse_kept_case(text, file.string(), redraw);
    const Retrial retrial = parsed.kept->retry();
    EXPECT_EQ(retrial.unfit, "") << file;
    EXPECT_EQ(retrial.failure, "") << file;
  }
}

TEST(KeptCases, AreStoredAsTheyWouldBeWritten) {
  for (const std::filesystem::path& file : case_files(kFolder)) {
    const Case kept = read_case(file);
    const Case again = parse_case(format_case(kept), "again");
    EXPECT_EQ(again.query.x_t0, kept.query.x_t0) << file;
    EXPECT_EQ(again.query.x_t1, kept.query.x_t1) << file;
  }
}

}  // namespace
}  // namespace selvage::fuzz
