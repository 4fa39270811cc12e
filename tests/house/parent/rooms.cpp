// The headers of every room. The parent has a room called kernel, too: neither takes the other's for its own.
#include <selvage/io/mesh_reader.h>
#include <selvage/kernel/kernel.h>
#include <selvage/sim/collision_step.h>
#include <selvage/verify/check.h>

#include "kernel/types.h"

static_assert(parents_own);
