// Queries of every kind, constructed and random, which take the search through all its branches.
#pragma once

#include <array>

#include "kernel/ccd.h"
#include "tests/kernel/constructed_contact.h"
#include "tests/kernel/pair_kinds.h"
#include "tests/kernel/random_points.h"

namespace selvage::testing {

using Points = std::array<Vec3, 4>;

inline constexpr CcdOptions kNoTolerance{0, 4096};

inline ConstructedContact contact_of(PairKind kind, ContactGenerator& generator, int bits) {
  return kind == PairKind::kVf ? generator.vf(bits) : kind == PairKind::kEe ? generator.ee(bits) : generator.self(bits);
}

/// A query of a random class, so that all branches of the search take part.
inline ConstructedContact random_query(Random& random, ContactGenerator& generator, PairKind kind) {
  ConstructedContact query = contact_of(kind, generator, 8);
  switch (random.integer(0, 5)) {
    case 0:
      break;
    case 1:
      for (Vec3& p : query.x_t1) p += 0.5 * detail::to_vec3(random.point());
      break;
    case 2:
      for (Points* x : {&query.x_t0, &query.x_t1}) {
        for (Vec3& p : *x) p = detail::to_vec3(random.point());
      }
      break;
    case 3:
      for (Points* x : {&query.x_t0, &query.x_t1}) {
        for (Vec3& p : *x) p[2] = 1;
      }
      break;
    case 4:
      query.x_t1 = query.x_t0;
      break;
    default:
      query.x_t0[2] = query.x_t0[1];
      query.x_t1[2] = query.x_t1[1];
  }
  return query;
}

}  // namespace selvage::testing
