// Values of options that make no sense are refused before any work, and named.
#include <gtest/gtest.h>

#include "tests/cli/run_program.h"

namespace selvage {
namespace {

using testing::run_program;

struct Mistake {
  std::vector<std::string> arguments;
  std::string option, words;  ///< in the message
};

/// Ends at the first that is let pass: a command that takes what it should refuse may run for minutes.
void expect_usage_errors(const std::vector<Mistake>& mistakes) {
  for (const Mistake& mistake : mistakes) {
    if (::testing::Test::HasFailure()) return;
    const auto result = run_program(mistake.arguments);
    EXPECT_EQ(result.exit_code, 2) << mistake.arguments[0] << mistake.option << result.out << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find(mistake.option), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(mistake.words), std::string::npos) << result.err;
  }
}

}  // namespace

TEST(Options, ANumberIsFinite) {
  for (const std::string value : {"nan", "-nan", "inf"}) {
    const std::string words = "'" + value + "' is not a number ";
    expect_usage_errors({
        {{"bench", "ccd", "--tolerance", value}, "--tolerance", words + "from 0 up"},
        {{"bench", "queries", "none.csv", "--tolerance", value}, "--tolerance", words + "from 0 up"},
        {{"bench", "broad", "--pleats", value}, "--pleats", words + "from 0.01 to 1"},
        {{"render", "none", "-o", "a.png", "--azimuth", value}, "--azimuth", words + "from -360 to 360"},
        {{"render", "none", "-o", "a.png", "--elevation", value}, "--elevation", words + "from -89 to 89"},
        {{"fuzz", "ccd", "--cases", "1", "--case-time", value}, "--case-time", words + "above 0"},
        {{"fuzz", "ccd", "--time", value}, "--time", "60s"},
        {{"verify", "none.obj", "--min-distance", value}, "--min-distance", words + "from 0 up"},
    });
  }
}

TEST(Options, ANumberThatWouldBeRoundedToZeroIsRefused) {
  for (const std::string value : {"1e-400", "-1e-400", "1e-9999"}) {
    const std::string words = "'" + value + "' is too small: it would be rounded to 0";
    expect_usage_errors({
        {{"verify", "none.obj", "--min-distance", value}, "--min-distance", words},
        {{"bench", "ccd", "--tolerance", value}, "--tolerance", words},
        {{"fuzz", "ccd", "--cases", "1", "--case-time", value}, "--case-time", words},
    });
  }
  for (const std::string value : {"0", "0e-400", "5e-324", "1e-310"}) {
    EXPECT_EQ(run_program({"verify", "none.obj", "--min-distance", value}).exit_code, 4) << value << ": no such file";
  }
}

// As in files, where the same text is refused.
TEST(Options, ANumberIsDecimal) {
  for (const std::string value : {"0x1", "0X1p3", "-0x1", "0x1p-1100", "0x", "1f", "1,5", " 1", "1 "}) {
    const std::string words = "'" + value + "' is not a number ";
    expect_usage_errors({
        {{"verify", "none.obj", "--min-distance", value}, "--min-distance", words + "from 0 up"},
        {{"verify", "none.obj", "--max-violations", value}, "--max-violations", words + "from 0 to"},
        {{"fuzz", "ccd", "--cases", value}, "--cases", words + "from 1 to"},
        {{"fuzz", "ccd", "--cases", "1", "--case-time", value}, "--case-time", words + "above 0"},
        {{"render", "none", "-o", "a.png", "--azimuth", value}, "--azimuth", words + "from -360 to 360"},
    });
  }
  for (const std::string value : {"0x10s", "0x1d", "0x10", " 1s", "1 s", "1ss", "s", "-1s", "1e999d", "nans"}) {
    expect_usage_errors({{{"fuzz", "ccd", "--time", value}, "--time", "60s"}});
  }
  // "010" was 8.
  for (const std::string value : {"0x10", "0X10", "010", "+010", "1e2", "1.5", " 16", "99999999999999999999"}) {
    const std::string words = "'" + value + "' is not a ";
    expect_usage_errors({
        {{"render", "none", "-o", "a.png", "--tiles", value}, "--tiles", words + "whole number from 1 to 1000"},
        {{"render", "none", "-o", "a.png", "--columns", value}, "--columns", words},
        {{"render", "none", "-o", "a.png", "--width", value}, "--width", words},
        {{"verify", "none.obj", "--threads", value}, "--threads", words + "whole number from 0 to 1024"},
        {{"verify", "none.obj", "--html-mb", value}, "--html-mb", words},
        {{"view", "none", "-o", "a.html", "--max-mb", value}, "--max-mb", words},
        {{"subdivide", "none", "-o", "none", "--levels", value}, "--levels", words},
        {{"bench", "ccd", "--repeat", value}, "--repeat", words},
        {{"bench", "broad", "--threads", "1," + value}, "--threads", words},
        {{"bench", "sim", "--growth", value}, "--growth", words},
    });
  }
  for (const std::string value : {"0x11", "017", "021"}) {
    expect_usage_errors({
        {{"bench", "sim", "--finest-mesh", value}, "--finest-mesh", "'" + value + "' is not a whole number"},
        {{"render", "none", "-o", "a.png", "--frames", value}, "--frames", "'" + value + "' is not a whole number"},
        {{"fuzz", "step", "--cases", "1", "--seed", value}, "--seed", "'" + value + "' is not a whole number"},
    });
  }
  for (const std::string value : {"+1", "1e0", ".5", "1.", "00.5"}) {
    EXPECT_EQ(run_program({"verify", "none.obj", "--min-distance", value}).exit_code, 4) << value << ": no such file";
  }
}

