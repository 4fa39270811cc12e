#include <csignal>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/cli/run_program.h"
#include "tests/cli/two_faces.h"

namespace selvage {

namespace fs = std::filesystem;
using testing::run_program;
using testing::spit;
using testing::TemporaryFolder;

namespace {

/// The exit code of what a shell makes of a command in a folder: for streams that run_program() cannot give.
int shell(const TemporaryFolder& folder, const std::string& command) {
  return WEXITSTATUS(std::system(("cd " + folder.path().string() + " && " + command).c_str()));
}

}  // namespace

TEST(Program, HelpStartsWithAnExample) {
  const auto result = run_program({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.out.starts_with("Example: selvage ")) << result.out;
  EXPECT_EQ(result.err, "");
}

TEST(Program, HelpThatNobodyReceivesIsAFileError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  for (const char* option : {"--help", "--version"}) {
    const TemporaryFolder folder;
    fs::create_symlink("/dev/full", folder.path() / "stdout.txt");
    const pid_t child = testing::start_program(folder.path(), {option});
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(WEXITSTATUS(status), 4) << option;
    EXPECT_NE(testing::slurp(folder.path() / "stderr.txt").find("standard output"), std::string::npos) << option;
  }
}

// More than stdio holds back, so that printing itself fails.
TEST(Program, ALongResultThatNobodyReceivesIsAFileError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const TemporaryFolder folder;
  EXPECT_EQ(shell(folder, SELVAGE_PROGRAM " bench stability --list > /dev/full 2> err.txt"), 4);
  EXPECT_EQ(testing::slurp(folder.path() / "err.txt"),
            "selvage: cannot write the result to standard output; send it to a file on a disk with room, or to a "
            "program that reads it\n");
}

TEST(Program, VersionNamesTheExactLibraries) {
  const auto result = run_program({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.out.starts_with("selvage ")) << result.out;
  EXPECT_NE(result.out.find("GMP"), std::string::npos) << result.out;
}

// Valgrind rounds to nearest only. CGAL's own check of that ends whatever is linked with it.
TEST(Program, RunsUnderValgrindUntilASecondOpinionNeedsDirectedRounding) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "valgrind does not run what a sanitizer watches";
#endif
  if (std::system("valgrind --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no valgrind (packages-bench.txt)";
  const TemporaryFolder folder;
  constexpr int kIllegalInstruction = 128 + SIGILL;
  if (shell(folder, "valgrind -q " SELVAGE_PROGRAM " --version > /dev/null 2>&1") == kIllegalInstruction) {
    GTEST_SKIP() << "valgrind does not know what Highway runs on this processor before main (rdtscp)";
  }
  const std::string face = "v 0 0 0\nv 4 0 0\nv 0 4 0\n";
  spit(folder.path() / "0.obj", face + "v 3 3 -1\nv 4 4 1\nv 4 3 1\nf 1 2 3\nf 4 5 6\n");
  spit(folder.path() / "1.obj", face + "v 3 3 1\nv 4 4 2\nv 4 3 2\nf 1 2 3\nf 4 5 6\n");
  const auto verify = [&](const std::string& options) {
    return shell(folder, "valgrind -q " SELVAGE_PROGRAM " verify 0.obj 1.obj --motion --threads 1 " + options +
                             " > out.txt 2>&1");
  };
  const auto said = [&] { return testing::slurp(folder.path() / "out.txt"); };
  EXPECT_EQ(verify(""), 0) << said();
  EXPECT_EQ(verify("--second-opinion-all"), 7) << said();
  EXPECT_NE(said().find("directed rounding"), std::string::npos) << said();
}

TEST(Program, NotesThatCannotBeWrittenStopNothing) {
  const TemporaryFolder folder;
  spit(folder.path() / "quad.obj", "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 1 2 3 4\n");  // a note: it is split
  const auto verify = [&](const std::string& streams) {
    return shell(folder, "rm -f report.json && " SELVAGE_PROGRAM " verify quad.obj --json report.json " + streams);
  };
  for (const char* stream : {"2> err.txt", "2>&-", "2> /dev/full", "0<&- 2>&-"}) {
    EXPECT_EQ(verify(std::string("> out.txt ") + stream), 0) << stream;
    EXPECT_TRUE(testing::slurp(folder.path() / "out.txt").starts_with("clean")) << stream;
    EXPECT_TRUE(nlohmann::json::accept(testing::slurp(folder.path() / "report.json"))) << stream;
  }
  EXPECT_NE(testing::slurp(folder.path() / "err.txt").find("note"), std::string::npos);
  EXPECT_EQ(verify(">&- 2> err.txt"), 4);
  // The text goes to stderr where the report takes stdout.
  EXPECT_EQ(shell(folder, SELVAGE_PROGRAM " verify quad.obj --json /dev/stdout > report.json 2> /dev/full"), 0);
  EXPECT_TRUE(nlohmann::json::accept(testing::slurp(folder.path() / "report.json")));
}

// Renamed over what is behind stdout, the report would take the place of a log that it is appended to.
TEST(Program, AReportOnStdoutStandsThereAloneBehindWhatWasThere) {
  const TemporaryFolder folder;
  const auto of = [&](const char* name) { return testing::slurp(folder.path() / name); };
  spit(folder.path() / "a.obj", testing::two_faces(0));
  const std::string at_rest = "1,4,1,4,0,1\n0,1,0,1,0,1\n1,1,0,1,0,1\n0,1,1,1,0,1\n";  // a vertex on a face
  spit(folder.path() / "a_vf.csv", at_rest + at_rest);
  ASSERT_EQ(shell(folder, SELVAGE_PROGRAM " verify a.obj --json part.json --shard 1/1 --cases cases > out.txt"), 1);
  const struct {
    std::string arguments, said;
    bool is_page = false;
  } commands[] = {{"verify a.obj --json ", "violated"},
                  {"verify a.obj --html ", "violated", true},
                  {"merge part.json -o ", "violated"},
                  {"doctor --json ", "sound"},
                  {"replay cases --json ", "exact:"},
                  {"view a.obj -o ", "frame", true},
                  {"bench queries a_vf.csv --repeat 1 --json ", "kernel"},
                  {"bench ccd --sheet 4 --repeat 1 --json ", "kernel"}};
  for (const auto& command : commands) {
    const auto expect_report = [&](const std::string& text) {
      EXPECT_EQ(command.is_page ? text.starts_with("<!") : nlohmann::json::accept(text), true) << text.substr(0, 200);
      EXPECT_NE(of("err.txt").find(command.said), std::string::npos) << of("err.txt");
    };
    const std::string program = SELVAGE_PROGRAM " " + command.arguments;
    for (const char* name : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", "log.txt"}) {
      SCOPED_TRACE(command.arguments + name);
      spit(folder.path() / "log.txt", "before\n");
      EXPECT_LE(shell(folder, program + name + " >> log.txt 2> err.txt"), 1);
      EXPECT_TRUE(of("log.txt").starts_with("before\n")) << of("log.txt").substr(0, 200);
      expect_report(of("log.txt").substr(std::min<std::size_t>(7, of("log.txt").size())));
    }
    SCOPED_TRACE(command.arguments + "a pipe");
    EXPECT_EQ(shell(folder, program + "/dev/stdout 2> err.txt | cat > log.txt"), 0);
    expect_report(of("log.txt"));
  }
}

TEST(Program, TwoReportsDoNotShareStdout) {
  const TemporaryFolder folder;
  spit(folder.path() / "a.obj", testing::two_faces(0));
  const std::string verify = SELVAGE_PROGRAM " verify a.obj --json /dev/stdout --html ";
  EXPECT_EQ(shell(folder, verify + "/dev/stdout 2> err.txt > log.txt"), 2);
  EXPECT_EQ(shell(folder, verify + "log.txt 2> err.txt > log.txt"), 2);
  EXPECT_EQ(shell(folder, "(" + verify + "/dev/fd/1 2> err.txt; echo $? > code.txt) | cat > log.txt"), 0);
  EXPECT_EQ(testing::slurp(folder.path() / "code.txt"), "2\n");
  EXPECT_NE(testing::slurp(folder.path() / "err.txt").find("is named for two outputs"), std::string::npos);
}

TEST(Program, NamesDoNotCommandTheTerminal) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj";
  spit(mesh, testing::two_faces(0));
  const auto found = run_program(folder, {"verify", mesh, "--cases", folder.path() / "c\x1b[2J"});
  EXPECT_EQ(found.exit_code, 1) << found.err;
  EXPECT_EQ(found.out.find('\x1b'), std::string::npos) << "raw";
  EXPECT_NE(found.out.find("selvage replay '" + (folder.path() / "c?[2J").string()), std::string::npos) << found.out;
  const auto unknown = run_program(folder, {"verify", mesh, "--x\x1b[2J"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("--x?[2J; --help"), std::string::npos) << unknown.err;
}

TEST(Program, AnEmptyArgumentIsUsage) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj";
  spit(mesh, "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  const auto result = run_program(folder, {"verify", mesh, "--json", ""});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("argument 4 is empty"), std::string::npos) << result.err;
}

TEST(Program, NoSubcommandIsUsage) {
  const auto result = run_program({});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err, "");
}

TEST(Program, UnknownSubcommandIsUsage) {
  const auto result = run_program({"knit"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("knit"), std::string::npos) << result.err;
  const auto with_options = run_program({"knit", "run", "-o", "x.npz"});
  EXPECT_EQ(with_options.exit_code, 2);
  EXPECT_NE(with_options.err.find("no subcommand 'knit'"), std::string::npos) << with_options.err;
}

TEST(Program, AWrongOptionIsOneLine) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"verify", "a.obj", "--jsn", "x"}, {"sim", "a.toml", "--quality", "ultra"}, {"sim"}}) {
    const auto result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(result.err.starts_with("selvage: ")) << result.err;
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
  }
}

