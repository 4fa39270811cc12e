// A violation that verify reports is a case that replay explains.
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/cli/two_faces.h"

namespace selvage {
namespace {

using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;
using testing::two_faces;

nlohmann::json parse(const std::filesystem::path& file) { return nlohmann::json::parse(slurp(file)); }

}  // namespace

TEST(ReplayCommand, ExplainsWhatVerifyFound) {
  const TemporaryFolder folder;
  const auto a = folder.path() / "a.obj", b = folder.path() / "b.obj", report = folder.path() / "report.json",
             explained = folder.path() / "replay.json";
  spit(a, two_faces(1));
  spit(b, two_faces(-3));
  const auto verified = run_program(folder, {"verify", "--motion", a, b, "--json", report, "--cases",
                                             folder.path() / "cases", "--max-violations", "2"});
  ASSERT_EQ(verified.exit_code, 1) << verified.err;
  const auto violations = parse(report)["violations"];
  ASSERT_EQ(violations.size(), 2U);
  const std::string file = violations[0]["case"], command = violations[0]["replay"];
  EXPECT_EQ(command, "selvage replay " + file);
  EXPECT_NE(verified.out.find("    " + command + "\n"), std::string::npos) << verified.out;
  EXPECT_EQ(violations[0]["positions"], (nlohmann::json{{1, 1, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}));
  EXPECT_EQ(violations[0]["bits_t1"][0], (nlohmann::json{"0x1p+0", "0x1p+0", "-0x1.8p+1"}));

  const auto replayed = run_program(folder, {"replay", file, "--json", explained});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
  const auto json = parse(explained);
  EXPECT_EQ(json["schema"], "selvage.replay/1");
  const auto& entry = json["cases"][0];
  EXPECT_EQ(entry["kind"], "vf");
  EXPECT_EQ(entry["exact"]["kind"], "cross");
  EXPECT_EQ(entry["exact"]["t"]["lower"], "1/4");
  EXPECT_EQ(entry["kernel"]["verdict"], "collides");
  EXPECT_LE(entry["kernel"]["toi_lower"]["number"], 0.25);
  EXPECT_GT(entry["kernel"]["toi_lower"]["number"], 0.2499);
  EXPECT_EQ(entry["textbook"]["collides"], true);
  EXPECT_EQ(entry["outcome"], "agree");
  // n . r = 16 (1 - 4 t): constant normal, linear height.
  EXPECT_EQ(entry["polynomials"][0]["bernstein"], (nlohmann::json{"16", "-16/3", "-80/3", "-48"}));
  EXPECT_EQ(entry["polynomials"][0]["sign_t0"], 1);
  EXPECT_EQ(entry["polynomials"][0]["sign_t1"], -1);
  EXPECT_EQ(entry["polynomials"][0]["roots"].size(), 1U);
  EXPECT_EQ(entry["polynomials"][0]["roots"][0]["upper"], "1/4");
}

TEST(ReplayCommand, EveryKindOfViolationBecomesACase) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", cases = folder.path() / "cases";
  // Two faces in one plane that overlap, one without area, and one that is near.
  spit(mesh, two_faces(0) + "v 9 0 0\nv 9 0 1\nv 9 0 2\nf 7 8 9\n" + "v 1 1 0.5\nv 2 1 0.5\nv 1 2 0.5\nf 10 11 12\n");
  ASSERT_EQ(run_program(folder, {"verify", mesh, "--min-distance", "1", "--cases", cases}).exit_code, 1);
  std::set<std::string> kinds;
  for (const auto& entry : std::filesystem::directory_iterator(cases)) {
    const std::string name = entry.path().filename();
    kinds.insert(name.substr(0, name.find('-', name.find('-', 6) + 1)));
    // The kernel is asked what the check has found: whether they come within the distance.
    const std::string text = slurp(entry.path());
    const bool is_near = name.starts_with("frame-0-vf") || name.starts_with("frame-0-ee");
    EXPECT_EQ(text.find("options tolerance=0x1p+0 ") != text.npos, is_near) << name << "\n" << text;
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"frame-0-ee", "frame-0-overlap", "frame-0-self", "frame-0-vf"}));
  const auto replayed = run_program(folder, {"replay", cases, "--json", folder.path() / "r.json"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out;
  EXPECT_NE(replayed.out.find("two triangles at one instant"), std::string::npos);
  EXPECT_NE(replayed.out.find("exact:    overlap"), std::string::npos) << replayed.out;
}

TEST(ReplayCommand, CasesOfTwoChecksAreNotMixed) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", cases = folder.path() / "cases";
  spit(mesh, two_faces(0));
  const std::vector<std::string> arguments = {"verify", mesh, "--cases", cases};
  ASSERT_EQ(run_program(folder, arguments).exit_code, 1);
  const auto again = run_program(folder, arguments);
  EXPECT_EQ(again.exit_code, 4) << again.out;
  EXPECT_NE(again.err.find(cases.string() + ": there are cases already; remove them"), std::string::npos) << again.err;
  auto part = arguments;  // of one check, whose parts write side by side
  part.insert(part.end(), {"--shard", "1/1"});
  EXPECT_EQ(run_program(folder, part).exit_code, 1);
  auto resumed = arguments;
  resumed.insert(resumed.end(), {"--resume", "--json", folder.path() / "r.json"});
  EXPECT_EQ(run_program(folder, resumed).exit_code, 1);
  for (const auto& entry : std::filesystem::directory_iterator(cases)) std::filesystem::remove(entry.path());
  spit(cases / "notes.txt", "mine");
  EXPECT_EQ(run_program(folder, arguments).exit_code, 1);
}

