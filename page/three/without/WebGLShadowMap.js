// In place of three.js' own: nothing casts a shadow.
export class WebGLShadowMap {
  enabled = false;
  render() {}
}
