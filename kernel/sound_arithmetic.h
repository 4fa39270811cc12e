// Refuses what breaks every proven bound. Each header with inline arithmetic rests on this one: a unit's own copy of an
// inline function may become the program's, the library's calls included.
#pragma once

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error "selvage: fast-math breaks every proven bound; compile without -ffast-math, -Ofast, and each of their parts"
#endif
#if defined(__FLT_EVAL_METHOD__) && (__FLT_EVAL_METHOD__ < 0 || __FLT_EVAL_METHOD__ == 2)
#error "selvage: doubles must be computed as doubles; compile for SSE (-mfpmath=sse), not for the x87 unit"
#endif
