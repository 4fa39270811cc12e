"use strict";
/* The meshes of this page (page/scene.h), unpacked when they are needed. */
class SceneSource {
  constructor() {
    const element = document.getElementById("scene");
    Object.assign(this, element ? JSON.parse(element.textContent) : { frames: [], surfaces: [], exponent: 0, radius: 1, origin: [0, 0, 0], bits: 0 });
    this.grids = [];
    this.triangles = [];
    this.indexOf = new Map(this.frames.map((label, i) => [label.frame, i]));
  }

  has(frame) {
    return this.indexOf.has(frame);
  }

  /* A promise of {positions, triangles, cloth}: Float32Array, Uint32Array, how many of the triangles are cloth. */
  async mesh(frame) {
    const i = this.indexOf.get(frame);
    const surface = this.frames[i].surface;
    const [grid, triangles] = await Promise.all([this.grid(i), this.surfaceTriangles(surface)]);
    const positions = new Float32Array(grid.length);
    const step = 2 ** -this.bits;
    for (let k = 0; k < grid.length; ++k) positions[k] = grid[k] * step;
    return { positions, triangles, cloth: this.surfaces[surface].cloth, surface };
  }

  grid(i) {
    this.grids[i] ??= (async () => {
      const values = await unpackIntegers("frame-" + i, 3);
      if (!this.frames[i].predicted) return values;
      const before = await this.grid(i - 1);
      return values.map((difference, k) => (difference + before[k]) | 0);
    })();
    return this.grids[i];
  }

  surfaceTriangles(surface) {
    this.triangles[surface] ??= unpackIntegers("surface-" + surface, 3).then((corners) => new Uint32Array(corners.buffer));
    return this.triangles[surface];
  }

  /* The place at which the view shows a point of the input. */
  toView(point) {
    const half = Math.trunc(this.exponent / 2);
    return point.map((x, k) => (x * 2 ** half * 2 ** (this.exponent - half) - this.origin[k]) / this.radius);
  }
}
