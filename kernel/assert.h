// Assertions. Cheap ones stay on in release: a wrong state stops the program rather than producing a wrong certificate.
#pragma once

#include <cstdio>
#include <cstdlib>

#define SELVAGE_ASSERT(condition)                                                                                  \
  do {                                                                                                             \
    if (!(condition)) {                                                                                            \
      std::fprintf(stderr, "selvage: internal error: %s does not hold (%s:%d)\n", #condition, __FILE__, __LINE__); \
      std::abort();                                                                                                \
    }                                                                                                              \
  } while (false)

#ifdef SELVAGE_ENABLE_VALIDATE
#define SELVAGE_VALIDATE(condition) SELVAGE_ASSERT(condition)
#else
#define SELVAGE_VALIDATE(condition) static_cast<void>(0)
#endif
