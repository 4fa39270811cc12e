#include "sim/scene/contact_reader.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace selvage::sim {
namespace {

constexpr std::array<std::string_view, 4> kKeys{"thickness_m", "tolerance_m", "friction_static", "friction_kinetic"};

}  // namespace

ContactProperties read_contact(TomlTable& table, const ContactProperties& fallback) {
  ContactProperties own = fallback;
  own.thickness_m = table.number("thickness_m", kPositive, fallback.thickness_m);
  own.tolerance_m = table.number("tolerance_m", kNotNegative, fallback.tolerance_m);
  own.friction_static = table.number("friction_static", kNotNegative, fallback.friction_static);
  const bool one_friction = table.has("friction_static") && !table.has("friction_kinetic");
  own.friction_kinetic =
      table.number("friction_kinetic", kNotNegative, one_friction ? own.friction_static : fallback.friction_kinetic);
  if (own.friction_kinetic > own.friction_static) {
    table.fail("friction_kinetic",
               fmt::format("friction_kinetic must not exceed friction_static, which is {}", own.friction_static));
  }
  if (!(own.tolerance_m < own.thickness_m)) {
    table.fail(table.has("tolerance_m") ? "tolerance_m" : "thickness_m",
               "tolerance_m must be below thickness_m; repulsions could not keep it otherwise");
  }
  return own;
}

ContactReader::ContactReader(const CollisionOptions& scene) : scene_(contact_of(scene)) {}

void ContactReader::know(TomlTable& table) {
  for (const std::string_view key : kKeys) table.know({key});
}

std::optional<ContactProperties> ContactReader::read(TomlTable& table, io::Group::Role role) {
  const ContactProperties own = read_contact(table, scene_);
  check_pairs(table, own, role);
  std::vector<ContactProperties>& read_so_far = role == io::Group::Role::kCloth ? cloths_ : bodies_;
  if (std::ranges::find(read_so_far, own) == read_so_far.end()) read_so_far.push_back(own);
  const bool has_own = std::ranges::any_of(kKeys, [&](std::string_view key) { return table.has(key); });
  return has_own ? std::optional(own) : std::nullopt;
}

void ContactReader::check_pairs(const TomlTable& table, const ContactProperties& own, io::Group::Role role) const {
  const auto check = [&](const ContactProperties& other) {
    const ContactProperties pair = combine(own, other);
    if (pair.tolerance_m < pair.thickness_m) return;
    table.fail(table.has("tolerance_m") ? "tolerance_m" : "thickness_m",
               fmt::format("with a part above it has the tolerance {:g} m at the thickness {:g} m; lower the larger "
                           "tolerance_m or raise a thickness_m",
                           pair.tolerance_m, pair.thickness_m));
  };
  std::ranges::for_each(cloths_, check);
  if (role == io::Group::Role::kCloth) std::ranges::for_each(bodies_, check);
}

}  // namespace selvage::sim
