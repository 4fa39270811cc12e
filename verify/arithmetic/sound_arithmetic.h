// Refuses what breaks the filters' proofs and the checks for finite numbers. Each header with inline arithmetic rests
// on this one: a unit's own copy of an inline function may become the program's, the library's calls included. The
// checker has its own because it shares nothing with the kernel (V2).
#pragma once

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) ||                     \
    (defined(__FLT_EVAL_METHOD__) && (__FLT_EVAL_METHOD__ < 0 || __FLT_EVAL_METHOD__ == 2))
#error \
    "the checker's filters are proved for IEEE doubles: do not compile with parts of -ffast-math, or for the x87 unit"
#endif
