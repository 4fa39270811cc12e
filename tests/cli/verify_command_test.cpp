#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/sequence.h"
#include "tests/cli/run_program.h"
#include "tests/cli/two_faces.h"

namespace selvage {
namespace {

using testing::expect_text;
using testing::run_program;
using testing::spit;
using testing::TemporaryFolder;
using testing::two_faces;

}  // namespace

TEST(VerifyCommand, APolygonThatIsNotConvexIsNamedAsTheCause) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj";
  const std::string corners = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\n";
  spit(mesh, corners + "f 1 2 3 4 5\n");
  const auto concave = run_program(folder, {"verify", mesh});
  EXPECT_EQ(concave.exit_code, 1);
  expect_text(concave.err, "note: faces 0 and 1 go around one corner, as those of a polygon do");
  spit(mesh, corners + "f 1 2 3\nf 1 3 4\nf 1 4 5\n");  // triangles of the user's own
  const auto folded = run_program(folder, {"verify", mesh});
  EXPECT_EQ(folded.exit_code, 1);
  EXPECT_EQ(folded.err.find("go around one corner"), std::string::npos) << folded.err;
}

TEST(VerifyCommand, CleanFrameIsZero) {
  const TemporaryFolder folder;
  spit(folder.path() / "a.obj", two_faces(1));
  const auto result = run_program(folder, {"verify", folder.path() / "a.obj"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(result.out.starts_with("clean\n")) << result.out;
  EXPECT_NE(result.out.find("1 of 1 checked, 0 violated"), std::string::npos) << result.out;
  EXPECT_EQ(result.err, "");
}

TEST(VerifyCommand, TouchingFrameIsOneAndNamed) {
  const TemporaryFolder folder;
  spit(folder.path() / "a.obj", two_faces(0));
  const auto result = run_program(folder, {"verify", folder.path() / "a.obj"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.out.find("overlap overlap, face 0, face 1 (vertices 0 1 2 3 4 5)"), std::string::npos) << result.out;
}

TEST(VerifyCommand, MotionThroughIsOneThoughBothFramesAreClean) {
  const TemporaryFolder folder;
  const auto a = folder.path() / "a.obj", b = folder.path() / "b.obj", json = folder.path() / "report.json";
  spit(a, two_faces(1));
  spit(b, two_faces(-3));
  EXPECT_EQ(run_program(folder, {"verify", a, b}).exit_code, 0);
  EXPECT_EQ(run_program(folder, {"verify", "--frames-only", a, b}).exit_code, 0);
  EXPECT_EQ(run_program(folder, {"verify", "--motion", a, b, "--json", json}).exit_code, 1);
  const auto report = nlohmann::json::parse(testing::slurp(json));
  EXPECT_EQ(report["schema"], "selvage.verify/1");
  EXPECT_EQ(report["verdict"], "violated");
  EXPECT_EQ(report["frames"], (nlohmann::json{{"checked", 2}, {"violated", 0}, {"expected", 2}}));
  EXPECT_EQ(report["motions"], (nlohmann::json{{"checked", 1}, {"violated", 1}, {"expected", 1}}));
  EXPECT_EQ(report["violations_total"], (nlohmann::json{{"vf", 3}, {"ee", 0}, {"overlap", 0}, {"self", 0}}));
  ASSERT_EQ(report["violations"].size(), 3);
  const auto& first = report["violations"][0];
  EXPECT_EQ(first["event"], "vf");
  EXPECT_EQ(first["kind"], "cross");
  EXPECT_EQ(first["features"], (nlohmann::json{3, 0}));
  EXPECT_EQ(first["t"]["lower"], "1/4");
  EXPECT_EQ(first["t"]["upper_number"], 0.25);
}

TEST(VerifyCommand, APlaceIsOfTheContactOrOfANamedVertex) {
  const TemporaryFolder folder;
  const auto a = folder.path() / "a.obj", b = folder.path() / "b.obj";
  spit(a, "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 -1 1\nv 1 9 1\nv 1 4 9\nf 4 5 6\n");
  spit(b, "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 -1 -1\nv 1 9 -1\nv 1 4 9\nf 4 5 6\n");
  const std::string edges = run_program(folder, {"verify", "--motion", a, b}).out;
  EXPECT_NE(edges.find("(vertices 0 1 3 4), with vertex 0 at (0, 0, 0) ["), std::string::npos) << edges;
  EXPECT_NE(edges.find("(vertices 0 1 2 3 4 5), with vertex 0 at (0, 0, 0) ["), std::string::npos) << edges;
  spit(b, two_faces(-3));
  spit(a, two_faces(1));
  const std::string vertices = run_program(folder, {"verify", "--motion", a, b}).out;
  EXPECT_NE(vertices.find("vf cross, vertex 3, face 0 (vertices 3 0 1 2), at ("), std::string::npos) << vertices;
}

TEST(VerifyCommand, TwoLevelsOfExactness) {
  // Vertices that come within the smallest double, and no farther.
  const TemporaryFolder folder;
  spit(folder.path() / "apart.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 5e-324\nv 2 1 1\nv 1 2 1\nf 4 5 6\n");
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "apart.obj"}).exit_code, 0);
  EXPECT_EQ(run_program(folder, {"verify", "--min-distance", "5e-324", folder.path() / "apart.obj"}).exit_code, 0);
  const auto near = run_program(folder, {"verify", "--min-distance", "1e-323", folder.path() / "apart.obj"});
  EXPECT_EQ(near.exit_code, 1);
  EXPECT_NE(near.out.find("vf near, vertex 3, face 0"), std::string::npos) << near.out;
}

