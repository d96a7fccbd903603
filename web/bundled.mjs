// TypeScript of the front end for tests that run in node: bundled, then imported.
import { build } from "esbuild";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

/// The exports of files below web/app/src, as one module.
export async function bundled(...files) {
  const folder = mkdtempSync(path.join(tmpdir(), "flightwatt-web-"));
  const outfile = path.join(folder, "bundle.mjs");
  const source = fileURLToPath(new URL("app/src/", import.meta.url));
  const contents = files.map((file) => `export * from "./${file}";`).join("\n");
  try {
    await build({
      stdin: { contents, resolveDir: source, loader: "ts" }, bundle: true, format: "esm", platform: "node", outfile,
      logLevel: "warning",
    });
    return await import(pathToFileURL(outfile).href);
  } finally {
    rmSync(folder, { recursive: true });
  }
}
