// Renders FOLDER/NAME.vl.json to FOLDER/NAME.svg with Vega, without a browser: node render.mjs FOLDER WIDTH HEIGHT NAME...
// (in pixels; HEIGHT is a maximum, 0: none)
import { readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import vm from "node:vm";

const [folder, ...rest] = process.argv.slice(2);
const [width, height] = rest.slice(0, 2).map(Number);
const names = rest.slice(2);
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

/** With panels of `factor` times their height, 40 px at least; squares remain squares. */
function flattened(part, factor) {
  const inner = Object.fromEntries(["concat", "vconcat", "hconcat"].filter((key) => part[key]).map((key) => [key, part[key].map((panel) => flattened(panel, factor))]));
  if (typeof part.height !== "number") return { ...part, ...inner };
  const height = Math.max(Math.min(40, part.height), Math.floor(part.height * factor));
  return { ...part, ...inner, height, width: part.width === part.height ? height : part.width };
}

const logger = vega.logger(vega.Error); // warnings are about legends of layers and about missing pointers
async function render(spec, room, factor = 1) {
  const view = new vega.View(vega.parse(vegaLite.compile(still(flattened(fitWidth(spec, room, width), factor)), { logger }).spec), { renderer: "none", logger });
  const svg = await view.toSVG();
  view.finalize();
  const [wide, tall] = ["width", "height"].map((side) => Number(svg.match(new RegExp(`<svg[^>]* ${side}="([\\d.]+)"`))[1]));
  return { svg, wide, tall };
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
  // Axes, titles and legends keep their height: the panels' share is known from two drawings.
  if (height > 0 && drawn.tall > height) {
    const half = (await render(spec, room, 0.5)).tall;
    drawn = await render(spec, room, 1 - (0.5 * (drawn.tall - height)) / Math.max(drawn.tall - half, 1));
  }
  await writeFile(path.join(folder, `${name}.svg`), drawn.svg);
}
