#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/cli/run_program.h"
#include "tests/io/point_cache_builder.h"

namespace selvage {
namespace {

using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

const char* const kTwoFaces = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 1\nv 2 1 1\nv 1 2 1\nf 4 5 6\n";

/// Two frames of kTwoFaces; the second face is `height` above the first in the second frame.
std::string cache(float height) {
  const float bottom[] = {0, 0, 0, 4, 0, 0, 0, 4, 0};
  std::string bytes = testing::pc2(6, 0, 2);
  for (const float z : {1.0f, height}) {
    for (const float x : bottom) testing::append_bytes(bytes, x, false);
    for (const float x : {1.0f, 1.0f, z, 2.0f, 1.0f, z, 1.0f, 2.0f, z}) testing::append_bytes(bytes, x, false);
  }
  return bytes;
}

}  // namespace

TEST(SequenceArgument, PointCacheIsVerifiedWithTheMeshBesideIt) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "cloth.pc2";
  spit(folder.path() / "cloth.obj", kTwoFaces);
  spit(file, cache(0x1p-149f));  // the smallest float keeps them apart
  const auto clean = run_program(folder, {"verify", file});
  EXPECT_EQ(clean.exit_code, 0) << clean.err;
  EXPECT_NE(clean.out.find("2 of 2 checked, 0 violated"), std::string::npos) << clean.out;
  EXPECT_NE(clean.out.find("float32 coordinates checked as stored"), std::string::npos) << clean.out;
  spit(file, cache(0));
  const auto touching = run_program(folder, {"verify", file});
  EXPECT_EQ(touching.exit_code, 1) << touching.err;
  EXPECT_NE(touching.out.find("cloth.pc2[1]"), std::string::npos) << touching.out;
  spit(file, cache(-1));
  EXPECT_EQ(run_program(folder, {"verify", file}).exit_code, 0);
  EXPECT_EQ(run_program(folder, {"verify", "--motion", file}).exit_code, 1);
}

TEST(SequenceArgument, ASequenceWithoutFramesIsNamed) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", sequence = folder.path() / "run";
  spit(mesh, kTwoFaces);
  ASSERT_EQ(run_program(folder, {"convert", mesh, "-o", sequence}).exit_code, 0);
  spit(sequence / "frames.jsonl", "");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"verify", sequence}, {"render", sequence, "-o", folder.path() / "a.png"}}) {
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find(sequence.string() + ": the sequence holds no frame; record one"), std::string::npos)
        << result.err;
  }
}

TEST(SequenceArgument, BaseMeshIsNamedOrMissed) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "cloth.pc2", mesh = folder.path() / "mesh.obj";
  spit(file, cache(1));
  const auto missing = run_program(folder, {"verify", file});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_NE(missing.err.find("--base"), std::string::npos) << missing.err;
  spit(mesh, kTwoFaces);
  EXPECT_EQ(run_program(folder, {"verify", file, "--base", mesh}).exit_code, 0);
  EXPECT_EQ(run_program(folder, {"verify", file, "--base", folder.path() / "none.obj"}).exit_code, 4);
  const auto needless = run_program(folder, {"verify", mesh, "--base", mesh});
  EXPECT_EQ(needless.exit_code, 2);
  EXPECT_NE(needless.err.find("faces of its own"), std::string::npos) << needless.err;
}

