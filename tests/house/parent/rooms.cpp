// The headers of every room, by the names that they have installed; and beside them by those that Selvage itself uses.
#include <selvage/io/mesh_reader.h>
#include <selvage/kernel/kernel.h>
#include <selvage/sim/collision_step.h>
#include <selvage/verify/check.h>

#include "kernel/kernel.h"
