#include "sim/contact/contact_properties.h"

#include <algorithm>
#include <cmath>

#include "kernel/types.h"

namespace selvage::sim {
namespace {

bool is_length(double value) { return value >= 0 && value <= kMaxCoordinate; }  // false for NaN
bool is_coefficient(double value) { return value >= 0 && std::isfinite(value); }

}  // namespace

ContactProperties combine(const ContactProperties& a, const ContactProperties& b) {
  // sqrt(m m) is m to the bit, and the root of a rounded product is monotone: kinetic stays at most static.
  return {.thickness_m = (a.thickness_m + b.thickness_m) / 2,
          .tolerance_m = std::max(a.tolerance_m, b.tolerance_m),
          .friction_static = std::sqrt(a.friction_static * b.friction_static),
          .friction_kinetic = std::sqrt(a.friction_kinetic * b.friction_kinetic)};
}

std::string_view first_bad_value(const ContactProperties& p) {
  if (!is_length(p.thickness_m)) return "thickness_m";
  if (!is_length(p.tolerance_m)) return "tolerance_m";
  if (!is_coefficient(p.friction_static)) return "friction_static";
  if (!is_coefficient(p.friction_kinetic) || p.friction_kinetic > p.friction_static) return "friction_kinetic";
  return {};
}

}  // namespace selvage::sim