TEST(SequenceArgument, WhatIsReadIsNotOverwritten) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", cloth = folder.path() / "a.pc2", report = folder.path() / "r.json";
  spit(mesh, kTwoFaces);
  spit(cloth, cache(1));
  ASSERT_EQ(run_program(folder, {"verify", mesh, "--json", report}).exit_code, 0);
  const std::string whole = testing::slurp(report);
  const auto plugin = folder.path() / "conformance.txt";
  spit(plugin, "a library");
  const std::vector<std::vector<std::string>> cases = {
      {"verify", mesh, "--json", mesh},
      {"verify", mesh, "--json", folder.path() / "." / "a.obj"},
      {"verify", cloth, "--base", mesh, "--json", mesh},
      {"verify", mesh, "--html", mesh},
      {"view", mesh, "-o", mesh},
      {"view", cloth, "-o", mesh},
      {"verify", cloth, "--json", mesh},  // not named, but read
      {"merge", report, "-o", report},
      {"merge", report, "-o", folder.path() / "ok.json", "--html", report},
      {"bench", "ccd", mesh, mesh, "--json", mesh},
      {"bench", "ccd", mesh, mesh, "--truth", report, report, "--json", report},
      {"bench", "broad", mesh, mesh, "--json", mesh},
      {"bench", "methods", mesh, mesh, "--json", mesh},
      {"bench", "queries", mesh, "--kind", "vf", "--json", mesh},
      {"replay", mesh, "--json", mesh},
      {"fuzz", "--plugin", plugin, "--artifacts", folder.path()},
  };
  for (const auto& arguments : cases) {
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0] << result.out << result.err;
    EXPECT_NE(result.err.find("would be overwritten"), std::string::npos) << result.err;
  }
  EXPECT_EQ(testing::slurp(mesh), kTwoFaces);
  EXPECT_EQ(testing::slurp(cloth), cache(1));
  EXPECT_EQ(testing::slurp(report), whole);
}

TEST(SequenceArgument, NoFileOfASequenceFolderIsOverwritten) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", run = folder.path() / "run";
  spit(mesh, kTwoFaces);
  ASSERT_EQ(run_program(folder, {"convert", mesh, "-o", run}).exit_code, 0);
  spit(run / "checkpoint.bin", "of a run");
  std::filesystem::create_symlink("run/frames.jsonl", folder.path() / "soft.png");
  std::filesystem::create_hard_link(run / "faces.npy", folder.path() / "hard");
  const auto contents = [&run] {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(run)) {
      files[entry.path().filename()] = testing::slurp(entry.path());
    }
    return files;
  };
  const auto before = contents();
  for (const std::filesystem::path& file :
       {run / "sequence.json", run / "frames.jsonl", run / "faces.npy", run / "frame_000000.npy",
        run / "checkpoint.bin", folder.path() / "soft.png", folder.path() / "hard"}) {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"verify", run, "--json", file},
                                                      {"verify", run, "--html", file},
                                                      {"view", run, "-o", file}}) {
      const auto result = run_program(folder, arguments);
      EXPECT_EQ(result.exit_code, 2) << arguments[0] << file << result.out << result.err;
      EXPECT_NE(result.err.find(file.string() + " is read, and would be overwritten"), std::string::npos) << result.err;
    }
  }
  EXPECT_EQ(run_program(folder, {"render", run, "-o", folder.path() / "soft.png"}).exit_code, 2);
  EXPECT_EQ(contents(), before);
  // What is not read may be replaced, beside the frames too.
  for (int i = 0; i < 2; ++i) EXPECT_EQ(run_program(folder, {"verify", run, "--json", run / "r.json"}).exit_code, 0);
}

TEST(SequenceArgument, NoReportTakesThePlaceOfAMeshOrAScene) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", other = folder.path() / "other.obj", scene = folder.path() / "s.toml",
             header = folder.path() / "sequence.json", checkpoint = folder.path() / "checkpoint.bin",
             link = folder.path() / "report.json";
  for (const auto& file : {mesh, other, scene, header, checkpoint}) spit(file, kTwoFaces);
  std::filesystem::create_symlink(other, link);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"verify", mesh, "--json", other},
                                                    {"verify", mesh, "--html", scene},
                                                    {"verify", mesh, "--json", link},
                                                    {"verify", mesh, "--json", header},
                                                    {"verify", mesh, "--json", checkpoint},
                                                    {"view", mesh, "-o", scene}}) {
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0] << result.out << result.err;
    EXPECT_NE(result.err.find(arguments.back() + " is there already"), std::string::npos) << result.err;
  }
  for (const auto& file : {mesh, other, scene, header, checkpoint}) EXPECT_EQ(testing::slurp(file), kTwoFaces);
}

