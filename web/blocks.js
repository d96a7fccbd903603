// Inverse of compressed_block() and packed_tables() (src/report/sections/blocks.cpp).
async function inflated(block) {
  if (typeof DecompressionStream === "undefined")
    throw new Error(
      "This browser cannot open the compressed flights of a page of many flights (it has no DecompressionStream). Open the page in Firefox 113, Chrome or Edge 80, Safari 16.4 or a later one; or write pages of up to 20 flights, which are not compressed (flightwatt batch --since, --until, --glob).",
    );
  try {
    const bytes = Uint8Array.from(atob(block.trim()), (letter) => letter.charCodeAt(0));
    return await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).text();
  } catch (error) {
    throw new Error(`This flight's part of the page is damaged: write the page again with flightwatt report. (${error.message})`);
  }
}

function unpacked(part) {
  if (Array.isArray(part)) return part.map(unpacked);
  if (part === null || typeof part !== "object") return part;
  if (!part.packed) return Object.fromEntries(Object.entries(part).map(([key, value]) => [key, unpacked(value)]));
  const numbers = (decimals, steps) => {
    let sum = 0;
    return steps.map((step) => (step === null ? null : (sum += step) / 10 ** decimals));
  };
  const columns = part.packed.map(([name, ...rest]) => ({ name, cells: rest.length === 2 ? numbers(...rest) : rest[0] }));
  return { values: columns[0].cells.map((_, row) => Object.fromEntries(columns.map(({ name, cells }) => [name, cells[row]]))) };
}