TEST(ReplayCommand, AByteOrderMarkIsSkipped) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", cases = folder.path() / "cases";
  spit(mesh, two_faces(0));
  ASSERT_EQ(run_program(folder, {"verify", mesh, "--cases", cases}).exit_code, 1);
  for (const auto& entry : std::filesystem::directory_iterator(cases)) {
    spit(entry.path(), "\xef\xbb\xbf" + slurp(entry.path()));
  }
  const auto replayed = run_program(folder, {"replay", cases});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
}

TEST(ReplayCommand, KeptCasesAgree) {
  const auto replayed = run_program({"replay", SELVAGE_SOURCE_DIR "/tests/fuzz/cases"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
  EXPECT_NE(replayed.out.find("tight-inclusion-misses.case: "), std::string::npos) << replayed.out;
}

TEST(ReplayCommand, AWrongExpectationIsThree) {
  const TemporaryFolder folder;
  const auto motion = folder.path() / "motion.case", overlap = folder.path() / "overlap.case";
  spit(motion,
       "selvage-case 1 vf\nseed hand\noptions tolerance=0x0p+0 max_intervals=64\np 1 1 1  1 1 -1\na 0 0 0  0 0 0\n"
       "b 4 0 0  4 0 0\nc 0 4 0  0 4 0\nexpect apart\n");
  spit(overlap,
       "selvage-case 1 overlap\nseed hand\na 0 0 0 0\nb 1 4 0 0\nc 2 0 4 0\nd 3 1 1 1\ne 4 2 1 1\nf 5 1 2 1\n"
       "expect touches\n");
  for (const auto& file : {motion, overlap}) {
    const auto replayed = run_program(folder, {"replay", file});
    EXPECT_EQ(replayed.exit_code, 3) << replayed.out << replayed.err;
    EXPECT_NE(replayed.out.find("EXPECTS ANOTHER ANSWER"), std::string::npos) << replayed.out;
  }
}

TEST(ReplayCommand, WhatTheKernelPromisesNothingAboutIsSaidToBeSo) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.case", json = folder.path() / "r.json";
  const auto replay = [&](const std::string& tolerance, const std::string& x) {
    spit(file, "selvage-case 1 vf\nseed hand\noptions tolerance=" + tolerance + " max_intervals=64\np " + x +
                   " 1 1  1 1 -1\na 0 0 0  0 0 0\nb 4 0 0  4 0 0\nc 0 4 0  0 4 0\nexpect apart\n");
    return run_program(folder, {"replay", "--json", json, file});
  };
  EXPECT_EQ(replay("0x1p-20", "0x1p+1000").exit_code, 0);
  const auto outside = replay("0x1p-20", "0x1.0000000000001p+1000");
  EXPECT_EQ(outside.exit_code, 3) << outside.out << outside.err;
  EXPECT_EQ(outside.out.find("holds"), std::string::npos) << outside.out;
  EXPECT_NE(outside.out.find("  property: ccd: not judged, and no plugin asked: a coordinate is beyond 2^1000\n"),
            std::string::npos)
      << outside.out;
  EXPECT_NE(outside.out.find("OUTSIDE THE DOMAIN: nothing is promised\n"), std::string::npos) << outside.out;
  EXPECT_EQ(parse(json)["cases"][0]["outcome"], "outside");
  const auto negative = replay("-0x1p-20", "9");
  EXPECT_EQ(negative.exit_code, 3) << negative.out;
  EXPECT_EQ(negative.err,
            "selvage: " + file.string() + ":3: tolerance: -0x1p-20 is negative; it is a distance, from 0 up\n");
}

TEST(ReplayCommand, TheTextbooksMissIsNamed) {
  // Edges of length 1e60 that cross at a time that is no double: at the nearest one they are far apart.
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.case";
  spit(file,
       "selvage-case 1 ee\n"
       "seed hand\n"
       "options tolerance=0x0p+0 max_intervals=4096\n"
       "a -1.1e60 3.7e59 1.3e59  -1.3e60 2.9e59 -1.7e58\n"
       "b 1.9e60 1.3e59 1.7e59  2.3e60 0.7e59 -2.3e58\n"
       "c 1.1e59 -1.7e60 1.9e58  1.3e59 -2.1e60 2.3e58\n"
       "d 2.3e59 2.9e60 -3.1e58  1.9e59 3.1e60 -2.7e58\n"
       "expect touches\n");
  const auto replayed = run_program(folder, {"replay", file});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
  EXPECT_NE(replayed.out.find("separated: A MISS"), std::string::npos) << replayed.out;
}

TEST(ReplayCommand, CasesOfOtherLevelsAreRunAgain) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.case";
  const std::string surface =
      "selvage-case 1 subdivision\nseed hand\nfailure touches\nset levels 1\nvertices 6\nv 0 0 0 0\nv 4 0 0 0\n"
      "v 0 4 0 0\nv 1 1 HEIGHT 0\nv 2 1 1 0\nv 1 2 1 0\nfaces 2\nf 0 1 2\nf 3 4 5\n";
  const auto replay = [&](const std::string& height) {
    std::string text = surface;
    spit(file, text.replace(text.find("HEIGHT"), 6, height));
    return run_program(folder, {"replay", file});
  };
  const auto holds = replay("1");
  EXPECT_EQ(holds.exit_code, 0) << holds.err;
  EXPECT_NE(holds.out.find("exactly, the frame after level 1 is free of touching"), std::string::npos) << holds.out;
  EXPECT_NE(holds.out.find("no promise is broken"), std::string::npos) << holds.out;
  const auto unfit = replay("-1");
  EXPECT_EQ(unfit.exit_code, 3);
  EXPECT_NE(unfit.err.find("a.case: the surface intersects itself at the start"), std::string::npos) << unfit.err;
  const auto hostile = replay("1e999");
  EXPECT_EQ(hostile.exit_code, 3);
  EXPECT_NE(hostile.err.find("a.case:9: '1e999' is not a finite number"), std::string::npos) << hostile.err;
}

