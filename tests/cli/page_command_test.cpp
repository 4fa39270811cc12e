// The pages of verify, merge and view, as files; tests/cli/pages.py opens them in a browser.
#include <bit>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/file/text.h"
#include "io/sequence.h"
#include "tests/cli/run_program.h"
#include "tests/cli/two_faces.h"

namespace selvage {
namespace {

using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;
using testing::two_faces;

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

nlohmann::json data_of(const std::string& page, const std::string& id) {
  const std::string start = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t begin = page.find(start);
  if (begin == page.npos) return {};
  return nlohmann::json::parse(page.substr(begin + start.size(), page.find("</script>", begin) - begin - start.size()));
}

std::string verdict_of(const std::string& page) {
  const std::string start = "<h1 id=\"verdict\">";
  const std::size_t begin = page.find(start) + start.size();
  return page.substr(begin, page.find('<', begin) - begin);
}

constexpr const char* kRow = "<tr data-title=";
constexpr const char* kBar = "data-begin=";

std::vector<std::int64_t> frames_of(const std::string& page) {
  std::vector<std::int64_t> frames;
  const auto scene = data_of(page, "scene");
  for (const auto& frame : scene["frames"]) frames.push_back(frame["frame"]);
  return frames;
}

}  // namespace

TEST(VerifyPage, SaysWhatTheReportSays) {
  const TemporaryFolder folder;
  const auto page = folder.path() / "page.html", json = folder.path() / "report.json", kept = folder.path() / "a.case";
  std::vector<std::string> command = {"verify", "--motion", "--json", json, "--html", page};
  for (const double height : {2.0, 1.0, -3.0}) {
    command.push_back(folder.path() / fmt::format("{}.obj", height));
    spit(command.back(), two_faces(height));
  }
  ASSERT_EQ(run_program(folder, command).exit_code, 1);
  const std::string html = slurp(page);
  const auto report = nlohmann::json::parse(slurp(json));
  EXPECT_EQ(data_of(html, "report"), report);
  EXPECT_EQ(verdict_of(html), "violated");
  ASSERT_EQ(report["violations"].size(), 3U);
  EXPECT_EQ(occurrences(html, kRow), 3U);
  EXPECT_EQ(occurrences(html, kBar), 3U);
  EXPECT_NE(
      html.find("title=\"motion 1 to 2: 3 vertex-face\" aria-label=\"motion 1 to 2: 3 vertex-face\" data-begin=\"1\""),
      html.npos);
  EXPECT_EQ(frames_of(html), (std::vector<std::int64_t>{1, 2, 0})) << "those with witnesses first";
  EXPECT_NE(html.find("The meshes of 3 of 3 frames"), html.npos);

  const auto cases = data_of(html, "cases");
  ASSERT_EQ(cases.size(), 3U);
  EXPECT_NE(html.find("selvage replay " + cases[0]["name"].get<std::string>()), html.npos);
  spit(kept, cases[0]["text"].get<std::string>());
  const auto replayed = run_program(folder, {"replay", kept});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_NE(replayed.out.find(report["violations"][0]["t"]["lower"]), std::string::npos) << replayed.out;
}

TEST(VerifyPage, HasEveryVerdictAndItsReasons) {
  const TemporaryFolder folder;
  const auto a = folder.path() / "a.obj", b = folder.path() / "b.obj", page = folder.path() / "page.html";
  spit(a, two_faces(1));
  spit(b, two_faces(2) + "f 1 4 5\n");
  EXPECT_EQ(run_program(folder, {"verify", a, "--html", page}).exit_code, 0);
  EXPECT_EQ(verdict_of(slurp(page)), "clean");
  EXPECT_EQ(occurrences(slurp(page), kRow), 0U);
  EXPECT_EQ(frames_of(slurp(page)), (std::vector<std::int64_t>{0})) << "a clean frame can be looked at";
  EXPECT_EQ(run_program(folder, {"verify", "--motion", a, b, "--html", page}).exit_code, 5);
  EXPECT_EQ(verdict_of(slurp(page)), "unknown");
  EXPECT_NE(slurp(page).find("vertices cannot be paired"), std::string::npos);
  EXPECT_EQ(data_of(slurp(page), "scene")["surfaces"].size(), 2U);
}

TEST(VerifyPage, AFrameThatWasNotReachedIsNotShownAsClean) {
  const TemporaryFolder folder;
  const auto good = folder.path() / "good.obj", bad = folder.path() / "bad.obj", page = folder.path() / "page.html";
  spit(good, two_faces(1));
  spit(bad, two_faces(0));
  ASSERT_EQ(run_program(folder, {"verify", "--fail-fast", good, bad, good, good, "--html", page}).exit_code, 1);
  const std::string html = slurp(page);
  EXPECT_EQ(occurrences(html, "title=\"Frame 0: no violation\""), 1U);
  EXPECT_EQ(occurrences(html, "title=\"Frame 2: not checked\""), 1U);
  EXPECT_EQ(occurrences(html, "title=\"Frame 3: not checked\""), 1U);
}

TEST(VerifyPage, NamesOfStrangersStayText) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "<script>alert(1)<.obj", page = folder.path() / "page.html";
  spit(mesh, "g </script><b>&\n" + two_faces(0));
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--ignore", "</script><b>&", "--html", page}).exit_code, 5);
  const std::string ignored = slurp(page);
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--html", page}).exit_code, 1);
  for (const std::string& html : {ignored, slurp(page)}) {
    EXPECT_EQ(html.find("<script>alert"), html.npos);
    EXPECT_EQ(html.find("<b>"), html.npos);
    EXPECT_EQ(occurrences(html, "<script"), occurrences(html, "</script>"));
  }
  EXPECT_NE(ignored.find("Ignored: &quot;&lt;/script&gt;&lt;b&gt;&amp;&quot;"), ignored.npos);
}

