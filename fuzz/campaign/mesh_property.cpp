#include "fuzz/campaign/mesh_property.h"

#include "fuzz/shrink/shrink_choices.h"
#include "fuzz/shrink/shrink_mesh.h"

namespace selvage::fuzz {
namespace {

constexpr std::int64_t kMeshChoiceTrials = 300;  // each takes milliseconds

}  // namespace

std::string MeshProperty::kept(const Stream& stream, ChoiceSource source, const std::string& origin,
                               const std::string& failure, bool shrunk) {
  if (!shrunk) return kept_text(KeptMesh(drawn(stream, source)), origin, failure);
  const Choices choices = shrink_choices(
      source, failure, [&](ChoiceSource simpler) { return run(stream, simpler).failure; }, kMeshChoiceTrials);
  const MeshCase simplest = drawn(stream, ChoiceSource::from_words(choices));
  return kept_text(KeptMesh(shrink(simplest, failure)), origin, failure);
}

}  // namespace selvage::fuzz
