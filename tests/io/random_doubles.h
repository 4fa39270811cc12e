// Doubles of every kind from RapidCheck: uniform bits reach all exponents, and the special values come often.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <rapidcheck.h>

#include "io/mesh_data.h"

namespace selvage::testing {

/// Any finite double; a quarter are -0, 0, subnormal ends, or the largest.
inline rc::Gen<double> finite_double() {
  const auto from_bits =
      rc::gen::map(rc::gen::resize(100, rc::gen::arbitrary<std::uint64_t>()), [](std::uint64_t bits) {
        const double value =
            std::bit_cast<double>(bits * 0x9e3779b97f4a7c15);  // spreads the small numbers of RapidCheck
        return std::isfinite(value) ? value : 1.5;
      });
  using Limits = std::numeric_limits<double>;
  const auto special = rc::gen::element(0.0, -0.0, Limits::denorm_min(), -Limits::denorm_min(), Limits::min(),
                                        std::nextafter(Limits::min(), 0.0), Limits::max(), Limits::lowest(), 0.1, 1e23);
  return rc::gen::weightedOneOf<double>({{3, from_bits}, {1, special}});
}

inline rc::Gen<io::Points> finite_points() {
  return rc::gen::container<io::Points>(
      rc::gen::map(rc::gen::tuple(finite_double(), finite_double(), finite_double()), [](const auto& xyz) {
        return std::array<double, 3>{std::get<0>(xyz), std::get<1>(xyz), std::get<2>(xyz)};
      }));
}

/// The nearest float, as a double; values beyond float become 1.5.
inline double to_lattice(double value) {
  const bool fits = std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
  return fits ? static_cast<double>(static_cast<float>(value)) : 1.5;
}

}  // namespace selvage::testing
