#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>

#include <gtest/gtest.h>

#include "cli/render/camera.h"
#include "cli/render/contact_sheet.h"
#include "cli/render/renderer.h"
#include "tests/cli/run_program.h"

namespace selvage::cli {
namespace {

constexpr int kWidth = 120, kHeight = 90;
const View kFromAbove{.azimuth_deg = -90, .elevation_deg = 89, .up = UpAxis::kZ};

// A unit square at the height z, seen from above from its front.
void add_square(io::MeshData& mesh, double side, double z, bool front) {
  const auto n = static_cast<std::int32_t>(mesh.points.size());
  const double h = side / 2;
  for (const auto& point : {std::array{-h, -h, z}, {h, -h, z}, {h, h, z}, {-h, h, z}}) mesh.points.push_back(point);
  if (front) {
    mesh.triangles.insert(mesh.triangles.end(), {{n, n + 1, n + 2}, {n, n + 2, n + 3}});
  } else {
    mesh.triangles.insert(mesh.triangles.end(), {{n, n + 2, n + 1}, {n, n + 3, n + 2}});
  }
}

io::Picture draw(const io::MeshData& mesh, const View& view = kFromAbove) {
  const RenderSurface surface = make_render_surface(mesh);
  Stage stage;
  stage.add_cloth(surface);
  return render(surface, view, stage, kWidth, kHeight, [] { return true; }).value();
}

struct Rgb {
  int r, g, b;
};
Rgb pixel(const io::Picture& picture, int x, int y) {
  const auto* p = &picture.rgb[static_cast<std::size_t>((y * picture.width + x) * 3)];
  return {p[0], p[1], p[2]};
}
bool warm(Rgb c) { return c.r > c.b + 40; }
bool cool(Rgb c) { return c.b > c.r + 40; }
bool grey(Rgb c) { return std::abs(c.r - c.b) < 30 && std::abs(c.r - c.g) < 30; }

}  // namespace

TEST(Render, FrontIsWarmBackIsCoolBodiesAreGrey) {
  for (const bool front : {true, false}) {
    io::MeshData mesh;
    add_square(mesh, 1, 0, front);
    const Rgb middle = pixel(draw(mesh), kWidth / 2, kHeight / 2);
    EXPECT_EQ(warm(middle), front) << middle.r << " " << middle.g << " " << middle.b;
    EXPECT_EQ(cool(middle), !front) << middle.r << " " << middle.g << " " << middle.b;
    mesh.groups = {{"table", io::Group::Role::kBody, 0, 2}};
    EXPECT_TRUE(grey(pixel(draw(mesh), kWidth / 2, kHeight / 2)));
  }
}

TEST(Render, TheNearerFaceHidesTheFarther) {
  for (const bool upper_first : {true, false}) {
    io::MeshData mesh;
    add_square(mesh, 1, upper_first ? 0.3 : 0, upper_first);
    add_square(mesh, 1, upper_first ? 0 : 0.3, !upper_first);
    EXPECT_TRUE(warm(pixel(draw(mesh), kWidth / 2, kHeight / 2))) << "the upper square shows its front";
  }
}

TEST(Render, ShadowsFallOnWhatIsBelow) {
  io::MeshData open;
  add_square(open, 1, 0, true);
  io::MeshData covered = open;
  add_square(covered, 0.6, 0.15, true);
  // Next to the upper square, away from the sun.
  const View view = kFromAbove;
  const io::Picture light = draw(open, view), dark = draw(covered, view);
  int darker = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) darker += pixel(dark, x, y).r < pixel(light, x, y).r - 20 ? 1 : 0;
  }
  EXPECT_GT(darker, 100);
}

TEST(Render, AFloorThatReachesBehindTheCameraIsDrawn) {
  io::MeshData mesh;
  add_square(mesh, 1, 1, true);
  add_square(mesh, 1000, 0, true);
  mesh.groups = {{"cloth", io::Group::Role::kCloth, 0, 2}, {"floor", io::Group::Role::kBody, 2, 4}};
  const io::Picture picture = draw(mesh, {.azimuth_deg = -90, .elevation_deg = 20});
  const Rgb corner = pixel(picture, kWidth / 2, kHeight - 2), sky = pixel(picture, 2, 2);
  EXPECT_TRUE(grey(corner));
  EXPECT_NE(corner.r, sky.r) << "floor and not background";
}

