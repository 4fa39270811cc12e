#include "sim/repair/body_return.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace selvage::sim {
namespace {

// A body that comes back goes at most this many gaps a step: a ball through which a cloth passed by its middle comes
// back in 3.2 s so, and in 10.4 s with steps four times as long, which the rigid zones have to resolve (measured).
constexpr double kStepGaps = 4;
constexpr int kMaxReturnSteps = 256;  // so that bodies much larger than the gap come back too
constexpr double kClearGaps = 4;      // between bodies that stand aside and the cloth

class BodyReturn {
 public:
  explicit BodyReturn(UntangleState& state) : state_(state), step_(state.make_step()) {
    for (VertexId v = 0; v < state.mesh.vertex_count; ++v) {
      if (state.mesh.vertex_owner[static_cast<std::size_t>(v)] < 0) continue;
      (state.is_body(v) ? body_box_ : cloth_box_).extend(Vec3(state.x.row(v)));
    }
  }

  bool run() {
    if (is_free(state_.x)) return true;
    if (body_box_.isEmpty()) return false;
    return come_out_again() || come_from_aside();
  }

 private:
  [[nodiscard]] bool is_free(const Positions& at) { return state_.only(state_.judge(at), true).empty(); }
  [[nodiscard]] Positions normals(double side) const;
  [[nodiscard]] Positions moved_bodies(const Positions& displacement) const;
  /// The cloth after the bodies have come back from where they are in `away`; none where it could not give way.
  [[nodiscard]] std::optional<Positions> come_back(const Positions& away);
  bool come_out_again();
  bool come_from_aside();
  [[nodiscard]] double largest_move(const Positions& x) const { return (x - state_.V).rowwise().norm().maxCoeff(); }
  void keep_nearer(std::optional<Positions> x, std::optional<Positions>& best) const {
    if (x && (!best || largest_move(*x) < largest_move(*best))) best = std::move(x);
  }

  UntangleState& state_;
  CollisionStep step_;
  Eigen::AlignedBox3d body_box_, cloth_box_;
};

/// #V by 3: of the bodies' vertices, to the side on which cloth belongs. Of a part that is closed, as an even number of
/// its faces hold each edge, and whose faces enclose a volume as they are wound, that is outwards. Of others, which are
/// open, or wound inwards by mistake or for what is within, it is `side` of all their faces.
Positions BodyReturn::normals(double side) const {
  constexpr double kEnclosed = 1e-6;  // of what its faces add and take away; chosen: rounding leaves 1e-16 for each
  struct Part {
    double volume = 0, magnitude = 0;  // six times
    bool is_open = false;
  };
  const Mesh& mesh = state_.mesh;
  std::vector<Part> parts(static_cast<std::size_t>(mesh.vertex_count));
  const auto part_of = [&](VertexId v) -> Part& { return parts[static_cast<std::size_t>(state_.parts.part(v))]; };
  Positions sum = Positions::Zero(state_.x.rows(), 3);
  std::vector<std::uint8_t> is_odd(mesh.edges.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!state_.is_body_face(static_cast<FaceId>(f))) continue;
    const auto& v = mesh.faces[f];
    const Vec3 a = state_.x.row(v[0]), b = state_.x.row(v[1]), c = state_.x.row(v[2]);
    const Vec3 normal = (b - a).cross(c - a), first = state_.x.row(state_.parts.part(v[0]));
    part_of(v[0]).volume += normal.dot(a - first);
    part_of(v[0]).magnitude += std::abs(normal.dot(a - first));
    for (const VertexId corner : v) sum.row(corner) += normal.transpose();
    for (const EdgeId e : mesh.face_edges[f]) is_odd[static_cast<std::size_t>(e)] ^= 1;
  }
  for (std::size_t e = 0; e < is_odd.size(); ++e) {
    if (is_odd[e] != 0) part_of(mesh.edges[e][0]).is_open = true;
  }
  for (VertexId v = 0; v < mesh.vertex_count; ++v) {
    const Part& part = part_of(v);
    const bool is_outwards = !part.is_open && part.volume > kEnclosed * part.magnitude;
    sum.row(v) = ((is_outwards ? 1 : side) * sum.row(v).stableNormalized()).eval();
  }
  return sum;
}

Positions BodyReturn::moved_bodies(const Positions& displacement) const {
  Positions x = state_.x;
  for (VertexId v = 0; v < state_.mesh.vertex_count; ++v) {
    if (state_.is_body(v)) x.row(v) = state_.on_lattice(x.row(v) + displacement.row(v));
  }
  return x;
}

std::optional<Positions> BodyReturn::come_back(const Positions& away) {
  Positions x = away;
  const double steps = std::ceil((away - state_.x).rowwise().norm().maxCoeff() / (kStepGaps * state_.options.gap_m));
  const int step_count = static_cast<int>(std::clamp<double>(steps, 1, kMaxReturnSteps));
  for (int n = 1; n <= step_count; ++n) {
    const double left = 1 - double(n) / step_count;
    Positions candidate = x;
    for (VertexId v = 0; v < state_.mesh.vertex_count; ++v) {
      if (!state_.is_scripted(v)) continue;
      const Vec3 end = state_.V.row(v), start = away.row(v);
      candidate.row(v) = state_.on_lattice(end + left * (start - end));
    }
    const CollisionStepResult result = step_(x, candidate, state_.bodies, kRepairStep_s);
    if (result.report.status != StepStatus::kSafe) return std::nullopt;
    x = result.x;
  }
  return x;
}

bool BodyReturn::come_out_again() {
  const std::array<Positions, 2> outwards{normals(1), normals(-1)};
  const std::size_t sides = outwards[0] == outwards[1] ? 1 : 2;
  const double deepest = body_box_.diagonal().stableNorm() / 2;
  std::optional<Positions> best;
  for (double depth = state_.options.gap_m; !best && depth <= deepest && state_.may_judge(); depth *= 2) {
    for (std::size_t side = 0; side < sides; ++side) {
      const Positions away = moved_bodies(-depth * outwards[side]);
      if (is_free(away)) keep_nearer(come_back(away), best);
    }
  }
  if (best) state_.x = *best;
  return best.has_value();
}

bool BodyReturn::come_from_aside() {
  std::optional<Positions> best;
  for (int direction = 0; direction < 6 && state_.may_judge(); ++direction) {
    const int axis = direction / 2;
    const double gap = kClearGaps * state_.options.gap_m;
    const double shift = direction % 2 == 0 ? cloth_box_.max()[axis] - body_box_.min()[axis] + gap
                                            : cloth_box_.min()[axis] - body_box_.max()[axis] - gap;
    Positions displacement = Positions::Zero(state_.x.rows(), 3);
    displacement.col(axis).setConstant(shift);
    const Positions away = moved_bodies(displacement);
    if (!is_free(away)) continue;  // the box of the cloth was passed by less than the lattice holds apart
    keep_nearer(come_back(away), best);
  }
  if (best) state_.x = *best;
  return best.has_value();
}

}  // namespace

bool return_bodies(UntangleState& state) { return BodyReturn(state).run(); }

}  // namespace selvage::sim
