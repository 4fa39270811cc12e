// kernel.h: the whole public API of the collision kernel, in the order data flows.
//   F, V_t0, V_t1 --(make_mesh, validate)--> Mesh --(BoxHierarchy)--> Candidates --(CcdBatch)--> BatchReport
//   Whole steps  find_collisions (all of the above --> CollisionReport), find_proximities. One pair at a time: vf_ccd,
//                ee_ccd, self_ccd, vf_proximity, ee_proximity, self_proximity. After some vertices have moved, pass
//                them as `active` and keep the other pairs' answers.
//   Positions    #V by 3 doubles in the caller's length unit; |coordinate| <= kMaxCoordinate.
//   Trajectory   x(t) = (1 - t) x_t0 + t x_t1, t in [0, 1]: straight lines, nothing else.
//   tolerance    a length the CALLER chooses; error_bound: a length the KERNEL proves. Never mixed in one name.
//   Answers      kSeparated is a proof about the real trajectories of the stored doubles, rounding included.
//   Failure      bad input: InputError from validate(), which whole steps REQUIRE to be kNone: without it they stop the
//                program (SELVAGE_REQUIRE). Limit reached: kUnresolved. Broken invariant: SELVAGE_ASSERT.
//                Nothing throws but std::bad_alloc (whole meshes need memory), prints but what stops the program, or
//                reads a clock; equal bits in give equal bits out.
//   K1, S1, V1   and the like, wherever they stand, are promises: docs/guarantee.md.
#pragma once

#include "kernel/box_hierarchy.h"
#include "kernel/candidates.h"
#include "kernel/ccd.h"
#include "kernel/ccd_batch.h"
#include "kernel/collisions.h"
#include "kernel/fp_env.h"
#include "kernel/input_error.h"
#include "kernel/mesh.h"
#include "kernel/proximities.h"
#include "kernel/proximity.h"
#include "kernel/types.h"
