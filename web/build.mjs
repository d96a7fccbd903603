// Bundles the front end: node web/build.mjs FOLDER writes FOLDER/app.js (one script, without modules) and FOLDER/app.css,
// and of the page of `flightwatt watch --serve` FOLDER/live.js and FOLDER/live.css.
// With the engine, node web/build.mjs FOLDER flightwatt.wasm, also FOLDER/flightwatt.html, one file with all inside, and
// FOLDER/site, the same to be served.
import { build } from "esbuild";
import { readFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { writePages } from "./pages.mjs";
import { workerText } from "./worker_text.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));
const [folder, module] = process.argv.slice(2);
if (!folder || process.argv.length > 4) {
  console.error("build.mjs: error: expected the folder of the bundles: node web/build.mjs FOLDER [flightwatt.wasm]");
  process.exit(2);
}
try {
  await build({
    absWorkingDir: here,
    entryPoints: { app: "app/src/main.tsx", live: "app/src/live/main.tsx" },
    outdir: path.resolve(folder),
    bundle: true,
    minify: true,
    format: "iife",
    target: ["es2020", "chrome100", "firefox100", "safari15.4"],
    jsx: "automatic",
    jsxImportSource: "preact",
    loader: { ".png": "empty" },  // Leaflet's marker pictures, which are not used
    plugins: [workerText],
    legalComments: "eof",
    logLevel: "warning",
  });
} catch {
  process.exit(1);  // esbuild has printed why
}
if (module) await writePages(path.resolve(folder), await readFile(module));
