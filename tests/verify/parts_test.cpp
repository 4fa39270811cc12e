// A long check in pieces: resumed, or split into parts that are joined. The result is that of one run, or an error.
#include <utility>

#include <gtest/gtest.h>

#include "tests/verify/frames.h"
#include "tests/verify/sheet.h"
#include "verify/report/merge.h"
#include "verify/report/report.h"

namespace selvage::verify {
namespace {

using selvage::testing::Frames;
using selvage::testing::sheet;

/// A sheet, and a triangle at a height that goes through it between frames 2 and 3, lies in it in frame 5 and is
/// farther away than all else in the last one.
std::vector<io::MeshData> frames() {
  std::vector<io::MeshData> result;
  for (const double height : {4.0, 3.0, 2.0, -2.0, -3.0, 0.25, -6.0}) {
    io::MeshData mesh = sheet(5);
    const auto p = testing::add_vertex(mesh, {1.25, 1.25, height}), q = testing::add_vertex(mesh, {1.5, 1.25, height}),
               r = testing::add_vertex(mesh, {1.25, 1.5, height});
    mesh.triangles.push_back({p, q, r});
    mesh.groups = {{"a", io::Group::Role::kCloth, 0, 10}, {"b", io::Group::Role::kCloth, 10, 20}};
    result.push_back(std::move(mesh));
  }
  return result;
}

SequenceOptions options() {
  SequenceOptions options;
  options.rules.exempt = {{"a", "b"}};
  options.check.max_violations = 4;
  return options;
}

const ReportContext kContext{"selvage test", {"memory"}, {}, {{"motions", "yes"}}};

/// Without what no two runs share.
std::string json(SequenceReport report) {
  report.seconds = 0;
  return json_report(report, kContext);
}

Part part(const std::vector<io::MeshData>& frames, std::size_t first, std::size_t end,
          SequenceOptions wanted = options()) {
  wanted.range = {first, end};
  const SequenceReport report = check_sequence(Frames(frames), wanted);
  return {std::to_string(first) + ".json", {report, kContext}};
}

SequenceOptions options(const GroupRules& rules) {
  SequenceOptions options;
  options.rules = rules;
  return options;
}
const GroupRules kIgnoring{{}, {}, {"b"}}, kExempting{{}, {{"a", "b"}}, {}};

/// Every frame with one face less in a group.
std::vector<io::MeshData> frames_of_a_smaller(std::size_t group) {
  std::vector<io::MeshData> result = frames();
  for (io::MeshData& mesh : result) mesh.groups[group].face_end -= 1;
  return result;
}

std::string merge_error(std::vector<Part> parts) {
  try {
    (void)merge(std::move(parts));
  } catch (const MergeError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(Parts, AReportComesBackFromItsJson) {
  const SequenceReport report = check_sequence(Frames(frames()), options());
  EXPECT_EQ(report.verdict, Verdict::kViolated);
  EXPECT_GT(report.exempted.at(0).pairs, 0);
  ASSERT_EQ(report.violations.size(), 4U);
  const std::string text = json_report(report, kContext);
  const ParsedReport parsed = parse_report(text, "report.json");
  EXPECT_EQ(json_report(parsed.report, parsed.context), text);
  EXPECT_EQ(parsed.report.violations[0].x_t1, report.violations[0].x_t1);
  const SequenceReport later = part(frames(), 3, 5).parsed.report;
  ASSERT_EQ(later.violations.at(0).frame, 2) << "the first motion starts from the frame before the range";
  const std::string of_later = json_report(later, kContext);
  EXPECT_EQ(json_report(parse_report(of_later, "part.json").report, kContext), of_later);
}

TEST(Parts, WhatIsNoReportIsRefused) {
  const std::string good = json_report(check_sequence(Frames(frames()), options()), kContext);
  EXPECT_NO_THROW((void)parse_report(good, "a"));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  for (const std::string& bad :
       {std::string("{}"), std::string("[]"), std::string("x"), good.substr(0, good.size() / 2),
        with("selvage.verify/1", "selvage.verify/2"), with("\"violated\"", "\"fine\""),
        with("\"end_frame\": 7", "\"end_frame\": 8"), with("\"first_frame\": 0", "\"first_frame\": -1"),
        with("\"frames\"", "\"frame\""), with("\"frame\": 2", "\"frame\": 7"),
        with("\"vertices\": [", "\"vertices\": [7,"), good + '\0' + "{}", with("\"checked\": 7", "\"checked\": 7e300"),
        with("\"checked\": 7", "\"checked\": -7"), with("\"features\": [", "\"features\": [4294967296,")}) {
    EXPECT_THROW((void)parse_report(bad, "a"), io::Error) << bad.substr(0, 80);
  }
}

TEST(Parts, AReportThatContradictsItselfIsRefused) {
  const SequenceReport good = check_sequence(Frames(frames()), options());
  ASSERT_EQ(good.verdict, Verdict::kViolated);
  const auto read = [](const SequenceReport& report) { (void)parse_report(json_report(report, kContext), "a"); };
  EXPECT_NO_THROW(read(good));
  const std::vector<std::pair<const char*, std::function<void(SequenceReport&)>>> damages = {
      {"none in all", [](SequenceReport& report) { report.violations_total = {}; }},
      {"vf", [](SequenceReport& report) { ++report.violations_total.vf; }},
      {"ee", [](SequenceReport& report) { ++report.violations_total.ee; }},
      {"overlap", [](SequenceReport& report) { ++report.violations_total.overlap; }},
      {"self", [](SequenceReport& report) { ++report.violations_total.self; }},
      {"of one", [](SequenceReport& report) { ++report.violated[0].counts.overlap; }},
      {"none of one", [](SequenceReport& report) { report.violated[0].counts = {}; }},
      {"one less", [](SequenceReport& report) { report.violated.pop_back(); }},
      {"violated frames", [](SequenceReport& report) { --report.frames.violated; }},
      {"violated motions", [](SequenceReport& report) { ++report.motions.violated; }},
      {"checked frames", [](SequenceReport& report) { report.frames.checked = 55; }},
      {"checked motions", [](SequenceReport& report) { report.motions.checked = 55; }},
      {"expected frames", [](SequenceReport& report) { --report.frames_expected; }},
      {"expected motions", [](SequenceReport& report) { ++report.motions_expected; }},
      {"listed", [](SequenceReport& report) { report.violations.pop_back(); }},
      {"checksums of surfaces", [](SequenceReport& report) { report.surface_crc32.pop_back(); }},
      {"time", [](SequenceReport& report) { report.violations.back().t.lower_approx = 9; }},
      {"clean", [](SequenceReport& report) { report.verdict = Verdict::kClean; }},
      {"unknown", [](SequenceReport& report) { report.verdict = Verdict::kUnknown; }},
      {"too many for a sum",
       [](SequenceReport& report) {
         report.violated.assign(2048, {2, false, {0, 0, std::int64_t{1} << 53, 0}});
         report.frames.violated = 2048;
       }},
      {"a frame behind the last", [](SequenceReport& report) { report.violations[0].frame = 7; }},
      {"a motion from the last frame",
       [](SequenceReport& report) {
         for (Violation& violation : report.violations) violation.frame = violation.motion ? 6 : violation.frame;
       }},
      {"a listed motion from the last frame",
       [](SequenceReport& report) {
         for (auto& unit : report.violated) unit.frame = unit.motion ? 6 : unit.frame;
       }},
  };
  for (const auto& [what, damage] : damages) {
    SequenceReport report = good;
    damage(report);
    EXPECT_THROW(read(report), io::Error) << what;
  }

  SequenceReport clean = check_sequence(Frames(std::vector<io::MeshData>(3, sheet(5))), SequenceOptions());
  ASSERT_EQ(clean.verdict, Verdict::kClean);
  EXPECT_NO_THROW(read(clean));
  SequenceReport cut = clean;
  cut.frame_crc32.clear();
  cut.surface_crc32.clear();
  EXPECT_THROW(read(cut), io::Error) << "tied to no bits";
  clean.second_opinion = SecondOpinionScope::kAll;
  EXPECT_NO_THROW(read(clean));
  clean.disagreements.push_back(good.violations.front());
  EXPECT_THROW(read(clean), io::Error) << "a disagreement that is not counted";
}

// Found by fuzzing: names were kept in a vector, so one name of a late frame asked for 2^55 bytes.
TEST(Parts, ANameCostsNoMoreInALateFrame) {
  SequenceReport report = check_sequence(Frames(frames()), options());
  const std::int64_t late = std::int64_t{1} << 50;
  report.violations.resize(1);
  report.violated.resize(1);
  report.violations[0].frame = report.violated[0].frame = report.first_frame = late;
  report.end_frame = report.frame_count = late + std::ssize(report.frame_crc32);
  report.motions_expected = report.frames_expected;
  report.violations_total = report.violated[0].counts;
  report.max_violations = 1;
  report.frames.violated = report.violated[0].motion ? 0 : 1;
  report.motions.violated = 1 - report.frames.violated;
  const std::string text = json_report(report, {"x", {"memory"}, {{late, "late"}}, {}});
  EXPECT_EQ(parse_report(text, "a").context.frame_names.at(late), "late");
}

TEST(Parts, ARunThatIsResumedReportsWhatOneRunWould) {
  const std::vector<io::MeshData> all = frames();
  const std::string whole = json(check_sequence(Frames(all), options()));
  std::vector<SequenceReport> notes;
  SequenceOptions noting = options();
  noting.checkpoint = [&](const SequenceReport& report) { notes.push_back(report); };
  (void)check_sequence(Frames(all), noting);
  ASSERT_EQ(notes.size(), all.size());
  for (const SequenceReport& note : notes) {
    const ParsedReport parsed = parse_report(json_report(note, kContext), "progress");
    std::int64_t units = 0;
    std::size_t last = 0;
    const auto done_before = static_cast<std::size_t>(note.frames.checked + note.motions.checked);
    SequenceOptions resuming = options();
    resuming.resume_from = &parsed.report;
    resuming.progress = [&](std::size_t done, std::size_t) {
      if (done >= done_before) ++units;  // before that frames are read and compared
      last = done;
      return true;
    };
    EXPECT_EQ(json(check_sequence(Frames(all), resuming)), whole);
    const bool has_work = note.frame_crc32.size() < all.size();
    if (has_work) {
      EXPECT_EQ(last, 2 * all.size() - 2) << "before the last frame all else is done";
    }
    EXPECT_LE(units, 2 * static_cast<std::int64_t>(all.size() - note.frame_crc32.size()))
        << "what is done is not done again";
  }
  SequenceOptions resuming = options();
  resuming.resume_from = &notes[3];
  notes[3].seconds = 1000;
  EXPECT_GE(check_sequence(Frames(all), resuming).seconds, 1000) << "of both runs";
  std::vector<io::MeshData> changed = all;
  changed[3].points[0][2] += 1;
  EXPECT_THROW((void)check_sequence(Frames(changed), resuming), io::Error) << "the last frame that was done";
  changed = all;
  changed.pop_back();
  EXPECT_THROW((void)check_sequence(Frames(changed), resuming), io::Error) << "another sequence";
  resuming.check.max_violations += 1;
  EXPECT_THROW((void)check_sequence(Frames(all), resuming), io::Error) << "a list of another length";
}

// It was only the last frame that was compared: a crossing put into another one was reported clean.
TEST(Parts, NoFrameThatAReportSpeaksOfMayChange) {
  const std::vector<io::MeshData> all = frames();
  SequenceReport progress;
  SequenceOptions wanted = options();
  wanted.range = {1, 6};
  wanted.checkpoint = [&](const SequenceReport& report) {
    if (report.frame_crc32.size() <= 3) progress = report;
  };
  const SequenceReport finished = check_sequence(Frames(all), wanted);
  for (const SequenceReport* earlier : {&std::as_const(progress), &finished}) {
    SequenceOptions resuming = options();
    resuming.range = {1, 6};
    resuming.resume_from = earlier;
    EXPECT_EQ(json(check_sequence(Frames(all), resuming)), json(finished));
    for (std::size_t i = 0; i < all.size() - 1; ++i) {  // frame 0 is before the range, frame 6 behind it
      const bool spoken_of = i <= earlier->frame_crc32.size();
      if (!spoken_of || i == 0) continue;  // frame 0 is in the sequence's identity
      std::vector<io::MeshData> changed = all;
      changed[i].points[7][2] += 1;
      EXPECT_THROW((void)check_sequence(Frames(changed), resuming), io::Error) << "positions of frame " << i;
      changed = all;
      std::swap(changed[i].triangles[3], changed[i].triangles[30]);
      EXPECT_THROW((void)check_sequence(Frames(changed), resuming), io::Error) << "faces of frame " << i;
      changed = all;
      changed[i].groups[1].role = io::Group::Role::kBody;
      EXPECT_THROW((void)check_sequence(Frames(changed), resuming), io::Error) << "roles in frame " << i;
      changed = all;
      changed[i].groups[1].face_end -= 1;
      EXPECT_THROW((void)check_sequence(Frames(changed), resuming), io::Error) << "groups of frame " << i;
    }
    std::vector<io::MeshData> changed = all;
    changed[0].groups[1].role = io::Group::Role::kBody;
    EXPECT_THROW((void)check_sequence(Frames(changed), resuming), io::Error) << "the frame before the range";
    for (const auto& other : std::vector<std::pair<std::size_t, std::size_t>>{{1, 5}, {1, 7}, {2, 6}}) {
      resuming.range = other;
      EXPECT_THROW((void)check_sequence(Frames(all), resuming), io::Error) << other.first << " to " << other.second;
    }
  }
}

// Welding alone: WeldingThatALaterFrameChangesIsAnotherSurface.
TEST(Parts, NoRuleMayComeToMeanOtherFaces) {
  const struct {
    const GroupRules& rules;
    std::size_t group;
    const char* what;
  } cases[] = {{kIgnoring, 1, "what is ignored"},
               {kExempting, 0, "one side of an exemption"},
               {kExempting, 1, "the other side of an exemption"}};
  for (const auto& c : cases) {
    const SequenceReport finished = check_sequence(Frames(frames()), options(c.rules));
    SequenceOptions resuming = options(c.rules);
    resuming.resume_from = &finished;
    EXPECT_NO_THROW((void)check_sequence(Frames(frames()), resuming)) << c.what;
    EXPECT_THROW((void)check_sequence(Frames(frames_of_a_smaller(c.group)), resuming), io::Error) << c.what;
  }
}

TEST(Parts, AStopWhileFramesAreComparedKeepsWhatWasDone) {
  const std::vector<io::MeshData> all = frames();
  const SequenceReport finished = check_sequence(Frames(all), options());
  SequenceOptions stopping = options();
  stopping.resume_from = &finished;
  int calls = 0;
  stopping.progress = [&](std::size_t, std::size_t) { return ++calls < 3; };
  SequenceReport kept;
  stopping.checkpoint = [&](const SequenceReport& report) { kept = report; };
  const SequenceReport stopped = check_sequence(Frames(all), stopping);
  EXPECT_EQ(stopped.verdict, Verdict::kUnknown);
  EXPECT_EQ(stopped.frames.checked, 0) << "nothing that was not compared is reported";
  EXPECT_EQ(json(kept), json(finished));
}

TEST(Parts, WeldingThatALaterFrameChangesIsAnotherSurface) {
  std::vector<io::MeshData> all(4, sheet(3));
  for (io::MeshData& mesh : all) testing::add_vertex(mesh, mesh.points[0]);
  for (io::MeshData& mesh : all) mesh.triangles[0] = {16, mesh.triangles[0][1], mesh.triangles[0][2]};
  SequenceOptions wanted;
  wanted.weld = true;
  SequenceReport progress;
  wanted.checkpoint = [&](const SequenceReport& report) {
    if (report.frame_crc32.size() <= 1) progress = report;
  };
  (void)check_sequence(Frames(all), wanted);
  SequenceOptions resuming;
  resuming.weld = true;
  resuming.resume_from = &progress;
  EXPECT_NO_THROW((void)check_sequence(Frames(all), resuming));
  all[2].points[16][2] += 0.25;  // the seam opens: it was never to be welded
  EXPECT_THROW((void)check_sequence(Frames(all), resuming), io::Error);
}

TEST(Parts, AllPartsMakeTheWhole) {
  const std::vector<io::MeshData> all = frames();
  const std::string whole = json(check_sequence(Frames(all), options()));
  for (std::size_t i = 1; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      // In any order.
      const ParsedReport merged = merge({part(all, j, all.size()), part(all, 0, i), part(all, i, j)});
      EXPECT_EQ(json(merged.report), whole) << i << " " << j;
    }
  }
}

TEST(Parts, NothingMissingDoubleOrForeignIsJoined) {
  const std::vector<io::MeshData> all = frames();
  const Part a = part(all, 0, 3), b = part(all, 3, 5), c = part(all, 5, 7);
  EXPECT_EQ(merge_error({a, b, c}), "");
  EXPECT_NE(merge_error({}), "");
  const std::string remedy = "; run that shard (selvage verify --shard i/N), and name its report too";
  EXPECT_EQ(merge_error({b, c}), "no part holds frames 0 to 2" + remedy);
  EXPECT_EQ(merge_error({a, c}), "no part holds frames 3 to 4" + remedy);
  EXPECT_EQ(merge_error({a, b}), "no part holds frames 5 to 6" + remedy);
  EXPECT_NE(merge_error({a, b, b, c}).find("both hold frames 3 to 4"), std::string::npos);
  EXPECT_NE(merge_error({a, part(all, 2, 5), c}).find("both hold"), std::string::npos);
  Part foreign = b;
  foreign.parsed.context.program = "selvage other";
  EXPECT_NE(merge_error({a, foreign, c}).find("programs"), std::string::npos);
  foreign = b;
  foreign.parsed.context.options[0].second = "no";
  EXPECT_NE(merge_error({a, foreign, c}).find("options"), std::string::npos);
  const std::vector<std::function<void(SequenceReport&)>> differences = {
      [](SequenceReport& report) { report.precision = io::Precision::kFloat32; },
      [](SequenceReport& report) { report.second_opinion = SecondOpinionScope::kAll; },
      [](SequenceReport& report) { report.bodies_checked = true; },
      [](SequenceReport& report) { report.gap_searched = true; },
      [](SequenceReport& report) { report.welded = {1, 0}; },
      [](SequenceReport& report) { report.ignored.emplace_back(); },
      [](SequenceReport& report) { report.exempted.clear(); }};
  for (std::size_t i = 0; i < differences.size(); ++i) {
    foreign = b;
    differences[i](foreign.parsed.report);
    EXPECT_NE(merge_error({a, foreign, c}).find("what they report differs"), std::string::npos) << i;
  }
  std::vector<io::MeshData> other = all;
  other[6].points[0][2] += 1;
  EXPECT_NE(merge_error({a, part(other, 3, 5), c}).find("sequences"), std::string::npos);
  other = all;
  other[2].points[0][2] += 1;  // neither the first nor the last frame: only the neighbour knows
  EXPECT_NE(merge_error({a, part(other, 3, 5), c}).find("frame 2 changed"), std::string::npos);
  other = all;
  other[2].groups[1].face_end -= 1;
  EXPECT_NE(merge_error({a, part(other, 3, 5), c}).find("frame 2 changed"), std::string::npos) << "its groups";
}

TEST(Parts, PartsThatIgnoreOtherFacesAreNotJoined) {
  const SequenceOptions ignoring = options(kIgnoring);
  const Part first = part(frames(), 0, 3, ignoring);
  EXPECT_EQ(merge_error({first, part(frames(), 3, 7, ignoring)}), "");
  EXPECT_NE(merge_error({first, part(frames_of_a_smaller(1), 3, 7, ignoring)}).find("frame 2 changed"),
            std::string::npos);
}

// Both gaps are written as at most 1: the later one is smaller all the same.
TEST(Parts, TheSmallestGapOfThePartsIsThatOfTheWhole) {
  std::vector<io::MeshData> all(2);
  all[0].points = testing::two_faces_apart(1, 0, 0);
  all[1].points = testing::two_faces_apart(1 - 0x1p-53, 0x1p-27, 0);
  for (io::MeshData& mesh : all) mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  SequenceOptions searching;
  searching.gap = true;
  const Part first = part(all, 0, 1, searching), second = part(all, 1, 2, searching);
  EXPECT_EQ(first.parsed.report.gap->upper, second.parsed.report.gap->upper);
  EXPECT_EQ(json(merge({first, second}).report), json(check_sequence(Frames(all), searching)));
}

TEST(Parts, DisagreementsOfAllPartsAreCountedAndSoManyListed) {
  std::vector<Part> parts = {part(frames(), 0, 3), part(frames(), 3, 7)};
  for (Part& each : parts) {
    SequenceReport& report = each.parsed.report;
    report.second_opinion = SecondOpinionScope::kAll;
    report.pairs.asked_again = report.pairs.disagreed = 3;
    report.disagreements.assign(3, part(frames(), 3, 7).parsed.report.violations.at(0));
  }
  const SequenceReport merged = merge(parts).report;
  EXPECT_EQ(merged.verdict, Verdict::kUnknown);
  EXPECT_EQ(merged.pairs.disagreed, 6);
  EXPECT_EQ(std::ssize(merged.disagreements), merged.max_violations);
}

// Every frame of it was gone through and counted, and of the last one nothing but areas was owed.
TEST(Parts, WhatALaterPartDidNotCheckLeavesTheWholeUnknown) {
  std::vector<io::MeshData> all(4, sheet(4));
  for (io::MeshData& mesh : all) mesh.groups = {{"a", io::Group::Role::kCloth, 0, 2}};
  all.back().groups[0].face_end = static_cast<std::int32_t>(all.back().triangles.size());
  SequenceOptions exempting = options({{}, {{"a", "a"}}, {}});
  exempting.motions = false;
  const Part first = part(all, 0, 2, exempting), second = part(all, 2, 4, exempting);
  EXPECT_EQ(first.parsed.report.verdict, Verdict::kClean);
  EXPECT_EQ(second.parsed.report.verdict, Verdict::kUnknown);
  const ParsedReport merged = merge({first, second});
  EXPECT_EQ(merged.report.verdict, Verdict::kUnknown);
  EXPECT_EQ(json(merged.report), json(check_sequence(Frames(all), exempting)));
}

TEST(Parts, APartThatWasStoppedLeavesTheWholeUnknown) {
  std::vector<io::MeshData> all(6, sheet(4));
  SequenceOptions stopping;
  stopping.range = {2, 4};
  stopping.progress = [](std::size_t done, std::size_t) { return done < 2; };
  const auto whole_part = [&](std::size_t first, std::size_t end) {
    SequenceOptions wanted;
    wanted.range = {first, end};
    return Part{"p", {check_sequence(Frames(all), wanted), kContext}};
  };
  const SequenceReport stopped = check_sequence(Frames(all), stopping);
  EXPECT_EQ(stopped.verdict, Verdict::kUnknown);
  EXPECT_EQ(merge({whole_part(0, 2), whole_part(2, 4), whole_part(4, 6)}).report.verdict, Verdict::kClean);
  EXPECT_EQ(merge({whole_part(0, 2), {"s", {stopped, kContext}}, whole_part(4, 6)}).report.verdict, Verdict::kUnknown);
}

}  // namespace selvage::verify
