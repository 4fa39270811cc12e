/* How someone else's collision code is put under `selvage fuzz --plugin LIB.so`, and measured by `selvage bench
 * queries` and `bench ccd` with --plugin LIB.so: a shared library that exports
 *
 *     const selvage_plugin* selvage_plugin_entry(void);
 *
 * Plain C; the library needs nothing of Selvage but this file. Smallest example: examples/plugins/boxes.cpp.
 * It is called by one thread at a time. What is judged is what this file says: docs/fuzzing.md, "Your own kernel". */
#ifndef SELVAGE_PLUGIN_H
#define SELVAGE_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of this interface: a plugin says which one it was built with, and another one is refused. */
#define SELVAGE_PLUGIN_VERSION 1

/* Four points that move on straight lines from x_t0 (t = 0) to x_t1 (t = 1). Any finite numbers of at most 2^1000,
 * subnormal ones and both zeros too; points may coincide, triangles and edges be without size, nothing need move.
 * vf: point 0 against the closed triangle of points 1, 2, 3. ee: closed edge (0, 1) against closed edge (2, 3). */
typedef struct {
  double x_t0[4][3], x_t1[4][3];
} selvage_query;

enum { SELVAGE_VF = 0, SELVAGE_EE = 1 };
enum { SELVAGE_SEPARATED = 0, SELVAGE_COLLIDES = 1 };

typedef struct {
  int32_t verdict; /* SELVAGE_SEPARATED: they do not touch at any t in [0,1]; SELVAGE_COLLIDES: they may */
  double toi;      /* where has_toi and SELVAGE_COLLIDES: they do not touch before this time, in [0,1] */
} selvage_answer;

typedef struct {
  uint32_t version; /* SELVAGE_PLUGIN_VERSION */
  const char* name; /* UTF-8; reports show 63 bytes of it */
  /* What an alarm may be off by: `collides` says that the features come within
   * tolerance + relative_tolerance * (largest side of the box of all points at both ends). */
  double tolerance, relative_tolerance;
  int32_t has_toi;
  void (*answer)(int32_t kind, const selvage_query* query, selvage_answer* answer);
  /* For `count` queries of one kind, from 0 up, answers with the bits that `answer` gives to each; may be NULL. */
  void (*answer_batch)(int32_t kind, size_t count, const selvage_query* queries, selvage_answer* answers);
} selvage_plugin;

typedef const selvage_plugin* (*selvage_plugin_entry_function)(void);

/* What the library defines, with this linkage, and visible (-fvisibility=hidden would hide it). */
#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const selvage_plugin*
selvage_plugin_entry(void);

#ifdef __cplusplus
}
#endif

#endif
