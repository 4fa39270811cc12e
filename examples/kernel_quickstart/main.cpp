// A triangle falls onto another one: which features collide, and until when is the motion certified free of touch?
#include <cstdio>

#include <selvage/kernel/kernel.h>

const char* name_of(selvage::PairKind kind) {
  switch (kind) {
    case selvage::PairKind::kVf:
      return "vertex, face";
    case selvage::PairKind::kEe:
      return "edge, edge";
    case selvage::PairKind::kSelf:
      return "vertex, its own face";
  }
  return "";
}

int main() {
  selvage::Faces F(2, 3);
  F << 0, 1, 2, 3, 4, 5;
  selvage::Positions V_t0(6, 3), V_t1(6, 3);
  V_t0 << 0, 0, 0, 1, 0, 0, 0, 1, 0,            // the floor
      0.2, 0.2, 1, 0.4, 0.2, 1, 0.2, 0.4, 1.5;  // above it
  V_t1 = V_t0;
  V_t1.bottomRows(3).col(2).array() -= 2.0;  // falls through in one step

  if (selvage::validate_faces(6, F) != selvage::InputError::kNone) return 2;
  const selvage::Mesh mesh = selvage::make_mesh(6, F);
  if (const auto error = selvage::validate(mesh, V_t0, V_t1); error != selvage::InputError::kNone) {
    std::puts(selvage::describe(error));
    return 2;
  }
  selvage::BoxHierarchy hierarchy(mesh);
  const auto report = selvage::find_collisions(mesh, hierarchy, V_t0, V_t1, {.tolerance = 1e-6});
  for (const auto& hit : report.collisions) {
    std::printf("%s %d %d collide at t >= %.17g\n", name_of(hit.kind), hit.first, hit.second, hit.ccd.toi_lower);
  }
  std::printf("no touch before t = %.17g\n", report.toi_lower);
  return report.collisions.empty() ? 1 : 0;
}
