// Lists of pairs that have nothing to do with each other, as the candidates of one mesh.
#pragma once

#include <array>
#include <vector>

#include "kernel/candidates.h"

namespace selvage::testing {

using FourPoints = std::array<Vec3, 4>;

/// Pair i has the vertices 4 i .. 4 i + 3 in query order. Pairs may also be given the first feature of the pair before.
class PairList {
 public:
  explicit PairList(PairKind kind) : kind_(kind) {}

  void add(const FourPoints& x_t0, const FourPoints& x_t1) {
    const auto first = static_cast<VertexId>(x_t0_.size());
    x_t0_.insert(x_t0_.end(), x_t0.begin(), x_t0.end());
    x_t1_.insert(x_t1_.end(), x_t1.begin(), x_t1.end());
    const auto pair = static_cast<std::int32_t>(size());
    if (kind_ == PairKind::kVf) {
      mesh_.faces.push_back({first + 1, first + 2, first + 3});
      vf_.push_back({first, pair});
    } else {
      mesh_.edges.push_back({first, first + 1});
      mesh_.edges.push_back({first + 2, first + 3});
      ee_.push_back({2 * pair, 2 * pair + 1});
    }
  }
  /// The last pair's first feature against a second one of its own.
  void share_first() {
    if (size() < 2) return;
    if (kind_ == PairKind::kVf) {
      vf_.back().vertex = vf_[vf_.size() - 2].vertex;
    } else {
      ee_.back().a = ee_[ee_.size() - 2].a;
    }
  }

  [[nodiscard]] PairKind kind() const { return kind_; }
  [[nodiscard]] std::size_t size() const { return kind_ == PairKind::kVf ? vf_.size() : ee_.size(); }
  [[nodiscard]] const std::vector<VfCandidate>& vf() const { return vf_; }
  [[nodiscard]] const std::vector<EeCandidate>& ee() const { return ee_; }
  [[nodiscard]] Mesh mesh() const {
    Mesh mesh = mesh_;
    mesh.vertex_count = static_cast<std::int32_t>(x_t0_.size());
    return mesh;
  }
  [[nodiscard]] Positions V_t0() const { return positions(x_t0_); }
  [[nodiscard]] Positions V_t1() const { return positions(x_t1_); }
  [[nodiscard]] FourPoints x_t0(std::size_t pair) const { return points(x_t0_, pair); }
  [[nodiscard]] FourPoints x_t1(std::size_t pair) const { return points(x_t1_, pair); }

 private:
  [[nodiscard]] FourPoints points(const std::vector<Vec3>& x, std::size_t pair) const {
    FourPoints result;
    for (std::size_t k = 0; k < 4; ++k) result[k] = x[4 * pair + k];
    if (kind_ == PairKind::kVf) {
      result[0] = x[static_cast<std::size_t>(vf_[pair].vertex)];
    } else {
      for (std::size_t k : {0U, 1U}) {
        result[k] = x[static_cast<std::size_t>(mesh_.edges[static_cast<std::size_t>(ee_[pair].a)][k])];
      }
    }
    return result;
  }
  static Positions positions(const std::vector<Vec3>& x) {
    Positions V(static_cast<Eigen::Index>(x.size()), 3);
    for (std::size_t v = 0; v < x.size(); ++v) V.row(static_cast<Eigen::Index>(v)) = x[v];
    return V;
  }

  PairKind kind_;
  Mesh mesh_;
  std::vector<Vec3> x_t0_, x_t1_;
  std::vector<VfCandidate> vf_;
  std::vector<EeCandidate> ee_;
};

}  // namespace selvage::testing