TEST(Options, TheRangeIsSaidInShort) {
  expect_usage_errors({
      {{"verify", "none.obj", "--max-violations", "-1"},
       "--max-violations",
       "'-1' is not a number from 0 to 1000000000000000"},
      {{"verify", "none.obj", "--max-violations", "9999999999999999999"},
       "--max-violations",
       "from 0 to 1000000000000000"},
      {{"fuzz", "ccd", "--cases", "0"}, "--cases", "'0' is not a number from 1 to 1000000000000000"},
      {{"fuzz", "ccd", "--jobs", "0"}, "--jobs", "'0' is not a number from 1 up"},
      {{"fuzz", "ccd", "--case-time", "0"}, "--case-time", "'0' is not a number above 0"},
      {{"bench", "queries", "none.csv", "--tolerance", "-1"}, "--tolerance", "'-1' is not a number from 0 up"},
  });
}

TEST(Options, AWordIsOneOfAFew) {
  expect_usage_errors({
      {{"bench", "sim", "--solvers", "soup"}, "--solvers", "'soup' is not explicit|implicit"},
      {{"bench", "sim", "--solvers", "explicit,soup"}, "--solvers", "'soup' is not explicit|implicit"},
      {{"bench", "sim", "--solvers", "0"}, "--solvers", "'0' is not explicit|implicit"},
      {{"sim", "none.toml", "-o", "none", "--quality", "soup"}, "--quality", "'soup' is not draft|full"},
  });
}

// campaign.json could not be read back, and beyond 2^63 the numbers of cases and shards would overflow.
TEST(Options, ACampaignIsNoLargerThanItsCounts) {
  for (const std::string cases : {"1000000000000001", "9007199254740993", "9223372036854775807"}) {
    const std::string words = "'" + cases + "' is not a number from 1 to 1000000000000000";
    expect_usage_errors({{{"fuzz", "ccd", "--cases", cases}, "--cases", words}});
  }
  for (const std::string shard : {"1/1000001", "2/18446744073709551615"}) {
    expect_usage_errors({{{"fuzz", "ccd", "--cases", "1", "--shard", shard}, "--shard", "at most 1000000 shards"}});
  }
  const std::string help = run_program({"fuzz", "--help"}).out;
  EXPECT_NE(help.find("from 1 to 1000000000000000"), std::string::npos) << help;
}

TEST(Options, AFrameIsAWholeNumber) {
  for (const std::string frame : {"-1", "1.5", "", "99999999999999999999"}) {
    const std::string words = "'" + frame + "' is not a whole number";
    expect_usage_errors({
        {{"render", "none", "-o", "a.png", "--frames", frame}, "--frames", words},
        {{"subdivide", "none", "-o", "none", "--frame", frame}, "--frame", words},
    });
  }
}

