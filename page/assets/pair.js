"use strict";
/* Two features and their motion, drawn on top of the cloth; each hides the other where it lies in front of it. */
const kPairColours = { light: ["#d55e00", "#0072b2"], dark: ["#ff8f4a", "#56b4e9"] };

/* Positions of strips (materials.line) along the segments, which are pairs of points. */
function strips(segments) {
  const geometry = new THREE.BufferGeometry();
  const position = [], other = [], side = [], index = [];
  for (const [a, b] of segments) {
    const first = side.length;
    position.push(...a, ...a, ...b, ...b);
    other.push(...b, ...b, ...a, ...a);
    side.push(1, -1, -1, 1);
    index.push(first, first + 1, first + 2, first + 2, first + 1, first + 3);
  }
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(position), 3));
  geometry.setAttribute("other", new THREE.BufferAttribute(new Float32Array(other), 3));
  geometry.setAttribute("side", new THREE.BufferAttribute(new Float32Array(side), 1));
  geometry.setIndex(index);
  return geometry;
}

function pointsOf(points) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points.flat()), 3));
  return geometry;
}

function triangleOf(corners) {
  const geometry = pointsOf(corners);
  const normal = vector.cross(vector.subtract(corners[1], corners[0]), vector.subtract(corners[2], corners[0]));
  const unit = vector.unit(normal, [0, 0, 0]);
  geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array([...unit, ...unit, ...unit]), 3));
  return geometry;
}

class PairView {
  /* ends: the vertices at t = 0 and at t = 1, in view units; features: two lists of indices into them; touch: when. */
  constructor({ ends, features, touch }, isDark, pixelRatio) {
    this.ends = ends;
    this.features = features;
    this.touch = touch;
    this.middle = [0, 0, 0];
    this.colours = kPairColours[isDark ? "dark" : "light"].map(linear);
    this.quiet = linear(isDark ? "#a2aab5" : "#5c6470");
    this.pixelRatio = pixelRatio;
    this.object = new THREE.Group();
    const points = this.at(touch);
    this.middle = vector.times(1 / points.length, points.reduce(vector.add));
    const reach = (list) => Math.max(...list.map((p) => vector.length(vector.subtract(p, this.middle))));
    this.radius = Math.max(reach(points), reach([...ends[0], ...ends[1]]) / 4) || 1e-6;  /* a long way may leave the picture */
    this.moves = ends[0].some((p, i) => vector.length(vector.subtract(p, ends[1][i])) > 0);
    this.object.position.set(...this.middle);  /* so that single precision is about the pair, not about the scene */
  }

  at(t) {
    return this.ends[0].map((p, i) => vector.subtract(vector.mix(p, this.ends[1][i], t), this.middle));
  }

  setTime(t) {
    this.dispose();
    const points = this.at(t);
    const scale = this.pixelRatio;
    const add = (Kind, geometry, material, order) => {
      const object = new Kind(geometry, material);
      object.renderOrder = order;
      object.frustumCulled = false;
      this.object.add(object);
    };
    const through = { transparent: true, depthTest: false, depthWrite: false };
    this.features.forEach((feature, which) => {
      const colour = this.colours[which];
      const corners = feature.map((i) => points[i]);
      if (corners.length === 3) add(THREE.Mesh, triangleOf(corners), materials.flat(colour, 0.75), 5);
      if (corners.length > 1) {
        const ring = corners.length === 2 ? [corners] : corners.map((p, i) => [p, corners[(i + 1) % 3]]);
        const width = (corners.length === 2 ? 6 : 3) * scale;
        add(THREE.Mesh, strips(ring), materials.line(colour, width, 1), 7);
        add(THREE.Mesh, strips(ring), materials.line(colour, width, 0.35, through), 6);
      } else {
        add(THREE.Points, pointsOf(corners), materials.point(colour, 15 * scale, 1, through), 8);
      }
    });
    if (!this.moves) return;
    const start = this.at(0), end = this.at(1);
    add(THREE.Mesh, strips(start.map((p, i) => [p, end[i]])), materials.line(this.quiet, 1.5 * scale, 0.7, through), 4);
  }

  /* From where both features are seen best: across the first, above the second. */
  direction() {
    const points = this.at(this.touch);
    const normals = this.features.filter((feature) => feature.length === 3)
      .map(([a, b, c]) => vector.unit(vector.cross(vector.subtract(points[b], points[a]), vector.subtract(points[c], points[a])), null))
      .filter((normal) => normal);
    const edges = this.features.map((feature) => vector.subtract(points[feature.at(-1)], points[feature[0]]));
    let up = normals.at(-1) ?? vector.unit(vector.cross(edges[0], edges[1]), null);
    if (!up) return null;
    const along = normals.length === 2 ? vector.cross(normals[0], normals[1]) : edges[1];
    const across = vector.unit(along, vector.unit(vector.cross(up, [0.36, 0.48, 0.8]), [1, 0, 0]));
    return vector.unit(vector.add(vector.times(0.55, up), vector.times(0.8, across)), up);
  }

  dispose() {
    for (const child of [...this.object.children]) {
      this.object.remove(child);
      child.geometry.dispose();
      child.material.dispose();
    }
  }
}
