// `selvage bench ... --svg`: what the tables say, as a picture.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/cli/two_faces.h"
#include "tests/cli/well_formed.h"

namespace selvage {
namespace {

using testing::expect_text;
using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

/// One end of a query: a vertex that rests on a face.
const std::string kTouch = "1,4,1,4,0,1\n0,1,0,1,0,1\n1,1,0,1,0,1\n0,1,1,1,0,1\n";

/// Of each bench, as little as it can do.
const std::vector<std::vector<std::string>> kBenches = {
    {"ccd", "--sheet", "8", "--repeat", "1"},
    {"broad", "--largest", "1000", "--pleats", "0.1,0.2", "--sample", "10", "--repeat", "1"},
    {"methods", "--sheet", "4", "--most", "10", "--hard", "4", "--repeat", "1"},
    {"sim", "--growth", "4,6", "--steps", "1", "--finest-mesh", "17", "--module-nodes", "8", "--repeat", "1"},
    {"verify", "--faces", "100,200", "--layers", "2", "--motion", "--repeat", "1"},
};

testing::ProgramResult run_bench(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "bench");
  return run_program(folder, arguments);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

void expect_picture(const std::string& svg) {
  EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" ")) << svg.substr(0, 100);
  EXPECT_EQ(testing::fault_of_xml(svg), "");
  for (const char* forbidden : {"<script", "href", "url(", "@import", "nan", "inf\"", "-0.0\""}) {
    EXPECT_EQ(svg.find(forbidden), svg.npos) << forbidden;
  }
}

}  // namespace

TEST(WellFormed, WhatIsNotIsFound) {
  EXPECT_EQ(testing::fault_of_xml("<a b=\"c\"><d>&lt;</d></a>\n"), "");
  for (const char* xml : {"<a><b></a></b>", "<a>", "<a></a><a></a>", "<a>&</a>", "<a>&x;</a>", "<a b=c></a>",
                          "<a>< </a>", "<a b=\"<\"></a>", "<a>\x01</a>", "x<a></a>"}) {
    EXPECT_NE(testing::fault_of_xml(xml), "") << xml;
  }
}

TEST(BenchSvg, OfEveryBenchIsAPictureWithAllRowsOfItsTables) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "out.svg", json = folder.path() / "out.json";
  for (std::vector<std::string> arguments : kBenches) {
    SCOPED_TRACE(arguments[0]);
    arguments.insert(arguments.end(), {"--svg", file, "--json", json});
    const auto result = run_bench(folder, arguments);
    EXPECT_LE(result.exit_code, 1) << result.err;
    const std::string svg = slurp(file);
    expect_picture(svg);
    const auto report = nlohmann::json::parse(slurp(json));
    // A title is the figure's, or a point's with its row.
    const std::size_t points = count_of(svg, "</title></path>"), bars = count_of(svg, "<rect ") - 1;
    std::size_t rows = 0;
    if (arguments[0] == "ccd") {
      EXPECT_EQ(bars, report.at("methods").size());
      for (const auto& [name, row] : report.at("methods").items()) expect_text(svg, ">" + name + "</text>");
    } else if (arguments[0] == "broad") {
      std::size_t moved = 0;
      for (const auto& motion : report.at("motions")) {
        rows += motion.at("methods").size();
        moved += motion.at("incremental").size();
      }
      const std::size_t of_one_thread = rows / 2, motions = report.at("motions").size();
      EXPECT_EQ(points, 3 * rows + moved + motions + of_one_thread);
      for (const char* text : {"1 thread", "2 threads", "sheet pleated by 0.1"}) {
        expect_text(svg, ">" + std::string(text) + "</text>");
      }
      EXPECT_EQ(count_of(svg, ">candidate pairs a face</text>"), 2U) << "once against it, once itself";
    } else if (arguments[0] == "methods") {
      std::size_t times = 0;
      for (const auto& set : report.at("sets")) {
        for (const auto& row : set.at("settings")) times += row.at("toi_examined") > 0 ? 1 : 0;
        rows += set.at("settings").size();
      }
      EXPECT_EQ(points, 2 * rows + times);
      EXPECT_GT(count_of(svg, ">0.001 m</text>"), 0U) << "the ends of a line say which is which";
    } else if (arguments[0] == "sim") {
      for (const char* table : {"time_steps", "meshes"}) rows += 3 * report.at(table).size();
      const std::size_t sizes = 2, phases = 3;
      EXPECT_EQ(points, rows + 2 * report.at("growth").size() + phases * sizes);
      // A module's bar is in two colours, but for the first.
      EXPECT_EQ(bars, report.at("conservation").size() + 2 * report.at("modules").size() - 1);
      for (const char* text : {"second order", "step of the dynamics, ms", "edge of the mesh, mm", "dynamics",
                               "velocity", "springs alone", "nothing: the same again"}) {
        expect_text(svg, ">" + std::string(text) + "</text>");
      }
    } else {
      for (const auto& sheet : report.at("sheets")) {
        for (const auto& method : sheet.at("methods")) rows += method.at("examined") > 0 ? 6 : 5;
      }
      EXPECT_EQ(points, rows);
      for (const char* text : {"Clean sheets", "20 vertices pushed through the next layer", "share decided exactly"}) {
        EXPECT_GE(count_of(svg, ">" + std::string(text) + "</text>"), 1U) << text;
      }
    }
  }
}

TEST(BenchSvg, NamesOfStrangersAreText) {
  const TemporaryFolder folder;
  const auto svg = folder.path() / "out.svg";
  const std::string name = "</text><script>\"&'\x01\xFF\xEF\xBF\xBF_vf.csv", file = folder.path() / "q_vf.csv";
  std::filesystem::create_directory(folder.path() / "<");  // what stands before the slash of the name
  const std::string hostile = folder.path() / name;
  spit(hostile, kTouch + kTouch);
  const auto result = run_bench(folder, {"queries", hostile, "--repeat", "1", "--svg", svg});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string picture = slurp(svg);
  expect_picture(picture);
  expect_text(picture, "&lt;/text&gt;&lt;script&gt;&quot;&amp;&#39;\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD_vf.csv");
  for (const char* row : {">kernel</text>", ">textbook</text>", ">exact</text>"}) expect_text(picture, row);
}

TEST(BenchSvg, IsRefusedBeforeTheWorkWhereItCannotBeWritten) {
  const TemporaryFolder folder;
  const std::string queries = folder.path() / "a_vf.csv", none = folder.path() / "no" / "out.svg";
  spit(queries, "soup");  // would be another error, once read
  std::vector<std::vector<std::string>> benches = kBenches;
  benches.push_back({"queries", queries});
  for (std::vector<std::string> arguments : benches) {
    arguments.insert(arguments.end(), {"--svg", none});
    const auto result = run_bench(folder, arguments);
    EXPECT_EQ(result.exit_code, 4) << arguments[0] << result.err;
    EXPECT_EQ(result.out, "") << arguments[0];
    expect_text(result.err, none);
  }
  for (const std::string& taken : {queries, (folder.path() / "out.json").string()}) {
    const auto result = run_bench(folder, {"queries", queries, "--json", folder.path() / "out.json", "--svg", taken});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    expect_text(result.err, taken);
  }
  EXPECT_EQ(slurp(queries), "soup");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out.json"));
}

TEST(BenchSvg, OnStdoutStandsThereAlone) {
  const TemporaryFolder folder;
  const auto result = run_bench(folder, {"ccd", "--sheet", "4", "--repeat", "1", "--svg", "/dev/stdout"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_picture(result.out);
  expect_text(result.err, "one thread; processor time");
}

}  // namespace selvage
