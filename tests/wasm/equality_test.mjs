#!/usr/bin/env node
// The program as WebAssembly against the native one, over the same files: what they print, write and return.
//   equality_test.mjs [--native BIN] [--module FILE] [--times] [PART...]
// Parts: logs, series, fits, missions, answers, sliders; all by default. Prints a line a case on the standard error, and a table at
// the end. Exit codes: 0 equal, 1 not, 77 where the module or the native program is not built. See docs/browser.md.
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { bundled } from "../../web/bundled.mjs";

const project = fileURLToPath(new URL("../../", import.meta.url)).replace(/\/$/, "");
const shared = path.resolve(project, "../shared");
const partNames = ["logs", "series", "fits", "missions", "answers", "sliders"];

const given = { native: path.join(project, "build/release/bin/flightwatt"),
                module: path.join(project, "build/wasm/flightwatt.wasm"), times: false, parts: [] };
for (let words = process.argv.slice(2); words.length > 0;) {
  const word = words.shift();
  if (word === "--native" || word === "--module") given[word.slice(2)] = words.shift();
  else if (word === "--times") given.times = true;
  else if (partNames.includes(word)) given.parts.push(word);
  else fail(`unknown argument '${word}'; parts: ${partNames.join(", ")}`, 2);
}
if (given.parts.length === 0) given.parts = partNames;
for (const [file, how] of [[given.native, "scripts/build release programs"], [given.module, "scripts/build_wasm"]])
  if (!fs.existsSync(file)) fail(`skipped: ${file} is missing; ${how} builds it`, 77);

function fail(message, code) {
  console.error(`equality_test: ${message}`);
  process.exit(code);
}

const { files, Folder, put, runProgram, StoredFile } = await bundled("engine/tree.ts", "engine/program.ts");
const module = await WebAssembly.compile(fs.readFileSync(given.module));
const scratch = fs.mkdtempSync(path.join(os.tmpdir(), "flightwatt-wasm-"));
process.on("exit", () => fs.rmSync(scratch, { recursive: true, force: true }));

/// A file of the disk, read where it is.
class DiskSource {
  constructor(file) {
    this.file = file;
    this.size = fs.statSync(file).size;
  }
  read(from, to) {
    const bytes = new Uint8Array(to - from);
    const descriptor = fs.openSync(this.file);
    try {
      return bytes.subarray(0, fs.readSync(descriptor, bytes, 0, to - from, from));
    } finally {
      fs.closeSync(descriptor);
    }
  }
}

/// Files and folders of the disk at their own paths.
function treeOf(...paths) {
  const root = new Folder();
  put(root, path.join(scratch, "made/.keep"), new StoredFile());
  const add = (name) => {
    const status = fs.statSync(name, { throwIfNoEntry: false });
    if (status?.isDirectory()) for (const entry of fs.readdirSync(name)) add(path.join(name, entry));
    else if (status?.isFile()) put(root, name, new StoredFile(new DiskSource(name), status.mtimeMs));
  };
  for (const name of paths) add(name);
  return root;
}

const rows = [];   // of the table at the end: a part's name and what was found
const failures = [];

/// Runs both programs with the same arguments and hands both results to `compare`, which returns the largest relative
/// difference, or throws what differs. Outputs go to scratch/made on the disk and in the tree, which begins empty unless
/// the case keeps the files of the one before it.
async function both(row, name, args, tree, compare, { keepsFiles = false } = {}) {
  const made = path.join(scratch, "made");
  if (!keepsFiles) fs.rmSync(made, { recursive: true, force: true });
  fs.mkdirSync(made, { recursive: true });
  const environment = { FLIGHTWATT_WEB: path.join(project, "web"), SOURCE_DATE_EPOCH: "0" };
  let start = performance.now();
  const run = spawnSync(given.native, args, { cwd: made, encoding: "utf8", maxBuffer: 1 << 30, env: { ...process.env, ...environment } });
  const nativeMs = performance.now() - start;
  const native = { code: run.status, out: run.stdout, err: run.stderr, files: new Map() };
  for (const entry of fs.readdirSync(made, { recursive: true, withFileTypes: true }))
    if (entry.isFile()) native.files.set(path.join(entry.parentPath ?? entry.path, entry.name), null);
  for (const file of native.files.keys()) native.files.set(file, fs.readFileSync(file));
  start = performance.now();
  let engine;
  try {
    engine = await runProgram(module, args, tree, () => {}, environment);
    engine.files = new Map([...files(tree)].filter(([file, { isChanged }]) => isChanged && file.startsWith(made + "/"))
      .map(([file, stored]) => [file, Buffer.from(stored.bytes())]));
  } catch (error) {
    engine = { code: "trap", out: "", err: String(error.stack ?? error), files: new Map() };
  }
  const engineMs = performance.now() - start;
  row.cases += 1;
  const seconds = given.times ? `, native ${nativeMs.toFixed(0)} ms, module ${engineMs.toFixed(0)} ms, ${
    ((engine.memoryBytes ?? 0) / 1048576).toFixed(0)} MiB` : "";
  try {
    if (native.code !== engine.code) throw new Error(`exit code ${native.code} and ${engine.code}: ${engine.err.slice(0, 400)}`);
    const difference = compare(native, engine);
    row.largest = Math.max(row.largest, difference);
    row.refused += native.code === 0 ? 0 : 1;
    console.error(`${row.name}: ${name}: exit code ${native.code}, ${difference.toExponential(1)}${seconds}`);
  } catch (error) {
    failures.push(`${row.name}: ${name}: ${error.message}`);
    console.error(`${row.name}: ${name}: DIFFERS: ${error.message}${seconds}`);
  }
}

