// The smallest plugin, of nothing but the header: features are separated where the boxes of their ways are apart. So it
// misses nothing and alarms by far too often, which it declares.
#include "selvage-plugin.h"

namespace {

struct Interval {
  double min, max;
};

/// Along `axis`, of the points from `begin` to `end`, all the way.
Interval way(const selvage_query& query, int begin, int end, int axis) {
  Interval result = {query.x_t0[begin][axis], query.x_t0[begin][axis]};
  for (int i = begin; i < end; ++i) {
    const double ends[] = {query.x_t0[i][axis], query.x_t1[i][axis]};
    for (const double x : ends) {
      if (x < result.min) result.min = x;
      if (x > result.max) result.max = x;
    }
  }
  return result;
}

void answer(int32_t kind, const selvage_query* query, selvage_answer* answer) {
  const int second = kind == SELVAGE_VF ? 1 : 2;  // its first point
  answer->verdict = SELVAGE_COLLIDES;
  for (int axis = 0; axis < 3; ++axis) {
    const Interval a = way(*query, 0, second, axis), b = way(*query, second, 4, axis);
    if (a.max < b.min || b.max < a.min) answer->verdict = SELVAGE_SEPARATED;
  }
}

}  // namespace

extern "C" const selvage_plugin* selvage_plugin_entry(void) {
  // Points in one box are at most its diagonal apart: sqrt(3) of its largest side.
  static const selvage_plugin plugin = {SELVAGE_PLUGIN_VERSION, "boxes", 0, 2, 0, answer, nullptr};
  return &plugin;
}
