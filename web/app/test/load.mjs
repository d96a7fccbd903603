// Modules of the front end as node imports them: bundled from their TypeScript.
import { build } from "esbuild";
import { fileURLToPath } from "node:url";
import { workerText } from "../../worker_text.mjs";

/// Returns the exports of a file of app/src.
export async function load(name) {
  const { outputFiles } = await build({
    entryPoints: [fileURLToPath(new URL(`../src/${name}`, import.meta.url))],
    bundle: true, write: false, format: "esm", platform: "neutral", mainFields: ["module", "main"],
    jsx: "automatic", jsxImportSource: "preact", loader: { ".png": "empty", ".css": "empty" }, plugins: [workerText],
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString("base64")}`);
}