TEST(Render, AnySizeThatDoublesHoldIsDrawnAlike) {
  const auto squares = [](int exponent) {
    io::MeshData mesh;
    add_square(mesh, std::ldexp(2.0, exponent), 0, true);
    add_square(mesh, std::ldexp(1.0, exponent), std::ldexp(0.25, exponent), false);
    return draw(mesh).rgb;
  };
  const auto expected = squares(0);
  for (const int exponent : {-1070, -1022, -300, 99, 512, 1022})
    EXPECT_EQ(squares(exponent) == expected, true) << exponent;
}

TEST(Render, FacesWithoutAreaAndSinglePointsAreHarmless) {
  io::MeshData mesh;
  mesh.points = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(draw(mesh).rgb.size(), static_cast<std::size_t>(kWidth * kHeight * 3));
}

TEST(Camera, AllPointsFitAndTouchTheMargin) {
  Stage stage;
  RenderSurface surface;
  for (int i = 0; i < 200; ++i) {
    const Vec3 point(std::sin(i * 1.7), 3 * std::cos(i * 2.3), 0.5 * std::sin(i * 0.9) + 10);
    stage.points.push_back(point);
    stage.bounds.add(point);
  }
  for (const double elevation : {-40.0, 0.0, 25.0, 80.0}) {
    const Camera camera({.azimuth_deg = 33, .elevation_deg = elevation}, stage, 400, 300);
    double largest = 0;
    for (const Vec3& point : stage.points) {
      const Vec3 seen = camera.to_camera(point);
      ASSERT_GT(seen.z(), camera.near_depth());
      const Eigen::Vector2d offset =
          (camera.to_screen(seen) - Eigen::Vector2d(200, 150)).cwiseQuotient(Eigen::Vector2d(200, 150));
      largest = std::max(largest, offset.cwiseAbs().maxCoeff());
    }
    EXPECT_NEAR(largest, 0.94, 1e-6);
  }
}

