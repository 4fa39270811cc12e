#include "fuzz/draw/generators.h"

#include <cmath>

#include "fuzz/draw/query_makers.h"

namespace selvage::fuzz {
namespace {

using Bands = std::array<std::optional<HitBand>, 3>;

constexpr HitBand kAlways{1, 1};
constexpr Bands every_kind(HitBand band) { return {band, band, band}; }

// Cases in a work unit follow from the time a case takes (kernel and oracle, measured): 25 ms for each group, but 50 ms
// for uniform and 120 ms for recorded queries, which are what simulators ask. Recorded queries take 3 us, uniform ones
// 6, constructed contacts 10 to 80.
constexpr std::int64_t kContactsPerUnit = 12;

// Contacts that are exact by construction: one class for each time, place and grid.
void add_contacts(std::vector<QueryClass>& classes) {
  constexpr std::array<const char*, 3> kTimes{"start", "middle", "end"};
  constexpr std::array<const char*, 3> kPlaces{"interior", "edge", "vertex"};
  constexpr std::array<const char*, 2> kGrids{"lattice", "uniform"};
  for (std::size_t time = 0; time < kTimes.size(); ++time) {
    for (std::size_t place = 0; place < kPlaces.size(); ++place) {
      for (std::size_t grid = 0; grid < kGrids.size(); ++grid) {
        const std::string name = std::string("contact-") + kTimes[time] + "-" + kPlaces[place] + "-" + kGrids[grid];
        const auto make = [time, place, grid](ChoiceSource& source, PairKind kind) {
          return make::contact(source, kind, static_cast<ContactTime>(time), static_cast<ContactPlace>(place),
                               static_cast<make::Grid>(grid));
        };
        classes.push_back({'A', kContactsPerUnit, name, make, every_kind(kAlways)});
      }
    }
  }
}

auto scaled_by(int exponent_first, int exponent_last) {
  return [=](ChoiceSource& source, PairKind kind) { return make::scaled(source, kind, exponent_first, exponent_last); };
}

auto mixed_by(int exponent_radius) {
  return [=](ChoiceSource& source, PairKind kind) { return make::mixed_coordinates(source, kind, exponent_radius); };
}

std::vector<QueryClass> make_classes() {
  std::vector<QueryClass> classes;
  add_contacts(classes);
  const std::vector<QueryClass> others = {
      {'B', 320, "lattice-ulp", make::lattice_ulp,
       Bands{HitBand{0.381, 0.516}, HitBand{0.447, 0.604}, HitBand{0.183, 0.248}}},
      {'C', 550, "degenerate", make::degenerate,
       Bands{HitBand{0.402, 0.544}, HitBand{0.521, 0.705}, HitBand{0.428, 0.579}}},
      {'D', 50, "in-plane", make::in_plane, Bands{HitBand{0.497, 0.672}, HitBand{0.661, 0.894}, HitBand{0.356, 0.482}}},
      {'D', 200, "same-velocity", make::same_velocity,
       Bands{HitBand{0.432, 0.584}, HitBand{0.441, 0.597}, HitBand{0.437, 0.592}}},
      {'D', 200, "no-motion", make::no_motion,
       Bands{HitBand{0.436, 0.59}, HitBand{0.447, 0.604}, HitBand{0.427, 0.577}}},
      {'D', 80, "rigid-rotation", make::rigid_rotation,
       Bands{HitBand{0.653, 0.883}, HitBand{0.662, 0.896}, HitBand{0.65, 0.88}}},
      {'E', 60, "sliver", make::sliver, Bands{HitBand{0.634, 0.858}, HitBand{0.637, 0.861}, HitBand{0.647, 0.875}}},
      {'E', 80, "needle", make::needle, Bands{HitBand{0.721, 0.976}, HitBand{0.728, 0.98}, HitBand{0.649, 0.878}}},
      {'F', 130, "short-motion", make::short_motion,
       Bands{HitBand{0.706, 0.956}, HitBand{0.703, 0.951}, HitBand{0.648, 0.877}}},
      {'F', 50, "huge-motion", make::huge_motion,
       Bands{HitBand{0.712, 0.963}, HitBand{0.707, 0.956}, HitBand{0.649, 0.879}}},
      {'H', 90, "double-root", make::double_root,
       Bands{HitBand{0.721, 0.976}, HitBand{0.724, 0.98}, HitBand{0.649, 0.878}}},
      {'H', 75, "triple-root", make::triple_root,
       Bands{HitBand{0.698, 0.945}, HitBand{0.698, 0.944}, HitBand{0.65, 0.88}}},
      {'K', 30, "one-point", make::one_point,
       Bands{HitBand{0.616, 0.833}, HitBand{0.742, 0.98}, HitBand{0.454, 0.615}}},
      {'K', 180, "exchange", make::exchange,
       Bands{HitBand{0.129, 0.175}, HitBand{0.239, 0.324}, HitBand{0.127, 0.172}}},
      {'A', 12, "end-at-tolerance", make::end_at_tolerance,
       Bands{HitBand{0.421, 0.57}, HitBand{0.426, 0.576}, HitBand{0.42, 0.568}}, true},
      {'G', 50, "huge", scaled_by(341, 985),
       Bands{HitBand{0.632, 0.856}, HitBand{0.639, 0.865}, HitBand{0.578, 0.782}}},  // up to kMaxCoordinate =
                                                                                     // 2^1000
      {'G', 50, "tiny", make::tiny, Bands{HitBand{0.636, 0.861}, HitBand{0.633, 0.856}, HitBand{0.568, 0.769}}},
      {'G', 40, "subnormal", scaled_by(-1074, -1040),
       Bands{HitBand{0.643, 0.869}, HitBand{0.651, 0.881}, HitBand{0.563, 0.761}}},
      {'G', 50, "mixed-axes", make::mixed_axes,
       Bands{HitBand{0.637, 0.862}, HitBand{0.637, 0.861}, HitBand{0.57, 0.771}}},
      {'G', 50, "mixed-coordinates", mixed_by(30), Bands{HitBand{0.131, 0.177}, HitBand{0.169, 0.229}, std::nullopt}},
      {'G', 1, "any-exponent", mixed_by(900), Bands{HitBand{0.05, 0.35}, HitBand{0.05, 0.35}, std::nullopt}, false, 64},
      {'I', 3700, "uniform", make::uniform, Bands{HitBand{0.059, 0.08}, HitBand{0.175, 0.236}, std::nullopt}},
      {'J', 22000, "recorded", make::recorded, Bands{HitBand{0.005, 0.06}, HitBand{0.005, 0.06}, std::nullopt}},
      // The last of all: inputs of the byte engines name a class by its place.
      {'L', 230, "resting", make::resting, Bands{HitBand{0.717, 0.971}, HitBand{0.719, 0.972}, HitBand{0.655, 0.887}}},
  };
  classes.insert(classes.end(), others.begin(), others.end());
  return classes;
}

/// A coordinate distance of two end positions: often the exact distance of aligned features.
double axis_distance(ChoiceSource& source, const MotionQuery& query) {
  const std::size_t other = 1 + source.n(static_cast<std::uint32_t>(point_count(query.kind)) - 1);
  return (query.x_t1[0] - query.x_t1[other]).cwiseAbs()[source.range(0, 2)];
}

void choose_options(ChoiceSource& source, MotionQuery& query) {
  if (query.options.tolerance == 0) {
    switch (source.n(8)) {
      case 4:
        query.options.tolerance = 1e-6;
        break;
      case 5:
        query.options.tolerance = std::ldexp(extent(query), -source.range(1, 50));
        break;
      case 6:
        query.options.tolerance = std::ldexp(extent(query), source.range(-4, 2));
        break;
      case 7:
        query.options.tolerance = axis_distance(source, query);
        break;
      default:
        break;
    }
  }
  if (source.one_in(32)) query.options.max_intervals = source.range(1, 64);
}

void repeat_point_of_self(MotionQuery& query) {
  if (query.kind != PairKind::kSelf) return;
  query.x_t0[3] = query.x_t0[0];
  query.x_t1[3] = query.x_t1[0];
}

/// A zero is one number and two bit patterns: kernels that take a minimum, a sign bit or a hash tell them apart.
void choose_signs_of_zero(ChoiceSource& source, MotionQuery& query) {
  if (!source.one_in(8)) return;
  for (auto* const x : {&query.x_t0, &query.x_t1}) {
    for (Vec3& point : *x) {
      for (double& coordinate : point) {
        if (coordinate == 0 && source.coin()) coordinate = -0.0;
      }
    }
  }
}

}  // namespace

const std::vector<QueryGroup>& query_groups() {
  static const std::vector<QueryGroup> groups = {
      {'A', "constructed contacts"},     {'B', "small integers, ulps"},    {'C', "degenerate features"},
      {'D', "in plane, rigid, at rest"}, {'E', "slivers and needles"},     {'F', "short and huge motions"},
      {'G', "scales and exponents"},     {'H', "double and triple roots"}, {'I', "uniform"},
      {'J', "recorded from cloth"},      {'K', "corners that meet"},       {'L', "one feature at rest"}};
  return groups;
}

const std::vector<QueryClass>& query_classes() {
  static const std::vector<QueryClass> classes = make_classes();
  return classes;
}

MotionQuery make_query(const QueryClass& query_class, PairKind kind, ChoiceSource& source) {
  MotionQuery query = query_class.make(source, kind);
  repeat_point_of_self(query);
  choose_options(source, query);
  choose_signs_of_zero(source, query);
  repeat_point_of_self(query);
  return query;
}

}  // namespace selvage::fuzz
