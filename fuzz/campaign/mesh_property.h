// A property whose cases are meshes, known as soon as they are drawn: how such a case is kept.
#pragma once

#include "fuzz/campaign/property.h"
#include "fuzz/kept/mesh_case.h"

namespace selvage::fuzz {

class MeshProperty : public Property {
 public:
  using Property::Property;

  /// Shrunk by its choices first, then as a mesh.
  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool shrunk) final;

 private:
  [[nodiscard]] virtual MeshCase drawn(const Stream& stream, ChoiceSource source) const = 0;
};

}  // namespace selvage::fuzz
