#include "sim/scene/garment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/assert.h"

namespace selvage::sim {
namespace {

using Ring = GarmentSpec::Ring;
using Loop = std::vector<VertexId>;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kPerimeterOfExtents = std::numbers::pi / 2;  // of an ellipse, per depth + width: within 4 % up to 2:1

// Between the front, where the depth counts, and the side, where the width does.
double slope_length(const Ring& a, const Ring& b) {
  const double in_depth = (a.depth_m - b.depth_m) / 2, in_width = (a.width_m - b.width_m) / 2;
  return std::hypot(a.height_m - b.height_m, std::sqrt((in_depth * in_depth + in_width * in_width) / 2));
}

// The rings of the mesh: those of the pattern, and evenly between them.
std::vector<Ring> subdivide(const GarmentSpec& spec) {
  std::vector<Ring> rings = {spec.rings.front()};
  for (std::size_t i = 0; i + 1 < spec.rings.size(); ++i) {
    const Ring &a = spec.rings[i], &b = spec.rings[i + 1];
    const auto count = std::max(1L, std::lround(slope_length(a, b) / spec.cell_m));
    for (long n = 1; n <= count; ++n) {
      const double t = double(n) / double(count);
      rings.push_back({a.height_m + t * (b.height_m - a.height_m), a.depth_m + t * (b.depth_m - a.depth_m),
                       a.width_m + t * (b.width_m - a.width_m)});
    }
  }
  return rings;
}

// One number for all rings, a multiple of four, so that front, back and both sides have a column of their own.
std::int32_t column_count(const std::vector<Ring>& rings, double cell_m) {
  double sum = 0;
  for (const Ring& ring : rings) sum += kPerimeterOfExtents * (ring.depth_m + ring.width_m);
  const double mean_m = sum / double(rings.size());
  return static_cast<std::int32_t>(4 * std::max(3L, std::lround(mean_m / cell_m / 4)));
}

// Cells [top, bottom) of the rows, and `half` columns to either side of the middle one.
struct Opening {
  std::int32_t top = 0, bottom = 0, half = 0;
};

Opening cut_opening(const GarmentSpec::Sleeves& sleeves, const std::vector<Ring>& rings, std::int32_t columns) {
  const auto nearest = [&](double height_m) {
    const auto nearer = [&](const Ring& a, const Ring& b) {
      return std::abs(a.height_m - height_m) < std::abs(b.height_m - height_m);
    };
    return static_cast<std::int32_t>(std::min_element(rings.begin(), rings.end(), nearer) - rings.begin());
  };
  Opening opening{nearest(sleeves.top_m), nearest(sleeves.bottom_m), 0};
  if (opening.top < 1 || opening.bottom + 2 > static_cast<std::int32_t>(rings.size())) {
    throw GarmentError("the sleeves leave no cloth above or below their opening; move top_m and bottom_m inside");
  }
  if (opening.top >= opening.bottom) {
    throw GarmentError("the opening of the sleeves is lower than a cell; lower cell_m, or top_m above bottom_m");
  }
  const Ring& middle = rings[static_cast<std::size_t>((opening.top + opening.bottom) / 2)];
  if (!(sleeves.depth_m < middle.depth_m)) {
    throw GarmentError("the opening of the sleeves is deeper than the garment there; lower their depth_m");
  }
  const double angle = std::asin(sleeves.depth_m / middle.depth_m);
  opening.half = static_cast<std::int32_t>(std::lround(angle * columns / (2 * std::numbers::pi)));
  if (opening.half < 1) throw GarmentError("the opening of the sleeves is narrower than a cell; lower cell_m");
  if (opening.half >= columns / 4) throw GarmentError("the openings of the sleeves meet; lower their depth_m");
  return opening;
}

class Tailor {
 public:
  explicit Tailor(const GarmentSpec& spec)
      : spec_(spec), rings_(subdivide(spec)), columns_(column_count(rings_, spec.cell_m)) {
    if (spec.sleeves) opening_ = cut_opening(*spec.sleeves, rings_, columns_);
  }

  Shape sew() {
    sew_tube();
    if (spec_.sleeves) {
      sew_sleeve(columns_ / 4, +1);
      sew_sleeve(3 * columns_ / 4, -1);
    }
    Shape shape;
    shape.x.resize(static_cast<Eigen::Index>(points_.size()), 3);
    for (std::size_t i = 0; i < points_.size(); ++i) shape.x.row(static_cast<Eigen::Index>(i)) = points_[i];
    shape.triangles = std::move(triangles_);
    return shape;
  }

