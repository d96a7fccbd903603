#!/usr/bin/env node
// The engine in a browser, from a page opened as a file and from one that is served: commands, files, cancel.
//   browser_test.mjs [--module FILE] [--large]
// --large also reads a log of 200 MB. Exit codes: 0 passed, 1 failed, 77 where the module, playwright-core or chromium is
// missing.
import assert from "node:assert/strict";
import fs from "node:fs";
import http from "node:http";
import os from "node:os";
import path from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import zlib from "node:zlib";
import { build } from "../../web/node_modules/esbuild/lib/main.js";
import { workerText } from "../../web/worker_text.mjs";

const project = fileURLToPath(new URL("../../", import.meta.url)).replace(/\/$/, "");
const words = process.argv.slice(2);
const isLarge = words.includes("--large");
const at = words.indexOf("--module");
const moduleFile = at < 0 ? path.join(project, "build/wasm/flightwatt.wasm") : words[at + 1];
const chromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((file) => fs.existsSync(file));
const playwright = await import("../../web/node_modules/playwright-core/index.mjs").catch(() => null);
for (const [there, what] of [[fs.existsSync(moduleFile), moduleFile], [chromium, "chromium"], [playwright, "playwright-core"]]) {
  if (there) continue;
  console.error(`browser_test: skipped: ${what} is missing`);
  process.exit(77);
}

const folder = fs.mkdtempSync(path.join(os.tmpdir(), "flightwatt-browser-"));
process.on("exit", () => fs.rmSync(folder, { recursive: true, force: true }));
await build({
  stdin: {
    contents: `import { startEngine } from "./client"; import { Cancelled } from "./engine";
               Object.assign(window, { startEngine, Cancelled });`,
    resolveDir: path.join(project, "web/app/src/engine"), loader: "ts",
  },
  outfile: path.join(folder, "engine.js"), bundle: true, format: "iife", target: "es2020", plugins: [workerText],
});
const wasm = fs.readFileSync(moduleFile);
const page = (inside) => `<!DOCTYPE html><meta charset="utf-8"><title>engine</title>${inside}<script src="engine.js"></script>`;
const packed = zlib.gzipSync(wasm, { level: 9 }).toString("base64");
fs.writeFileSync(path.join(folder, "embedded.html"), page(`<script type="text/plain" id="flightwatt-wasm">${packed}</script>`));
fs.writeFileSync(path.join(folder, "served.html"), page(
  `<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src blob:; connect-src 'self'">`));
fs.writeFileSync(path.join(folder, "flightwatt.wasm"), wasm);

const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
const server = http.createServer((request, answer) => {
  const file = path.join(folder, path.basename(request.url));
  if (!fs.existsSync(file)) return answer.writeHead(404).end();
  answer.writeHead(200, { "Content-Type": types[path.extname(file)] }).end(fs.readFileSync(file));
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));

const browser = await playwright.chromium.launch({ executablePath: chromium, args: ["--no-sandbox"] });
const log = (name) => fs.readFileSync(path.join(project, "logs", name)).toString("base64");
const logs = ["opterra_synthetic_01.data", "opterra_synthetic_01.log"].map((name) => [name, log(name)]);

/// What the page does; returns what it found.
async function exercise(logs, largeMb) {
  const bytesOf = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const found = { milliseconds: {} };
  const timed = async (name, work) => {
    const start = performance.now();
    const result = await work();
    found.milliseconds[name] = Math.round(performance.now() - start);
    return result;
  };
  const engine = window.startEngine();
  found.version = await timed("load and first run", () => engine.run(["--version"]));
  found.again = await timed("second run", () => engine.run(["--version"]));
  await engine.write("logs/a b/ü.data", new File([bytesOf(logs[0][1])], "x.data"));
  await engine.write("/logs/a b/ü.log", bytesOf(logs[1][1]));
  const lines = [];
  found.segment = await timed("segment", () => engine.run(["segment", "logs/a b/ü.data", "--json", "-o", "p.txt"], (line) => lines.push(line)));
  found.lines = lines;
  found.list = await engine.list();
  found.written = new TextDecoder().decode(await engine.read("/p.txt"));
  found.missing = await engine.read("/not").then(() => "read", (error) => error.message);
  const waiting = engine.run(["batch", "logs", "-o", "out/batch"]);
  const next = engine.run(["--version"]);
  setTimeout(() => engine.cancel(), 50);
  const settled = await Promise.allSettled([waiting, next]);
  found.cancelled = settled.map(({ status, reason }) => status === "rejected" && reason instanceof window.Cancelled);
  found.listAfter = await engine.list();
  found.afterCancel = await timed("run after cancel", () => engine.run(["segment", "logs/a b/ü.data", "--json"]));
  await engine.remove("logs");
  found.listAtEnd = await engine.list();
  found.removed = await engine.run(["segment", "logs/a b/ü.data"]);
  if (largeMb > 0) {
    const text = new TextDecoder().decode(bytesOf(logs[0][1]));
    const parts = [];
    const end = Number(text.trim().split("\n").pop().split(" ")[0]) + 1;
    for (let i = 0, size = 0; size < largeMb * 1e6; ++i) {
      const part = i === 0 ? text : text.replace(/^[0-9.]+/gm, (time) => (Number(time) + i * end).toFixed(3));
      parts.push(part);
      size += part.length;
    }
    await engine.write("large.data", new File(parts, "large.data"));
    await engine.write("large.log", bytesOf(logs[1][1]));
    found.large = await timed("segment 200 MB", () => engine.run(["segment", "large.data", "--json"]));
    found.large.out = found.large.out.slice(0, 200);
  }
  return found;
}

let failed = false;
for (const [name, address] of [["from a file", pathToFileURL(path.join(folder, "embedded.html")).href],
  ["served", `http://127.0.0.1:${server.address().port}/served.html`]]) {
  const tab = await browser.newPage();
  tab.on("console", (message) => console.error(`browser_test: ${name}: ${message.text()}`));
  tab.on("pageerror", (error) => console.error(`browser_test: ${name}: ${error.message}`));
  try {
    await tab.goto(address);
    const found = await tab.evaluate(`(${exercise})(${JSON.stringify(logs)}, ${isLarge && name === "from a file" ? 200 : 0})`);
    assert.match(found.version.out, /^flightwatt \d/);
    assert.equal(found.segment.code, 0, found.segment.err);
    assert.ok(found.segment.err.includes(found.lines[0] ?? ""));
    assert.deepEqual(found.list.map((file) => file.path), ["/logs/a b/ü.data", "/logs/a b/ü.log", "/p.txt"]);
    assert.ok(found.written.length > 0);
    assert.match(found.missing, /no file/);
    assert.deepEqual(found.cancelled, [true, true]);
    assert.deepEqual(found.listAfter, found.list);
    assert.equal(found.afterCancel.out, found.segment.out);
    assert.deepEqual(found.listAtEnd.map((file) => file.path), ["/p.txt"]);
    assert.equal(found.removed.code, 3);
    if (found.large) assert.equal(found.large.code, 0, found.large.err);
    const times = Object.entries(found.milliseconds).map(([what, ms]) => `${what} ${ms} ms`).join(", ");
    console.log(`browser_test: ${name}: passed: ${times}`);
  } catch (error) {
    failed = true;
    console.log(`browser_test: ${name}: FAILED: ${error.message}`);
  }
  await tab.close();
}
await browser.close();
server.close();
process.exit(failed ? 1 : 0);
