#include "kernel/coplanarity.h"

#include "kernel/rounding.h"

namespace selvage::detail {

namespace {

double blend(double a, double b, double s, double t) { return s * a + t * b; }

/// The blossom: the value symmetric and affine in three times, which gives Bernstein coefficients over any interval.
double blossom(const std::array<double, 4>& c, double t1, double t2, double t3) {
  const double s1 = 1 - t1, s2 = 1 - t2, s3 = 1 - t3;
  const double a = blend(c[0], c[1], s1, t1), b = blend(c[1], c[2], s1, t1), d = blend(c[2], c[3], s1, t1);
  return blend(blend(a, b, s2, t2), blend(b, d, s2, t2), s3, t3);
}

Double3 extent_of(const Double3& a, const Double3& b) { return max(abs(a), abs(b)); }

/// sum over all six permutations of a_i b_j c_k: bounds every sum of absolute terms of a determinant.
double permanent(const Double3& a, const Double3& b, const Double3& c) {
  const Double3 minors = {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
  return dot(minors, c);
}

}  // namespace

CoplanarityCubic coplanarity_cubic(const PairMotion& motion) {
  const Double3 &u0 = motion.t0.edge_u, &v0 = motion.t0.edge_v, &r0 = motion.t0.corner[0];
  const Double3 &u1 = motion.t1.edge_u, &v1 = motion.t1.edge_v, &r1 = motion.t1.corner[0];
  const Double3 first = cross(u0, v0), last = cross(u1, v1);
  const Double3 middle_doubled = cross(u0, v1) + cross(u1, v0);
  CoplanarityCubic cubic;
  cubic.coefficient = {dot(first, r0), (dot(middle_doubled, r0) + dot(first, r1)) / 3,
                       (dot(last, r0) + dot(middle_doubled, r1)) / 3, dot(last, r1)};
  const double scale = permanent(extent_of(u0, u1), extent_of(v0, v1), extent_of(r0, r1));
  cubic.error_bound = kDeterminantError * scale + 0x1p-1060;
  return cubic;
}

bool is_definite(const CoplanarityCubic& cubic, double t_begin, double t_end) {
  const auto& c = cubic.coefficient;
  const std::array<double, 4> local = {blossom(c, t_begin, t_begin, t_begin), blossom(c, t_begin, t_begin, t_end),
                                       blossom(c, t_begin, t_end, t_end), blossom(c, t_end, t_end, t_end)};
  const double largest =
      std::max(std::max(std::fabs(c[0]), std::fabs(c[1])), std::max(std::fabs(c[2]), std::fabs(c[3])));
  const double bound = cubic.error_bound + kBlossomError * largest;
  const double least = std::min(std::min(local[0], local[1]), std::min(local[2], local[3]));
  const double greatest = std::max(std::max(local[0], local[1]), std::max(local[2], local[3]));
  return least > bound || greatest < -bound;
}

}  // namespace selvage::detail
