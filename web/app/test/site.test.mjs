// The page that is served, in Chromium: it is kept for a time without a network, and a new version replaces it whole.
// CHROMIUM is the browser.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import http from "node:http";
import os from "node:os";
import path from "node:path";
import { test } from "node:test";
import { chromium } from "playwright-core";
import { writePages } from "../../pages.mjs";

const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
const skip = existsSync(executablePath) ? false : "no browser";
const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css" };

/// Serves a folder as hosts of pages do: browsers may keep what they get for ten minutes.
async function served(folder) {
  const server = http.createServer((request, response) => {
    const name = request.url === "/" ? "index.html" : request.url.slice(1);
    const head = { "content-type": types[path.extname(name)] ?? "application/wasm", "cache-control": "max-age=600" };
    readFile(path.join(folder, name)).then((data) => response.writeHead(200, head).end(data), () => response.writeHead(404).end());
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { server, address: `http://127.0.0.1:${server.address().port}/` };
}

test("a page that is served works without a network, and a new version is new in all of its files", { skip, timeout: 120_000 }, async (t) => {
  const folder = await mkdtemp(path.join(os.tmpdir(), "flightwatt-site-"));
  const write = async (version) => {
    await writeFile(path.join(folder, "app.js"), `document.title = "${version}"; navigator.serviceWorker.register("service-worker.js");`);
    await writeFile(path.join(folder, "app.css"), "");
    await writePages(folder, Buffer.from(version));
  };
  await write("first");
  const { server, address } = await served(path.join(folder, "site"));
  const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
  t.after(async () => {
    await browser.close();
    server.close();
    await rm(folder, { recursive: true });
  });
  const context = await browser.newContext();
  const page = await context.newPage();
  const kept = () => page.waitForFunction(() => navigator.serviceWorker.controller?.state === "activated");
  await page.goto(address);
  await kept();
  await write("second");
  const before = await page.evaluate(() => caches.keys());
  await page.evaluate(async () => void (await (await navigator.serviceWorker.ready).update()));
  await page.evaluate(async ([old]) => {
    for (let i = 0; i < 600 && (await caches.keys()).includes(old); ++i) await new Promise((later) => setTimeout(later, 50));
  }, before);
  await context.setOffline(true);
  await page.reload();
  assert.equal(await page.title(), "second");
  assert.equal(await page.evaluate(async () => (await fetch("flightwatt.wasm")).text()), "second");
});