TEST(VerifyCommand, MaxViolationsCapsTheListNotTheCount) {
  const TemporaryFolder folder;
  spit(folder.path() / "a.obj", two_faces(1));
  spit(folder.path() / "b.obj", two_faces(-3));
  const auto result = run_program(
      folder, {"verify", "--motion", "--max-violations", "1", folder.path() / "a.obj", folder.path() / "b.obj"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.out.find("violations: 3 vf"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("and 2 more"), std::string::npos) << result.out;
}

TEST(VerifyCommand, TheTerminalShowsTenViolationsAndTheJsonAHundred) {
  const TemporaryFolder folder;
  std::string flat;  // twelve faces without area
  for (int face = 0; face < 12; ++face) {
    for (int corner = 0; corner < 3; ++corner) flat += fmt::format("v {} {} 0\n", corner, 2 * face);
  }
  for (int face = 0; face < 12; ++face) flat += fmt::format("f {} {} {}\n", 3 * face + 1, 3 * face + 2, 3 * face + 3);
  spit(folder.path() / "a.obj", flat);
  const auto json = folder.path() / "report.json";
  const auto result = run_program(folder, {"verify", "--json", json, folder.path() / "a.obj"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.out.find("and 2 more"), std::string::npos) << result.out;
  EXPECT_EQ(nlohmann::json::parse(std::ifstream(json))["violations"].size(), 12U);
}

TEST(VerifyCommand, ChangingFacesAreUnknown) {
  const TemporaryFolder folder;
  spit(folder.path() / "a.obj", two_faces(1));
  spit(folder.path() / "b.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  const auto a = folder.path() / "a.obj", b = folder.path() / "b.obj";
  EXPECT_EQ(run_program(folder, {"verify", a, b}).exit_code, 0);  // frames alone need no pairing
  const auto result = run_program(folder, {"verify", "--motion", a, b});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_TRUE(result.out.starts_with("unknown\n")) << result.out;
  EXPECT_NE(result.out.find("b.obj"), std::string::npos) << result.out;
}

TEST(VerifyCommand, ANameWithACommaCanBeExempt) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj";
  spit(mesh,
       "o shirt, left\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\no a\\b\\\nv 1 1 0\nv 2 1 0\nv 1 2 0\nf 4 5 6\n"
       "o button\nv 9 9 9\nv 9 9 8\nv 9 8 9\nf 7 8 9\n");
  for (const std::string pair : {R"(shirt\, left,a\b\\)", R"(a\\b\\,shirt\, left)"}) {
    const auto exempt = run_program(folder, {"verify", mesh, "--exempt", pair});
    EXPECT_EQ(exempt.exit_code, 0) << pair << exempt.err;
    EXPECT_NE(exempt.out.find("exempted:   1 pairs of "), std::string::npos) << exempt.out;
  }
  const auto bare = run_program(folder, {"verify", mesh, "--exempt", "shirt, left,shirt, left"});
  EXPECT_EQ(bare.exit_code, 2);
  EXPECT_NE(bare.err.find(R"(\, for a comma in a name)"), std::string::npos) << bare.err;
}

TEST(VerifyCommand, WhatMayTouchIsCountedAndMustExist) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", json = folder.path() / "report.json";
  // Objects that overlap, and a third far away.
  spit(mesh,
       "o shirt\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\no collar\nv 1 1 0\nv 2 1 0\nv 1 2 0\nf 4 5 6\n"
       "o button\nv 9 9 9\nv 9 9 8\nv 9 8 9\nf 7 8 9\n");
  EXPECT_EQ(run_program(folder, {"verify", mesh}).exit_code, 1);
  const auto exempt = run_program(folder, {"verify", mesh, "--exempt", "shirt,collar", "--json", json});
  EXPECT_EQ(exempt.exit_code, 0) << exempt.out << exempt.err;
  EXPECT_NE(exempt.out.find("exempted:   1 pairs of \"shirt\" and \"collar\""), std::string::npos) << exempt.out;
  EXPECT_EQ(nlohmann::json::parse(std::ifstream(json))["allowed"]["exempted"],
            (nlohmann::json{{{"groups", {"shirt", "collar"}}, {"pairs", 1}}}));
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--ignore", "collar"}).exit_code, 0);
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--group", "x=1:2", "--exempt", "x,shirt"}).exit_code, 0);
  const auto all = run_program(folder, {"verify", mesh, "--group", "all=0:3", "--exempt", "all,all"});
  EXPECT_EQ(all.exit_code, 5) << all.out;
  EXPECT_NE(all.out.find("every pair of faces is exempt"), std::string::npos) << all.out;
  const auto unknown = run_program(folder, {"verify", mesh, "--exempt", "shirt,coller"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(
      unknown.err.find("no group \"coller\"; the groups are \"button\" (1 faces), \"collar\" (1 faces), \"shirt\""),
      std::string::npos)
      << unknown.err;
  for (const std::vector<std::string>& bad : {std::vector<std::string>{"--exempt", "shirt"},
                                              {"--exempt", "shirt,"},
                                              {"--exempt", "a,b,c"},
                                              {"--ignore", "x"},
                                              {"--group", "x"},
                                              {"--group", "x=1"},
                                              {"--group", "x=2:1", "--ignore", "x"},
                                              {"--group", "x=0:9", "--ignore", "x"},
                                              {"--exempt", "button,button"},
                                              {"--resume"}}) {
    std::vector<std::string> arguments = {"verify", mesh};
    arguments.insert(arguments.end(), bad.begin(), bad.end());
    EXPECT_EQ(run_program(folder, arguments).exit_code, 2) << bad[0] << " " << bad.back();
  }
}

/// Where a group that a rule names is missing in the second of two frames. What was kept of the first is FILE.progress.
testing::ProgramResult verify_up_to_a_missing_group(const TemporaryFolder& folder,
                                                    const std::filesystem::path& report) {
  const auto a = folder.path() / "s_0.obj", b = folder.path() / "s_1.obj";
  const std::string button = "v 9 9 9\nv 8 9 9\nv 8 8 9\ng button\nf 7 8 9\n";
  spit(a, two_faces(0) + button);
  spit(b, two_faces(0) + std::string(button).replace(button.find('b'), 1, "B"));
  return run_program(folder, {"verify", a, b, "--ignore", "button", "--json", report});
}

TEST(VerifyCommand, AGroupThatALaterFrameLacksIsNamedWithTheFrame) {
  const TemporaryFolder folder;
  const std::string json = folder.path() / "r.json";
  const auto result = verify_up_to_a_missing_group(folder, json);
  EXPECT_EQ(result.exit_code, 2) << result.out;
  EXPECT_NE(result.err.find("s_1.obj: ignore: no group \"button\"; the groups are \"Button\""), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("what was checked before it is kept in " + json + ".progress"), std::string::npos)
      << result.err;
  const auto mesh = folder.path() / "a.obj";
  spit(mesh, two_faces(1));
  const auto at_once =
      run_program(folder, {"verify", mesh, "--ignore", "button", "--json", folder.path() / "one.json"});
  EXPECT_EQ(at_once.exit_code, 2) << at_once.out;
  EXPECT_EQ(at_once.err.find("is kept in"), std::string::npos) << "nothing was: " << at_once.err;
}

TEST(VerifyCommand, ProgressThatCannotBeKeptStopsNothing) {
  const TemporaryFolder folder;
  const std::string json = folder.path() / "r.json";
  std::filesystem::create_directory(json + ".progress");
  const auto result = verify_up_to_a_missing_group(folder, json);
  EXPECT_EQ(result.exit_code, 2) << result.out;
  EXPECT_NE(result.err.find("r.json.progress: "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("the check goes on"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("s_1.obj: ignore: no group"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("is kept in"), std::string::npos) << result.err;
}

TEST(VerifyCommand, AReportOnStdoutStandsAlone) {
  const TemporaryFolder folder;
  const auto a = folder.path() / "a.obj";
  spit(a, two_faces(0));
  const auto result = run_program(folder, {"verify", a, "--json", "/dev/stdout"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["verdict"], "violated");
  EXPECT_TRUE(result.err.starts_with("violated\n")) << result.err;
}

TEST(VerifyCommand, AGapWithoutAPairIsSaid) {
  const TemporaryFolder folder;
  const auto a = folder.path() / "a.obj";
  spit(a, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_NE(run_program(folder, {"verify", a, "--gap"}).out.find("gap:        none: "), std::string::npos);
}

TEST(VerifyCommand, ABodyThatTheFormatCannotNameIsNamedByTheUser) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", json = folder.path() / "a.json";
  const std::string sheet = "v 0 0 5\nv 1 0 5\nv 0 1 5\nf 7 8 9\n";
  spit(mesh, two_faces(0) + sheet);
  EXPECT_EQ(run_program(folder, {"verify", mesh}).exit_code, 1);
  // Both of one group that the user makes: not checked against each other. One alone: against the other, as cloth.
  const auto both = run_program(folder, {"verify", mesh, "--group", "low=0:2", "--body", "low", "--json", json});
  EXPECT_EQ(both.exit_code, 0) << both.out << both.err;
  const auto report = nlohmann::json::parse(testing::slurp(json));
  EXPECT_EQ(report["surface"]["body_faces"], 2);
  EXPECT_EQ(report["options"]["body"], "low");
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--group", "low=0:2", "--body", "low", "--bodies"}).exit_code, 1);
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--group", "low=1:2", "--body", "low"}).exit_code, 1);
  const auto unknown = run_program(folder, {"verify", mesh, "--group", "low=0:2", "--body", "lows"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("--body: no group \"lows\"; the groups are \"low\""), std::string::npos) << unknown.err;
  const auto outside = run_program(folder, {"verify", mesh, "--group", "low=2:2000000000", "--body", "low"});
  EXPECT_EQ(outside.exit_code, 2) << outside.err;
  EXPECT_NE(outside.err.find("are no range of the mesh's 3 faces"), std::string::npos) << outside.err;
  // A face cannot be of both.
  spit(mesh, two_faces(0) + "g sheet\n" + sheet);
  const auto divided = run_program(folder, {"verify", mesh, "--group", "low=1:3", "--body", "low"});
  EXPECT_EQ(divided.exit_code, 3) << divided.err;
  EXPECT_NE(divided.err.find("which is a body; give both groups one role"), std::string::npos) << divided.err;
}

TEST(VerifyCommand, AGroupThatJoinsOneOfTheSequenceIsNoted) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", json = folder.path() / "a.json";
  spit(mesh, two_faces(0) + "g sheet\nv 0 0 5\nv 1 0 5\nv 0 1 5\nf 7 8 9\n");
  const std::string note = "--group: the sequence has a group \"sheet\" of its own; faces 0:1 are added to it";
  const auto joined =
      run_program(folder, {"verify", mesh, "--group", "sheet=0:1", "--ignore", "sheet", "--json", json});
  EXPECT_EQ(joined.err, "selvage: note: " + note + "\n");
  const auto report = nlohmann::json::parse(testing::slurp(json));
  EXPECT_EQ(report["notes"], nlohmann::json{note});
  EXPECT_EQ(report["allowed"]["ignored"][0]["faces"], 2);
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--group", "low=0:1", "--ignore", "low"}).err, "");
}

TEST(VerifyCommand, BadInputIsNeverAVerdict) {
  const struct {
    const char* why;
    std::string content;
    int exit_code;
    const char* message;
  } cases[] = {
      {"empty file", "", 3, "a.obj"},
      {"no face", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", 3, "a.obj"},
      {"index out of range", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", 3, "a.obj:4"},
      {"index zero", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", 3, "a.obj:4"},
      {"repeated corner", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n", 3, "a.obj:4"},
      {"not a number", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 3, "a.obj:1"},
      {"infinity", "v 0 0 0\nv 1 0 inf\nv 0 1 0\nf 1 2 3\n", 3, "a.obj:2"},
      {"too large", "v 0 0 0\nv 1 0 0\nv 0 1e999 0\nf 1 2 3\n", 3, "a.obj:3"},
      {"cut off", "v 0 0 0\nv 1 0 0\nv 0 1", 3, "a.obj:3"},
      {"words", "v zero 0 0\nf 1 1 1\n", 3, "a.obj:1"},
  };
  for (const auto& c : cases) {
    const TemporaryFolder folder;
    spit(folder.path() / "a.obj", c.content);
    const auto result = run_program(folder, {"verify", folder.path() / "a.obj"});
    EXPECT_EQ(result.exit_code, c.exit_code) << c.why << ": " << result.out << result.err;
    EXPECT_EQ(result.out, "") << c.why;
    EXPECT_NE(result.err.find(c.message), std::string::npos) << c.why << ": " << result.err;
  }
}

TEST(VerifyCommand, ALastLineWithoutItsEndIsNotCounted) {
  const TemporaryFolder folder;
  {
    io::SequenceWriter writer(folder.path() / "run",
                              {{{0, 1, 2}}, {}, io::SequenceKind::kFrames, io::Precision::kFloat64, "test"});
    for (int i = 0; i < 3; ++i) writer.append(i, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  }
  const auto list = folder.path() / "run" / "frames.jsonl";
  const std::string lines = testing::slurp(list);
  spit(list, lines.substr(0, lines.size() - 1));
  const auto result = run_program(folder, {"verify", folder.path() / "run"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("frames:     2 of 2 checked"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find("the last line has no end and is left out"), std::string::npos) << result.err;
  spit(list, lines);
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "run"}).err, "");
}

TEST(VerifyCommand, AFinishedReportIsOfTheBitsThatWereChecked) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"verify"};
  for (const char* name : {"a.obj", "b.obj", "c.obj"}) {
    spit(folder.path() / name, two_faces(1));
    arguments.push_back(folder.path() / name);
  }
  const auto json = folder.path() / "report.json";
  arguments.insert(arguments.end(), {"--json", json, "--resume"});
  ASSERT_EQ(run_program(folder, arguments).exit_code, 0);
  EXPECT_EQ(run_program(folder, arguments).exit_code, 0) << "again, from the finished report";
  spit(folder.path() / "b.obj", two_faces(0));
  const auto resumed = run_program(folder, arguments);
  EXPECT_EQ(resumed.exit_code, 3) << resumed.out;
  EXPECT_EQ(resumed.out, "");
  EXPECT_NE(resumed.err.find("b.obj: its positions are not those that the run to be resumed has checked"),
            std::string::npos)
      << resumed.err;
  arguments.pop_back();
  EXPECT_EQ(run_program(folder, arguments).exit_code, 1) << "anew";
}

TEST(VerifyCommand, MissingAndUnwritableFilesAreFour) {
  const TemporaryFolder folder;
  const auto missing = run_program(folder, {"verify", folder.path() / "missing.obj"});
  EXPECT_EQ(missing.exit_code, 4) << missing.err;
  EXPECT_NE(missing.err.find("missing.obj"), std::string::npos) << missing.err;
  spit(folder.path() / "a.obj", two_faces(1));
  const auto unwritable =
      run_program(folder, {"verify", folder.path() / "a.obj", "--json", folder.path() / "no" / "r.json"});
  EXPECT_EQ(unwritable.exit_code, 4) << unwritable.err;
  EXPECT_EQ(unwritable.out, "") << "no verdict on stdout that the report does not hold";
}

TEST(VerifyCommand, UsageErrorsAreTwo) {
  const TemporaryFolder folder;
  spit(folder.path() / "a.obj", two_faces(1));
  const std::string a = folder.path() / "a.obj";
  const std::vector<std::vector<std::string>> cases = {
      {"verify"},
      {"verify", a, "--motion"},  // one frame: no motion would be checked
      {"verify", a, a, "--motion", "--frames-only"},
      {"verify", a, "--min-distance", "-1"},
      {"verify", a, "--min-distance", "nan"},
      {"verify", a, "--max-violations", "-3"},
      {"verify", a, "--threads", "-1"},
      {"verify", a, "--threads", "99999999999999999999"},
      {"verify", a, "--jsn", "x"},
  };
  for (const auto& arguments : cases) {
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 2) << result.out << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err, "");
  }
}

// Parts are joined, and runs resumed, where these are the same.
TEST(VerifyCommand, AReportHoldsTheOptionsThatAVerdictDependsOn) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", json = folder.path() / "r.json";
  spit(mesh, two_faces(1));
  const auto options_of = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"verify", mesh, mesh, "--json", json});
    (void)run_program(folder, arguments);
    return nlohmann::json::parse(testing::slurp(json))["options"];
  };
  const nlohmann::json none = {{"motions", "no"}, {"min_distance", "none"}, {"bodies", "no"},
                               {"gap", "no"},     {"second_opinion", "no"}, {"groups", ""},
                               {"body", ""},      {"exempt", ""},           {"ignore", ""},
                               {"weld", "no"}};
  EXPECT_EQ(options_of({}), none);
  const nlohmann::json all = {{"motions", "yes"}, {"min_distance", "0x1p-1"}, {"bodies", "yes"},
                              {"gap", "yes"},     {"second_opinion", "yes"},  {"groups", "front=0:1 back=1:2"},
                              {"body", "back"},   {"exempt", "front,back"},   {"ignore", "front"},
                              {"weld", "yes"}};
  EXPECT_EQ(
      options_of({"--motion", "--min-distance", "0.5", "--bodies", "--gap", "--second-opinion", "--group", "front=0:1",
                  "--group", "back=1:2", "--body", "back", "--exempt", "front,back", "--ignore", "front", "--weld"}),
      all);
}

TEST(VerifyCommand, StepsAreCheckedWithTheirMotionsUnlessFramesAloneAreAskedFor) {
  const TemporaryFolder folder;
  const auto run = folder.path() / "run";
  {
    io::SequenceHeader header;
    header.triangles = {{0, 1, 2}, {3, 4, 5}};
    header.kind = io::SequenceKind::kSteps;
    io::SequenceWriter writer(run, header);
    for (const double height : {1.0, -3.0}) {
      writer.append(1 - height, {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, height}, {2, 1, height}, {1, 2, height}});
    }
  }
  EXPECT_EQ(run_program(folder, {"verify", run}).exit_code, 1) << "one face goes through the other";
  const auto frames = run_program(folder, {"verify", run, "--frames-only"});
  EXPECT_EQ(frames.exit_code, 0) << frames.out;
  EXPECT_NE(frames.out.find("motions:    not checked (--motion does)"), std::string::npos) << frames.out;
}

TEST(VerifyCommand, OutputsThatCannotBeWrittenAreFoundBeforeTheCheck) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", run = folder.path() / "run", none = folder.path() / "no" / "x";
  spit(mesh, two_faces(1));
  ASSERT_EQ(run_program(folder, {"convert", mesh, mesh, "-o", run.string() + "/"}).exit_code, 0);
  std::string frame = testing::slurp(run / "frame_000001.npy");
  frame.back() ^= 1;
  spit(run / "frame_000001.npy", frame);
  ASSERT_EQ(run_program(folder, {"verify", run}).exit_code, 3) << "what the check comes upon";
  for (const std::vector<std::string>& output :
       {std::vector<std::string>{"--json", none}, {"--html", none}, {"--html", run}, {"--cases", mesh}}) {
    const auto result = run_program(folder, {"verify", run, output[0], output[1]});
    EXPECT_EQ(result.exit_code, 4) << output[0] << ": " << result.err;
    EXPECT_NE(result.err.find(output[1]), std::string::npos) << result.err;
  }
  const auto json = folder.path() / "report.json";
  EXPECT_EQ(run_program(folder, {"verify", run, "--json", json}).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(json)) << "trying leaves nothing";
}

TEST(VerifyCommand, HelpStartsWithAnExample) {
  const auto result = run_program({"verify", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.out.starts_with("Example: selvage verify ")) << result.out;
}

}  // namespace selvage
