// Separating directions: n . x > 0 for every corner difference x at both ends of a time interval proves that the
// features do not touch within it, because every difference in between is a convex combination of these.
#pragma once

#include <optional>

#include "kernel/arithmetic/rounding.h"
#include "kernel/query/closest_point.h"

namespace selvage::detail {

/// PROVED: |fl(n . x) - n . X| < support_error for every corner x at every t. REQUIRES |components of n| < 2^10.
template <class Real>
[[nodiscard]] double support_error(const Triple<Real>& n, const Double3& extent);

/// PROVED when true: no touch while t goes from the instant of `begin` to the instant of `end`.
template <class Real>
[[nodiscard]] bool separates(const PairMotion<Real>& motion, const DifferencePolygon<Real>& begin,
                             const DifferencePolygon<Real>& end, const Triple<Real>& n);

/// Bernstein coefficients of corner x edge while both move from one instant to another, the middle one doubled.
struct CrossMotion {
  Double3 first, middle_doubled, last;
};
template <class Real>
[[nodiscard]] CrossMotion cross_motion(const Triple<Real>& corner_begin, const Triple<Real>& corner_end,
                                       const Triple<Real>& edge_begin, const Triple<Real>& edge_end) {
  return {leading(cross(corner_begin, edge_begin)),
          leading(cross(corner_begin, edge_end) + cross(corner_end, edge_begin)), leading(cross(corner_end, edge_end))};
}
/// PROVED: of `first` and `last` along each axis, and half that of `middle_doubled`.
template <class Real>
[[nodiscard]] Double3 winding_error(const PairMotion<Real>& motion) {
  const Double3 &d = motion.extent, &e = motion.edge_extent;
  const Double3 minors = {d.y * e.z + d.z * e.y, d.z * e.x + d.x * e.z, d.x * e.y + d.y * e.x};
  return scaled(kWindingError<Real>, minors) + Double3{kUnderflowError, kUnderflowError, kUnderflowError};
}

/// How far a direction that separates at the begin of an interval goes on separating.
template <class Real>
struct Reach {
  double share = 0;  ///< of the interval, a guess in [0, 1]; 0: it does not separate at the begin
  Triple<Real> direction;
};
/// The better of the two directions of `closest`, the closest point at the begin.
template <class Real>
[[nodiscard]] Reach<Real> separated_reach(const PairMotion<Real>& motion, const DifferencePolygon<Real>& begin,
                                          const DifferencePolygon<Real>& end, const ClosestPoint<Real>& closest);
/// A direction that separates a smaller share of an interval than this makes no better progress than halving.
inline constexpr double kFarShare = 0.125;

/// PROVED when true: no touch while t goes from the instant of `begin` to the instant of `end`. Touching features have
/// the origin in their polygon, so that the cross products corner x edge around it are all multiples, none negative, of
/// one vector. Two that keep opposite signs along one axis exclude that. Follows rotations, where a fixed direction
/// cannot.
template <class Real>
[[nodiscard]] bool winds_apart(const PairMotion<Real>& motion, const DifferencePolygon<Real>& begin,
                               const DifferencePolygon<Real>& end);

/// Gilbert's algorithm (1966) from `point`, a point of the swept hull: walks toward the hull's point nearest to the
/// origin, which is the best direction there is. The first direction that separates, if one appears in time.
template <class Real>
[[nodiscard]] std::optional<Triple<Real>> separating_direction(const PairMotion<Real>& motion,
                                                               const DifferencePolygon<Real>& begin,
                                                               const DifferencePolygon<Real>& end, Triple<Real> point);

/// How far apart a direction shows the features to be, scaled.
struct SupportedDistance {
  double lower = 0;   ///< PROVED: their distance is at least this; 0 if no direction was found that separates them
  Double3 direction;  ///< what shows it: within the angle of cosine lower / distance of the exact one
};
/// At the instant of `polygon`: the best of the directions of `closest`, and of some steps of Gilbert's algorithm where
/// these come short of the distance: where the exact closest point is within rounding of several features, or the
/// features are so thin that their normals are noise.
[[nodiscard]] SupportedDistance supported_distance(const PairMotion<double>& motion,
                                                   const DifferencePolygon<double>& polygon,
                                                   const ClosestPoint<double>& closest);

/// PROVED: the features come within this distance, scaled, at the instant of `polygon`. `blended`: the instant is
/// neither t = 0 nor t = 1. `weights` as in ClosestPoint.
[[nodiscard]] double distance_upper(const PairMotion<double>& motion, const DifferencePolygon<double>& polygon,
                                    bool blended, const std::array<double, 4>& weights);

/// |v|, relative error at most kNormError whatever its size.
[[nodiscard]] double norm(const Double3& v);

extern template double support_error(const Double3&, const Double3&);
extern template double support_error(const Triple<DoubleDouble>&, const Double3&);
extern template bool separates(const PairMotion<double>&, const DifferencePolygon<double>&,
                               const DifferencePolygon<double>&, const Double3&);
extern template bool separates(const PairMotion<DoubleDouble>&, const DifferencePolygon<DoubleDouble>&,
                               const DifferencePolygon<DoubleDouble>&, const Triple<DoubleDouble>&);
extern template Reach<double> separated_reach(const PairMotion<double>&, const DifferencePolygon<double>&,
                                              const DifferencePolygon<double>&, const ClosestPoint<double>&);
extern template Reach<DoubleDouble> separated_reach(const PairMotion<DoubleDouble>&,
                                                    const DifferencePolygon<DoubleDouble>&,
                                                    const DifferencePolygon<DoubleDouble>&,
                                                    const ClosestPoint<DoubleDouble>&);
extern template bool winds_apart(const PairMotion<double>&, const DifferencePolygon<double>&,
                                 const DifferencePolygon<double>&);
extern template bool winds_apart(const PairMotion<DoubleDouble>&, const DifferencePolygon<DoubleDouble>&,
                                 const DifferencePolygon<DoubleDouble>&);
extern template std::optional<Double3> separating_direction(const PairMotion<double>&, const DifferencePolygon<double>&,
                                                            const DifferencePolygon<double>&, Double3);
extern template std::optional<Triple<DoubleDouble>> separating_direction(const PairMotion<DoubleDouble>&,
                                                                         const DifferencePolygon<DoubleDouble>&,
                                                                         const DifferencePolygon<DoubleDouble>&,
                                                                         Triple<DoubleDouble>);

}  // namespace selvage::detail