// A list took all the words that followed, and the files of the command with them.
TEST(Options, AListTakesOneWordAUse) {
  const std::vector<std::vector<std::string>> files_are_missing = {
      {"render", "--frames", "0,1", "none", "-o", "a.png"},
      {"render", "--frames", "0", "--frames", "1,2", "none", "-o", "a.png"},
      {"bench", "broad", "--threads", "1,2", "none.obj", "none.obj"},
      {"bench", "broad", "--threads", "1", "--threads", "2", "none.obj", "none.obj"},
      {"bench", "broad", "--pleats", "0.2,0.1", "none.obj", "none.obj"},
      {"bench", "ccd", "--truth", "boxes", "verdicts", "none.obj", "none.obj"},
      {"bench", "ccd", "--truth", "boxes", "verdicts", "--truth", "more", "still", "none.obj", "none.obj"},
  };
  for (const auto& arguments : files_are_missing) {
    const auto result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 4) << arguments[0] << " " << arguments[1] << result.out << result.err;
    EXPECT_NE(result.err.find("none"), std::string::npos) << result.err;
  }
  EXPECT_EQ(run_program({"bench", "verify", "--faces", "100", "200", "--repeat", "1"}).exit_code, 2);
  EXPECT_EQ(run_program({"bench", "verify", "--threads", "1", "2", "--faces", "100", "--repeat", "1"}).exit_code, 2);
}

TEST(Options, HelpIsPlainText) {
  for (const char* command :
       {"bench", "convert", "doctor", "fuzz", "merge", "render", "replay", "sim", "subdivide", "verify", "view"}) {
    const auto help = run_program({command, "--help"});
    EXPECT_EQ(help.exit_code, 0) << command;
    for (const char c : help.out)
      ASSERT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20) << command << help.out;
    EXPECT_EQ(help.out.find("ENUM"), std::string::npos) << help.out;
  }
  const std::string sim = run_program({"sim", "--help"}).out;
  EXPECT_NE(sim.find("--quality draft|full"), std::string::npos) << sim;
}

TEST(Options, AChoiceIsOneOfItsWords) {
  for (const std::string value : {"1", "0", "", "Y"}) {
    const std::string words = "'" + value + "' is not ";
    expect_usage_errors({
        {{"sim", "none.toml", "-o", "none", "--record", value}, "--record", words + "frames|steps"},
        {{"sim", "none.toml", "-o", "none", "--quality", value}, "--quality", words + "draft|full"},
        {{"view", "none", "-o", "none", "--up", value}, "--up", words + "y|z"},
        {{"render", "none", "-o", "none.png", "--up", value}, "--up", words + "y|z"},
    });
  }
}

TEST(Options, ANumberOfACaseIsWhole) {
  for (const std::string number : {"99999999999999999999", "-1", "", "1x", "soup"}) {
    expect_usage_errors({{{"fuzz", "step", "--only", "soup:" + number}, "--only", "'soup:" + number + "'"}});
  }
  expect_usage_errors({{{"fuzz", "step", "--cases", "1", "--seed", "-1"}, "--seed", "'-1' is not a whole number"}});
}

