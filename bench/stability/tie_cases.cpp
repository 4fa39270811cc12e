#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

const Material kTiedCloth{1e-3, 100, 1, 0.2};

/// A sheet whose coordinates are multiples of 2^-6, so that they are the same bits at the far offset.
sim::Shape lattice_sheet(int cells) { return sim::make_sheet(cells + 1, cells + 1, cells * 0x1p-4, cells * 0x1p-4); }

/// The sheet falls onto another of the same lattice, which lies still, moved by `shift` against it.
void fall_onto_lattice(Trial& trial, const Vec3& shift) {
  StageSetup setup;
  const int cells = trial.pick(4, 8, 16);
  setup.dt_s = 0x1p-8;
  setup.gravity_m_s2 = Vec3(0, 0, -8);
  setup.add_body(lattice_sheet(2 * cells), Vec3::Zero());
  setup.add_cloth(lattice_sheet(cells), Vec3(0, 0, 0x1p-6) + shift, kTiedCloth, Vec3(0, 0, -4));
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(60, 6); ++step) stage.step();
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void grid_on_grid(Trial& trial) { fall_onto_lattice(trial, Vec3::Zero()); }
void vertices_on_edges(Trial& trial) { fall_onto_lattice(trial, Vec3(0x1p-5, 0, 0)); }
void vertices_on_diagonals(Trial& trial) { fall_onto_lattice(trial, Vec3(0x1p-5, 0x1p-5, 0)); }

void cube_on_grid(Trial& trial) {
  StageSetup setup;
  const int cells = trial.pick(2, 4, 8);
  setup.dt_s = 0x1p-8;
  const Part cube = setup.add_cloth(sim::make_box(Vec3::Constant(cells * 0x1p-4), cells),
                                    Vec3(0, 0, cells * 0x1p-5 + 0x1p-6), {1e-3, 400, 0, 0.2}, Vec3(0, 0, -8));
  const Part sheet = setup.add_cloth(lattice_sheet(2 * cells), Vec3::Zero(), kTiedCloth);
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(40, 4); ++step) stage.step();
  trial.at_least("cube above the sheet, m", stage.centre(cube).z() - stage.centre(sheet).z(), 0);
  stage.require_balances();
}

/// Candidates that touch exactly, in all of: face, edge and vertex.
void touch_at_end(Trial& trial) {
  for (const Vec3& shift : {Vec3(0x1p-7, 0x1p-6, 0), Vec3(0x1p-5, 0, 0), Vec3(0, 0, 0)}) {
    StageSetup setup;
    setup.collision.tolerance_m = 0;
    setup.collision.repulsion = false;
    const int cells = trial.pick(2, 4, 8);
    setup.add_cloth(lattice_sheet(2 * cells), Vec3::Zero());
    const Part upper = setup.add_cloth(lattice_sheet(cells), shift + Vec3(0, 0, 0x1p-4));
    Stage stage(trial, setup);
    Positions candidate = stage.x();
    candidate.middleRows(upper.begin, upper.size()).col(2).array() -= 0x1p-4;
    trial.require(stage.step_to(candidate).first_collisions > 0, "an exact touch was not found");
  }
}

/// Edge pairs whose coplanarity cubic is (t - 1/2)^2: they touch at half time and part again. Edge (a, b) stands still
/// on its triangle; c, d move on straight lines, and the height above the crossing is ((t - 1/2)^2) / (2 + t).
void touch_and_go(Trial& trial) {
  StageSetup setup;
  setup.collision.tolerance_m = 0;
  setup.collision.repulsion = false;
  const int count = trial.pick(1, 4, 16);
  std::vector<Part> upper;
  for (int i = 0; i < count; ++i) {
    const Vec3 place(4.0 * i, 0, 0);
    sim::Shape below, above;
    below.x.resize(3, 3);
    below.x << -1, 0, 0, 1, 0, 0, 0, 0, -1;
    above.x.resize(3, 3);
    above.x << 0, -1, 0.25, 0, 1, 0, 0, 0, 4;
    below.triangles = above.triangles = {{0, 1, 2}};
    setup.add_cloth(below, place);
    upper.push_back(setup.add_cloth(above, place));
  }
  Stage stage(trial, setup);
  Positions candidate = stage.x();
  for (const Part& part : upper) {
    candidate.row(part.begin) += Eigen::RowVector3d(0, -1, -2);
    candidate.row(part.begin + 1) += Eigen::RowVector3d(0, 0, 1);
  }
  trial.at_least("contacts found", double(stage.step_to(candidate).first_collisions), count);
}

void two_vertex_swap(Trial& trial) {
  // Neighbours of a lattice change places, everywhere at once.
  StageSetup setup;
  const int cells = trial.pick(3, 7, 15);
  setup.add_cloth(lattice_sheet(cells), Vec3::Zero());
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(4, 2); ++step) {
    Positions candidate = stage.x();
    for (Eigen::Index i = 0; i + 1 < candidate.rows(); i += 2) candidate.row(i).swap(candidate.row(i + 1));
    stage.step_to(candidate);
  }
  stage.require_balances();
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

}  // namespace

std::vector<StabilityCase> tie_cases() {
  return {
      {"grid-on-grid", "a sheet falls onto the same lattice: vertex over vertex, edge over edge", "contact found",
       grid_on_grid},
      {"vertices-on-edges", "every vertex falls onto an edge that two faces share", "contact found", vertices_on_edges},
      {"vertices-on-diagonals", "every vertex falls onto a diagonal or into the middle of a square", "contact found",
       vertices_on_diagonals},
      {"cube-on-grid", "an aligned cube falls onto an aligned sheet", "it stays above; momentum and energy kept",
       cube_on_grid},
      {"touch-at-end", "candidates touch exactly at t = 1: face, edge, vertex", "found, without a tolerance",
       touch_at_end},
      {"touch-and-go", "a double root: edges touch at t = 1/2 and part again", "found, without a tolerance",
       touch_and_go},
      {"two-vertex-swap", "neighbouring vertices are asked to change places", "momentum and energy kept",
       two_vertex_swap},
  };
}

}  // namespace selvage::bench