function newRow(name, allowed) {
  const row = { name, allowed, cases: 0, refused: 0, largest: 0 };
  rows.push(row);
  return row;
}

/// Numbers in texts, and what is between them.
const numberPattern = /[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?/g;

/// The largest relative difference of the numbers of two texts, which else are equal; throws where they differ by more
/// than `allowed` and by more than half of a last digit that is printed. `tiny` is the size of what counts as zero.
function difference(native, engine, allowed, what, tiny = 1e-12) {
  if (native === engine) return 0;
  if (native.replace(numberPattern, "#") !== engine.replace(numberPattern, "#")) throw new Error(`${what}: ${firstDifference(native, engine)}`);
  const [one, other] = [native.match(numberPattern) ?? [], engine.match(numberPattern) ?? []];
  let largest = 0;
  for (let i = 0; i < one.length; ++i) {
    if (one[i] === other[i]) continue;
    const [a, b] = [Number(one[i]), Number(other[i])];
    const scale = Math.max(Math.abs(a), Math.abs(b));
    const relative = scale < tiny ? 0 : Math.abs(a - b) / scale;
    if (relative > allowed) throw new Error(`${what}: number ${i + 1}: ${one[i]} and ${other[i]}, ${relative.toExponential(1)}`);
    largest = Math.max(largest, relative);
  }
  return largest;
}

function firstDifference(native, engine) {
  const [one, other] = [native.split("\n"), engine.split("\n")];
  const at = one.findIndex((line, i) => line !== other[i] &&
    line.replace(numberPattern, "#") !== (other[i] ?? "").replace(numberPattern, "#"));
  return at < 0 ? `${one.length} and ${other.length} lines` : `line ${at + 1}:\n  native ${one[at].slice(0, 300)}\n  module ${(other[at] ?? "").slice(0, 300)}`;
}

/// Printed texts and the standard errors.
const printed = (allowed) => (native, engine) => Math.max(
  difference(native.err, engine.err, allowed, "standard error"), difference(native.out, engine.out, allowed, "standard output"));

/// And all files that were written. Fingerprints of results differ with the last digit of any.
const written = (allowed, only = () => true) => (native, engine) => {
  let largest = printed(allowed)(native, engine);
  const names = (result) => [...result.files.keys()].filter(only).sort().join("\n");
  if (names(native) !== names(engine)) throw new Error(`files: ${firstDifference(names(native), names(engine))}`);
  for (const [file, bytes] of native.files) {
    if (!only(file) || bytes.equals(engine.files.get(file))) continue;
    const text = (content) => content.toString().replace(/"(results|seal|key)": ?"[0-9a-f ]+"/g, '"$1":""');
    largest = Math.max(largest, difference(text(bytes), text(engine.files.get(file)), allowed, path.relative(scratch, file)));
  }
  return largest;
};

/// Logs below folders, without what belongs to another log.
function logsBelow(...folders) {
  const found = folders.filter((folder) => fs.existsSync(folder)).flatMap((folder) =>
    fs.readdirSync(folder, { recursive: true }).map((name) => path.join(folder, name)));
  const isLog = (name) => /\.(data|data\.gz|bin|BIN|LOG|ulg|px4log|tlog|tlm|csv)$/.test(name) && fs.statSync(name).isFile();
  return found.filter(isLog).sort();
}

/// The folder of a log, which has its definitions beside it.
const beside = (log) => treeOf(path.dirname(log));

const own = logsBelow(path.join(project, "logs"));
const others = logsBelow(path.join(shared, "archives"), path.join(shared, "flights"))
  .concat(logsBelow(path.join(shared, "m100")).filter((_, i) => i % 7 === 0));
if (others.length === 0) console.error(`equality_test: ${shared} is missing: logs of others are skipped`);

const parts = {
  async logs() {
    const row = newRow("segment --json", 0);
    for (const log of [...own, ...others]) await both(row, log, ["segment", log, "--json"], beside(log), printed(0));
  },
  async series() {
    const row = newRow("parse", 1e-14);
    const chosen = [...own.slice(0, 1), ...others.filter((_, i) => i % 5 === 0)];
    for (const log of chosen) await both(row, log, ["parse", log], beside(log), printed(1e-14));
  },
  async fits() {
    const batch = newRow("batch: files", 1e-6);
    const tree = treeOf(path.join(project, "logs"));
    await both(batch, "logs", ["batch", ...own, "--jobs", "1", "-o", path.join(scratch, "made/batch")], tree, written(1e-6));
    const row = newRow("fit, validate, battery, trends", 1e-6);
    await both(row, "fit logs", ["fit", ...own, "--json"], treeOf(path.join(project, "logs")), printed(1e-6));
    await both(row, "validate logs", ["validate", ...own, "--json"], treeOf(path.join(project, "logs")), printed(1e-6));
    await both(row, "battery logs", ["battery", ...own, "--capacity", "5.1", "--json"], treeOf(path.join(project, "logs")), printed(1e-6));
    const flights = logsBelow(path.join(shared, "flights")).filter((name) => /\/20_.*\.data$/.test(name));
    if (flights.length > 1)
      await both(row, "fit ../shared/flights", ["fit", ...flights, "--json"], treeOf(path.join(shared, "flights")), printed(1e-6));
  },
  async missions() {
    const row = newRow("simulate, plan, compare, path", 1e-9);
    const tree = () => treeOf(path.join(project, "missions"), path.join(project, "fits"), path.join(project, "logs"));
    const below = (folder) => fs.readdirSync(path.join(project, "missions", folder)).filter((name) => name.endsWith(".toml"))
      .map((name) => path.join(project, "missions", folder, name));
    const missions = [...below("paper"), ...below("synthetic")];
    for (const mission of missions) {
      const name = path.relative(project, mission);
      for (const stage of ["simulate", "plan", "path"])
        await both(row, `${stage} ${name}`, [stage, mission, "--json"], tree(), printed(1e-9));
    }
    await both(row, "simulate --samples", ["simulate", path.join(project, "missions/paper/phased.toml"), "--samples", "2000", "--json"], tree(), printed(1e-9));
    await both(row, "compare missions/paper", ["compare", ...below("paper"), "--json"], tree(), printed(1e-9));
  },
  async answers() {
    const row = newRow("answer --json", 1e-6);
    const groups = new Map([["logs", own]]);
    for (const log of others.filter((name) => /autopilots|flights|mit\/.*ulg/.test(name))) {
      const key = path.relative(shared, path.dirname(log));
      groups.set(key, [...(groups.get(key) ?? []), log]);
    }
    for (const [name, logs] of groups) {
      const tree = treeOf(...new Set(logs.map((log) => path.dirname(log))));
      await both(row, name, ["answer", ...logs, "--capacity", "5", "--no-page", "--json"], tree, printed(1e-6));
    }
  },
  /// A page's sliders are options of answer, whose mission simulate flies: 100 settings, the same in each run. They rest
  /// on fits, which differ by up to 1e-6.
  async sliders() {
    const allowed = 1e-5;
    const row = newRow("answer and simulate, 100 settings", allowed);
    const logs = own.filter((name) => /_0[1-3]\.data$/.test(name));
    const out = path.join(scratch, "made/answer");
    const ranges = [["--reserve", 0, 50], ["--payload", 0, 1], ["--wind", 0, 12], ["--airspeed", 9, 18], ["--temperature", -20, 45]];
    const random = randomNumbers(20261129);
    const between = (low, high) => (low + (high - low) * random()).toFixed(2);
    for (let i = 0; i < 100; ++i) {
      const options = ranges.filter(() => random() < 0.4).flatMap(([option, low, high]) => [option, between(low, high)]);
      const question = ["--capacity", between(1, 8), ...options];
      const tree = treeOf(path.join(project, "logs"));
      const answer = ["answer", ...logs, "-o", out, "--no-page", "--json", "--quiet", ...question];
      await both(row, question.join(" "), answer, tree, printed(allowed));
      const simulate = ["simulate", path.join(out, "answer-mission.toml"), "--samples", "400", "--json"];
      await both(row, `simulate ${question.join(" ")}`, simulate, tree, printed(allowed), { keepsFiles: true });
    }
  },
};

/// Mulberry32: numbers from 0 to 1.
function randomNumbers(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let mixed = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 4294967296;
  };
}

for (const part of given.parts) await parts[part]();

const table = [["compared", "cases", "refused alike", "largest difference", "allowed", "result"],
  ...rows.map(({ name, allowed, cases, refused, largest }) => [name, cases, refused, largest === 0 ? "none" : largest.toExponential(1),
    allowed === 0 ? "none" : allowed.toExponential(), failures.some((line) => line.startsWith(name)) ? "DIFFERS" : "equal"])];
const widths = table[0].map((_, column) => Math.max(...table.map((line) => String(line[column]).length)));
for (const line of table) console.log(line.map((cell, i) => String(cell).padEnd(widths[i])).join("  ").trimEnd());
if (failures.length > 0) {
  console.log(`\n${failures.join("\n")}`);
  process.exit(1);
}
