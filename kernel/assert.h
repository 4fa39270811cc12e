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

/// What a function REQUIRES of its caller, where it is cheap beside what the function does.
#define SELVAGE_REQUIRE(condition)                                                                               \
  do {                                                                                                           \
    if (!(condition)) {                                                                                          \
      std::fprintf(stderr, "selvage: %s is called without what it requires: %s; its header says what that is\n", \
                   __func__, #condition);                                                                        \
      std::abort();                                                                                              \
    }                                                                                                            \
  } while (false)