// Hours of work would end in an error.
TEST(Options, ANameThatNoFileCanHaveIsFourBeforeTheWork) {
  const testing::TemporaryFolder folder;
  const auto path_of = [&](std::size_t length, const std::string& extension) {
    return (folder.path() / (std::string(length - extension.size(), 'n') + extension)).string();
  };
  const std::string mesh = folder.path() / "a.obj", case_file = folder.path() / "a.case",
                    report = folder.path() / "r.json", queries = folder.path() / "q_vf.csv",
                    json = path_of(256, ".json");
  testing::spit(mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  testing::spit(case_file,
                "selvage-case 1 vf\nseed hand\noptions tolerance=0 max_intervals=64\np 1 1 1  1 1 -1\n"
                "a 0 0 0  0 0 0\nb 4 0 0  4 0 0\nc 0 4 0  0 4 0\nexpect touches\n");
  std::string rows;
  for (int i = 0; i < 8; ++i) rows += std::to_string(i) + ",1,0,1,0,1,0\n";
  testing::spit(queries, rows);
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--json", report}).exit_code, 0);
  const std::vector<std::string> kCommands[] = {
      {"verify", mesh, "--json", json},
      {"verify", mesh, mesh, "--json", path_of(247, ".json")},  // progress is kept in NAME.json.progress
      {"verify", mesh, "--html", json},
      {"verify", mesh, "--cases", json},
      {"verify", mesh, "--json", folder.path() / std::string(256, 'n') / "report.json"},
      {"merge", report, "-o", json},
      {"merge", report, "-o", folder.path() / "whole.json", "--html", json},
      {"convert", mesh, "-o", path_of(256, ".npz")},
      {"convert", mesh, mesh, "-o", path_of(255, ".obj")},  // whose frames are NAME_000000.obj
      {"render", mesh, "-o", path_of(256, ".png")},
      {"view", mesh, "-o", json},
      {"subdivide", mesh, "-o", path_of(256, "")},
      {"sim", SELVAGE_SOURCE_DIR "/sim/scenes/demo.toml", "-o", path_of(256, "")},
      {"replay", case_file, "--json", json},
      {"fuzz", "scale", "--cases", "1", "--artifacts", path_of(256, "")},
      {"doctor", "--json", json},
      {"bench", "queries", queries, "--json", json},
      {"bench", "ccd", "--sheet", "10", "--json", json},
      {"bench", "ccd", "--sheet", "10", "--svg", json},
      {"bench", "broad", "--largest", "100", "--repeat", "1", "--json", json},
      {"bench", "methods", "--sheet", "2", "--hard", "10", "--repeat", "1", "--json", json},
      {"bench", "verify", "--faces", "100", "--repeat", "1", "--json", json},
      {"bench", "stability", "--quick", "--case", "knot", "--json", json},
      {"bench", "sim", "--finest-mesh", "17", "--growth", "2", "--module-nodes", "2", "--repeat", "1", "--json", json},
  };
  for (const auto& arguments : kCommands) {
    const auto result = run_program(folder, arguments);
    const std::string what = arguments[0] + " " + arguments[1] + ": " + result.out + result.err;
    EXPECT_EQ(result.exit_code, 4) << what;
    EXPECT_EQ(result.out, "") << what;
    EXPECT_NE(result.err.find("File name too long; shorten the name"), std::string::npos) << what;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_LT(entry.path().filename().string().size(), 40U) << entry.path();
  }
}

// Of one frame nothing is kept: the report follows at once.
TEST(Options, OnlyWhatKeepsProgressNeedsANameForIt) {
  const testing::TemporaryFolder folder;
  const std::string mesh = folder.path() / "a.obj";
  testing::spit(mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto json_of = [&](std::size_t length) {
    return (folder.path() / (std::string(length - 5, 'n') + ".json")).string();
  };
  for (const std::vector<std::string>& of_one_frame :
       {std::vector<std::string>{mesh}, {mesh, "--resume"}, {mesh, mesh, "--shard", "2/2"}}) {
    std::vector<std::string> arguments = {"verify", "--json", json_of(255)};
    arguments.insert(arguments.end(), of_one_frame.begin(), of_one_frame.end());
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(std::filesystem::remove(json_of(255)));
  }
  EXPECT_EQ(run_program(folder, {"verify", mesh, mesh, "--json", json_of(246)}).exit_code, 0);
  for (const std::size_t length : {247U, 255U}) {
    const auto result = run_program(folder, {"verify", mesh, mesh, "--json", json_of(length)});
    EXPECT_EQ(result.exit_code, 4) << result.out;
    const std::string words = json_of(length) +
                              ".progress: cannot keep progress there: File name too long; shorten the name of the "
                              "report, beside which it is kept, to 246 bytes";
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(json_of(length)));
  }
}

TEST(Options, AFolderThatCannotBeMadeIsFour) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "file";
  testing::spit(file, "whole");
  for (const std::filesystem::path& artifacts : {file, std::filesystem::path("/proc/x")}) {
    const auto result = run_program(folder, {"fuzz", "ccd", "--cases", "10", "--artifacts", artifacts});
    EXPECT_EQ(result.exit_code, 4) << result.out << result.err;
    EXPECT_NE(result.err.find(artifacts.string() + ": cannot use: "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("; check the path"), std::string::npos) << result.err;
  }
  EXPECT_EQ(testing::slurp(file), "whole");
}

}  // namespace selvage
