// In place of three.js' own: the pages have no headset.
export class WebXRManager {
  enabled = false;
  isPresenting = false;
  addEventListener() {}
  removeEventListener() {}
  setAnimationLoop() {}
  dispose() {}
  getEnvironmentBlendMode() {
    return null;
  }
}
