// The engine without its worker: the tree of files, and the program over it where scripts/build_wasm has built it.
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import test from "node:test";
import { fileURLToPath } from "node:url";
import { bundled } from "../../bundled.mjs";

const { files, Folder, normalized, put, remove, runProgram, StoredFile } =
  await bundled("engine/tree.ts", "engine/program.ts", "engine/paths.ts");
const project = (path) => fileURLToPath(new URL(`../../../${path}`, import.meta.url));
const built = project("build/wasm/flightwatt.wasm");
const missing = existsSync(built) ? false : "scripts/build_wasm has not built build/wasm/flightwatt.wasm";
const module = missing ? null : await WebAssembly.compile(readFileSync(built));
const text = (string) => new TextEncoder().encode(string);
const treeWith = (entries) => {
  const root = new Folder();
  for (const [path, content] of Object.entries(entries)) put(root, path, new StoredFile(text(content)));
  return root;
};
const contentOf = (root, path) => new TextDecoder().decode(files(root).get(path).bytes());

test("paths are absolute and without dots", () => {
  assert.equal(normalized("logs/./a/../b.bin"), "/logs/b.bin");
  assert.equal(normalized("/../x"), "/x");
});

test("a file in a folder is found, replaced and removed with its folder", () => {
  const root = treeWith({ "/logs/a.bin": "one" });
  put(root, "/logs/a.bin", new StoredFile(text("two")));
  assert.equal(contentOf(root, "/logs/a.bin"), "two");
  remove(root, "/logs");
  assert.equal(files(root).size, 0);
  remove(root, "/not/there");
});

test("a file grows by parts and keeps them", () => {
  const file = new StoredFile();
  for (let i = 0; i < 1000; ++i) file.write(text("abc"), 3 * i);
  assert.equal(file.size, 3000);
  assert.equal(new TextDecoder().decode(file.bytes()), "abc".repeat(1000));
  file.resize(2);
  file.resize(4);
  assert.deepEqual([...file.bytes()], [97, 98, 0, 0]);
  assert.ok(file.isChanged);
});

test("a source is read in parts, and copied when it is written", () => {
  const asked = [];
  const source = { size: 10, read: (from, to) => (asked.push([from, to]), text("0123456789").subarray(from, to)) };
  const file = new StoredFile(source);
  assert.equal(new TextDecoder().decode(file.read(2, 4)), "23");
  assert.deepEqual(asked, [[2, 4]]);
  assert.ok(!file.isChanged);
  file.write(text("x"), 0);
  assert.equal(new TextDecoder().decode(file.bytes()), "x123456789");
});

test("the program states its version", { skip: missing }, async () => {
  const result = await runProgram(module, ["--version"], new Folder());
  assert.equal(result.code, 0, result.err);
  assert.match(result.out, /^flightwatt \d/);
});

test("a wrong stage is refused with exit code 2, and its line arrives", { skip: missing }, async () => {
  const lines = [];
  const result = await runProgram(module, ["segmnt"], new Folder(), (line) => lines.push(line));
  assert.equal(result.code, 2);
  assert.match(result.err, /did you mean 'segment'/);
  assert.deepEqual(lines, result.err.trimEnd().split("\n"));
});

test("what a browser cannot do is refused", { skip: missing }, async () => {
  for (const stage of ["watch", "play", "profile"]) {
    const result = await runProgram(module, [stage], new Folder());
    assert.equal(result.code, 2);
    assert.match(result.err, /a browser cannot/);
  }
});

test("a name beyond ASCII is an argument and a file", { skip: missing }, async () => {
  const name = "/Flüge/流れ <b>.csv";
  const result = await runProgram(module, ["segment", name], treeWith({ [name]: "time_s,power_w\n0,1\n" }));
  assert.equal(result.code, 3);
  assert.ok(result.err.includes(name), result.err);
});

test("a log that cannot be read is an error of the log", { skip: missing }, async () => {
  const root = new Folder();
  put(root, "/a.csv", new StoredFile({ size: 100, read: () => { throw new Error("changed on disk"); } }));
  const result = await runProgram(module, ["segment", "/a.csv"], root);
  assert.equal(result.code, 3);
  assert.match(result.err, /a\.csv: error: cannot be read/);
});

test("runs share the tree: a log's series is segmented as the log", { skip: missing }, async () => {
  const root = new Folder();
  for (const name of ["opterra_synthetic_01.data", "opterra_synthetic_01.log"]) put(root, name, new StoredFile(readFileSync(project(`logs/${name}`))));
  const parsed = await runProgram(module, ["parse", "opterra_synthetic_01.data", "-o", "series.csv"], root);
  assert.equal(parsed.code, 0, parsed.err);
  assert.ok(files(root).get("/series.csv").isChanged);
  const result = await runProgram(module, ["segment", "series.csv", "--json"], root);
  assert.equal(result.code, 0, result.err);
  assert.equal(JSON.parse(result.out).sorties?.length ?? 1, 1);
});