TEST(VerifyPage, NamesThatAreNoUtf8LeaveThePageUtf8) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "cloth\xff.obj", page = folder.path() / "page.html";
  spit(mesh, two_faces(0));
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--html", page, "--cases", folder.path() / "\xfe"}).exit_code, 1);
  EXPECT_TRUE(io::is_utf8(slurp(page)));
  EXPECT_EQ(run_program(folder, {"view", mesh, "-o", page}).exit_code, 0);
  EXPECT_TRUE(io::is_utf8(slurp(page)));
  const std::string name = data_of(slurp(page), "scene")["frames"][0]["name"];
  EXPECT_NE(name.find("cloth\xef\xbf\xbd.obj"), name.npos) << name;
}

TEST(VerifyPage, MeshesThatDoNotFitAreLeftOutAndSo) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", page = folder.path() / "page.html";
  spit(mesh, two_faces(0));
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--html", page, "--html-mb", "0"}).exit_code, 1);
  EXPECT_TRUE(frames_of(slurp(page)).empty());
  EXPECT_NE(slurp(page).find("1 more with witnesses or in between did not fit into --html-mb 0"), std::string::npos);
  EXPECT_EQ(occurrences(slurp(page), kRow), 1U) << "the witness is there all the same";
  EXPECT_EQ(run_program(folder, {"verify", mesh, "--html", folder.path() / "none/page.html"}).exit_code, 4);
}

TEST(MergePage, IsThatOfOneRunWithoutTheMeshes) {
  const TemporaryFolder folder;
  std::vector<std::string> sources;
  for (int i = 0; i < 4; ++i) {
    sources.push_back(folder.path() / fmt::format("{}.obj", i));
    spit(sources.back(), two_faces(i == 2 ? 0 : 1));
  }
  std::vector<std::string> merge = {"merge", "-o", folder.path() / "all.json", "--html", folder.path() / "page.html"};
  for (const char* shard : {"1/2", "2/2"}) {
    std::vector<std::string> verify = {"verify", "--shard", shard, "--json",
                                       folder.path() / (std::string{shard[0]} + ".json")};
    merge.push_back(verify.back());
    verify.insert(verify.end(), sources.begin(), sources.end());
    (void)run_program(folder, verify);
  }
  const auto merged = run_program(folder, merge);
  EXPECT_EQ(merged.exit_code, 1) << merged.err;
  const std::string html = slurp(folder.path() / "page.html");
  EXPECT_EQ(verdict_of(html), "violated");
  EXPECT_EQ(occurrences(html, kRow), 1U);
  EXPECT_EQ(occurrences(html, kBar), 4U);
  EXPECT_TRUE(frames_of(html).empty());
}

/// Writes cloth.pc2 and its base mesh: positions at random, which nothing makes smaller.
void write_noise(const std::filesystem::path& folder, std::int32_t vertices, std::int32_t frames) {
  std::string mesh, bytes("POINTCACHE2\0\1\0\0\0", 16);
  const auto append = [&](auto value) {
    const auto raw = std::bit_cast<std::array<char, 4>>(value);
    bytes.append(raw.begin(), raw.end());
  };
  append(vertices);
  append(0.0F);
  append(1.0F);
  append(frames);
  std::mt19937 generator(1);
  for (std::int32_t i = 0; i < 3 * vertices * frames; ++i) append(static_cast<float>(generator() >> 8));
  for (std::int32_t i = 0; i < vertices; ++i) mesh += "v 0 0 0\n";
  for (std::int32_t i = 0; i + 2 < vertices; i += 3) mesh += fmt::format("f {} {} {}\n", i + 1, i + 2, i + 3);
  spit(folder / "cloth.obj", mesh);
  spit(folder / "cloth.pc2", bytes);
}

