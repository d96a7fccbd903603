// Renders FOLDER/NAME.vl.json to FOLDER/NAME.svg with Vega, without a browser: node render.mjs FOLDER WIDTH NAME... (WIDTH in pixels)
import { readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import vm from "node:vm";

const [folder, asked, ...names] = process.argv.slice(2);
const width = Number(asked);
const here = path.dirname(new URL(import.meta.url).pathname);
const script = (name) => readFile(path.join(here, name), "utf8");
const fitWidth = vm.runInThisContext(`(${await script("fit_width.js")})`);
// The same files as in the page.
for (const library of ["vega", "vega-lite"]) vm.runInThisContext(await script(`node_modules/${library}/build/${library}.min.js`));
const { vega, vegaLite } = globalThis;

/** Without the transparent points of the page's tooltips, which only enlarge the file. */
function still(part) {
  if (Array.isArray(part)) return part.map(still);
  if (part === null || typeof part !== "object") return part;
  return Object.fromEntries(Object.entries(part).filter(([key, value]) => !(key === "point" && value?.opacity === 0)).map(([key, value]) => [key, still(value)]));
}

const logger = vega.logger(vega.Error); // warnings are about legends of layers and about missing pointers
async function render(spec, room) {
  const view = new vega.View(vega.parse(vegaLite.compile(still(fitWidth(spec, room)), { logger }).spec), { renderer: "none", logger });
  const svg = await view.toSVG();
  view.finalize();
  return { svg, wide: Number(svg.match(/<svg[^>]* width="([\d.]+)"/)[1]) };
}

for (const name of names) {
  const spec = JSON.parse(await readFile(path.join(folder, `${name}.vl.json`), "utf8"));
  // The width of axes and legends is known after drawing: a figure that is too wide is drawn again with less room.
  let room = width;
  let drawn = await render(spec, room);
  for (let trial = 0; trial < 10 && drawn.wide > width; ++trial) {
    room -= drawn.wide - width;
    drawn = await render(spec, room);
  }
  await writeFile(path.join(folder, `${name}.svg`), drawn.svg);
}
