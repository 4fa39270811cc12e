#include "sim/contact/interaction.h"

#include <algorithm>
#include <cmath>

namespace selvage::sim {
namespace {

std::size_t vertex_count(PairKind kind) { return kind == PairKind::kSelf ? 3 : 4; }

}  // namespace

bool is_in_first_feature(PairKind kind, std::size_t i) { return i < (kind == PairKind::kEe ? 2U : 1U); }

std::array<double, 4> signed_weights(PairKind kind, const std::array<double, 4>& weights) {
  std::array<double, 4> result{};
  for (std::size_t i = 0; i < vertex_count(kind); ++i) {
    result[i] = is_in_first_feature(kind, i) ? weights[i] : -weights[i];
  }
  return result;
}

Interaction make_interaction(PairKind kind, const std::array<VertexId, 4>& vertices,
                             const std::array<double, 4>& weights, std::span<const double> inverse_mass) {
  Interaction result{
      .vertices = vertices, .weights = signed_weights(kind, weights), .vertex_count = vertex_count(kind)};
  for (std::size_t i = 0; i < result.vertex_count; ++i) {
    result.mobility[i] = inverse_mass[static_cast<std::size_t>(vertices[i])];
  }
  result.inverse_mass_scale = *std::ranges::max_element(result.mobility);
  if (!(result.inverse_mass_scale > 0)) return result;
  for (double& mobility : result.mobility) {
    mobility /= result.inverse_mass_scale;
    if (mobility < kLeastMobility) mobility = 0;
  }
  return result;
}

PairVectors gather(const Interaction& interaction, const Positions& X) {
  PairVectors x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = X.row(interaction.vertices[i]);
  return x;
}

Vec3 relative(const Interaction& interaction, const PairVectors& x) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i < 4; ++i) sum += interaction.weights[i] * (x[i] - x[0]);
  return sum;
}

double effective_mobility(const Interaction& interaction) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += interaction.weights[i] * interaction.weights[i] * interaction.mobility[i];
  return sum;
}

bool is_closed(const Interaction& interaction) {
  const std::span<const double> mobility(interaction.mobility.data(), interaction.vertex_count);
  return std::ranges::all_of(mobility, [](double m) { return m > 0; });
}

double lever_share(const Interaction& interaction) {
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    longest = std::max(longest, std::abs(interaction.weights[i]) * interaction.mobility[i]);
  }
  longest /= effective_mobility(interaction);
  const double share = kMaxLever / longest;
  return share < 1 ? share * share : 1.0;
}

PairVectors distribute(const Interaction& interaction, const Vec3& change) {
  PairVectors result = zero_vectors();
  const double mobility = effective_mobility(interaction);
  if (!(mobility > 0)) return result;
  const double share = lever_share(interaction);
  for (std::size_t i = 0; i < 4; ++i) {
    result[i] = (share * (interaction.weights[i] * interaction.mobility[i] / mobility)) * change;
  }
  return result;
}

}  // namespace selvage::sim