 private:
  // Columns from the middle of the nearer side: 0 there, columns / 4 at the front and at the back.
  [[nodiscard]] std::int32_t from_side(std::int32_t column) const {
    const std::int32_t half_turn = columns_ / 2;
    return std::abs(column % half_turn - half_turn / 2);
  }
  [[nodiscard]] bool is_cut_vertex(std::int32_t row, std::int32_t column) const {
    return row > opening_.top && row < opening_.bottom && from_side(column) < opening_.half;
  }
  [[nodiscard]] bool is_cut_cell(std::int32_t row, std::int32_t column) const {
    return row >= opening_.top && row < opening_.bottom && from_side(column) <= opening_.half &&
           from_side(column + 1) <= opening_.half;
  }
  [[nodiscard]] VertexId at(std::int32_t row, std::int32_t column) const {
    return tube_[static_cast<std::size_t>(row * columns_ + column % columns_)];
  }

  VertexId add(const Vec3& point) {
    points_.push_back(point);
    return static_cast<VertexId>(points_.size() - 1);
  }
  // Diagonals alternate like a chessboard: no direction is stiffer.
  void add_cell(VertexId a, VertexId b, VertexId c, VertexId d, bool flip) {
    if (flip) {
      triangles_.insert(triangles_.end(), {{a, b, d}, {b, c, d}});
    } else {
      triangles_.insert(triangles_.end(), {{a, b, c}, {a, c, d}});
    }
  }

  void sew_tube() {
    const auto rows = static_cast<std::int32_t>(rings_.size());
    for (std::int32_t row = 0; row < rows; ++row) {
      const Ring& ring = rings_[static_cast<std::size_t>(row)];
      for (std::int32_t column = 0; column < columns_; ++column) {
        const double angle = 2 * std::numbers::pi * column / columns_;
        tube_.push_back(is_cut_vertex(row, column) ? -1
                                                   : add({ring.depth_m / 2 * std::cos(angle),
                                                          ring.width_m / 2 * std::sin(angle), ring.height_m}));
      }
    }
    for (std::int32_t row = 0; row + 1 < rows; ++row) {
      for (std::int32_t column = 0; column < columns_; ++column) {
        if (is_cut_cell(row, column)) continue;
        add_cell(at(row + 1, column), at(row + 1, column + 1), at(row, column + 1), at(row, column),
                 (row + column) % 2 == 1);
      }
    }
  }

  // The border of an opening, counter-clockwise seen from outside.
  [[nodiscard]] Loop opening_loop(std::int32_t middle) const {
    const std::int32_t left = middle - opening_.half, right = middle + opening_.half;
    Loop loop;
    for (std::int32_t column = left; column < right; ++column) loop.push_back(at(opening_.bottom, column));
    for (std::int32_t row = opening_.bottom; row > opening_.top; --row) loop.push_back(at(row, right));
    for (std::int32_t column = right; column > left; --column) loop.push_back(at(opening_.top, column));
    for (std::int32_t row = opening_.top; row < opening_.bottom; ++row) loop.push_back(at(row, left));
    return loop;
  }

  void sew_sleeve(std::int32_t middle, double side) {
    const GarmentSpec::Sleeves& sleeves = *spec_.sleeves;
    const Loop opening = opening_loop(middle);
    const auto count = opening.size();
    Vec3 center = Vec3::Zero();
    for (const VertexId vertex : opening) center += points_[static_cast<std::size_t>(vertex)] / double(count);
    const double down = sleeves.down_deg * kDegree;
    const Vec3 along(0, side * std::cos(down), -std::sin(down)), across(0, side * std::sin(down), std::cos(down));
    std::vector<Vec3> from, to;
    for (const VertexId vertex : opening) {
      from.push_back(points_[static_cast<std::size_t>(vertex)]);
      const Vec3 offset = from.back() - center;
      const double radius = std::hypot(offset.x(), offset.z());
      to.push_back(center + sleeves.length_m * along +
                   sleeves.cuff_radius_m / radius * (offset.x() * Vec3::UnitX() + offset.z() * across));
    }
    Loop last = opening;
    const auto rows = std::max(1L, std::lround(sleeves.length_m / spec_.cell_m));
    for (long row = 1; row <= rows; ++row) {
      const double t = double(row) / double(rows);
      Loop next;
      for (std::size_t i = 0; i < count; ++i) next.push_back(add((1 - t) * from[i] + t * to[i]));
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t j = (i + 1) % count;
        add_cell(last[i], last[j], next[j], next[i], (static_cast<std::size_t>(row) + i) % 2 == 1);
      }
      last = std::move(next);
    }
  }

  const GarmentSpec& spec_;
  std::vector<Ring> rings_;
  std::int32_t columns_;
  Opening opening_;             ///< empty: no cell is cut
  std::vector<VertexId> tube_;  ///< row by row; -1 in an opening
  std::vector<Vec3> points_;
  io::Triangles triangles_;
};

}  // namespace

Shape make_garment(const GarmentSpec& spec) {
  SELVAGE_ASSERT(spec.rings.size() >= 2 && spec.cell_m > 0);
  return Tailor(spec).sew();
}

}  // namespace selvage::sim
