// The program as a WebAssembly.Module, compiled once a page: from the page itself, where it is embedded (a page opened
// from a file may fetch nothing), else from a file beside it.

/// The id of the element <script type="text/plain"> whose text is flightwatt.wasm, compressed by gzip, in base64.
const embedded = "flightwatt-wasm";

function bytesOfBase64(text: string): Uint8Array<ArrayBuffer> {
  const characters = atob(text.trim());
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < characters.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

/// Compiles while it unpacks.
function compileGzip(bytes: Uint8Array<ArrayBuffer>): Promise<WebAssembly.Module> {
  const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compileStreaming(new Response(unpacked, { headers: { "Content-Type": "application/wasm" } }));
}

/// Whether this page has the module inside.
export function isModuleEmbedded(): boolean { return document.getElementById(embedded) !== null; }

/// Rejects where the file is not served, with its address.
export async function loadModule(url = "flightwatt.wasm"): Promise<WebAssembly.Module> {
  const element = document.getElementById(embedded);
  if (element) {
    const bytes = bytesOfBase64(element.textContent ?? "");
    element.remove();  // 3 MB that nothing reads again
    return compileGzip(bytes);
  }
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${url}: ${answer.status} ${answer.statusText}`);
  if (answer.headers.get("Content-Type")?.startsWith("application/wasm")) return WebAssembly.compileStreaming(answer);
  return WebAssembly.compile(await answer.arrayBuffer());  // a server that does not know the type
}
