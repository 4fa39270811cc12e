"use strict";
/* Linear light, as in `selvage render`: warm and cool differ in brightness too. */
const kClothFront = [0.68, 0.14, 0.045], kClothBack = [0.035, 0.17, 0.36], kBody = [0.40, 0.40, 0.42];

/* The 3D view: one mesh that may move between two frames, and one pair. Draws only when something has changed. */
class Viewer {
  constructor(box) {
    this.box = box;
    this.canvas = box.querySelector("canvas");
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true });
    this.scene = new THREE.Scene();
    this.camera = new OrbitCamera(this.canvas, () => this.draw());
    this.geometry = null;
    this.meshes = [];
    this.pair = null;
    this.time = 0;
    this.showsEdges = false;
    this.wanted = false;
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.dark.addEventListener("change", () => this.showPair(this.pair));
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    this.bindBar();
  }

  bindBar() {
    const on = (name, event, action) => this.box.querySelector(`[data-do=${name}]`)?.addEventListener(event, action);
    on("overview", "click", () => this.overview());
    on("edges", "change", (event) => {
      this.showsEdges = event.target.checked;
      this.draw();
    });
    on("up", "change", (event) => this.camera.setUp(event.target.value));
    this.camera.up = this.box.querySelector("[data-do=up]").value;
    this.canvas.addEventListener("keydown", (event) => {
      if (event.key === "0") this.overview();
    });
  }

  overview() {
    this.camera.flyTo([0, 0, 0], 1.05, null);
  }

  /* {positions, triangles, cloth} as SceneSource.mesh() gives them, or null; `later`: where the vertices go till t = 1. */
  showMesh(mesh, later) {
    if (this.geometry && this.from?.triangles !== mesh?.triangles) this.removeMesh();
    this.from = mesh;
    this.to = later ?? null;
    if (mesh && !this.geometry) this.makeMesh(mesh);
    this.setTime(0);
  }

  removeMesh() {
    for (const object of this.meshes) {
      this.scene.remove(object);
      for (const material of object.material) material.dispose();
    }
    this.geometry.dispose();
    this.geometry = null;
  }

  makeMesh(mesh) {
    const geometry = new THREE.BufferGeometry();
    for (const name of ["position", "normal"]) {
      geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(mesh.positions.length), 3));
    }
    geometry.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
    geometry.addGroup(0, 3 * mesh.cloth, 0);
    geometry.addGroup(3 * mesh.cloth, mesh.triangles.length - 3 * mesh.cloth, 1);
    const solid = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };  /* so that edges lie in front */
    this.cloth = materials.surface(kClothFront, kClothBack, solid);
    this.body = materials.surface(kBody, kBody, solid);
    this.wire = materials.wire([0, 0, 0], 0.28);
    this.meshes = [[this.cloth, this.body], [this.wire, this.wire]].map((material) => new THREE.Mesh(geometry, material));
    for (const object of this.meshes) {
      object.frustumCulled = false;
      this.scene.add(object);
    }
    this.geometry = geometry;
  }

  /* {ends, features, touch} as PairView takes them, or null. */
  showPair(pair) {
    if (this.pair) {
      this.pair.dispose();
      this.scene.remove(this.pair.object);
    }
    this.pair = pair ? new PairView(pair, this.dark.matches, devicePixelRatio) : null;
    if (this.pair) this.scene.add(this.pair.object);
    this.setTime(this.time);
  }

  flyToPair() {
    const direction = this.pair.direction();
    this.camera.flyTo(this.pair.middle, this.pair.radius * 1.8, direction);
  }

  setTime(t) {
    this.time = t;
    this.pair?.setTime(t);
    if (this.geometry) this.move(t);
    this.draw();
  }

  move(t) {
    const position = this.geometry.attributes.position;
    const start = this.from.positions, end = this.to?.positions ?? start;
    for (let k = 0; k < start.length; ++k) position.array[k] = (1 - t) * start[k] + t * end[k];
    addNormals(position.array, this.from.triangles, this.geometry.attributes.normal.array);
    position.needsUpdate = true;
    this.geometry.attributes.normal.needsUpdate = true;
  }

  draw() {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.drawNow();
    });
  }

  drawNow() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(devicePixelRatio);
    this.renderer.setSize(width, height, false);
    this.camera.apply(width / height);
    if (this.geometry) this.style();
    this.scene.traverse((object) => {
      if (object.material?.uniforms?.viewport) object.material.uniforms.viewport.value = [width * devicePixelRatio, height * devicePixelRatio];
    });
    this.renderer.render(this.scene, this.camera.lens);
    this.box.dataset.camera = this.camera.lens.position.toArray().map((x) => x.toPrecision(4)).join(" ");
    this.box.dataset.draws = Number(this.box.dataset.draws ?? 0) + 1;
  }

  /* With a pair the cloth is its background: grey, and only a hint of it where it is far from the pair. */
  style() {
    const grey = this.dark.matches ? [0.20, 0.21, 0.23] : [0.50, 0.51, 0.53];
    const focus = this.pair ? [...this.camera.toLens(this.pair.middle), this.pair.radius * 2] : [0, 0, 0, 0];
    this.cloth.uniforms.front.value = this.pair ? grey : kClothFront;
    this.cloth.uniforms.back.value = this.pair ? vector.times(0.75, grey) : kClothBack;
    for (const material of [this.cloth, this.body]) {
      material.transparent = Boolean(this.pair);
      material.depthWrite = !this.pair;
      material.uniforms.opacity.value = this.pair ? 0.62 : 1;
      material.uniforms.focus.value = focus;
    }
    this.wire.uniforms.focus.value = focus;
    this.wire.uniforms.front.value = this.dark.matches && this.pair ? [1, 1, 1] : [0, 0, 0];
    this.wire.uniforms.opacity.value = this.dark.matches ? 0.18 : 0.28;
    this.wire.visible = this.showsEdges || Boolean(this.pair);
  }
}

/* Vertex normals weighted by area, not of length one. */
function addNormals(x, triangles, normals) {
  normals.fill(0);
  for (let f = 0; f < triangles.length; f += 3) {
    const a = 3 * triangles[f], b = 3 * triangles[f + 1], c = 3 * triangles[f + 2];
    const ux = x[b] - x[a], uy = x[b + 1] - x[a + 1], uz = x[b + 2] - x[a + 2];
    const vx = x[c] - x[a], vy = x[c + 1] - x[a + 1], vz = x[c + 2] - x[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    normals[a] += nx; normals[a + 1] += ny; normals[a + 2] += nz;
    normals[b] += nx; normals[b + 1] += ny; normals[b + 2] += nz;
    normals[c] += nx; normals[c + 1] += ny; normals[c + 2] += nz;
  }
  for (let k = 0; k < normals.length; k += 3) {
    const length = Math.hypot(normals[k], normals[k + 1], normals[k + 2]);
    if (length > 0) for (let axis = 0; axis < 3; ++axis) normals[k + axis] /= length;
  }
}

/* A promise of a Viewer, or of null with the reason shown in the box. three.js is unpacked first. */
async function startViewer(box) {
  try {
    const script = document.createElement("script");
    script.textContent = new TextDecoder().decode(await unpack("three"));
    document.head.append(script);
    return new Viewer(box);
  } catch (error) {
    box.querySelector(".message").textContent =
      "There is no 3D view: it needs WebGL 2 and a browser of 2023 or later (" + error.message + ").";
    return null;
  }
}