TEST(ViewPage, HasAllFramesOrEveryNthThatFits) {
  constexpr std::int32_t kFrames = 40;
  const TemporaryFolder folder;
  const auto cache = folder.path() / "cloth.pc2", page = folder.path() / "page.html";
  write_noise(folder.path(), 3000, kFrames);

  const auto all = run_program(folder, {"view", cache, "-o", page});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_TRUE(all.out.starts_with("40 of 40 frames (all), rounded to multiples of ")) << all.out;
  EXPECT_EQ(frames_of(slurp(page)).size(), 40U);

  const auto some = run_program(folder, {"view", cache, "-o", page, "--max-mb", "1"});
  EXPECT_EQ(some.exit_code, 0) << some.err;
  const std::vector<std::int64_t> frames = frames_of(slurp(page));
  ASSERT_GT(frames.size(), 5U) << "noise of 16 bits is 8 bytes a point in base64: about 30 frames fit";
  ASSERT_LT(frames.size(), 40U);
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) EXPECT_EQ(frames[i], frames[1] * static_cast<std::int64_t>(i));
  EXPECT_EQ(frames.back(), kFrames - 1) << "how it ended is always there";
  EXPECT_LT(slurp(page).size(), 1'000'000U + 200'000U) << "meshes, and the page around them";
  EXPECT_NE(some.out.find(fmt::format("{} of 40 frames (one in {} and the last)", frames.size(), frames[1])),
            std::string::npos)
      << some.out;
}

TEST(ViewPage, TheFirstAndTheLastFrameFitOrNothingDoes) {
  // 0.35 MB a frame: two fit into 1 MB, the third did not.
  const TemporaryFolder folder;
  const auto cache = folder.path() / "cloth.pc2", page = folder.path() / "page.html";
  write_noise(folder.path(), 42000, 8);
  const auto two = run_program(folder, {"view", cache, "-o", page, "--max-mb", "1"});
  EXPECT_EQ(two.exit_code, 0) << two.err;
  EXPECT_EQ(frames_of(slurp(page)), (std::vector<std::int64_t>{0, 7}));
  std::filesystem::remove(page);
  write_noise(folder.path(), 90000, 3);
  const auto none = run_program(folder, {"view", cache, "-o", page, "--max-mb", "1"});
  EXPECT_EQ(none.exit_code, 3) << none.out;
  EXPECT_NE(none.err.find("the first and the last frame do not fit into --max-mb 1; allow more"), std::string::npos)
      << none.err;
  EXPECT_FALSE(std::filesystem::exists(page));
}

TEST(ViewPage, AHiddenGroupIsNotInThePage) {
  const TemporaryFolder folder;
  const auto run = folder.path() / "run", page = folder.path() / "p.html";
  // The floor reaches so far that the view would have to move its corners nearer.
  const io::Points points = {{0, 0, 0}, {1e9, 0, 0}, {0, 1e9, 0}, {0, 0, 1}, {1, 0, 1},
                             {0, 1, 1}, {0, 0, 5},   {1, 0, 5},   {0, 1, 5}, {1, 1, 5}};
  const io::Triangles faces = {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}, {3, 4, 5}, {6, 7, 8}, {7, 8, 9}};
  io::SequenceWriter(run, {faces,
                           {{"floor", io::Group::Role::kBody, 0, 3},
                            {"ball", io::Group::Role::kBody, 3, 4},
                            {"sheet", io::Group::Role::kCloth, 4, 6}},
                           io::SequenceKind::kFrames,
                           io::Precision::kFloat64,
                           "test"})
      .append(0, points);
  const auto all = run_program(folder, {"view", run, "-o", page});
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_NE(all.out.find("2 positions too far from the cloth"), std::string::npos) << all.out;
  const auto larger = slurp(page).size();
  const auto hidden = run_program(folder, {"view", run, "-o", page, "--hide", "floor"});
  EXPECT_EQ(hidden.exit_code, 0) << hidden.err;
  EXPECT_EQ(hidden.out.find("too far"), std::string::npos) << hidden.out;
  EXPECT_EQ(data_of(slurp(page), "scene")["surfaces"][0]["cloth"], 2) << "the ball is a body still";
  EXPECT_LT(slurp(page).size(), larger);
  EXPECT_EQ(run_program(folder, {"view", run, "-o", page, "--hide", "floor", "--hide", "ball"}).exit_code, 0);
  EXPECT_EQ(data_of(slurp(page), "scene")["surfaces"][0]["cloth"], 2);
  const auto unknown = run_program(folder, {"view", run, "-o", page, "--hide", "floors"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("--hide: no group \"floors\"; the groups are \"floor\", \"ball\", \"sheet\""),
            std::string::npos)
      << unknown.err;
}

TEST(ViewPage, UsageAndInputErrorsAreNamed) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj";
  spit(mesh, two_faces(1));
  EXPECT_EQ(run_program(folder, {"view", mesh}).exit_code, 2);
  EXPECT_EQ(run_program(folder, {"view", mesh, "-o", folder.path() / "p.html", "--max-mb", "0"}).exit_code, 2);
  EXPECT_EQ(run_program(folder, {"view", folder.path() / "none.obj", "-o", folder.path() / "p.html"}).exit_code, 4);
}

}  // namespace selvage
