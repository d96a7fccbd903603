// Modules of the front end for tests in node: bundled by esbuild, with Preact's own parts.
import { build } from "esbuild";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { workerText } from "../../../worker_text.mjs";

const source = fileURLToPath(new URL("../../src/", import.meta.url));

/** Maps and plots draw in browsers only, where tests/report/page_test.mjs sees them. */
const withoutDrawing = {
  name: "without drawing",
  setup(building) {
    building.onResolve({ filter: /^(leaflet|uplot)/ }, ({ path: name }) => ({ path: name, namespace: "without-drawing" }));
    building.onLoad({ filter: /.*/, namespace: "without-drawing" }, () => ({ contents: "export default {};", loader: "js" }));
  },
};

/** Returns what modules of web/app/src export ("ui/format.ts"), and Preact's `h`, `options` and `Fragment`. */
export async function bundled(...modules) {
  const folder = mkdtempSync(path.join(tmpdir(), "flightwatt-front-end-"));
  const file = path.join(folder, "bundle.mjs");
  try {
    await build({
      stdin: { contents: [...modules.map((name) => `export * from "./${name}";`), 'export { h, options, Fragment } from "preact";'].join("\n"), resolveDir: source, loader: "ts" },
      bundle: true, format: "esm", platform: "neutral", mainFields: ["module", "main"], outfile: file, jsx: "automatic", jsxImportSource: "preact",
      plugins: [withoutDrawing, workerText],
      loader: { ".css": "empty" }, logLevel: "error",
    });
    return await import(pathToFileURL(file).href);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

const escaped = (text) => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");

/** Renders once, without effects: enough to see what a part shows of its document. */
export function html(node, { options, Fragment }) {
  const render = (one) => {
    if (one == null || typeof one === "boolean") return "";
    if (Array.isArray(one)) return one.map(render).join("");
    if (typeof one !== "object") return escaped(one);
    if (one.type === Fragment) return render(one.props.children);
    if (typeof one.type === "function") {
      one.__c = { __v: one, props: one.props, context: {}, __h: [], setState() {}, forceUpdate() {} };
      options.__b?.(one);
      options.__r?.(one);
      return render(one.type.call(one.__c, one.props, {}));
    }
    const { children, ...attributes } = one.props;
    const shown = Object.entries(attributes).filter(([name, value]) => value != null && value !== false && typeof value !== "function" && name !== "ref" && name !== "style");
    return `<${one.type}${shown.map(([name, value]) => ` ${name}="${escaped(value)}"`).join("")}>${render(children)}</${one.type}>`;
  };
  return render(node);
}

export const words = (markup) => markup.replace(/<[^>]+>/g, " ").replace(/&amp;/g, "&").replace(/&lt;/g, "<").replace(/&gt;/g, ">").replace(/&quot;/g, '"').replace(/\s+/g, " ").trim();
