#include "fuzz/draw/surface_makers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "kernel/assert.h"

namespace selvage::fuzz {
namespace {

/// Adds (columns + 1) x (rows + 1) vertices place(column, row), and their triangles.
template <typename Place>
void add_grid(SurfaceDraft& draft, int columns, int rows, std::int32_t body, Place place) {
  const auto first = static_cast<std::int32_t>(draft.x.size());
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      draft.x.push_back(place(column, row));
      draft.body.push_back(body);
    }
  }
  const auto id = [&](int column, int row) { return first + row * (columns + 1) + column; };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      draft.faces.push_back({id(column, row), id(column + 1, row), id(column + 1, row + 1)});
      draft.faces.push_back({id(column, row), id(column + 1, row + 1), id(column, row + 1)});
    }
  }
}

/// Horizontal sheets above each other.
void add_layers(SurfaceDraft& draft, int layers, int cells, double gap) {
  for (int layer = 0; layer < layers; ++layer) {
    add_grid(draft, cells, cells, -1, [&](int column, int row) { return Vec3(column, row, layer * gap); });
  }
}

/// Eight faces about `centre`, each edge halved `levels` times, pushed out to the sphere.
void add_shell(SurfaceDraft& draft, const Vec3& centre, double radius, int levels, std::int32_t body) {
  const auto first = static_cast<std::int32_t>(draft.x.size());
  std::vector<Vec3> directions{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<std::array<std::int32_t, 3>> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                                 {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(directions.size()));
      if (is_new) {
        const Vec3 sum = directions[static_cast<std::size_t>(a)] + directions[static_cast<std::size_t>(b)];
        directions.push_back(sum / sum.norm());
      }
      return found->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = finer;
  }
  for (const Vec3& direction : directions) {
    draft.x.push_back(centre + radius * direction);
    draft.body.push_back(body);
  }
  for (const auto& [a, b, c] : faces) draft.faces.push_back({first + a, first + b, first + c});
}

/// Distances between layers: from a whole spacing down to what a simulation in resting contact sees, and far less.
double choose_gap(ChoiceSource& source) { return std::ldexp(1.0, -source.range(0, 30)); }

SurfaceDraft sheets(ChoiceSource& source) {
  SurfaceDraft draft;
  draft.gap = choose_gap(source);
  const int cells = source.range(1, 3);
  add_layers(draft, source.range(2, 3), cells, draft.gap);
  return draft;
}

SurfaceDraft cards(ChoiceSource& source) {
  SurfaceDraft draft;
  draft.gap = choose_gap(source);
  add_layers(draft, source.range(4, 10), 1, draft.gap);
  return draft;
}

/// One sheet folded like a bellows: x runs to and fro, the folds stand a gap apart.
SurfaceDraft crumpled(ChoiceSource& source) {
  SurfaceDraft draft;
  draft.gap = std::ldexp(1.0, -source.range(1, 12));
  const int folds = source.range(2, 5);
  add_grid(draft, 2 * folds, source.range(1, 3), -1,
           [&](int column, int row) { return Vec3(column % 2, row, column * draft.gap); });
  return draft;
}

/// One triangle in each cell of a lattice, with room between the cells.
SurfaceDraft soup(ChoiceSource& source) {
  SurfaceDraft draft;
  draft.gap = 0.25;
  const int side = source.range(2, 3);
  for (int cell = 0; cell < side * side * side; ++cell) {
    const Vec3 corner(cell % side, cell / side % side, cell / (side * side));
    const auto first = static_cast<std::int32_t>(draft.x.size());
    for (int i = 0; i < 3; ++i) {
      // Corners in three different octants of the cell: never collinear with the simple answers.
      Vec3 place(i == 1, i == 2, 0);
      for (double& coordinate : place) coordinate = 0.5 * coordinate + 0.25 * source.unit_real();
      draft.x.push_back(corner + place);
      draft.body.push_back(-1);
    }
    draft.faces.push_back({first, first + 1, first + 2});
  }
  return draft;
}

/// Closed surfaces inside each other.
SurfaceDraft shells(ChoiceSource& source) {
  SurfaceDraft draft;
  draft.gap = std::ldexp(1.0, -source.range(2, 10));
  const int levels = source.range(0, 1);
  const int count = source.range(1, 3);
  for (int shell = 0; shell < count; ++shell) add_shell(draft, Vec3::Zero(), 1 + shell * draft.gap, levels, -1);
  return draft;
}

/// Triangles up to 2^20 times longer than wide, lying close side by side.
SurfaceDraft needles(ChoiceSource& source) {
  SurfaceDraft draft;
  const double length = std::ldexp(1.0, source.range(4, 20));
  draft.gap = choose_gap(source);
  const int count = source.range(2, 6);
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::int32_t>(draft.x.size());
    const double height = i * draft.gap;
    const bool across = i % 2 == 1;
    draft.x.insert(draft.x.end(), {Vec3(0, 0, height), across ? Vec3(0, length, height) : Vec3(length, 0, height),
                                   across ? Vec3(1, 0, height) : Vec3(0, 1, height)});
    draft.body.insert(draft.body.end(), 3, -1);
    draft.faces.push_back({first, first + 1, first + 2});
  }
  return draft;
}

/// A sheet over one body, or between two.
SurfaceDraft with_bodies(ChoiceSource& source) {
  SurfaceDraft draft;
  draft.gap = choose_gap(source);
  const int cells = source.range(1, 3);
  add_grid(draft, cells, cells, -1, [&](int column, int row) { return Vec3(column, row, 0); });
  const int bodies = source.range(1, 2);
  for (int body = 0; body < bodies; ++body) {
    const double side = body == 0 ? -1 : 1;
    if (source.coin()) {
      add_shell(draft, Vec3(0.5 * cells, 0.5 * cells, side * (cells + draft.gap)), cells, source.range(0, 1), body);
    } else {
      add_grid(draft, 1, 1, body, [&](int column, int row) {
        return Vec3(2 * cells * column - 0.5, 2 * cells * row - 0.5, side * draft.gap);
      });
    }
  }
  return draft;
}

}  // namespace

const std::vector<SurfaceClass>& surface_classes() {
  static const std::vector<SurfaceClass> classes = {{"sheets", sheets},     {"cards", cards},   {"crumpled", crumpled},
                                                    {"soup", soup},         {"shells", shells}, {"needles", needles},
                                                    {"bodies", with_bodies}};
  return classes;
}

const SurfaceClass& surface_class(std::string_view name) {
  const auto found = std::ranges::find(surface_classes(), name, &SurfaceClass::name);
  SELVAGE_ASSERT(found != surface_classes().end());
  return *found;
}

}  // namespace selvage::fuzz
