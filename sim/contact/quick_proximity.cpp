#include "sim/contact/quick_proximity.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/contact/quick_proximity.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/contact/nearest_points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using detail::HWY_NAMESPACE::Value3;

using Many = hn::CappedTag<double, detail::kMaxWideLanes>;
using One = hn::CappedTag<double, 1>;

void Write(const Nearest<Many>& nearest, std::size_t i, QuickProximities& to) {
  const Many d;
  hn::StoreU(nearest.distance, d, to.distance.data() + i);
  hn::StoreU(nearest.direction.x, d, to.direction[0].data() + i);
  hn::StoreU(nearest.direction.y, d, to.direction[1].data() + i);
  hn::StoreU(nearest.direction.z, d, to.direction[2].data() + i);
  hn::StoreU(nearest.first_weight, d, to.weights[0].data() + i);
  for (std::size_t k = 0; k < 3; ++k) hn::StoreU(nearest.weights.of[k], d, to.weights[k + 1].data() + i);
}

template <PairKind kKind>
void FindKind(const detail::LanePairs& pairs, const double* V, QuickProximities& result) {
  const Many d;
  const hn::RebindToSigned<Many> place;
  for (std::size_t i = 0; i < pairs.count(); i += hn::Lanes(d)) {
    Value3<Many> x[4];
    for (std::size_t k = 0; k < 4; ++k) {
      const auto vertex = hn::LoadU(hn::Rebind<std::uint32_t, Many>(), pairs.vertices(k) + i);
      const auto wide = hn::BitCast(place, hn::PromoteTo(hn::RebindToUnsigned<Many>(), vertex));
      const auto row = hn::Add(hn::Add(wide, wide), wide);
      x[k] = {hn::GatherIndex(d, V, row), hn::GatherIndex(d, V + 1, row), hn::GatherIndex(d, V + 2, row)};
    }
    Write(Nearest<Many>::Of<kKind>(x), i, result);
  }
}
void FindMany(const detail::LanePairs& pairs, const double* V, QuickProximities& result) {
  pairs.kind() == PairKind::kVf ? FindKind<PairKind::kVf>(pairs, V, result) : FindKind<PairKind::kEe>(pairs, V, result);
}

QuickProximity FindOne(PairKind kind, const PairVectors& points) {
  const One d;
  Value3<One> x[4];
  for (std::size_t k = 0; k < 4; ++k) {
    x[k] = {hn::Set(d, points[k].x()), hn::Set(d, points[k].y()), hn::Set(d, points[k].z())};
  }
  const auto nearest = kind == PairKind::kVf ? Nearest<One>::Of<PairKind::kVf>(x) : Nearest<One>::Of<PairKind::kEe>(x);
  const auto& [u, v, w] = nearest.direction;
  const auto& weights = nearest.weights.of;
  return {
      hn::GetLane(nearest.distance),
      {hn::GetLane(u), hn::GetLane(v), hn::GetLane(w)},
      {hn::GetLane(nearest.first_weight), hn::GetLane(weights[0]), hn::GetLane(weights[1]), hn::GetLane(weights[2])}};
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::sim {

HWY_EXPORT(FindOne);
HWY_EXPORT(FindMany);

QuickProximity quick_proximity(PairKind kind, const PairVectors& x) { return HWY_DYNAMIC_DISPATCH(FindOne)(kind, x); }

void quick_proximities(const detail::LanePairs& pairs, const Positions& V, QuickProximities& result) {
  HWY_DYNAMIC_DISPATCH(FindMany)(pairs, V.data(), result);
}

QuickProximity QuickProximities::operator[](std::size_t i) const {
  return {distance[i],
          {direction[0][i], direction[1][i], direction[2][i]},
          {weights[0][i], weights[1][i], weights[2][i], weights[3][i]}};
}

}  // namespace selvage::sim
#endif
