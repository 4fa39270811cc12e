"use strict";
/* Points and directions as arrays of three doubles. */
const vector = {
  add: (a, b) => a.map((x, k) => x + b[k]),
  subtract: (a, b) => a.map((x, k) => x - b[k]),
  times: (s, a) => a.map((x) => s * x),
  mix: (a, b, t) => a.map((x, k) => (1 - t) * x + t * b[k]),
  dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  length: (a) => Math.hypot(...a),
  /* Of length one; `otherwise` where it has no direction. */
  unit: (a, otherwise) => {
    const length = Math.hypot(...a);
    return length > 0 && Number.isFinite(length) ? a.map((x) => x / length) : otherwise;
  },
};
