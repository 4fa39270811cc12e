#include "sim/base/lattice.h"

#include <algorithm>
#include <limits>

namespace selvage::sim {

double to_lattice(double x, Precision precision) {
  if (precision == Precision::kFloat64) return std::clamp(x, -kMaxCoordinate, kMaxCoordinate);
  constexpr double kMaxFloat = static_cast<double>(std::numeric_limits<float>::max());
  return static_cast<double>(static_cast<float>(std::clamp(x, -kMaxFloat, kMaxFloat)));
}

Positions to_lattice(const PositionsRef& x, Precision precision) {
  return x.unaryExpr([precision](double value) { return to_lattice(value, precision); });
}

Positions rounded(Positions x, Precision precision) {
  if (precision == Precision::kFloat32) x = x.cast<float>().cast<double>().eval();
  return x;
}

}  // namespace selvage::sim
