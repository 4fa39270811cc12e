#include "bench/layered_sheet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace selvage::bench {
namespace {

using verify::Point;

constexpr double kGapPerEdge = 0.135;
constexpr int kTurnCells = 6;        // along the half circle from one layer to the next
constexpr double kRoughness = 0.05;  // of the gap, up and down
constexpr double kWave = 0.05, kDrift = 0.002;
constexpr double kTau = 2 * std::numbers::pi;

/// In [-1, 1), from the number alone (the finisher of SplitMix64: Steele, Lea, Flood 2014).
double noise(std::uint64_t n) {
  n += 0x9e3779b97f4a7c15;
  n = (n ^ n >> 30) * 0xbf58476d1ce4e5b9;
  n = (n ^ n >> 27) * 0x94d049bb133111eb;
  return static_cast<double>((n ^ n >> 31) >> 11) * 0x1p-52 - 1;
}

/// The height that all layers share: waves, and bumps of many lengths on top.
double height(double x, double y) {
  double z = kWave * std::sin(3 * kTau * x + 0.3) * std::cos(2 * kTau * y);
  double amplitude = 0.1 * kWave;
  for (std::uint64_t octave = 1; octave <= 4; ++octave, amplitude *= 0.3) {
    const double frequency = kTau * static_cast<double>(2 << octave);
    const double turn = std::numbers::pi * noise(octave);
    z += amplitude * std::sin(frequency * (x * std::cos(turn) + y * std::sin(turn)) + static_cast<double>(octave));
  }
  return z;
}

Point drift(const Point& p) {
  return {kDrift * std::sin(kTau * (p[1] + 0.5 * p[2])), kDrift * std::sin(kTau * (p[2] + 0.7 * p[0])),
          kDrift * std::cos(kTau * (p[0] - 0.4 * p[1]))};
}

/// The rotation by the quaternion (1, 2, 3, 4) / sqrt(30); layers are stacked along its third column.
constexpr std::array<Point, 3> kRotation = {
    {{-20. / 30, 4. / 30, 22. / 30}, {20. / 30, -10. / 30, 20. / 30}, {10. / 30, 28. / 30, 4. / 30}}};

Point rotated(const Point& p) {
  Point q{};
  for (std::size_t k = 0; k < 3; ++k) q[k] = kRotation[k][0] * p[0] + kRotation[k][1] * p[1] + kRotation[k][2] * p[2];
  return q;
}

/// Where the sheet is, before it is crumpled, after `step` of its cells along the serpentine.
struct Station {
  double x, z;
  bool in_turn;
};
Station station(int step, int cells, double gap) {
  const int period = cells + kTurnCells;
  const int layer = step / period, within = step % period;
  const bool forth = layer % 2 == 0;
  if (within <= cells) {
    const double along = static_cast<double>(within) / cells;
    return {forth ? along : 1 - along, gap * layer, false};
  }
  const double angle = std::numbers::pi * (within - cells) / kTurnCells;
  const double beyond = 0.5 * gap * std::sin(angle);
  return {forth ? 1 + beyond : -beyond, gap * (layer + 0.5 * (1 - std::cos(angle))), true};
}

}  // namespace

LayeredSheet layered_sheet(int faces, int layers) {
  const double turns = kTurnCells * (layers - 1.0);
  const double side = (std::sqrt(turns * turns + 2.0 * layers * faces) - turns) / (2.0 * layers);
  const int cells = std::max(2, static_cast<int>(std::lround(side)));
  const int steps = cells * layers + kTurnCells * (layers - 1);
  LayeredSheet sheet;
  sheet.layers = layers;
  sheet.gap = kGapPerEdge / cells;
  const auto row = static_cast<std::size_t>(cells) + 1;
  sheet.V_t0.reserve(row * static_cast<std::size_t>(steps + 1));
  sheet.V_t1.reserve(sheet.V_t0.capacity());
  for (int i = 0; i <= steps; ++i) {
    const Station at = station(i, cells, sheet.gap);
    for (int j = 0; j <= cells; ++j) {
      const double y = static_cast<double>(j) / cells;
      const double rough = at.in_turn ? 0 : kRoughness * sheet.gap * noise(1000 + sheet.V_t0.size());
      const Point p = rotated({at.x, y, at.z + height(at.x, y) + rough}), moved = drift(p);
      sheet.V_t0.push_back(p);
      sheet.V_t1.push_back({p[0] + moved[0], p[1] + moved[1], p[2] + moved[2]});
    }
  }
  sheet.triangles.reserve(2 * static_cast<std::size_t>(steps) * static_cast<std::size_t>(cells));
  for (int i = 0; i < steps; ++i) {
    // Layers one above the other are cut into the same triangles, so that bumps cannot bring them together.
    const bool forth = i / (cells + kTurnCells) % 2 == 0;
    for (int j = 0; j < cells; ++j) {
      const int a = i * (cells + 1) + j, b = a + cells + 1;
      if (forth) {
        sheet.triangles.push_back({a, b, a + 1});
        sheet.triangles.push_back({b, b + 1, a + 1});
      } else {
        sheet.triangles.push_back({a, b, b + 1});
        sheet.triangles.push_back({a, b + 1, a + 1});
      }
    }
  }
  return sheet;
}

void poke(std::vector<Point>& V, int count, double distance) {
  const Point up = rotated({0, 0, 1});
  // The first half of the vertices lies below the last layer.
  const std::size_t stride = V.size() / 2 / static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    Point& p = V[i * stride + stride / 3];
    for (std::size_t k = 0; k < 3; ++k) p[k] += distance * up[k];
  }
}

}  // namespace selvage::bench
