// Reads what a part of a scene says about its contacts. Internal to the scene reader.
#pragma once

#include <optional>
#include <vector>

#include "io/mesh_data.h"
#include "sim/scene/toml_table.h"

namespace selvage::sim {

/// What the table says of contacts; of what it does not say, `fallback`, but a friction that stands alone is both.
/// Throws io::Error where the kinetic friction is above the static one, or the tolerance not below the thickness.
[[nodiscard]] ContactProperties read_contact(TomlTable& table, const ContactProperties& fallback);

class ContactReader {
 public:
  explicit ContactReader(const CollisionOptions& scene);

  /// The keys of read_contact().
  static void know(TomlTable& table);

  /// The part's own properties, where it has a key for one of them; the others are the scene's. Throws io::Error where
  /// the tolerance does not stay below the thickness, with the part itself and with every part read before that it can
  /// meet: two bodies never do.
  [[nodiscard]] std::optional<ContactProperties> read(TomlTable& table, io::Group::Role role);

 private:
  void check_pairs(const TomlTable& table, const ContactProperties& own, io::Group::Role role) const;

  ContactProperties scene_;
  std::vector<ContactProperties> cloths_, bodies_;  ///< those read so far, each once
};

}  // namespace selvage::sim
