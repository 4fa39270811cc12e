#include "bench/plain_distance.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace selvage::bench {
namespace {

/// 0 where the length it would be a share of is 0.
double share(double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0; }

}  // namespace

double plain_vf_distance(const std::array<Vec3, 4>& x) {
  const Vec3 ab = x[2] - x[1], ac = x[3] - x[1], ap = x[0] - x[1];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.norm();  // nearest: a
  const Vec3 bp = x[0] - x[2];
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.norm();  // b
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - share(d1, d1 - d3) * ab).norm();  // ab
  const Vec3 cp = x[0] - x[3];
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.norm();  // c
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - share(d2, d2 - d6) * ac).norm();  // ac
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return (bp - share(d4 - d3, (d4 - d3) + (d5 - d6)) * (ac - ab)).norm();  // bc
  const double sum = va + vb + vc;
  return (ap - (vb / sum) * ab - (vc / sum) * ac).norm();
}

double plain_ee_distance(const std::array<Vec3, 4>& x) {
  const Vec3 d1 = x[1] - x[0], d2 = x[3] - x[2], r = x[0] - x[2];
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), b = d1.dot(d2), c = d1.dot(r), f = d2.dot(r);
  double s = share(b * f - c * e, a * e - b * b);
  double t = e > 0 ? (b * s + f) / e : 0;
  if (t < 0 || t > 1 || e == 0) {  // the nearest point of the line is off the second edge: its end, and back again
    t = std::clamp(t, 0.0, 1.0);
    s = share(b * t - c, a);
  }
  return (r + s * d1 - t * d2).norm();
}

}  // namespace selvage::bench
