// Vertices that follow a script instead of the dynamics (kinematic bodies): rigid bodies, figures that a sequence
// animates, and pins of cloth, which may hang on a body.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "sim/bodies/attachment.h"
#include "sim/bodies/body_sequence.h"
#include "sim/bodies/linkage.h"
#include "sim/bodies/passage.h"

namespace selvage::sim {

class Collider {
 public:
  /// x_world = linkage.at(t)(local), as many rows as vertices.
  struct Rigid {
    Positions local;
    Linkage linkage;
  };
  struct Animated {
    std::shared_ptr<const BodySequence> local;
    Linkage linkage;
  };
  /// By a body, to whose rows it is attached.
  struct Carried {
    Attachment attachment;
    std::size_t body;     ///< its place among the colliders
    VertexId body_begin;  ///< its first vertex
  };
  using Motion = std::variant<Rigid, Animated, Carried>;

  static constexpr double kNeverReleased_s = std::numeric_limits<double>::infinity();

  /// Vertex vertices[i] is at row i of the motion, until release_s. `met`: the rows that cloth can meet; all, if none
  /// are given.
  Collider(std::string name, std::vector<VertexId> vertices, Motion motion, double release_s = kNeverReleased_s,
           std::optional<std::vector<Eigen::Index>> met = {});

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::vector<VertexId>& vertices() const { return vertices_; }
  [[nodiscard]] bool holds(double time_s) const { return time_s < release_s_; }
  /// Null where none animates it.
  [[nodiscard]] const BodySequence* sequence() const;
  /// The body that carries it.
  [[nodiscard]] std::optional<std::size_t> carrier() const;
  /// Whether its vertices may move against each other: then each waits, and catches up, by itself.
  [[nodiscard]] bool deforms() const { return !std::holds_alternative<Rigid>(motion_); }
  /// Its vertices, in their order, at the time: the script exactly, rounded to the precision of the state. x: all
  /// vertices, of which what is carried looks where its body is. Throws io::Error where a frame of the sequence cannot
  /// be read any more.
  [[nodiscard]] Positions placed_at(double time_s, Precision precision, const Positions& x) const;
  /// How the vertices that cloth can meet leave straight lines between two times.
  struct Bend {
    double leaves_line_by_m = 0;  ///< how far they leave the straight lines from where they are first to where at last
    double off_by_m = 0;          ///< and are from where the dynamics of a step between has them (Passage)
    Eigen::AlignedBox3d within;   ///< where they are meanwhile; not of one that goes straight
  };
  /// At its keys, at the frames of its sequence and at quarters of the time between. Lines are left without bound where
  /// it turns by more than 90 degrees, of which the ends say little. Reads every frame between once, those about the
  /// middle twice: the steps of a run read what lies within them, and what lies within steps that they then halve or
  /// double, some four times in all, where the start has read all frames already. REQUIRES that nothing carries it.
  [[nodiscard]] Bend bend(double t0_s, double t1_s) const { return bends(t0_s, t1_s, {}).front(); }
  /// Its own, then those of what it carries, where its script has it; it is placed as often as for its own alone.
  [[nodiscard]] std::vector<Bend> bends(double t0_s, double t1_s, std::span<const Collider* const> carried) const;
  /// Of all its vertices in a step between (Passage). REQUIRES that nothing carries it.
  [[nodiscard]] Positions bow_m(double t0_s, double t1_s) const;
  /// Writes them to their rows.
  void place_at(double time_s, Precision precision, Positions& x) const;

 private:
  /// Null where nothing carries it.
  [[nodiscard]] const Carried* carried() const { return std::get_if<Carried>(&motion_); }
  /// REQUIRES that nothing carries it.
  [[nodiscard]] const Linkage& linkage() const;
  /// Where something may change: keys, frames, a quarter and three quarters; in their order.
  [[nodiscard]] std::vector<double> times_between(double t0_s, double t1_s) const;
  void add_turns(double t0_s, double t1_s, std::vector<double>& times) const;

  std::string name_;
  std::vector<VertexId> vertices_;
  Motion motion_;
  double release_s_;
  std::optional<std::vector<Eigen::Index>> met_;
};

}  // namespace selvage::sim