TEST(SequenceArgument, NoPartOfACampaignIsOverwritten) {
  const TemporaryFolder folder;
  const auto part = folder.path() / "part", ledger = part / "campaign.json";
  ASSERT_EQ(run_program(folder, {"fuzz", "ccd", "--cases", "1", "--jobs", "1", "--artifacts", part}).exit_code, 0);
  const std::string before = testing::slurp(ledger);
  const auto result = run_program(folder, {"merge", part, "-o", part});
  EXPECT_EQ(result.exit_code, 2) << result.out << result.err;
  EXPECT_NE(result.err.find(ledger.string() + " is read, and would be overwritten"), std::string::npos) << result.err;
  EXPECT_EQ(testing::slurp(ledger), before);
}

TEST(SequenceArgument, ALinkToWhatIsNotThereYetIsFollowed) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", link = folder.path() / "link", target = folder.path() / "deep" / "r.json",
             circle = folder.path() / "circle";
  spit(mesh, kTwoFaces);
  std::filesystem::create_symlink("second", link);
  std::filesystem::create_symlink("deep/r.json", folder.path() / "second");
  std::filesystem::create_symlink("circle", circle);
  const auto nowhere = run_program(folder, {"verify", mesh, "--json", link});
  EXPECT_EQ(nowhere.exit_code, 4) << nowhere.out;
  EXPECT_NE(nowhere.err.find(target.string() + ": cannot "), std::string::npos) << nowhere.err;
  std::filesystem::create_directory(folder.path() / "deep");
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--json", link, "--html", target}).exit_code, 2) << "one file";
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--json", link}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(nlohmann::json::parse(slurp(target))["verdict"], "clean");
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--json", circle}).exit_code, 4);
  EXPECT_TRUE(std::filesystem::is_symlink(circle));
}

TEST(SequenceArgument, TwoOutputsAreTwoFiles) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", same = folder.path() / "same", part = folder.path() / "part.json";
  spit(mesh, kTwoFaces);
  ASSERT_EQ(run_program(folder, {"verify", mesh, "--json", part}).exit_code, 0);
  const auto other_name = folder.path() / "." / "same";
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"verify", mesh, "--json", same, "--html", other_name},
        {"merge", part, "-o", same, "--html", other_name}}) {
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0] << result.out << result.err;
    EXPECT_NE(result.err.find(other_name.string() + " is named for two outputs"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(same));
  }
  for (const auto& cases : {other_name, folder.path() / "same.progress"}) {
    const auto result = run_program(folder, {"verify", mesh, "--json", same, "--cases", cases});
    EXPECT_EQ(result.exit_code, 2) << result.out << result.err;
    EXPECT_NE(result.err.find("is named for a report and for the folder of --cases"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(cases));
  }
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--json", "/dev/null", "--html", "/dev/null"}).exit_code, 0);
}

