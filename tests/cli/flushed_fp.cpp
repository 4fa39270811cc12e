// Linked into a copy of the program, this does what GCC's start-up code for -ffast-math does: FTZ and DAZ before main.
#include "tests/fp_control.h"

namespace {

[[gnu::constructor]] void flush_to_zero() {
  selvage::testing::set_fp_control(selvage::testing::fp_control() | selvage::testing::kFlushing);
}

}  // namespace
