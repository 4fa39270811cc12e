#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/sequence.h"
#include "io/sequence/sequence_readers.h"
#include "tests/fp_control.h"
#include "tests/io/point_cache_builder.h"
#include "tests/public_data.h"
#include "tests/verify/frames.h"
#include "tests/verify/sheet.h"
#include "verify/check.h"
#include "verify/report/report.h"

namespace selvage::verify {
namespace {

using selvage::testing::Frames;
using selvage::testing::sheet;

io::MeshData lifted(io::MeshData mesh, double height) {
  for (Point& p : mesh.points) p[2] += height;
  return mesh;
}

/// A sheet with a triangle above it (height > 1), below it (height < -1), or, with another foot, through it.
io::MeshData sheet_and_triangle(double height, double foot) {
  io::MeshData mesh = sheet(5);
  const auto p = testing::add_vertex(mesh, {1.25, 1.25, height});
  const auto q = testing::add_vertex(mesh, {1.5, 1.25, height});
  const auto r = testing::add_vertex(mesh, {1.25, 1.5, foot});
  mesh.triangles.push_back({p, q, r});
  return mesh;
}
io::MeshData sheet_and_triangle(double height) { return sheet_and_triangle(height, height); }

SequenceReport check_frames(const std::vector<io::MeshData>& frames, const SequenceOptions& options = {}) {
  return check_sequence(Frames(frames), options);
}

}  // namespace

TEST(SequenceCheck, CleanNeedsEveryFrameAndEveryMotion) {
  const SequenceReport report = check_frames({sheet(4), lifted(sheet(4), 0.5), lifted(sheet(4), 2)});
  EXPECT_EQ(report.verdict, Verdict::kClean);
  EXPECT_EQ(report.frames.checked, 3);
  EXPECT_EQ(report.frames_expected, 3);
  EXPECT_EQ(report.motions.checked, 2);
  EXPECT_EQ(report.motions_expected, 2);
  EXPECT_EQ(report.faces, 32);
  EXPECT_EQ(report.vertices, 25);
  EXPECT_EQ(report.largest_coordinate, 4);
  EXPECT_GT(report.pairs.vf, 0);
  EXPECT_GT(report.pairs.overlap, 0);
}

TEST(SequenceCheck, NamesTheFrameAndTheMotionThatAreViolated) {
  const SequenceReport motion =
      check_frames({sheet_and_triangle(2), sheet_and_triangle(3), sheet_and_triangle(-3), sheet_and_triangle(-4)});
  EXPECT_EQ(motion.verdict, Verdict::kViolated);
  EXPECT_EQ(motion.frames.violated, 0);
  EXPECT_EQ(motion.motions.violated, 1);
  ASSERT_FALSE(motion.violations.empty());
  EXPECT_EQ(motion.violations.front().frame, 1);
  EXPECT_TRUE(motion.violations.front().motion);

  const SequenceReport frame = check_frames({sheet_and_triangle(2), sheet_and_triangle(3), sheet_and_triangle(3, -3)},
                                            {{}, true, false, nullptr});
  EXPECT_EQ(frame.verdict, Verdict::kViolated);
  EXPECT_EQ(frame.frames.violated, 1);
  ASSERT_FALSE(frame.violations.empty());
  EXPECT_EQ(frame.violations.front().frame, 2);
  EXPECT_FALSE(frame.violations.front().motion);
}

TEST(SequenceCheck, TheLargestCoordinateIsThatFarthestFromZero) {
  EXPECT_EQ(check_frames({sheet_and_triangle(9), sheet_and_triangle(-11)}).largest_coordinate, 11);
}

TEST(SequenceCheck, FramesAloneDoNotSeeWhatHappensBetween) {
  const SequenceReport report =
      check_frames({sheet_and_triangle(3), sheet_and_triangle(-3)}, {{}, true, false, nullptr});
  EXPECT_EQ(report.verdict, Verdict::kClean);
  EXPECT_EQ(report.motions_expected, 0);
}

TEST(SequenceCheck, NothingToCheckIsAnError) {
  EXPECT_THROW(check_frames({}), io::Error);
  io::MeshData no_faces = sheet(3);
  no_faces.triangles.clear();
  EXPECT_THROW(check_frames({sheet(3), no_faces}), io::Error);
}

TEST(SequenceCheck, ChangingFacesAreUnknownAndNamed) {
  io::MeshData other = sheet(4);
  std::swap(other.triangles[3], other.triangles[4]);
  const SequenceReport report = check_frames({sheet(4), other, other});
  EXPECT_EQ(report.verdict, Verdict::kUnknown);
  EXPECT_EQ(report.frames.checked, 3);
  EXPECT_EQ(report.motions.checked, 1);
  ASSERT_EQ(report.unchecked.size(), 1U);
  EXPECT_NE(report.unchecked[0].find("memory[0] to memory[1]"), std::string::npos) << report.unchecked[0];

  SequenceOptions frames_only;
  frames_only.motions = false;
  const SequenceReport frames = check_frames({sheet(4), sheet(4), other, other}, frames_only);
  EXPECT_EQ(frames.verdict, Verdict::kClean);
  EXPECT_EQ(first_surface_change(frames), 2);
  EXPECT_NE(text_report(frames, {}, 0).find("change, first at frame 2;"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(json_report(frames, {}))["surface"]["first_change"], 2);
  EXPECT_EQ(first_surface_change(check_frames({sheet(4), sheet(4)})), std::nullopt);

  io::MeshData more_vertices = sheet(4);
  testing::add_vertex(more_vertices, {9, 9, 9});
  EXPECT_EQ(check_frames({sheet(4), more_vertices}).verdict, Verdict::kUnknown);
  EXPECT_EQ(first_surface_change(check_frames({sheet(4), more_vertices}, frames_only)), 1);
}

TEST(SequenceCheck, AViolationOutweighsWhatWasNotChecked) {
  io::MeshData other = sheet_and_triangle(3, -3);
  std::swap(other.triangles[3], other.triangles[4]);
  EXPECT_EQ(check_frames({sheet(4), other}).verdict, Verdict::kViolated);
}

TEST(SequenceCheck, StoppedIsUnknown) {
  for (std::size_t stop = 0; stop < 5; ++stop) {
    SequenceOptions options;
    std::size_t last_done = 0;
    options.progress = [&](std::size_t done, std::size_t total) {
      EXPECT_EQ(total, 5U);
      last_done = done;
      return done < stop;
    };
    const SequenceReport report = check_frames({sheet(4), sheet(4), sheet(4)}, options);
    EXPECT_EQ(report.verdict, Verdict::kUnknown) << stop;
    EXPECT_EQ(report.frames.checked + report.motions.checked, static_cast<std::int64_t>(last_done));
    EXPECT_EQ(last_done, stop);
    ASSERT_EQ(report.unchecked.size(), 1U);
  }
}

TEST(SequenceCheck, AsksNoMoreThanTheFirstViolationWhereThatIsEnough) {
  SequenceOptions options;
  options.stop_at_violation = true;
  const std::vector<io::MeshData> meshes = {sheet_and_triangle(3), sheet_and_triangle(-3), sheet_and_triangle(-4)};
  const SequenceReport report = check_frames(meshes, options);
  EXPECT_EQ(report.verdict, Verdict::kViolated);
  EXPECT_EQ(report.motions.checked, 1) << "the motion to the second frame is violated";
  EXPECT_EQ(report.frames.checked, 2) << "which is checked to its end";
  EXPECT_FALSE(is_complete(report));
  ASSERT_EQ(report.unchecked.size(), 1U);
  EXPECT_EQ(report.unchecked.front(), "stopped at the first violation after 3 of 5 frames and motions");

  const SequenceReport last = check_frames({meshes[1], meshes[2], meshes[0]}, options);
  EXPECT_EQ(last.verdict, Verdict::kViolated);
  EXPECT_TRUE(is_complete(last)) << "nothing is left to be stopped";
  EXPECT_EQ(check_frames({meshes[1], meshes[2]}, options).verdict, Verdict::kClean);
}

TEST(SequenceCheck, IsStoppedWithinAFrameThatCollapsed) {
  constexpr std::int64_t kFew = 50;  // of some 1000 blocks of pairs
  io::MeshData collapsed = sheet(40);
  std::ranges::fill(collapsed.points, Point{1, 1, 1});
  for (const bool motions : {false, true}) {
    std::atomic<std::int64_t> asked = 0, asked_in_first = 0;
    SequenceOptions options;
    options.motions = motions;
    options.gap = !motions;
    options.progress = [&](std::size_t done, std::size_t) {
      if (done == 1) asked_in_first = asked.load();
      return true;
    };
    options.check.stop = [&] { return ++asked > asked_in_first + kFew && asked_in_first > 0; };
    const SequenceReport report = check_frames({sheet(40), collapsed}, options);
    EXPECT_EQ(report.verdict, Verdict::kUnknown);
    EXPECT_EQ(report.frames.checked, 1);
    EXPECT_EQ(report.motions.checked, 0);
    EXPECT_EQ(report.violations_total.total(), 0);
    ASSERT_EQ(report.unchecked.size(), 1U);
    EXPECT_NE(report.unchecked.front().find("stopped on request after 1 of "), std::string::npos);
    EXPECT_LT(asked, asked_in_first + 2 * kFew);
  }
}

TEST(SequenceCheck, BodiesAloneAreUnknownUnlessAskedFor) {
  io::MeshData body = sheet(4);
  body.groups = {{"table", io::Group::Role::kBody, 0, 32}};
  SequenceOptions options;
  EXPECT_EQ(check_frames({body, body}, options).verdict, Verdict::kUnknown);
  options.check.check_bodies = true;
  const SequenceReport report = check_frames({body, body}, options);
  EXPECT_EQ(report.verdict, Verdict::kClean);
  EXPECT_EQ(report.body_faces, 32);
}

// A face that was named both was a body's, so what it crossed was left out and the frame was clean.
TEST(SequenceCheck, AFaceHasOneRole) {
  io::MeshData mesh = sheet_and_triangle(3, -3);
  mesh.groups = {{"shirt", io::Group::Role::kCloth, 0, 51}, {"ball", io::Group::Role::kBody, 10, 51}};
  try {
    (void)check_frames({mesh});
    FAIL() << "two roles";
  } catch (const io::Error& error) {
    EXPECT_EQ(error.kind(), io::ErrorKind::kBadInput);
    EXPECT_STREQ(error.what(),
                 "memory[0]: face 10 is in the group \"shirt\", which is cloth, and in \"ball\", which is a body; give "
                 "both groups one role, or ranges that have no face in common");
  }
  mesh.groups[1].role = io::Group::Role::kCloth;
  EXPECT_EQ(check_frames({mesh}).verdict, Verdict::kViolated) << "groups of one role may overlap";
  mesh.groups = {{"shirt", io::Group::Role::kCloth, 0, 10}, {"ball", io::Group::Role::kBody, 10, 50}};
  EXPECT_EQ(check_frames({mesh}).verdict, Verdict::kViolated) << "neighbours; the last face is in no group and cloth";
  mesh.groups[0].face_begin = mesh.groups[0].face_end = 20;
  EXPECT_EQ(check_frames({mesh}).verdict, Verdict::kViolated) << "a group without faces overlaps nothing";
}

// Where every pair was exempt nothing was examined, also not what exemptions leave owed.
TEST(SequenceCheck, AreasAreCheckedWhateverMayTouch) {
  io::MeshData mesh = sheet(3), flat = mesh;
  flat.points[0] = testing::point_on(flat, 0, {0, 2, 2});
  for (io::MeshData* m : {&mesh, &flat}) m->groups = {{"a", io::Group::Role::kCloth, 0, 18}};
  SequenceOptions options;
  options.rules.exempt = {{"a", "a"}};
  const SequenceReport fine = check_frames({mesh, mesh}, options);
  EXPECT_EQ(fine.verdict, Verdict::kUnknown) << "no pair was looked at";
  EXPECT_EQ(fine.unchecked.size(), 3U);
  EXPECT_EQ(fine.pairs.self, 2 * 18 + 3 * 18);
  const SequenceReport report = check_frames({mesh, flat}, options);
  EXPECT_EQ(report.verdict, Verdict::kViolated);
  EXPECT_EQ(report.frames.violated, 1);
  EXPECT_EQ(report.motions.violated, 1);
  EXPECT_GT(report.violations_total.self, 0);
  EXPECT_EQ(report.violations_total.overlap + report.violations_total.vf + report.violations_total.ee, 0);
}

TEST(SequenceCheck, FacesThatAllCollapseAreViolated) {
  io::MeshData mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  SequenceOptions options;
  options.weld = true;
  const SequenceReport report = check_frames({mesh, mesh}, options);
  EXPECT_EQ(report.verdict, Verdict::kViolated);
  EXPECT_EQ(report.frames.violated, 2);
  EXPECT_EQ(report.motions.violated, 1);
  EXPECT_EQ(report.violations_total.total(), report.violations_total.self);
}

TEST(SequenceCheck, TheGapIsOfANearestPairOfAllFrames) {
  // Nearest corners 1 apart, and a little less: both distances have the upper bound 1, and the second no exact double.
  const auto two = [](double x, double y) {
    io::MeshData mesh;
    mesh.points = {{0, 0, 0}, {-1, 1, 0}, {-1, -1, 0}, {x, 0, y}, {x + 1, 1, y}, {x + 1, -1, y}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    return mesh;
  };
  const io::MeshData one = two(1, 0), less = two(1 - 0x1p-53, 0x1p-27), least = two(1 - 0x1p-53, 0x1p-28);
  SequenceOptions options;
  options.gap = true;
  options.motions = false;
  const struct {
    std::vector<io::MeshData> frames;
    std::int64_t nearest;
  } cases[] = {{{one, less, least}, 2}, {{least, one, less}, 0}, {{one, less, one}, 1}, {{less, least, least}, 1}};
  for (const auto& [frames, nearest] : cases) {
    const std::optional<Gap> gap = check_frames(frames, options).gap;
    ASSERT_TRUE(gap);
    EXPECT_EQ(gap->frame, nearest);
    EXPECT_EQ(gap->upper, 1);
    EXPECT_EQ(gap->lower, 1 - 0x1p-53);
  }
}

TEST(SequenceCheck, UnreferencedVerticesAreCountedNotChecked) {
  io::MeshData mesh = sheet(4);
  testing::add_vertex(mesh, testing::point_on(mesh, 3, {1, 1, 2}));
  const SequenceReport report = check_frames({mesh, mesh});
  EXPECT_EQ(report.verdict, Verdict::kClean);
  EXPECT_EQ(report.unreferenced_vertices, 1);
}

TEST(SequenceCheck, ListIsCappedOverTheWholeSequence) {
  SequenceOptions options;
  options.check.max_violations = 4;
  const SequenceReport report = check_frames(
      {sheet_and_triangle(3), sheet_and_triangle(-3), sheet_and_triangle(3), sheet_and_triangle(-3)}, options);
  EXPECT_EQ(report.violations.size(), 4U);
  EXPECT_GT(report.violations_total.total(), 4);
  EXPECT_EQ(report.motions.violated, 3);
  ASSERT_EQ(report.violated.size(), 3U) << "each of them is counted, also those that the list has no place for";
  ViolationCounts sum;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(report.violated[i].frame, static_cast<std::int64_t>(i));
    EXPECT_TRUE(report.violated[i].motion);
    sum += report.violated[i].counts;
  }
  EXPECT_EQ(sum.vf, report.violations_total.vf);
  EXPECT_EQ(sum.total(), report.violations_total.total());
}

TEST(Report, TheReplayCommandIsTypedAsItStands) {
  EXPECT_EQ(replay_command("a/frame-0-overlap-0-1.case"), "selvage replay a/frame-0-overlap-0-1.case");
  EXPECT_EQ(replay_command("Tim's shots/a.case"), "selvage replay 'Tim'\\''s shots/a.case'");
}

TEST(Report, TextAndJsonTellTheSame) {
  SequenceOptions options;
  options.check.max_violations = 2;
  const SequenceReport report = check_frames({sheet_and_triangle(3), sheet_and_triangle(-3)}, options);
  const ReportContext context{"selvage test", {"a\xff.obj"}, {{0, "first"}, {1, "second"}}};
  const auto json = nlohmann::json::parse(json_report(report, context));
  EXPECT_EQ(json["schema"], "selvage.verify/1");
  EXPECT_EQ(json["verdict"], "violated");
  EXPECT_EQ(json["program"], "selvage test");
  EXPECT_EQ(json["pairs"]["vf"], report.pairs.vf);
  EXPECT_EQ(json["pairs"]["exact"], report.pairs.exact);
  EXPECT_EQ(json["violations_total"]["vf"], report.violations_total.vf);
  ASSERT_EQ(json["violations"].size(), 2U);
  const auto& violation = json["violations"][0];
  EXPECT_EQ(violation["frame"], 0);
  EXPECT_EQ(violation["frame_name"], "first");
  EXPECT_EQ(violation["unit"], "motion");
  EXPECT_EQ(violation["event"], "vf");
  EXPECT_EQ(violation["t"]["lower"], report.violations[0].t.lower);
  EXPECT_EQ(violation["t"]["lower_number"], report.violations[0].t.lower_approx);
  EXPECT_EQ(violation["vertices"].size(), 4U);
  EXPECT_EQ(json["surface"]["faces"], 51);
  EXPECT_GE(json["seconds"], 0);

  const std::string text = text_report(report, context, 1);
  EXPECT_TRUE(text.starts_with("violated\n")) << text;
  EXPECT_NE(text.find("2 of 2 checked, 0 violated"), std::string::npos) << text;
  EXPECT_NE(text.find("1 of 1 checked, 1 violated"), std::string::npos) << text;
  EXPECT_NE(text.find("and " + std::to_string(report.violations_total.total() - 1) + " more"), std::string::npos);
}

TEST(Report, APartKnowsWhetherItsFirstFrameHasTheSurfaceOfTheOneBefore) {
  io::MeshData other = sheet(4);
  std::swap(other.triangles[3], other.triangles[4]);
  SequenceOptions part;
  part.range = {2, 4};
  EXPECT_EQ(first_surface_change(check_frames({sheet(4), sheet(4), other, other}, part)), 2);
  EXPECT_EQ(first_surface_change(check_frames({sheet(4), other, other, other}, part)), std::nullopt);
}

TEST(Report, SaysThatMotionsAreNotChecked) {
  SequenceOptions frames_only;
  frames_only.motions = false;
  const auto motions_of = [](const SequenceReport& report) {
    const std::string text = text_report(report, {}, 0);
    const std::size_t begin = text.find("motions:");
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  const std::vector<io::MeshData> two = {sheet(3), lifted(sheet(3), 1)};
  EXPECT_EQ(motions_of(check_frames(two, frames_only)), "motions:    not checked (--motion does)");
  EXPECT_EQ(motions_of(check_frames(two)), "motions:    1 of 1 checked, 0 violated");
  frames_only.range = std::pair<std::size_t, std::size_t>(0, 1);
  EXPECT_EQ(motions_of(check_frames(two, frames_only)), "motions:    not checked (--motion does)") << "a part";
  frames_only.range.reset();
  EXPECT_EQ(motions_of(check_frames({sheet(3)}, frames_only)), "motions:    0 of 0 checked, 0 violated");
}

TEST(Report, NamesWeldingWhereAMeshIsSplitAtSeams) {
  io::MeshData split = sheet(3);
  for (std::size_t corner = 0; corner < 3; ++corner) {  // the last face has its own vertices
    std::int32_t& vertex = split.triangles.back()[corner];
    vertex = testing::add_vertex(split, split.points[static_cast<std::size_t>(vertex)]);
  }
  const auto says = [](const SequenceReport& report) {
    return text_report(report, {}, 0).find("split at seams (selvage verify --weld") != std::string::npos;
  };
  const SequenceReport report = check_frames({split});
  EXPECT_EQ(report.verdict, Verdict::kViolated);
  EXPECT_TRUE(says(report));
  SequenceOptions weld;
  weld.weld = true;
  EXPECT_EQ(check_frames({split}, weld).verdict, Verdict::kClean);
  EXPECT_FALSE(says(check_frames({split}, weld)));
  const SequenceReport through = check_frames({sheet_and_triangle(3, -3)});
  EXPECT_EQ(through.verdict, Verdict::kViolated);
  EXPECT_FALSE(says(through)) << "which no seam explains";
}

// Sequences of other simulators; the numbers of intersecting face pairs beside them are CGAL's.
TEST(SequenceCheck, CountsWhatCgalCountsInPublicSequences) {
  const auto data = testing::public_data();
  if (!data || !std::filesystem::exists(*data / "sequences")) GTEST_SKIP() << "public data not found: set SELVAGE_DATA";
  for (const char* name : {"blender-table-50", "blender-curtain-150", "eltopo-curtain-50"}) {
    const std::filesystem::path file = *data / "sequences" / (std::string(name) + ".npz");
    std::ifstream stream(*data / "sequences" / (std::string(name) + ".pairs.json"));
    const auto expected = nlohmann::json::parse(stream)["frames"];
    const auto sequence = io::open_sequence({file});
    ASSERT_EQ(sequence->frame_count(), expected.size()) << name;
    for (std::size_t i = 0; i < sequence->frame_count(); ++i) {
      const io::MeshData mesh = sequence->frame(i);
      const std::vector<std::uint8_t> is_body = io::body_faces(mesh.triangles.size(), mesh.groups);
      const CheckResult result = check_frame({mesh.triangles, is_body}, mesh.points,
                                             {.max_violations = 1000000, .min_distance = {}, .check_bodies = false});
      std::int64_t cloth_pairs = 0, sharing = 0, body_pairs = 0;
      for (const Violation& v : result.violations) {
        if (v.event != EventKind::kOverlap) continue;
        const auto [f, g] = v.features;
        if (is_body[static_cast<std::size_t>(f)] != 0 || is_body[static_cast<std::size_t>(g)] != 0) {
          ++body_pairs;
          continue;
        }
        ++cloth_pairs;
        const auto& x = v.vertices;
        if (std::find_first_of(x.begin(), x.begin() + 3, x.begin() + 3, x.end()) != x.begin() + 3) ++sharing;
      }
      EXPECT_EQ(cloth_pairs, expected[i]["cloth_self_pairs"]) << name << " frame " << i;
      EXPECT_EQ(sharing, expected[i]["of_these_sharing_a_vertex"]) << name << " frame " << i;
      EXPECT_EQ(body_pairs, expected[i]["cloth_body_pairs"]) << name << " frame " << i;
    }
  }
}

/// The reader widens float32 to double; under "denormals are zero" a subnormal one would be read as zero.
TEST(SequenceCheck, FramesAreReadUnderTheGuard) {
  std::string cache = testing::pc2(6, 0, 1);
  constexpr float kGap = 0x1p-149f;
  for (const float x : {0.0f, 0.0f, 0.0f, 4.0f, 0.0f, 0.0f, 0.0f, 4.0f, 0.0f}) testing::append_bytes(cache, x, false);
  for (const float x : {1.0f, 1.0f, kGap, 2.0f, 1.0f, kGap, 1.0f, 2.0f, kGap}) testing::append_bytes(cache, x, false);
  io::MeshData base;
  base.points.resize(6);
  base.triangles = {{0, 1, 2}, {3, 4, 5}};
  const auto sequence = io::open_point_cache(io::in_memory(cache), io::PointCacheFormat::kPc2, base, "in");
  const unsigned found = testing::fp_control();
  testing::set_fp_control(found | testing::kFlushing);  // as a library built with -ffast-math leaves it
  const SequenceReport report = check_sequence(*sequence, {});
  testing::set_fp_control(found);
  EXPECT_EQ(report.verdict, Verdict::kClean);
}

}  // namespace selvage::verify
