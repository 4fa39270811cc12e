#include "bench/inclusion_ccd.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace selvage::bench {
namespace {

using Points = std::array<Vec3, 4>;
using Range = std::array<double, 2>;

/// Ranges of t, u, v. Their ends are multiples of kLeastWidth, so that 1 - t and 1 - u - v are exact.
struct DomainBox {
  std::array<Range, 3> range;
};
constexpr double kLeastWidth = 0x1p-40;

/// |computed - real| of one component of F at a corner, m the largest |coordinate| along that axis:
///   a point at t: two products and a sum, 3 u m (1 - t is exact);
///   its product with a weight 1, the sums 2, the difference of the two features 1: 7 u for each point of weight w,
///   times |w| m. Weights of the corners of a box sum, in absolute value, to 1 for the vertex and to at most 3 for the
///   face (u + v up to 2), to 2 for two edges. So 28 u m; 32 covers second order and the evaluation of the bound. At
///   most 11 products may lose 2^-1075 each by underflow, times weights below 2: 2^-1069 covers them.
double rounding_bound(double largest) { return 32 * 0x1p-53 * largest + 0x1p-1069; }

/// The values of F over a box: its bounds on each axis before rounding.
struct Image {
  Vec3 low, high;
};

class Subdivision {
 public:
  Subdivision(PairKind kind, const Points& x_t0, const Points& x_t1, const InclusionOptions& options)
      : kind_(kind), x_t0_(x_t0), x_t1_(x_t1), options_(options) {
    Vec3 low = x_t0[0], high = x_t0[0];
    for (std::size_t i = 0; i < 4; ++i) {
      low = low.cwiseMin(x_t0[i]).cwiseMin(x_t1[i]);
      high = high.cwiseMax(x_t0[i]).cwiseMax(x_t1[i]);
      in_domain_ &= x_t0[i].allFinite() && x_t1[i].allFinite();
    }
    const Vec3 largest = low.cwiseAbs().cwiseMax(high.cwiseAbs());
    in_domain_ &= largest.maxCoeff() <= kMaxCoordinate;
    error_bound_ = largest.unaryExpr(&rounding_bound);
    accepted_width_ = options.tolerance * (high - low).maxCoeff();
    const auto longest = [&](std::size_t a, std::size_t b) {
      const double at_t0 = (x_t0[a] - x_t0[b]).lpNorm<Eigen::Infinity>();
      return std::max(at_t0, (x_t1[a] - x_t1[b]).lpNorm<Eigen::Infinity>());
    };
    for (std::size_t i = 0; i < 4; ++i) {
      variation_[0] = std::max(variation_[0], (x_t1[i] - x_t0[i]).lpNorm<Eigen::Infinity>());
    }
    variation_[1] = kind == PairKind::kVf ? longest(1, 2) : longest(0, 1);
    variation_[2] = kind == PairKind::kVf ? longest(1, 3) : longest(2, 3);
  }

  InclusionAnswer run();

 private:
  [[nodiscard]] Vec3 value(const Points& x, double u, double v) const;
  [[nodiscard]] Image image(const DomainBox& box) const;
  [[nodiscard]] bool excludes_touch(const Image& f) const {
    return ((f.low - error_bound_).array() > 0).any() || ((f.high + error_bound_).array() < 0).any();
  }
  [[nodiscard]] std::size_t widest(const DomainBox& box) const;
  void keep_halves(const DomainBox& box, std::vector<DomainBox>& next) const;

  PairKind kind_;
  const Points &x_t0_, &x_t1_;
  const InclusionOptions& options_;
  bool in_domain_ = true;
  Vec3 error_bound_;
  double accepted_width_ = 0;
  std::array<double, 3> variation_{};  ///< how far F may move over the whole range of t, u, v
};

Vec3 Subdivision::value(const Points& x, double u, double v) const {
  if (kind_ == PairKind::kVf) return x[0] - ((1 - u - v) * x[1] + u * x[2] + v * x[3]);
  return ((1 - u) * x[0] + u * x[1]) - ((1 - v) * x[2] + v * x[3]);
}

Image Subdivision::image(const DomainBox& box) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Image image{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  const auto& [times, us, vs] = box.range;
  for (const double t : times) {
    Points x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = (1 - t) * x_t0_[i] + t * x_t1_[i];
    for (const double u : us) {
      for (const double v : vs) {
        const Vec3 f = value(x, u, v);
        image.low = image.low.cwiseMin(f);
        image.high = image.high.cwiseMax(f);
      }
    }
  }
  return image;
}

/// The direction to split across; 3 where none can be split any more.
std::size_t Subdivision::widest(const DomainBox& box) const {
  std::size_t best = 3;
  double most = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double width = box.range[i][1] - box.range[i][0];
    if (width <= kLeastWidth || !(width * variation_[i] > most)) continue;
    most = width * variation_[i];
    best = i;
  }
  return best;
}

void Subdivision::keep_halves(const DomainBox& box, std::vector<DomainBox>& next) const {
  const std::size_t axis = widest(box);
  const double middle = (box.range[axis][0] + box.range[axis][1]) / 2;
  for (const std::size_t end : {std::size_t{1}, std::size_t{0}}) {
    DomainBox half = box;
    half.range[axis][end] = middle;
    if (kind_ == PairKind::kVf && half.range[1][0] + half.range[2][0] > 1) continue;  // beside the triangle
    next.push_back(half);
  }
}

InclusionAnswer Subdivision::run() {
  if (!in_domain_) return {true, true, 0};
  const DomainBox whole{{{{0, 1}, {0, 1}, {0, 1}}}};
  if (excludes_touch(image(whole))) return {};  // most queries, without a list of boxes
  std::vector<DomainBox> level{whole}, next;
  std::int32_t looked_at = 0;
  double toi = 2;  // of the earliest box that was small enough; 2: of none
  while (!level.empty()) {
    std::sort(level.begin(), level.end(),
              [](const DomainBox& a, const DomainBox& b) { return a.range[0][0] < b.range[0][0]; });
    next.clear();
    for (const DomainBox& box : level) {
      const double start = box.range[0][0];
      if (start >= toi) break;  // later than what is accepted already, as are those behind it
      if (looked_at++ == options_.max_boxes) {
        const double split_before = next.empty() ? start : next.front().range[0][0];
        return {true, true, std::min({toi, start, split_before})};
      }
      const Image f = image(box);
      if (excludes_touch(f)) continue;
      if ((f.high - f.low).maxCoeff() <= accepted_width_ || widest(box) == 3) {
        toi = start;
      } else {
        keep_halves(box, next);
      }
    }
    level.swap(next);
  }
  return toi <= 1 ? InclusionAnswer{true, false, toi} : InclusionAnswer{};
}

}  // namespace

InclusionAnswer inclusion_vf(const Points& x_t0, const Points& x_t1, const InclusionOptions& options) {
  return Subdivision(PairKind::kVf, x_t0, x_t1, options).run();
}

InclusionAnswer inclusion_ee(const Points& x_t0, const Points& x_t1, const InclusionOptions& options) {
  return Subdivision(PairKind::kEe, x_t0, x_t1, options).run();
}

}  // namespace selvage::bench
