"use strict";
/* Shaders of the 3D view. Colours are linear until the last line of each. */
const kSurfaceVertex = `
precision highp float;
in vec3 position, normal;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform mat3 normalMatrix;
out vec3 viewNormal, viewPosition;
void main() {
  vec4 p = modelViewMatrix * vec4(position, 1.0);
  viewNormal = normalMatrix * normal;
  viewPosition = p.xyz;
  gl_Position = projectionMatrix * p;
}`;
/* What is farther from a focus than its radius, w, fades to a hint of itself; no radius, no focus. */
const kFade = `
float fade(vec3 position, vec4 focus) {
  float distance_in_radii = focus.w > 0.0 ? length(position - focus.xyz) / focus.w : 0.0;
  return mix(1.0, 0.035, smoothstep(0.8, 2.6, distance_in_radii));
}`;
/* Light over the viewer's left shoulder and from above; where a vertex has no normal, that of the triangle. */
const kSurfaceFragment = `
precision highp float;
in vec3 viewNormal, viewPosition;
uniform vec3 front, back;
uniform float opacity;
uniform vec4 focus;
out vec4 colour;
${kFade}
void main() {
  vec3 flat_normal = cross(dFdx(viewPosition), dFdy(viewPosition));
  float length_squared = dot(viewNormal, viewNormal);
  vec3 n = length_squared > 1e-12 ? viewNormal * inversesqrt(length_squared) : normalize(flat_normal);
  if (dot(n, viewPosition) > 0.0) n = -n;
  float sun = max(dot(n, vec3(-0.56, 0.60, 0.57)), 0.0);
  float sky = 0.5 + 0.5 * n.y;
  float rim = 1.0 - abs(dot(n, normalize(viewPosition)));
  vec3 light = (gl_FrontFacing ? front : back) * (0.10 + 0.22 * sky + 0.85 * sun) + 0.05 * rim * rim;
  colour = vec4(pow(light, vec3(1.0 / 2.2)), opacity * fade(viewPosition, focus));
}`;
/* A segment as a strip some pixels wide: every vertex knows both ends and its side. Lifted a little towards the viewer. */
const kLineVertex = `
precision highp float;
in vec3 position, other;
in float side;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform vec2 viewport;
uniform float width;
void main() {
  vec4 here = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  vec4 there = projectionMatrix * modelViewMatrix * vec4(other, 1.0);
  vec2 along = (there.xy / there.w - here.xy / here.w) * viewport;
  float pixels = length(along);
  along = pixels > 0.0 ? along / pixels : vec2(1.0, 0.0);
  here.xy += (vec2(-along.y, along.x) * side - along * 0.5) * width / viewport * here.w;
  here.z -= 1e-4 * here.w;
  gl_Position = here;
}`;
const kPointVertex = `
precision highp float;
in vec3 position;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform float width;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z -= 2e-4 * gl_Position.w;
  gl_PointSize = width;
}`;
const kWireFragment = `
precision highp float;
in vec3 viewPosition;
uniform vec3 front;
uniform float opacity;
uniform vec4 focus;
out vec4 colour;
${kFade}
void main() {
  colour = vec4(front, opacity * fade(viewPosition, focus));
}`;
const kPlainFragment = `
precision highp float;
uniform vec3 front;
uniform float opacity, round_off;
out vec4 colour;
void main() {
  if (round_off > 0.0 && length(gl_PointCoord - 0.5) > 0.5) discard;
  colour = vec4(pow(front, vec3(1.0 / 2.2)), opacity);
}`;

function linear(hex) {
  return [1, 3, 5].map((at) => (parseInt(hex.slice(at, at + 2), 16) / 255) ** 2.2);
}

function makeMaterial(vertexShader, fragmentShader, values, options) {
  const uniforms = Object.fromEntries(Object.entries(values).map(([name, value]) => [name, { value }]));
  return new THREE.RawShaderMaterial({ glslVersion: "300 es", vertexShader, fragmentShader, uniforms, side: 2, ...options });
}

/* side: 2 is THREE.DoubleSide. */
const materials = {
  surface: (front, back, options) => makeMaterial(kSurfaceVertex, kSurfaceFragment, { front, back, opacity: 1, focus: [0, 0, 0, 0] }, options),
  flat: (front, opacity) => makeMaterial(kSurfaceVertex, kPlainFragment, { front, opacity, round_off: 0 }, { transparent: true }),
  line: (front, width, opacity, options) =>
    makeMaterial(kLineVertex, kPlainFragment, { front, width, opacity, viewport: [1, 1], round_off: 0 }, options),
  point: (front, width, opacity, options) =>
    makeMaterial(kPointVertex, kPlainFragment, { front, width, opacity, round_off: 1 }, options),
  wire: (front, opacity) =>
    makeMaterial(kSurfaceVertex, kWireFragment, { front, opacity, focus: [0, 0, 0, 0] }, { wireframe: true, transparent: true, depthWrite: false }),
};
