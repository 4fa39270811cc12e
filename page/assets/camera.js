"use strict";
/* An orbit about a target: drag to turn, shift or right button to move, wheel to go nearer; arrow keys, + and - too. */
class OrbitCamera {
  constructor(canvas, changed) {
    this.lens = new THREE.PerspectiveCamera(38, 1, 0.01, 100);
    this.changed = changed;
    this.up = "z";
    this.place = { target: [0, 0, 0], distance: 3.2, azimuth: -0.96, elevation: 0.42 };
    this.flight = 0;
    this.listen(canvas);
  }

  /* A direction in the scene from one in which up is the third axis. */
  fromUp([x, y, z]) {
    return this.up === "z" ? [x, y, z] : [x, z, -y];
  }
  toUp([x, y, z]) {
    return this.up === "z" ? [x, y, z] : [x, -z, y];
  }

  setUp(up) {
    this.up = up;
    this.changed();
  }

  apply(aspect) {
    const { target, distance, azimuth, elevation } = this.place;
    const towards = this.fromUp([Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation)]);
    this.lens.position.set(...vector.add(target, vector.times(distance, towards)));
    this.lens.up.set(...this.fromUp([0, 0, 1]));
    this.lens.lookAt(...target);
    this.lens.near = distance / 50;
    this.lens.far = distance * 3 + 200;
    this.lens.aspect = aspect;
    this.lens.updateProjectionMatrix();
    this.lens.updateMatrixWorld();
  }

  /* A point as the lens sees it: to the right, upwards, backwards. REQUIRES apply(). */
  toLens([x, y, z]) {
    const e = this.lens.matrixWorldInverse.elements;
    return [0, 1, 2].map((k) => e[k] * x + e[k + 4] * y + e[k + 8] * z + e[k + 12]);
  }

  /* Turns so that the view is against `direction`, at a distance at which `radius` about the target fits. */
  flyTo(target, radius, direction) {
    const goal = { ...this.place, target, distance: radius / Math.sin((19 * Math.PI) / 180) };
    if (direction) {
      const [x, y, z] = this.toUp(direction);
      goal.azimuth = Math.atan2(y, x);
      goal.elevation = Math.max(-1.45, Math.min(1.45, Math.asin(Math.max(-1, Math.min(1, z)))));
      const turns = Math.round((this.place.azimuth - goal.azimuth) / (2 * Math.PI));
      goal.azimuth += 2 * Math.PI * turns;
    }
    const start = this.place;
    const flight = ++this.flight;
    const begin = performance.now();
    const duration = matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : 700;
    const step = (now) => {
      if (flight !== this.flight) return;
      const s = duration > 0 ? Math.min(1, Math.max(0, (now - begin) / duration)) : 1;
      const t = s * s * (3 - 2 * s);
      const mix = (a, b) => a + (b - a) * t;
      this.place = {
        target: vector.mix(start.target, goal.target, t),
        distance: Math.exp(mix(Math.log(start.distance), Math.log(goal.distance))),
        azimuth: mix(start.azimuth, goal.azimuth),
        elevation: mix(start.elevation, goal.elevation),
      };
      this.changed();
      if (s < 1) requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  turn(across, upwards) {
    this.flight++;
    this.place.azimuth -= across;
    this.place.elevation = Math.max(-1.55, Math.min(1.55, this.place.elevation + upwards));
    this.changed();
  }
  move(right, upwards) {
    this.flight++;
    const e = this.lens.matrixWorld.elements;
    const scale = this.place.distance;
    const shift = vector.add(vector.times(-right * scale, [e[0], e[1], e[2]]), vector.times(upwards * scale, [e[4], e[5], e[6]]));
    this.place.target = vector.add(this.place.target, shift);
    this.changed();
  }
  approach(factor) {
    this.flight++;
    this.place.distance = Math.max(1e-9, Math.min(1e5, this.place.distance * factor));
    this.changed();
  }

  listen(canvas) {
    const pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    const release = (event) => pointers.delete(event.pointerId);
    canvas.addEventListener("pointerup", release);
    canvas.addEventListener("pointercancel", release);
    canvas.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const across = (event.clientX - before[0]) / canvas.clientHeight, down = (event.clientY - before[1]) / canvas.clientHeight;
      if (pointers.size === 2) {
        const [other] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
        const span = (place) => Math.hypot(place[0] - other[0], place[1] - other[1]);
        this.approach(span(before) / Math.max(1, span([event.clientX, event.clientY])));
      } else if (event.shiftKey || event.buttons === 2 || event.buttons === 4) {
        this.move(across * 0.7, down * 0.7);
      } else {
        this.turn(across * 4, down * 4);
      }
      pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.approach(Math.exp(Math.max(-0.5, Math.min(0.5, event.deltaY * 0.0012))));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const keys = {
        ArrowLeft: () => this.turn(-0.15, 0), ArrowRight: () => this.turn(0.15, 0), ArrowUp: () => this.turn(0, 0.15),
        ArrowDown: () => this.turn(0, -0.15), "+": () => this.approach(0.8), "=": () => this.approach(0.8), "-": () => this.approach(1.25),
      };
      if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      keys[event.key]();
    });
  }
}