TEST(RenderCommand, WritesASheetOfTheFramesAskedFor) {
  const testing::TemporaryFolder folder;
  testing::spit(folder.path() / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string mesh = (folder.path() / "a.obj").string(), sheet = (folder.path() / "sheet.png").string();
  const auto result =
      testing::run_program(folder, {"render", mesh, mesh, "-o", sheet, "--frames", "1", "--width", "200"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string png = testing::slurp(sheet);
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(static_cast<unsigned char>(png[19]), 200) << "width";
  const std::string loud = (folder.path() / "SHEET.PNG").string();
  const auto upper = testing::run_program(folder, {"render", mesh, "-o", loud, "--frames", "0", "--width", "200"});
  EXPECT_EQ(upper.exit_code, 0) << upper.err;
  EXPECT_EQ(testing::slurp(loud).substr(1, 3), "PNG");
  EXPECT_EQ(testing::run_program(folder, {"render", mesh, "-o", sheet + ".jpg"}).exit_code, 2);
}

TEST(RenderCommand, AHiddenGroupLeavesThePictureOfTheOthers) {
  const testing::TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  const std::string sheet = "g sheet\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string lid = "g lid\nv 0 0 1\nv 3 0 1\nv 0 3 1\nf 4 5 6\n", edge = "g edge\nv 1 1 0\nf 2 7 3\n";
  testing::spit(path("all.obj"), sheet + lid + edge);
  testing::spit(path("open.obj"), sheet + "g edge\nv 1 1 0\nf 2 4 3\n");
  const auto draw = [&](const char* mesh, const char* picture, const std::vector<std::string>& hidden) {
    std::vector<std::string> arguments = {"render", path(mesh), "-o", path(picture), "--width", "200"};
    for (const std::string& name : hidden) arguments.insert(arguments.end(), {"--hide", name});
    return testing::run_program(folder, arguments);
  };
  ASSERT_EQ(draw("open.obj", "open.png", {}).exit_code, 0);
  ASSERT_EQ(draw("all.obj", "all.png", {}).exit_code, 0);
  const auto hidden = draw("all.obj", "hidden.png", {"lid"});
  EXPECT_EQ(hidden.exit_code, 0) << hidden.err;
  EXPECT_NE(testing::slurp(path("all.png")), testing::slurp(path("open.png")));
  EXPECT_EQ(testing::slurp(path("hidden.png")), testing::slurp(path("open.png")));

  const auto unknown = draw("all.obj", "none.png", {"lid", "lids"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("--hide: no group \"lids\"; the groups are \"sheet\", \"lid\", \"edge\""),
            std::string::npos)
      << unknown.err;
  const auto nothing = draw("all.obj", "none.png", {"lid", "sheet", "edge"});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_NE(nothing.err.find("there is nothing left to show"), std::string::npos) << nothing.err;
  EXPECT_FALSE(std::filesystem::exists(path("none.png")));
}

TEST(Render, ALargePictureIsDrawnInBandsWithoutASeam) {
  io::MeshData mesh;
  add_square(mesh, 1, 0, true);
  const RenderSurface surface = make_render_surface(mesh);
  Stage stage;
  stage.add_cloth(surface);
  int asked = 0;
  const auto count = [&] { return ++asked > 0; };
  const io::Picture picture = render(surface, kFromAbove, stage, 1200, 900, count).value();
  EXPECT_GT(asked, 2);
  for (int y = 100; y < 800; ++y) ASSERT_TRUE(warm(pixel(picture, 600, y))) << y;
  EXPECT_FALSE(render(surface, kFromAbove, stage, 1200, 900, [&] { return --asked > 1; }));
}

TEST(RenderCommand, ASheetThatNeedsMoreThanTwoGigabytesIsRefused) {
  const testing::TemporaryFolder folder;
  testing::spit(folder.path() / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string mesh = (folder.path() / "a.obj").string(), sheet = (folder.path() / "s.png").string();
  const auto wide = testing::run_program(folder, {"render", mesh, "-o", sheet, "--width", "10001"});
  EXPECT_EQ(wide.exit_code, 2) << wide.err;
  const auto high = testing::run_program(
      folder, {"render", mesh, mesh, "-o", sheet, "--columns", "1", "--frames", "0,1", "--width", "10000"});
  EXPECT_EQ(high.exit_code, 2) << high.err;
  EXPECT_NE(high.err.find("10000 by 15000"), std::string::npos) << high.err;
  EXPECT_FALSE(std::filesystem::exists(sheet));
}

TEST(RenderCommand, ASignalEndsIt) {
  const testing::TemporaryFolder folder;
  testing::spit(folder.path() / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string mesh = (folder.path() / "a.obj").string(), sheet = (folder.path() / "s.png").string();
  const pid_t child = testing::start_program(
      folder.path(), {"render", mesh, "-o", sheet, "--tiles", "1", "--columns", "1", "--width", "9000"});
  testing::wait_until_signal_is_caught(child, SIGTERM);
  kill(child, SIGTERM);
  const auto result = testing::wait_for_program(folder.path(), child);
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_NE(result.err.find("interrupted; nothing was written"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(sheet));
}

TEST(RenderCommand, OnlyPngIsDrawn) {
  const testing::TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", picture = folder.path() / "a.jpg";
  testing::spit(mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto result = testing::run_program(folder, {"render", mesh, "-o", picture});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("only PNG"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(picture));
}

TEST(RenderCommand, AFrameThatIsNotThereIsUsage) {
  const testing::TemporaryFolder folder;
  testing::spit(folder.path() / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto result = testing::run_program(folder, {"render", (folder.path() / "a.obj").string(), "-o",
                                                    (folder.path() / "s.png").string(), "--frames", "1"});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "s.png"));
}

}  // namespace selvage::cli
