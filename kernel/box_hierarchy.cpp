#include "kernel/box_hierarchy.h"

#include "kernel/assert.h"
#include "kernel/fp_env.h"
#include "kernel/pair_finder.h"

namespace selvage {

struct BoxHierarchy::Impl {
  explicit Impl(const Mesh& own_mesh) : mesh(own_mesh), clusters(make_face_clusters(mesh)), boxes(mesh, clusters) {}

  const Mesh& mesh;
  FaceClusters clusters;
  FittedBoxes boxes;
  bool fitted = false;
};

BoxHierarchy::BoxHierarchy(const Mesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
BoxHierarchy::~BoxHierarchy() = default;
BoxHierarchy::BoxHierarchy(BoxHierarchy&&) noexcept = default;
BoxHierarchy& BoxHierarchy::operator=(BoxHierarchy&&) noexcept = default;

void BoxHierarchy::refit(const PositionsRef& V_t0, const PositionsRef& V_t1, const CandidateOptions& options) {
  const FpEnvGuard guard;
  impl_->boxes.refit(impl_->mesh, impl_->clusters, V_t0, V_t1, options);
  impl_->fitted = true;
}

Candidates BoxHierarchy::candidates() const {
  const FpEnvGuard guard;
  SELVAGE_ASSERT(impl_->fitted);
  return find_pairs(impl_->mesh, impl_->clusters, impl_->boxes);
}

}  // namespace selvage
