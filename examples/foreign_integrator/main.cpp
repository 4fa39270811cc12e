// A cloth simulator that knows nothing of contact, made safe by one call. The integrator is position-based: it moves
// vertices where it likes, through the table and through itself. CollisionStep turns what it wants into what is safe.
//
//   foreign_integrator [STEPS [FOLDER]]     120 steps; into FOLDER goes every step, for `selvage verify FOLDER`
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <vector>

#include <selvage/io/sequence.h>
#include <selvage/kernel/kernel.h>
#include <selvage/sim/collision_step.h>

namespace {

constexpr int kSide = 25;  // vertices along a side of the cloth
constexpr int kClothVertices = kSide * kSide;
constexpr double kSpacing = 0.03;     // m
constexpr double kVertexMass = 2e-4;  // kg
constexpr double kStep = 1.0 / 120;   // s
constexpr int kSolverIterations = 20;

using selvage::Positions;

struct Edge {
  int a, b;
  double length;
};

// The foreign part: gravity and edge lengths, by projection. No contact anywhere.
void integrate(const std::vector<Edge>& edges, const Positions& x, const Positions& v, Positions& candidate) {
  candidate = x;
  candidate.topRows(kClothVertices) += kStep * v.topRows(kClothVertices);
  candidate.topRows(kClothVertices).col(2).array() -= kStep * kStep * 9.81;
  for (int iteration = 0; iteration < kSolverIterations; ++iteration) {
    for (const Edge& edge : edges) {
      const Eigen::RowVector3d d = candidate.row(edge.b) - candidate.row(edge.a);
      const Eigen::RowVector3d correction = 0.5 * (1 - edge.length / d.norm()) * d;
      candidate.row(edge.a) += correction;
      candidate.row(edge.b) -= correction;
    }
  }
}

// A square cloth above a small table (two triangles), one vertex and face list for both.
void build(Positions& x, std::vector<Edge>& edges, selvage::Faces& F) {
  x.resize(kClothVertices + 4, 3);
  std::vector<Eigen::RowVector3i> faces;
  const auto add_edge = [&](int a, int b) { edges.push_back({a, b, (x.row(b) - x.row(a)).norm()}); };
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const int n = j * kSide + i;
      x.row(n) << kSpacing * (i - kSide / 2), kSpacing * (j - kSide / 2), 0.1 + 0.002 * std::sin(0.7 * i + 0.3 * j);
    }
  }
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const int n = j * kSide + i;
      if (i + 1 < kSide) add_edge(n, n + 1);
      if (j + 1 < kSide) add_edge(n, n + kSide);
      if (i + 1 == kSide || j + 1 == kSide) continue;
      add_edge(n, n + kSide + 1);
      faces.push_back({n, n + 1, n + kSide + 1});
      faces.push_back({n, n + kSide + 1, n + kSide});
    }
  }
  const int t = kClothVertices;
  const double half = 0.15;
  x.bottomRows(4) << -half, -half, 0, half, -half, 0, half, half, 0, -half, half, 0;
  faces.push_back({t, t + 1, t + 2});
  faces.push_back({t, t + 2, t + 3});
  F.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t f = 0; f < faces.size(); ++f) F.row(static_cast<Eigen::Index>(f)) = faces[f];
}

// Every position that was certified, bit for bit.
class StepRecorder {
 public:
  StepRecorder(const char* folder, const selvage::Faces& F) : writer_(folder, header_of(F)) {}
  void append(int step, const Positions& x) {
    selvage::io::Points points;
    for (Eigen::Index i = 0; i < x.rows(); ++i) points.push_back({x(i, 0), x(i, 1), x(i, 2)});
    writer_.append(step * kStep, points);
  }

 private:
  static selvage::io::SequenceHeader header_of(const selvage::Faces& F) {
    selvage::io::SequenceHeader header;
    for (Eigen::Index f = 0; f < F.rows(); ++f) header.triangles.push_back({F(f, 0), F(f, 1), F(f, 2)});
    const int end = static_cast<int>(F.rows()), table = end - 2;
    header.groups = {{"cloth", selvage::io::Group::Role::kCloth, 0, table},
                     {"table", selvage::io::Group::Role::kBody, table, end}};
    header.kind = selvage::io::SequenceKind::kSteps;
    header.producer = "foreign_integrator";
    return header;
  }
  selvage::io::SequenceWriter writer_;
};

}  // namespace

int main(int argc, char** argv) {
  const int steps = argc > 1 ? std::atoi(argv[1]) : 120;
  Positions x, candidate;
  std::vector<Edge> edges;
  selvage::Faces F;
  build(x, edges, F);
  const selvage::Mesh mesh = selvage::make_mesh(static_cast<int>(x.rows()), F);

  selvage::sim::CollisionOptions options;
  options.friction_static = options.friction_kinetic = 0.4;
  selvage::sim::CollisionStep collide(mesh, options);
  std::vector<double> inverse_mass(kClothVertices, 1 / kVertexMass);
  inverse_mass.resize(static_cast<std::size_t>(x.rows()), 0);  // the table does not move
  std::vector<int> body(kClothVertices, -1);
  body.resize(static_cast<std::size_t>(x.rows()), 0);

  std::optional<StepRecorder> recorder;
  if (argc > 2) {
    recorder.emplace(argv[2], F);
    recorder->append(0, x);
  }

  Positions v = Positions::Zero(x.rows(), 3);
  long collisions = 0;
  for (int step = 0; step < steps; ++step) {
    integrate(edges, x, v, candidate);
    const auto safe = collide(x, candidate, {inverse_mass, body}, kStep);
    if (safe.report.status != selvage::sim::StepStatus::kSafe) {
      const auto status = selvage::sim::name_of(safe.report.status);
      std::fprintf(stderr, "step %d: %.*s: %s\n", step, static_cast<int>(status.size()), status.data(),
                   selvage::describe(safe.report.input_error));
      return 1;
    }
    v = safe.velocity;
    x = safe.x;
    if (recorder) recorder->append(step + 1, x);
    collisions += safe.report.first_collisions;
  }
  const double lowest = x.topRows(kClothVertices).col(2).minCoeff();
  const double middle = x(kClothVertices / 2, 2);
  std::printf("after %d steps: middle of the cloth at %.4f m, lowest corner at %.3f m, %ld collisions resolved\n",
              steps, middle, lowest, collisions);
  // On the table, not through it; over its edges, not stuck on it.
  return middle > 0 && middle < 0.01 && lowest < -0.05 ? 0 : 1;
}
