// In place of the shaders of three.js' own materials, which are not used.
export const vertex = "";
export const fragment = "";
export default "";
