// Compressed blocks of the page: base64 text of deflated bytes.
"use strict";

/**
 * Bytes of base64 text; a loop is ten times as fast as Uint8Array.from with a function.
 * @param {string} text
 * @returns {Uint8Array<ArrayBuffer>}
 */
function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; k++) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

/**
 * The content of a compressed block.
 * @param {string} id of the block's element
 * @returns {Response}
 */
function inflate(id) {
  const bytes = bytesOf(document.getElementById(id)?.textContent ?? "");
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")));
}

/**
 * Run a script; from a blob the browser compiles it beside the page, not in its way.
 * @param {Blob} text
 */
async function runScript(text) {
  const script = document.createElement("script");
  script.src = URL.createObjectURL(text);
  await /** @type {Promise<void>} */ (new Promise((resolve, reject) => {
    script.onload = () => resolve();
    script.onerror = () => reject(new Error("cannot run the script"));
    document.head.append(script);
  }));
  URL.revokeObjectURL(script.src);
}

/**
 * Run a script before this returns.
 * @param {string} text
 */
function runText(text) {
  const script = document.createElement("script");
  script.textContent = text;
  document.head.append(script);
}
