#include "bench/stability/trial.h"

#include <array>

#include <fmt/format.h>

namespace selvage::bench {
namespace {

constexpr double kFarLengths = 1e6;  // the offset that the suite names

}  // namespace

int Trial::pick(int coarse, int middle, int fine) const {
  return std::array{coarse, middle, fine}.at(static_cast<std::size_t>(variant().resolution));
}

Vec3 Trial::offset(double length_m) const { return (variant().far ? kFarLengths : 0) * length_m * Vec3(1, -1, 1); }

void Trial::require(bool holds, const std::string& what) {
  if (!holds) throw CriterionFailed(what);
}

void Trial::judge(const Figure& figure) {
  report_.figures.push_back(figure);
  require(figure.holds(), fmt::format("{} = {:.6g}, {} {:g} is asked", figure.name, figure.value,
                                      figure.at_most ? "at most" : "at least", figure.limit));
}

}  // namespace selvage::bench
