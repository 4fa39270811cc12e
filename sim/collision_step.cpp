#include "sim/collision_step.h"