TEST(SequenceArgument, AJumpInTheNumbersIsSaid) {
  const TemporaryFolder folder;
  const auto verify = [&folder](const std::vector<std::string>& names) {
    std::vector<std::string> arguments = {"verify", "--motion"};
    for (const std::string& name : names) {
      spit(folder.path() / name, kTwoFaces);
      arguments.push_back(folder.path() / name);
    }
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  };
  EXPECT_NE(verify({"f_1.obj", "f_2.obj", "f_4.obj"}).find("f_4.obj comes right after "), std::string::npos);
  EXPECT_NE(verify({"f_010.obj", "f_002.obj"}).find("f_002.obj comes right after "), std::string::npos);
  EXPECT_NE(verify({"f_1.obj", "f_1.obj"}).find("f_1.obj comes right after "), std::string::npos);
  EXPECT_NE(verify({"f_0.obj", "f_2.obj", "f_3.obj"}).find("f_2.obj comes right after "), std::string::npos);
  EXPECT_NE(verify({"s1_v2.obj", "s2_v2.obj", "s9_v2.obj"}).find("s9_v2.obj comes right after "), std::string::npos);
  EXPECT_NE(verify({"c.-003.obj", "c.-001.obj", "c.0000.obj"}).find("c.-001.obj comes right after "),
            std::string::npos);
  EXPECT_NE(verify({"g_1.obj", "g_2.OBJ", "g_4.obj"}).find("g_4.obj comes right after "), std::string::npos);
  const std::string id = "_12345678901234567890";
  EXPECT_NE(verify({"1" + id + ".obj", "2" + id + ".obj", "4" + id + ".obj"}).find("comes right after "),
            std::string::npos);
  for (const std::vector<std::string>& shuffled :
       {std::vector<std::string>{"f_2.obj", "f_1.obj"}, {"f_1.obj", "f_10.obj", "f_11.obj", "f_2.obj"}}) {
    EXPECT_NE(verify(shuffled).find("in the order in which they are named, which is not that of their numbers"),
              std::string::npos)
        << shuffled[1];
  }
  for (const std::vector<std::string>& even : {std::vector<std::string>{"f_08.obj", "f_09.obj", "f_10.obj"},
                                               {"f_9.obj", "f_10.obj", "f_11.obj"},
                                               {"f_10.obj", "f_20.obj", "f_30.obj"},
                                               {"1a.obj", "2a.obj"},
                                               {"d.-003.obj", "d.-002.obj", "d.-001.obj", "d.0000.obj"},
                                               {"shot-12.obj", "shot-13.obj", "shot-14.obj"},
                                               {"a1_b1.obj", "a2_b3.obj"},
                                               {"before.obj", "after.obj"},
                                               {"take1_end.obj", "take3.obj", "take4.obj"}}) {
    EXPECT_EQ(verify(even), "") << even[0];
  }
}

TEST(SequenceArgument, AFrameThatIsMissingInTheListOfAFolderIsSaid) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"convert"};
  for (int i = 0; i < 4; ++i) {
    arguments.push_back(folder.path() / ("f_" + std::to_string(i) + ".obj"));
    spit(arguments.back(), kTwoFaces);
  }
  arguments.insert(arguments.end(), {"-o", folder.path() / "run/"});
  ASSERT_EQ(run_program(folder, arguments).exit_code, 0);
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "run"}).err, "");
  const auto list = folder.path() / "run" / "frames.jsonl";
  std::string lines = slurp(list);
  const std::size_t begin = lines.find('\n', lines.find("frame_000001")) + 1;
  spit(list, lines.erase(begin, lines.find('\n', begin) + 1 - begin));
  const auto result = run_program(folder, {"verify", folder.path() / "run"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("frame_000003.npy comes right after "), std::string::npos) << result.err;
}

TEST(SequenceArgument, NamesOfFilesDoNotCommandTheTerminal) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"convert"};
  for (const char* name : {"\x1b[31m\n_1.obj", "\x1b[31m\n_2.obj", "\x1b[31m\n_4.obj"}) {
    arguments.push_back(folder.path() / name);
    spit(arguments.back(), kTwoFaces);
  }
  arguments.insert(arguments.end(), {"-o", folder.path() / "\x1b[2J.obj"});
  const auto converted = run_program(folder, arguments);
  EXPECT_EQ(converted.exit_code, 0) << converted.err;
  EXPECT_NE(converted.err.find("/?[31m?_4.obj comes right after "), std::string::npos) << converted.err;
  EXPECT_NE(converted.out.find("/?[2J_000000.obj ... "), std::string::npos) << converted.out;
  EXPECT_EQ((converted.out + converted.err).find('\x1b'), std::string::npos);
}

