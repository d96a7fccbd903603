// Renders FOLDER/NAME.vl.json to FOLDER/NAME.svg with Vega, without a browser: node render.mjs FOLDER NAME...
import { readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import vm from "node:vm";
import * as vega from "vega";
import * as vegaLite from "vega-lite";

const width = 720;
const [folder, ...names] = process.argv.slice(2);
const here = path.dirname(new URL(import.meta.url).pathname);
const fitWidth = vm.runInThisContext(`(${await readFile(path.join(here, "fit_width.js"), "utf8")})`);

/** Without the transparent points that carry the page's tooltips: on paper they are weight alone. */
function still(part) {
  if (Array.isArray(part)) return part.map(still);
  if (part === null || typeof part !== "object") return part;
  return Object.fromEntries(Object.entries(part).filter(([key, value]) => !(key === "point" && value?.opacity === 0)).map(([key, value]) => [key, still(value)]));
}

const logger = vega.logger(vega.Error); // warnings are of layers' legends, and of mice that are not here
for (const name of names) {
  const spec = still(fitWidth(JSON.parse(await readFile(path.join(folder, `${name}.vl.json`), "utf8")), width));
  const view = new vega.View(vega.parse(vegaLite.compile(spec, { logger }).spec), { renderer: "none", logger });
  await writeFile(path.join(folder, `${name}.svg`), await view.toSVG());
  view.finalize();
}
