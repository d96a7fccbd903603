// The program as an engine of a page under test: the page's calls run the native program in a folder of their own.
import { execFile } from "node:child_process";
import { mkdir, mkdtemp, readFile, readdir, rm, stat, writeFile } from "node:fs/promises";
import os from "node:os";
import path from "node:path";

/// Gives a page an engine that runs `program`; returns the folder of its files.
export async function giveNativeEngine(page, program) {
  const folder = await mkdtemp(path.join(os.tmpdir(), "flightwatt-app-"));
  const place = (name) => path.join(folder, name);
  const all = async (below) =>
    (await readdir(place(below), { withFileTypes: true })).flatMap((entry) => ({
      entry,
      name: path.posix.join(below, entry.name),
    }));
  const list = async (below = ".") => {
    const found = [];
    for (const { entry, name } of await all(below))
      if (entry.isDirectory()) found.push(...(await list(name)));
      else found.push({ path: name, bytes: (await stat(place(name))).size });
    return found;
  };
  let running = null;
  await page.exposeFunction("nativeRun", (args) =>
    new Promise((done) => {
      running = execFile(program, args, { cwd: folder, maxBuffer: 1 << 28 }, (error, out, err) => {
        const code = error ? (error.code ?? -1) : 0;
        done({ code, out, err });
      });
      running.stderr.on(
        "data",
        (text) => void page.evaluate((lines) => globalThis.nativeErrorLines?.(lines), String(text)).catch(() => {}),
      );
    }));
  await page.exposeFunction("nativeWrite", async (name, base64, is_more) => {
    await mkdir(path.dirname(place(name)), { recursive: true });
    await writeFile(place(name), Buffer.from(base64, "base64"), { flag: is_more ? "a" : "w" });
  });
  await page.exposeFunction("nativeRead", async (name) => (await readFile(place(name))).toString("base64"));
  await page.exposeFunction("nativeList", () => list());
  await page.exposeFunction("nativeRemove", (name) => rm(place(name), { recursive: true, force: true }));
  await page.exposeFunction("nativeCancel", () => running?.kill());
  await page.addInitScript(() => {
    const bytesOf = (base64) => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const base64Of = (bytes) => {
      let text = "";
      for (let at = 0; at < bytes.length; at += 32768) text += String.fromCharCode(...bytes.subarray(at, at + 32768));
      return btoa(text);
    };
    let cancelled = 0;
    globalThis.flightwattEngine = {
      async run(args, onErrorLine) {
        const begun = cancelled;
        globalThis.nativeErrorLines = (text) => {
          if (begun === cancelled) text.split("\n").filter(Boolean).forEach((line) => onErrorLine?.(line));
        };
        const result = await globalThis.nativeRun(args);
        if (begun !== cancelled) throw Object.assign(new Error("cancelled"), { name: "Cancelled" });
        return result;
      },
      async write(name, data) {
        const bytes = data instanceof Uint8Array ? data : new Uint8Array(await data.arrayBuffer());
        const part = 3 << 20;
        for (let at = 0; at === 0 || at < bytes.length; at += part) await globalThis.nativeWrite(
          name,
          base64Of(bytes.subarray(at, at + part)),
          at > 0,
        );
      },
      read: async (name) => bytesOf(await globalThis.nativeRead(name)),
      list: () => globalThis.nativeList(),
      remove: (name) => globalThis.nativeRemove(name),
      cancel() {
        cancelled += 1;
        void globalThis.nativeCancel();
      },
    };
  });
  return folder;
}
