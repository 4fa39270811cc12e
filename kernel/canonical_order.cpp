#include "kernel/canonical_order.h"

#include <utility>

namespace selvage::detail {

namespace {

bool precedes(const Double3& a, const Double3& b, bool if_equal) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  if (a.z != b.z) return a.z < b.z;
  return if_equal;
}

bool point_precedes(const CanonicalPair& pair, std::size_t i, std::size_t j) {
  return precedes(pair.x_t0[i], pair.x_t0[j], precedes(pair.x_t1[i], pair.x_t1[j], false));
}

void swap_points(CanonicalPair& pair, std::size_t i, std::size_t j) {
  std::swap(pair.x_t0[i], pair.x_t0[j]);
  std::swap(pair.x_t1[i], pair.x_t1[j]);
  std::swap(pair.original[i], pair.original[j]);
}

void order_points(CanonicalPair& pair, std::size_t i, std::size_t j) {
  if (point_precedes(pair, j, i)) swap_points(pair, i, j);
}

/// Whether edge (2, 3) comes before edge (0, 1), both ordered in themselves.
bool second_edge_precedes(const CanonicalPair& pair) {
  if (point_precedes(pair, 2, 0)) return true;
  if (point_precedes(pair, 0, 2)) return false;
  return point_precedes(pair, 3, 1);
}

}  // namespace

CanonicalPair canonical_order(PairKind kind, const std::array<Double3, 4>& x_t0, const std::array<Double3, 4>& x_t1) {
  CanonicalPair pair{x_t0, x_t1, {0, 1, 2, 3}};
  switch (kind) {
    case PairKind::kVf:
      order_points(pair, 1, 2);
      order_points(pair, 2, 3);
      order_points(pair, 1, 2);
      break;
    case PairKind::kEe:
      order_points(pair, 0, 1);
      order_points(pair, 2, 3);
      if (second_edge_precedes(pair)) {
        swap_points(pair, 0, 2);
        swap_points(pair, 1, 3);
        pair.features_swapped = true;
      }
      break;
    case PairKind::kSelf:
      order_points(pair, 1, 2);
      break;
  }
  return pair;
}

std::array<double, 4> restore_weights(const CanonicalPair& pair, const std::array<double, 4>& weights) {
  std::array<double, 4> result = {};
  for (std::size_t i = 0; i < 4; ++i) result[static_cast<std::size_t>(pair.original[i])] = weights[i];
  return result;
}

Double3 restore_normal(const CanonicalPair& pair, const Double3& normal) {
  return pair.features_swapped ? -normal : normal;
}

}  // namespace selvage::detail
