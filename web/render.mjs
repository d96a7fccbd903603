// Renders every FOLDER/NAME.vl.json to FOLDER/NAME.svg with Vega, without a browser: node render.mjs FOLDER [WIDTH]
import { readFile, readdir, writeFile } from "node:fs/promises";
import path from "node:path";
import vm from "node:vm";
import * as vega from "vega";
import * as vegaLite from "vega-lite";

const [folder, width = "720"] = process.argv.slice(2);
const here = path.dirname(new URL(import.meta.url).pathname);
const fitWidth = vm.runInThisContext(`(${await readFile(path.join(here, "fit_width.js"), "utf8")})`);

const logger = vega.logger(vega.Error); // warnings are of layers' legends, and of mice that are not here
const ending = ".vl.json";
for (const file of (await readdir(folder)).filter((name) => name.endsWith(ending)).sort()) {
  const spec = fitWidth(JSON.parse(await readFile(path.join(folder, file), "utf8")), Number(width));
  const view = new vega.View(vega.parse(vegaLite.compile(spec, { logger }).spec), { renderer: "none", logger });
  await writeFile(path.join(folder, `${file.slice(0, -ending.length)}.svg`), await view.toSVG());
  view.finalize();
}
