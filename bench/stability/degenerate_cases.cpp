#include <algorithm>
#include <utility>

#include "bench/stability/cases.h"
#include "bench/stability/exact_watch.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/stage.h"
#include "sim/base/points.h"

namespace selvage::bench {
namespace {

/// Three sheets above each other, 1 cm apart.
StageSetup three_sheets(Trial& trial) {
  StageSetup setup;
  const int side = trial.pick(3, 4, 6);
  for (int layer = 0; layer < 3; ++layer) {
    setup.add_cloth(sim::make_sheet(side, side, 1, 1), Vec3(0.013 * layer, 0.007 * layer, 0.01 * layer));
  }
  return setup;
}

/// Candidates that flatten everything, step after step: `flatten` maps a position to where it should go.
template <class Flatten>
void collapse(Trial& trial, Flatten flatten) {
  Stage stage(trial, three_sheets(trial));
  for (int step = 0; step < trial.steps(4, 2); ++step) {
    Positions candidate = stage.x();
    for (Eigen::Index i = 0; i < candidate.rows(); ++i) {
      candidate.row(i) = (flatten(Vec3(candidate.row(i).transpose() - stage.offset())) + stage.offset()).transpose();
    }
    stage.step_to(candidate);
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void collapse_to_point(Trial& trial) {
  collapse(trial, [](const Vec3&) { return Vec3(0.25, 0.25, 0.25); });
}
void collapse_to_line(Trial& trial) {
  collapse(trial, [](const Vec3& x) { return Vec3(x.x(), 0.5 * x.x(), 0.25 * x.x()); });
}
void collapse_to_plane(Trial& trial) {
  collapse(trial, [](const Vec3& x) { return Vec3(x.x(), x.y(), 0); });
}

void inside_out(Trial& trial) {
  StageSetup setup;
  setup.add_cloth(sim::make_box(Vec3(1, 1.1, 1.2), trial.pick(1, 2, 3)), Vec3::Zero());
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(4, 2); ++step) {
    const Vec3 centre = stage.x().colwise().mean();
    stage.step_to((-stage.x()).rowwise() + 2 * centre.transpose());
  }
  // Of a fine box, all of whose pairs meet in the centre, the motion is cut back before its collisions are looked for.
  trial.at_least("steps with collisions, and vertices cut back",
                 double(trial.report().steps_with_collisions + trial.report().cut_candidates), 1);
}

/// A step of a surface that is not free at the start: refused by the exact check; the collision step, which cannot
/// know, must still end with finite positions, and keep the faces that are sound free of each other.
void step_beside_unsound(Trial& trial, const StageSetup& setup, const std::vector<std::uint8_t>& unsound) {
  const Vec3 offset = trial.offset(1);
  const Positions x = setup.x.rowwise() + offset.transpose();
  const auto vertex_count = static_cast<std::size_t>(x.rows());
  const verify::Topology all = verify::make_topology({setup.triangles}, vertex_count);
  const verify::Topology sound = verify::make_topology({setup.triangles, {}, unsound}, vertex_count);
  trial.at_least("violations named at the start",
                 double(verify::check_frame(all, sim::points_of(x), {}).violations.size()), 1);

  const Mesh mesh = make_mesh(static_cast<std::int32_t>(x.rows()), setup.triangles);
  sim::CollisionStep step(mesh, setup.collision);
  const Positions candidate = x + setup.dt_s * setup.v;
  const sim::CollisionStepResult result =
      step(x, candidate, {setup.inverse_mass, setup.body, setup.policy}, setup.dt_s);
  trial.require(result.report.status == sim::StepStatus::kSafe && result.x.allFinite(), "it did not end in a state");
  trial.require(result.report.first_collisions > 0, "no contact was found");
  const verify::CheckResult motion = verify::check_motion(sound, sim::points_of(x), sim::points_of(result.x), {});
  trial.require(motion.violations_total.total() == 0, "sound faces touched");
  trial.report().vertices = x.rows();
  trial.report().faces = std::ssize(setup.triangles);
  ++trial.report().steps;
}

void zero_area(Trial& trial) {
  // A corner of the lower sheet gets a face with two corners at one place, and one with all three.
  StageSetup setup;
  const int side = trial.pick(4, 8, 16);
  sim::Shape sheet = sim::make_sheet(side, side, 1, 1);
  const Eigen::Index n = sheet.x.rows();
  std::vector<std::uint8_t> unsound(sheet.triangles.size(), 0);
  sheet.x.conservativeResize(n + 3, 3);
  for (Eigen::Index extra = 0; extra < 3; ++extra) sheet.x.row(n + extra) = sheet.x.row(0);
  const auto first = static_cast<std::int32_t>(n);
  sheet.triangles.push_back({0, first, 1});
  sheet.triangles.push_back({0, first + 1, first + 2});
  unsound.resize(sheet.triangles.size(), 1);
  setup.add_cloth(sheet, Vec3::Zero());
  setup.add_cloth(sim::make_sheet(side, side, 1, 1), Vec3(0.013, 0.007, 0.01), {}, Vec3(0, 0, -3));
  unsound.resize(setup.triangles.size(), 0);
  step_beside_unsound(trial, setup, unsound);
}

void duplicate_vertices(Trial& trial) {
  // Two halves of a sheet that meet at a seam, each with vertices of its own there, at the same bits.
  StageSetup setup;
  const int side = trial.pick(4, 8, 16);
  const sim::Shape half = sim::make_sheet(side, side, 1, 1);
  setup.add_cloth(half, Vec3(-0.5, 0, 0));
  setup.add_cloth(half, Vec3(0.5, 0, 0));
  std::vector<std::uint8_t> unsound;
  for (const auto& t : setup.triangles) {
    const bool at_seam = std::ranges::any_of(t, [&](VertexId v) { return setup.x(v, 0) == 0; });
    unsound.push_back(at_seam ? 1 : 0);
  }
  setup.add_cloth(sim::make_sheet(side, side, 2, 1), Vec3(0.013, 0.007, 0.01), {}, Vec3(0, 0, -3));
  unsound.resize(setup.triangles.size(), 0);
  step_beside_unsound(trial, setup, unsound);
}

void orientation(Trial& trial) {
  // One collision, with all faces as they are, all turned over, and every other one turned over.
  std::vector<Positions> ends;
  for (const int stride : {0, 1, 2}) {
    StageSetup setup = three_sheets(trial);
    setup.add_cloth(sim::make_sphere(0.2, trial.pick(0, 1, 2)), Vec3(0.05, 0.03, 0.3), {}, Vec3(0, 0, -20));
    for (std::size_t f = 0; stride > 0 && f < setup.triangles.size(); f += static_cast<std::size_t>(stride)) {
      std::swap(setup.triangles[f][1], setup.triangles[f][2]);
    }
    Stage stage(trial, setup);
    for (int step = 0; step < trial.steps(6, 2); ++step) stage.step();
    ends.push_back(stage.x());
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 3);
  const double difference =
      std::max((ends[1] - ends[0]).cwiseAbs().maxCoeff(), (ends[2] - ends[0]).cwiseAbs().maxCoeff());
  trial.at_most("difference, m", difference, trial.variant().far ? 1e-6 : 1e-9);
}

/// `pages` sheets that share one edge line, like a book, spread over half a turn.
sim::Shape make_book(int pages, int cells) {
  sim::Shape book;
  book.x.resize(Eigen::Index{cells + 1} * (1 + pages * cells), 3);
  const auto vertex = [&](int page, int column, int row) {
    return column == 0 ? row : (cells + 1) * (1 + page * cells + column - 1) + row;
  };
  for (int page = 0; page < pages; ++page) {
    const Eigen::Matrix3d turn = sim::rotation_matrix(Vec3(0, 180.0 * page / pages, 0));
    for (int column = 0; column <= cells; ++column) {
      for (int row = 0; row <= cells; ++row) {
        const Vec3 flat(double(column) / cells, double(row) / cells, 0);
        book.x.row(vertex(page, column, row)) = (turn * flat).transpose();
        if (column == cells || row == cells) continue;
        const std::int32_t a = vertex(page, column, row), b = vertex(page, column + 1, row);
        const std::int32_t c = vertex(page, column + 1, row + 1), d = vertex(page, column, row + 1);
        book.triangles.push_back({a, b, c});
        book.triangles.push_back({a, c, d});
      }
    }
  }
  return book;
}

void book(Trial& trial) {
  StageSetup setup;
  setup.add_cloth(make_book(trial.pick(3, 5, 8), trial.pick(1, 3, 5)), Vec3::Zero());
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(8, 2); ++step) {
    Positions candidate = stage.x();
    candidate.col(2).setConstant(stage.offset().z());  // shut: all pages in one plane
    stage.step_to(candidate);
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void bow_ties(Trial& trial) {
  // Triangles that share one vertex and nothing else, thrown at it.
  StageSetup setup;
  const int count = trial.pick(4, 16, 48);
  sim::Shape fan;
  fan.x.resize(Eigen::Index{2} * count + 1, 3);
  fan.x.bottomRows(1).setZero();
  for (int i = 0; i < count; ++i) {
    const Eigen::Matrix3d turn = sim::rotation_matrix(Vec3(0, 0, 360.0 * i / count)) *
                                 sim::rotation_matrix(Vec3(0, 40.0 - 80.0 * (i % 3) / 2, 0));
    const Eigen::Index row = Eigen::Index{2} * i;
    fan.x.row(row) = (turn * Vec3(1, 0, 0)).transpose();
    fan.x.row(row + 1) = (turn * Vec3(1, 2.0 / count, 0.1)).transpose();
    fan.triangles.push_back({2 * i, 2 * i + 1, 2 * count});
  }
  setup.add_cloth(fan, Vec3::Zero());
  setup.v = -80 * setup.x;
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(8, 3); ++step) stage.step();
  stage.require_balances();
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void almost_nothing(Trial& trial) {
  // No face at all, and one: what does not hold a face passes through everything, and one triangle is free to go.
  for (const bool with_face : {false, true}) {
    StageSetup setup;
    sim::Shape shape;
    shape.x = sim::make_sheet(3, trial.pick(3, 10, 100), 1, 1).x;
    if (with_face) shape.triangles = {{0, 2, 4}};
    setup.add_cloth(shape, Vec3::Zero(), {}, Vec3(0, 0, 1));
    Stage stage(trial, setup);
    for (int step = 0; step < 3; ++step) {
      Positions candidate = stage.candidate();
      candidate.row(1) = candidate.row(0);  // vertex 1 is in no face
      stage.step_to(candidate);
      trial.require(stage.x() == candidate, "the candidates were changed");
    }
  }
}

void many_pieces(Trial& trial) {
  // Separate triangles that all fly to one point.
  StageSetup setup;
  const int side = trial.pick(3, 5, 7);
  sim::Shape piece;
  piece.x.resize(3, 3);
  piece.x << 0, 0, 0, 0.5, 0.1, 0.2, 0.1, 0.5, 0.3;
  piece.triangles = {{0, 1, 2}};
  for (int cell = 0; cell < side * side * side; ++cell) {
    const int row = cell / side % side, layer = cell / (side * side);
    const Vec3 place(cell % side, row, layer);
    setup.add_cloth(piece, place, {}, 20 * (Vec3::Constant(0.5 * side) - place));
  }
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(8, 5); ++step) stage.step();
  stage.require_balances();
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

}  // namespace

std::vector<StabilityCase> degenerate_cases() {
  return {
      {"collapse-to-point", "all candidates are one point", "no face loses its area", collapse_to_point},
      {"collapse-to-line", "all candidates lie on a line", "no face loses its area", collapse_to_line},
      {"collapse-to-plane", "three layers are asked into one plane", "layers stay apart", collapse_to_plane},
      {"inside-out", "a closed surface is asked to pass through its centre", "it does not", inside_out},
      {"zero-area", "faces with two and with three corners at one place", "refused at the start; sound faces stay free",
       zero_area},
      {"duplicate-vertices", "a seam whose vertices lie at the same bits",
       "refused at the start; sound faces stay free", duplicate_vertices},
      {"orientation", "faces turned over, all and every other one", "the same result", orientation},
      {"book", "many pages share an edge, and are asked to shut into one plane", "pages stay apart", book},
      {"bow-ties", "faces that share one vertex and nothing else fly at it", "momentum and energy kept", bow_ties},
      {"almost-nothing", "no face, one face, loose vertices", "no candidate is changed by a bit", almost_nothing},
      {"many-pieces", "up to 343 separate triangles fly to one point", "momentum and energy kept", many_pieces},
  };
}

}  // namespace selvage::bench
