"use strict";
/* The bytes of a packed element of this page (page/packed.h): a promise of a Uint8Array. */
async function unpack(id) {
  const text = document.getElementById(id).textContent;
  const deflated = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const stream = new Blob([deflated]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
/* The integers of packed_integers(): a promise of an Int32Array. */
async function unpackIntegers(id, stride) {
  const planes = await unpack(id);
  const count = planes.length / 4;
  const values = new Int32Array(count);
  for (let i = 0; i < count; ++i) {
    const folded = planes[i] | (planes[count + i] << 8) | (planes[2 * count + i] << 16) | (planes[3 * count + i] << 24);
    const difference = (folded >>> 1) ^ -(folded & 1);
    values[i] = i < stride ? difference : (difference + values[i - stride]) | 0;
  }
  return values;
}