TEST(Program, AnUnknownBenchIsNamedAndTheOthersListed) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"bench", "foo"}, {"bench", "foo", "a.obj", "--json", "x"}, {"bench", "foo", "ccd"}}) {
    const auto result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("no subcommand 'foo'; there are queries, ccd, "), std::string::npos) << result.err;
  }
  const auto none = run_program({"bench"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("a subcommand is required; there are queries, "), std::string::npos) << none.err;
  EXPECT_EQ(run_program({"bench", "ccd", "--jsn", "x"}).exit_code, 2);
}

TEST(Program, AnErrorNamesTheFileThatWasAskedFor) {
  const testing::TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", absent = folder.path() / "no" / "x.html";
  testing::spit(mesh, "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"verify", mesh, "--json", absent},
                                                    {"verify", mesh, "--html", absent},
                                                    {"view", mesh, "-o", absent}}) {
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find(absent.string() + ": cannot open: "), std::string::npos) << result.err;
  }
}

TEST(Program, AnErrorNeitherBreaksTheLineNorCommandsTheTerminal) {
  const testing::TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj";
  testing::spit(mesh, "g a\x1b[31m\xc2\x9b b\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  const auto result = run_program(folder, {"verify", mesh, "--exempt", "nosuch,\x1b[7m\n"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_EQ(result.err.find('\x1b'), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("\xc2\x9b"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
}

TEST(Program, AReportThatWasCutIsNamedInOneLine) {
  const testing::TemporaryFolder folder;
  const auto cut = folder.path() / "cut.json", ledger = folder.path() / "part" / "campaign.json";
  std::filesystem::create_directory(folder.path() / "part");
  for (const auto& file : {cut, ledger}) {
    testing::spit(file, "{\"schema\": ");
    const std::filesystem::path part = file == cut ? cut : ledger.parent_path();
    const auto result = run_program(folder, {"merge", part, "-o", folder.path() / "out"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_NE(result.err.find(file.string() + ": "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("not valid JSON at byte 12; is it whole?\n"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("exception"), std::string::npos) << result.err;
    testing::spit(file, std::string("{\"schema\":0}\0[]", 15));  // nlohmann-json takes a zero for the end
    const auto damaged = run_program(folder, {"merge", part, "-o", folder.path() / "out"});
    EXPECT_EQ(damaged.exit_code, 3) << damaged.err;
    EXPECT_NE(damaged.err.find("a zero byte at byte 13; is it whole?\n"), std::string::npos) << damaged.err;
  }
}

// Each of these would else compute a little, and print, or come upon what it cannot read.
TEST(Program, ReportsThatCannotBeWrittenAreFoundBeforeTheWork) {
  const TemporaryFolder folder;
  const auto none = folder.path() / "no" / "x.png", junk = folder.path() / "junk.obj",
             part = folder.path() / "part.json";
  spit(junk, "v 0 0 zero\n");
  spit(part, "{}");
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"bench", "queries", junk, "--kind", "vf", "--json"},
           {"bench", "ccd", "--sheet", "2", "--repeat", "1", "--json"},
           {"bench", "broad", "--largest", "1000", "--sample", "10", "--repeat", "1", "--json"},
           {"bench", "methods", "--sheet", "4", "--most", "10", "--hard", "1", "--repeat", "1", "--json"},
           {"bench", "sim", "--growth", "4", "--steps", "1", "--finest-mesh", "17", "--module-nodes", "8", "--repeat",
            "1", "--json"},
           {"bench", "verify", "--faces", "100", "--layers", "2", "--repeat", "1", "--json"},
           {"bench", "stability", "--quick", "--case", "knot", "--json"},
           {"doctor", "--json"},
           {"merge", part, "-o"},
           {"merge", part, "-o", folder.path() / "all.json", "--html"},
           {"render", junk, "-o"},
           {"replay", junk, "--json"},
           {"view", junk, "-o"}}) {
    std::vector<std::string> arguments = command;
    arguments.push_back(none);
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 4) << command[0] << " " << command[1] << ": " << result.err;
    EXPECT_NE(result.err.find(none.string()), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "") << command[0];
  }
}

TEST(Program, AFileBeyondTheSizeLimitIsAFileErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  std::string mesh;
  for (int i = 0; i < 3000; ++i) mesh += "v " + std::to_string(i) + " 0 0\nv 0 1 0\nv 0 0 1\n";
  spit(folder.path() / "a.obj", mesh + "f 1 2 3\n");
  const std::string output = folder.path() / "out";
  fs::create_directory(output);
  for (const std::string command :
       {"convert a.obj -o out/a.npz", "convert a.obj -o out/a/", "view a.obj -o out/a.html",
        "render a.obj -o out/a.png", "verify a.obj --html out/a.html", "subdivide a.obj -o out/fine"}) {
    SCOPED_TRACE(command);
    const std::string limited =
        "cd " + folder.path().string() + " && ulimit -f 2 && exec " SELVAGE_PROGRAM " " + command;  // 1 KiB
    const auto result = run_program(folder, {"-c", limited}, "/bin/sh");
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_NE(result.err.find("ulimit"), std::string::npos) << result.err;
    EXPECT_TRUE(fs::is_empty(output));
    EXPECT_EQ(result.out.starts_with("clean\n"), command.starts_with("verify")) << "a verdict is kept: " << result.out;
  }
}

TEST(Program, WhatNeedsMoreMemoryThanThereIsEndsAtALimit) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer takes terabytes of addresses";
#endif
  const TemporaryFolder folder;
  spit(folder.path() / "a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  const auto verify = [&] {
    return shell(folder, "ulimit -v 1000000 && exec " SELVAGE_PROGRAM " verify a.obj --threads 1 > out.txt 2> err.txt");
  };
  EXPECT_EQ(verify(), 0) << testing::slurp(folder.path() / "err.txt");
  fs::resize_file(folder.path() / "a.obj", std::uintmax_t{1} << 31);
  EXPECT_EQ(verify(), 5);
  EXPECT_EQ(testing::slurp(folder.path() / "err.txt"),
            "selvage: out of memory: nothing is known about the rest; a coarser mesh or a shard needs less\n");
}

// What that is, `memory_limit_test.cpp` has. The kernel would hand out more, and kill what uses it.
TEST(Program, MayNotAskForMoreMemoryThanThereIs) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", pipe = folder.path() / "pipe";
  spit(mesh, "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);  // nobody reads it: the command does not end by itself
  const pid_t child = testing::start_program(folder.path(), {"view", mesh, "-o", pipe});
  const auto says = [&] { return testing::slurp("/proc/" + std::to_string(child) + "/limits"); };
  constexpr const char* kNone = "Max data size             unlimited ";
  for (int i = 0; i < 1000 && says().find(kNone) != std::string::npos; ++i) usleep(10'000);
  EXPECT_NE(says().find("Max data size"), std::string::npos);
  EXPECT_EQ(says().find(kNone), std::string::npos);
  kill(child, SIGKILL);
  testing::wait_for_program(folder.path(), child);
}

TEST(Program, CommandsThatCannotStopInBetweenDieOfTheSignal) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", pipe = folder.path() / "pipe";
  spit(mesh, "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);  // nobody reads it: the command does not end by itself
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"view", mesh, "-o", pipe}, {"bench", "ccd", mesh, mesh, "--json", pipe}}) {
    for (const int signal : {SIGTERM, SIGINT}) {
      const pid_t child = testing::start_program(folder.path(), arguments);
      usleep(100'000);  // by then it would catch the signal if it did
      kill(child, signal);
      EXPECT_EQ(testing::wait_for_program(folder.path(), child).exit_code, -1) << arguments.front();
    }
  }
}

}  // namespace selvage
