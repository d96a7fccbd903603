// Renders every FOLDER/NAME.vl.json to FOLDER/NAME.svg with Vega, without a browser: node render.mjs FOLDER [WIDTH]
import { readFile, readdir, writeFile } from "node:fs/promises";
import path from "node:path";
import vm from "node:vm";
import * as vega from "vega";
import * as vegaLite from "vega-lite";

const [folder, width = "720"] = process.argv.slice(2);
const here = path.dirname(new URL(import.meta.url).pathname);
const fitWidth = vm.runInThisContext(`(${await readFile(path.join(here, "fit_width.js"), "utf8")})`);

/** Without the transparent points that carry the page's tooltips: on paper they are weight alone. */
function still(part) {
  if (Array.isArray(part)) return part.map(still);
  if (part === null || typeof part !== "object") return part;
  return Object.fromEntries(Object.entries(part).filter(([key, value]) => !(key === "point" && value?.opacity === 0)).map(([key, value]) => [key, still(value)]));
}

const logger = vega.logger(vega.Error); // warnings are of layers' legends, and of mice that are not here
const ending = ".vl.json";
for (const file of (await readdir(folder)).filter((name) => name.endsWith(ending)).sort()) {
  const spec = still(fitWidth(JSON.parse(await readFile(path.join(folder, file), "utf8")), Number(width)));
  const view = new vega.View(vega.parse(vegaLite.compile(spec, { logger }).spec), { renderer: "none", logger });
  await writeFile(path.join(folder, `${file.slice(0, -ending.length)}.svg`), await view.toSVG());
  view.finalize();
}
