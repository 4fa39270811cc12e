// In place of three.js' own: nothing reflects an environment.
export class PMREMGenerator {}
