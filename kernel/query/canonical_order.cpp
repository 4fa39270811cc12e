#include "kernel/query/canonical_order.h"

#include <utility>

namespace selvage::detail {

namespace {

/// -1, 0 or 1; -0 before +0, so that only equal bits compare equal.
int compare(double a, double b) {
  if (a != b) return a < b ? -1 : 1;
  return static_cast<int>(std::signbit(b)) - static_cast<int>(std::signbit(a));
}

int compare(const Vec3& a, const Vec3& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (const int order = compare(a[axis], b[axis]); order != 0) return order;
  }
  return 0;
}

struct Sorter {
  const Vec3* x_t0;
  const Vec3* x_t1;
  CanonicalOrder order;

  [[nodiscard]] int compare_places(std::size_t i, std::size_t j) const {
    const std::size_t a = order.original[i], b = order.original[j];
    if (x_t0[a][0] != x_t0[b][0]) return x_t0[a][0] < x_t0[b][0] ? -1 : 1;  // decides nearly always
    const int at_t0 = compare(x_t0[a], x_t0[b]);
    return at_t0 != 0 ? at_t0 : compare(x_t1[a], x_t1[b]);
  }
  void sort_places(std::size_t i, std::size_t j) {
    if (compare_places(j, i) < 0) std::swap(order.original[i], order.original[j]);
  }
};

}  // namespace

CanonicalOrder canonical_order(PairKind kind, const Vec3* x_t0, const Vec3* x_t1) {
  Sorter sorter{x_t0, x_t1, {}};
  switch (kind) {
    case PairKind::kVf:
      sorter.sort_places(1, 2);
      sorter.sort_places(2, 3);
      sorter.sort_places(1, 2);
      break;
    case PairKind::kEe: {
      sorter.sort_places(0, 1);
      sorter.sort_places(2, 3);
      const int first_ends = sorter.compare_places(2, 0);
      if (first_ends < 0 || (first_ends == 0 && sorter.compare_places(3, 1) < 0)) {
        std::swap(sorter.order.original[0], sorter.order.original[2]);
        std::swap(sorter.order.original[1], sorter.order.original[3]);
        sorter.order.features_swapped = true;
      }
      break;
    }
    case PairKind::kSelf:
      sorter.sort_places(1, 2);
      break;
  }
  return sorter.order;
}

std::array<double, 4> restore_weights(const CanonicalOrder& order, const std::array<double, 4>& weights) {
  std::array<double, 4> result = {};
  for (std::size_t i = 0; i < 4; ++i) result[order.original[i]] = weights[i];
  return result;
}

Vec3 restore_normal(const CanonicalOrder& order, const Double3& normal) {
  return to_vec3(order.features_swapped ? -normal : normal);
}

}  // namespace selvage::detail
