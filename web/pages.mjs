// The pages that have the engine: one file that is opened by a double click, and a folder to be served.
import { createHash } from "node:crypto";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { gzipSync } from "node:zlib";

const most_bytes = 5_000_000;
const hash = (text, algorithm = "sha256") => createHash(algorithm).update(text).digest("base64");
const inScript = (text) => text.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");

/// A page that loads nothing from elsewhere: what it runs and how it looks is its own.
function page({ policy, head, body }) {
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<meta name="description" content="How long, how far, and does my plan fit? From the logs of a drone, in this browser alone.">
<meta name="theme-color" content="#0a5a9c">
<title>FlightWatt</title>
${head}
</head>
<body>
<div id="app"><noscript>FlightWatt reads logs with a script, in this browser alone. Allow scripts on this page, or use the program: flightwatt LOGS</noscript></div>
${body}
</body>
</html>
`;
}

const of_both = ["default-src 'none'", "img-src data: blob:", "base-uri 'none'", "form-action 'none'"];

/// flightwatt.html, with the engine compressed inside.
function onePage(script, style, module) {
  const code = inScript(script);
  const policy = [...of_both, `script-src 'sha256-${hash(code)}' 'wasm-unsafe-eval' blob:`, "worker-src blob:", `style-src 'sha256-${hash(style)}'`];
  return page({
    policy: policy.join("; "),
    head: `<link rel="icon" href="data:,">\n<style>${style}</style>`,
    body: `<script type="text/plain" id="flightwatt-wasm">${gzipSync(module, { level: 9 }).toString("base64")}</script>\n<script>${code}</script>`,
  });
}

/// Answers from what it keeps; a new version of the page is a new cache, whose files are of that version: none is what the
/// browser fetched before.
function serviceWorker(files, version) {
  return `// FlightWatt works without a network: its files are kept at the first visit.
const cache_name = "flightwatt-${version}";
const files = ${JSON.stringify(["./", ...files])}.map((file) => new Request(file, { cache: "reload" }));
addEventListener("install", (event) => event.waitUntil(caches.open(cache_name).then((cache) => cache.addAll(files)).then(() => skipWaiting())));
addEventListener("activate", (event) => event.waitUntil(caches.keys().then((names) => Promise.all(
  names.filter((name) => name.startsWith("flightwatt-") && name !== cache_name).map((name) => caches.delete(name)))).then(() => clients.claim())));
addEventListener("fetch", (event) => {
  if (event.request.method !== "GET") return;
  event.respondWith(caches.match(event.request, { cacheName: cache_name, ignoreSearch: true }).then((kept) => kept ?? fetch(event.request)));
});
`;
}

async function writeSite(folder, script, style, module) {
  const policy = [...of_both, "script-src 'self' 'wasm-unsafe-eval' blob:", "worker-src 'self' blob:", "style-src 'self'", "connect-src 'self'", "manifest-src 'self'"];
  const index = page({
    policy: policy.join("; "),
    head: `<meta name="flightwatt-engine" content="flightwatt.wasm">\n<link rel="icon" href="data:,">\n<link rel="stylesheet" href="app.css">`,
    body: `<script src="app.js"></script>`,
  });
  const files = { "index.html": index, "app.js": script, "app.css": style, "flightwatt.wasm": module };
  const version = createHash("sha256");
  for (const content of Object.values(files)) version.update(content);
  const worker = serviceWorker(Object.keys(files).slice(1), version.digest("hex").slice(0, 16));
  await mkdir(folder, { recursive: true });
  for (const [name, content] of Object.entries({ ...files, "service-worker.js": worker })) await writeFile(path.join(folder, name), content);
}

/// Writes flightwatt.html and site/ into the folder of the bundle.
export async function writePages(folder, module) {
  const [script, style] = await Promise.all(["app.js", "app.css"].map((name) => readFile(path.join(folder, name), "utf8")));
  const one = onePage(script, style, module);
  if (one.length > most_bytes) throw new Error(`flightwatt.html has ${one.length} bytes, more than ${most_bytes}`);
  await writeFile(path.join(folder, "flightwatt.html"), one);
  await writeSite(path.join(folder, "site"), script, style, module);
}
