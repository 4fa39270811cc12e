// What the pages use of three.js: page/assets/viewer.js. Materials have their own shaders.
export { PerspectiveCamera } from "./package/src/cameras/PerspectiveCamera.js";
export { BufferAttribute } from "./package/src/core/BufferAttribute.js";
export { BufferGeometry } from "./package/src/core/BufferGeometry.js";
export { RawShaderMaterial } from "./package/src/materials/RawShaderMaterial.js";
export { Group } from "./package/src/objects/Group.js";
export { LineSegments } from "./package/src/objects/LineSegments.js";
export { Mesh } from "./package/src/objects/Mesh.js";
export { Points } from "./package/src/objects/Points.js";
export { Scene } from "./package/src/scenes/Scene.js";
export { WebGLRenderer } from "./package/src/renderers/WebGLRenderer.js";
