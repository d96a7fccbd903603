// Bundles the front end: node web/build.mjs FOLDER writes FOLDER/app.js (one script, without modules) and FOLDER/app.css.
import { build } from "esbuild";
import { fileURLToPath } from "node:url";
import { workerText } from "./worker_text.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));
const folder = process.argv[2];
if (!folder || process.argv.length > 3) {
  console.error("build.mjs: error: expected the folder for app.js and app.css: node web/build.mjs FOLDER");
  process.exit(2);
}
try {
  await build({
    absWorkingDir: here,
    entryPoints: { app: "app/src/main.tsx" },
    outdir: fileURLToPath(new URL(folder + "/", `file://${process.cwd()}/`)),
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
