// CGAL's control of the processor's rounding, to be included before all else of CGAL: without an object that, as a
// program ends, aborts it where its rounding mode is another than at the start. A host of the checker may set its own.
#pragma once

#include <CGAL/assertions.h>

#ifdef CGAL_NDEBUG
#include <CGAL/FPU.h>
#else
#define CGAL_NDEBUG  // for that object alone: the assertions of CGAL are defined by now, and stay
#include <CGAL/FPU.h>
#undef CGAL_NDEBUG
#endif