TEST(ReplayCommand, BadCasesAreThreeAndNamed) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.case";
  const std::string good =
      "selvage-case 1 overlap\nseed s\na 0 0 0 0\nb 1 4 0 0\nc 2 0 4 0\nd 3 1 1 1\ne 4 2 1 1\nf 5 1 2 1\n";
  for (const auto& bad :
       std::vector<std::string>{std::string("selvage-case 2 vf\n"), std::string(), good, good + "expect apart\nmore\n",
                                "selvage-case 1 overlap\nseed s\na 0 0 0 0\nb 0 4 0 0\nc 2 0 4 0\nd 3 1 1 1\ne 4 2 1 "
                                "1\nf 5 1 2 1\nexpect apart\n",
                                "selvage-case 1 overlap\nseed s\na 0 0 0 0\nb 1 4 0 0\nc 2 0 4 0\nd 0 1 1 1\ne 4 2 1 "
                                "1\nf 5 1 2 1\nexpect apart\n"}) {
    spit(file, bad);
    const auto replayed = run_program(folder, {"replay", file});
    EXPECT_EQ(replayed.exit_code, 3) << bad << replayed.out;
    EXPECT_NE(replayed.err.find("a.case:"), std::string::npos) << replayed.err;
  }
  EXPECT_EQ(run_program(folder, {"replay", folder.path() / "absent.case"}).exit_code, 4);
  EXPECT_EQ(run_program(folder, {"replay"}).exit_code, 2);
}

}  // namespace selvage