TEST(SequenceArgument, NotesAreInTheReportsToo) {
  const TemporaryFolder folder;
  const auto json = folder.path() / "r.json", page = folder.path() / "r.html", merged = folder.path() / "m.json",
             run = folder.path() / "run";
  std::vector<std::string> files;
  for (const char* name : {"f_1.obj", "f_2.obj", "f_4.obj"}) {
    files.push_back(folder.path() / name);
    spit(files.back(), kTwoFaces);
  }
  const auto notes_of = [](const std::filesystem::path& report) {
    return nlohmann::json::parse(slurp(report))["notes"].get<std::vector<std::string>>();
  };
  const auto jumped = run_program(folder, {"verify", files[0], files[1], files[2], "--json", json, "--html", page});
  ASSERT_EQ(notes_of(json).size(), 1U);
  EXPECT_EQ(jumped.err, "selvage: note: " + notes_of(json)[0] + "\n");
  EXPECT_NE(notes_of(json)[0].find("f_4.obj comes right after "), std::string::npos);
  EXPECT_NE(slurp(page).find("<p>Note: " + notes_of(json)[0] + "</p>"), std::string::npos);

  for (const char* part : {"1", "2"}) {
    const auto report = folder.path() / (std::string(part) + ".part");
    ASSERT_EQ(run_program(folder, {"verify", files[0], files[1], files[2], "--shard", std::string(part) + "/2",
                                   "--json", report})
                  .exit_code,
              0);
  }
  const auto join = run_program(folder, {"merge", folder.path() / "1.part", folder.path() / "2.part", "-o", merged});
  EXPECT_EQ(notes_of(merged), notes_of(json));
  EXPECT_EQ(join.err, jumped.err);

  ASSERT_EQ(run_program(folder, {"convert", files[0], files[1], "-o", run}).exit_code, 0);
  EXPECT_EQ(run_program(folder, {"verify", run, "--json", json}).err, "");
  EXPECT_EQ(notes_of(json), std::vector<std::string>());
  spit(run / "frames.jsonl", slurp(run / "frames.jsonl") + "{\"file\"");
  EXPECT_EQ(run_program(folder, {"verify", run, "--json", json}).exit_code, 0);
  ASSERT_EQ(notes_of(json).size(), 1U);
  EXPECT_NE(notes_of(json)[0].find("the last line has no end"), std::string::npos);
}

TEST(SequenceArgument, PolygonsThatAreSplitAreCounted) {
  const TemporaryFolder folder;
  const auto obj = folder.path() / "a_1.obj", ply = folder.path() / "a.ply", next = folder.path() / "a_2.obj",
             cache = folder.path() / "c.pc2", json = folder.path() / "r.json";
  spit(obj, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\nf 1 2 3 4\nf 4 3 5\n");
  spit(next, "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 0 2 1\nf 1 2 3 4\nf 4 3 5\n");
  spit(ply,
       "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n"
       "5 0 1 2 3 4\n");
  spit(cache, testing::pc2(5, 0, 1) + std::string(5 * 3 * sizeof(float), '\0'));
  const std::string split = " more corners than three and is split into triangles around the first";
  for (const auto& file : {obj, ply}) {
    const auto result = run_program(folder, {"verify", file, "--json", json});
    EXPECT_EQ(result.exit_code, 0) << result.out;
    EXPECT_NE(result.err.find(file.string() + ": 1 face has" + split), std::string::npos) << result.err;
    EXPECT_EQ(nlohmann::json::parse(slurp(json))["notes"].size(), 1U);
  }
  const auto both = run_program(folder, {"verify", obj, next});
  EXPECT_NE(
      both.err.find(obj.string() + " to " + next.string() + ": 2 faces have more corners than three and are split"),
      std::string::npos)
      << both.err;
  const auto base = run_program(folder, {"verify", cache, "--base", obj});
  EXPECT_NE(base.err.find("the base mesh of " + cache.string() + ": 1 face has" + split), std::string::npos)
      << base.err;
  const auto converted = run_program(folder, {"convert", obj, "-o", folder.path() / "run"});
  EXPECT_NE(converted.err.find(": 1 face has" + split), std::string::npos) << converted.err;
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "run"}).err, "") << "its faces are triangles";
}

