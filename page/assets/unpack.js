"use strict";
/* The bytes of a packed element of this page (page/packed.h): a promise of a Uint8Array. */
async function unpack(id) {
  const text = document.getElementById(id).textContent;
  const deflated = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const stream = new Blob([deflated]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
