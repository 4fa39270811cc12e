#include "tests/kernel/random_motion.h"

#include <cmath>
#include <limits>

#include <rapidcheck.h>

namespace selvage::testing {

namespace {

using Triples = std::vector<std::array<VertexId, 3>>;

/// Any triples of distinct vertices: edges of many faces, duplicates, opposite orientations, loose vertices.
Triples soup(VertexId vertex_count) {
  const auto triple = rc::gen::container<std::array<VertexId, 3>>(rc::gen::inRange<VertexId>(0, vertex_count));
  return *rc::gen::container<Triples>(
      rc::gen::suchThat(triple, [](const auto& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }));
}

/// Appends a grid of 2 * columns * rows faces over new vertices.
void add_grid(int columns, int rows, VertexId& vertex_count, Triples& faces) {
  const VertexId stride = columns + 1;
  for (VertexId j = 0; j < rows; ++j) {
    for (VertexId i = 0; i < columns; ++i) {
      const VertexId a = vertex_count + j * stride + i;
      faces.push_back({a, a + 1, a + stride});
      faces.push_back({a + stride + 1, a + stride, a + 1});
    }
  }
  vertex_count += stride * (rows + 1);
}

double nudge(double x, int ulps) {
  if (ulps == 0) return x;
  return std::nextafter(x, ulps * std::numeric_limits<double>::infinity());
}

/// Lattice points (integer + offset) * scale with few distinct values along every axis.
Positions lattice_points(VertexId vertex_count, int extent, double offset, double scale, bool nudged) {
  const auto count = static_cast<std::size_t>(3 * vertex_count);
  const auto integers = *rc::gen::container<std::vector<int>>(count, rc::gen::inRange(0, extent + 1));
  const auto nudges =
      nudged ? *rc::gen::container<std::vector<int>>(count, rc::gen::inRange(-1, 2)) : std::vector<int>(count, 0);
  Positions V(vertex_count, 3);
  for (std::size_t i = 0; i < count; ++i) {
    V(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) =
        nudge((integers[i] + offset) * scale, nudges[i]);
  }
  return V;
}

}  // namespace

RandomShape random_shape() {
  RandomShape shape;
  Triples faces;
  if (*rc::gen::inRange(0, 3) == 0) {
    shape.vertex_count = *rc::gen::inRange<VertexId>(3, 24);
    faces = soup(shape.vertex_count);
  } else {
    const int component_count = *rc::gen::inRange(1, 4);
    for (int c = 0; c < component_count; ++c) {
      add_grid(*rc::gen::inRange(1, 12), *rc::gen::inRange(1, 12), shape.vertex_count, faces);
    }
    shape.vertex_count += *rc::gen::inRange(0, 2);  // a loose vertex
  }
  shape.F.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (Eigen::Index f = 0; f < shape.F.rows(); ++f) {
    for (Eigen::Index k = 0; k < 3; ++k)
      shape.F(f, k) = faces[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)];
  }
  return shape;
}

RandomMotion random_motion(VertexId vertex_count) {
  const double scale = *rc::gen::element(1.0, 0x1p-1074, 0x1p-1060, 0.1, 0x1p+980);
  const double offset = *rc::gen::element(0.0, -5.0, 0x1p+15);
  const int extent = *rc::gen::element(6, 1, 30, 1000);
  const bool nudged = *rc::gen::arbitrary<bool>();
  RandomMotion motion;
  motion.V_t0 = lattice_points(vertex_count, extent, offset, scale, nudged);
  motion.V_t1 = *rc::gen::arbitrary<bool>() ? motion.V_t0 : lattice_points(vertex_count, extent, offset, scale, nudged);
  if (*rc::gen::arbitrary<bool>()) {  // a short motion: the boxes are nearly those of an instant
    motion.V_t1 = motion.V_t0;
    if (vertex_count > 0) motion.V_t1.row(*rc::gen::inRange<VertexId>(0, vertex_count)) *= 0.5;
  }
  motion.reach = *rc::gen::element(0.0, 1.0, 0.5, 3.0, 0x1p-52) * scale;
  if (*rc::gen::inRange(0, 4) == 0) motion.reach = *rc::gen::element(0x1p-1074, 0x3p-1074, 0x1p+1000);
  motion.boxes = *rc::gen::element(MotionBoxes::kSwept, MotionBoxes::kMoving);
  if (*rc::gen::inRange(0, 4) == 0) {  // far, and together: moving boxes tell apart what swept ones do not
    motion.V_t1.rowwise() += Eigen::RowVector3d(1, -1, 1) * (2.0 * extent * scale);
  }
  const auto flags = static_cast<std::size_t>(vertex_count);
  switch (*rc::gen::inRange(0, 4)) {
    case 0:
      break;
    case 1:
      motion.active = *rc::gen::container<std::vector<std::uint8_t>>(flags, rc::gen::inRange<std::uint8_t>(0, 2));
      break;
    case 2:
      motion.active.assign(flags, 0);
      break;
    default:
      motion.active.assign(flags, 0);
      if (flags > 0) motion.active[*rc::gen::inRange<std::size_t>(0, flags)] = 1;
  }
  return motion;
}

std::ostream& operator<<(std::ostream& out, const RandomShape& shape) {
  return out << shape.vertex_count << " vertices, faces\n" << shape.F;
}

std::ostream& operator<<(std::ostream& out, const RandomMotion& motion) {
  out << (motion.boxes == MotionBoxes::kMoving ? "moving" : "swept") << " boxes, reach " << std::hexfloat
      << motion.reach << ", V_t0\n";
  for (const Positions* V : {&motion.V_t0, &motion.V_t1}) {
    for (Eigen::Index v = 0; v < V->rows(); ++v) out << (*V)(v, 0) << ' ' << (*V)(v, 1) << ' ' << (*V)(v, 2) << '\n';
    if (V == &motion.V_t0) out << "V_t1\n";
  }
  out << (motion.active.empty() ? "all active" : "active");
  for (const std::uint8_t flag : motion.active) out << ' ' << static_cast<int>(flag);
  return out << std::defaultfloat;
}

}  // namespace selvage::testing