TEST(SequenceArgument, WhatCanBeReadOnceOnlyIsRefused) {
  const TemporaryFolder folder;
  const auto pipe = folder.path() / "a.obj", cache = folder.path() / "a.pc2", mesh = folder.path() / "b.obj";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  spit(cache, "POINTCACHE2");
  spit(mesh, kTwoFaces);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"verify", pipe},
                                                    {"verify", cache, "--base", pipe},
                                                    {"render", pipe, "-o", folder.path() / "a.png"},
                                                    {"subdivide", pipe, "-o", folder.path() / "fine"},
                                                    {"replay", pipe},
                                                    {"merge", pipe, "-o", folder.path() / "merged.json"},
                                                    {"bench", "queries", "--kind", "vf", pipe},
                                                    {"bench", "ccd", mesh, pipe},
                                                    {"sim", pipe, "-o", folder.path() / "run"},
                                                    {"verify", "/dev/zero"}}) {
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 4) << arguments[0];
    EXPECT_NE(result.err.find("write it to a file first"), std::string::npos) << result.err;
  }
}

TEST(SequenceArgument, AFolderWithAPipeInItIsRefused) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj";
  spit(mesh, kTwoFaces);
  for (const char* name : {"sequence.json", "faces.npy", "frames.jsonl", "frame_000001.npy"}) {
    const auto run = folder.path() / (std::string("run_") + name), file = run / name;
    ASSERT_EQ(run_program(folder, {"convert", mesh, mesh, "-o", run.string() + "/"}).exit_code, 0);
    std::filesystem::remove(file);
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    const auto result = run_program(folder, {"verify", run});
    EXPECT_EQ(result.exit_code, 4) << name;
    EXPECT_NE(result.err.find(file.string() + ": a pipe"), std::string::npos) << result.err;
  }
}

TEST(SequenceArgument, AnOutputThatIsNotWhatItsNameSaysIsUsage) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj";
  spit(mesh, kTwoFaces);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"verify", mesh, "--json", "-"},
                                                    {"convert", mesh, "-o", "-"},
                                                    {"view", mesh, "-o", "-"},
                                                    {"subdivide", mesh, "-o", "-"},
                                                    {"subdivide", mesh, "-o", folder.path() / "fine.npz"},
                                                    {"sim", mesh, "-o", folder.path() / "run.OBJ"}}) {
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0] << result.err;
    EXPECT_NE(result.err.find("; name "), std::string::npos) << result.err;
  }
  EXPECT_EQ(run_program(folder, {"subdivide", mesh, "-o", folder.path() / "fine.npz/"}).exit_code, 0);
  EXPECT_EQ(run_program(folder, {"subdivide", mesh, "-o", folder.path() / "v1.2"}).exit_code, 0);
}

TEST(SequenceArgument, AFolderOfMeshesIsNotTakenForASequence) {
  const TemporaryFolder folder;
  spit(folder.path() / "f_1.obj", kTwoFaces);
  for (const char* command : {"verify", "convert", "render"}) {
    std::vector<std::string> arguments = {command, folder.path()};
    if (std::string(command) != "verify") arguments.insert(arguments.end(), {"-o", folder.path() / "out.png"});
    if (std::string(command) == "convert") arguments.back() = folder.path() / "out.npz";
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_NE(result.err.find("name its mesh files instead"), std::string::npos) << result.err;
  }
}

TEST(SequenceArgument, PointCacheIsDrawn) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "cloth.pc2", mesh = folder.path() / "mesh.obj", sheet = folder.path() / "sheet.png";
  spit(file, cache(1));
  spit(mesh, kTwoFaces);
  const auto result = run_program(folder, {"render", file, "--base", mesh, "-o", sheet, "--width", "200"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(testing::slurp(sheet).starts_with("\x89PNG"));
}

}  // namespace selvage
