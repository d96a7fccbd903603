// The sliders of `flightwatt report --interactive`, in Chromium from a file and without a network: node --test web/app/test/
// FLIGHTWATT is the program that writes the page and is its engine; with FLIGHTWATT_MODULE, a flightwatt.wasm.gz, the
// page runs that instead. CHROMIUM is the browser.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { copyFileSync, cpSync, existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { readFile } from "node:fs/promises";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { bundled } from "../../bundled.mjs";
import { giveNativeEngine } from "./native_engine.mjs";

const { missionText } = await bundled("work/mission_text.ts");

const web = fileURLToPath(new URL("../../", import.meta.url));
const program = process.env.FLIGHTWATT && path.resolve(process.env.FLIGHTWATT);
const module = process.env.FLIGHTWATT_MODULE;
const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
const skip = program && existsSync(executablePath) ? false : "no FLIGHTWATT, or no browser";
const patience = { timeout: 300_000 };

let browser;
let folder;
let missions;

before(async () => {
  if (skip) return;
  browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
  folder = mkdtempSync(path.join(os.tmpdir(), "flightwatt-report-"));
  missions = path.join(folder, "missions");
  for (const name of ["missions", "fits"]) cpSync(path.resolve(web, "..", name), path.join(folder, name), { recursive: true });
  execFileSync("node", [path.join(web, "build.mjs"), folder]);
  if (module) copyFileSync(module, path.join(folder, "flightwatt.wasm.gz"));
  else writeFileSync(path.join(folder, "flightwatt.wasm.gz"), "no module: the native engine is given");
  const names = ["paper/phased", "paper/adaptive", "synthetic/survey-path"].map((name) => path.join(missions, `${name}.toml`));
  const options = ["--interactive", "-o", path.join(folder, "report.html")];
  execFileSync(program, ["report", ...names, ...options], { env: { ...process.env, FLIGHTWATT_WEB: folder } });
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
});

/// Opens the page and selects a mission; anything that it fetches, or any error of it, fails the test.
async function open(t, mission, { width = 1440, height = 900, scheme = "light" } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, offline: true });
  t.after(() => context.close());
  const page = await context.newPage();
  page.on("pageerror", (error) => assert.fail(error));
  page.on("request", (request) => assert.match(request.url(), /^(file|blob|data):/));
  if (!module) await giveNativeEngine(page, program);
  await page.goto(pathToFileURL(path.join(folder, "report.html")).href);
  await page.click(`.mission-table .row-button:has-text("${mission}")`);
  await page.waitForSelector(`.mission-card[aria-label="Mission ${mission}"]`);
  return page;
}

const move = (page, label, value) => page.locator(`input[aria-label="${label}"]`).fill(String(value));
const settled = (page) => page.waitForFunction(
  () => document.querySelector(".mission-again[aria-busy=false] :is(.mission-facts, .refused)"), null, patience);
const facts = (page) => page.locator(".mission-again dd").allTextContents();

test("a changed number takes the place of the written one, whatever is around it", () => {
  const text = "\uFEFFreserve_soc_percent=5#%\r\nrun = { \"ü✈\" = { fps = 10} }\r\n[wind]\r\nspeed_m_per_s =\t4.0 # m/s\r\n";
  const sliders = [
    { key: "reserve_soc_percent", value: 5, places: [{ line: 1, column: 1 }] },
    { key: "ü✈.fps", value: 10, places: [{ line: 2, column: 18 }] },
    { key: "wind.speed_m_per_s", value: 4, places: [{ line: 4, column: 1 }] },
    { key: "capacity_ah", value: 3.2, places: [] },
    { key: "payload_kg", value: 0, places: [] },
  ];
  assert.equal(missionText(text, sliders, {}), text.slice(1));
  assert.equal(missionText(text, sliders, { 0: 12, 1: 5.8, 2: 0, 4: 0.5 }),
    "payload_kg = 0.5\nreserve_soc_percent=12#%\r\nrun = { \"ü✈\" = { fps = 5.8} }\r\n[wind]\r\nspeed_m_per_s =\t0 # m/s\r\n");
});

test("two rates of a line are changed, and of a table that is not stated all keys are written", () => {
  const sliders = [
    { key: "a.fps", value: 1, places: [{ line: 1, column: 17 }, { line: 1, column: 33 }] },
    { key: "wind.speed_m_per_s", value: 0, places: [] },
    { key: "wind.from_deg", value: 0, places: [] },
  ];
  assert.equal(missionText("run = { a   = { fps = 1, b = 2, fps = 1 } }", sliders, { 0: 30, 1: 4 }),
    "wind.speed_m_per_s = 4\nwind.from_deg = 0\nrun = { a   = { fps = 30, b = 2, fps = 30 } }");
});

test("what a slider shows is what the program prints of the changed mission, which can be saved", { skip, ...patience }, async (t) => {
  const page = await open(t, "phased");
  await move(page, "Reserve", 12);
  await move(page, "Pack capacity", 1.7);
  await settled(page);
  assert.match(await page.textContent(".mission-again"), /Keeps the reserve of 12 %/);
  assert.match(await page.textContent(".mission-what-if .command code"),
    /simulate phased\.toml --samples 1000 {2}# with reserve_soc_percent = 12, capacity_ah = 1\.7$/);
  const download = page.waitForEvent("download");
  await page.click("text=Save the mission");
  const saved = path.join(missions, "paper/saved.toml");
  writeFileSync(saved, await readFile(await (await download).path(), "utf8"));
  const printed = JSON.parse(execFileSync(program, ["simulate", saved, "--json", "--samples", "1000"]));
  assert.equal(printed.reserve_soc_percent, 12);
  const [landing, keeps] = await facts(page);
  if (printed.depleted_at_s == null) assert.equal(landing, `${printed.final_soc_percent.toFixed(1)} %`);
  else assert.match(landing, /^fails after/);
  const percent = Math.round(100 * (1 - printed.probability_below_reserve));
  assert.match(keeps, percent < 1 ? /^under 1/ : percent > 99 ? /^over 99/ : new RegExp(`^${percent} of 100`));
  await page.click("text=As written");
  await page.waitForSelector(".mission-again .mission-facts", { state: "detached" });
  assert.equal(await page.locator(".mission-what-if .command").count(), 0);
});

test("a rate of the software is changed where the schedule has it", { skip, ...patience }, async (t) => {
  const page = await open(t, "adaptive");
  await move(page, "detection fps, 32 as written", 16);
  await settled(page);
  assert.match(await page.textContent(".mission-what-if .command code"), /# with detection\.fps = [\d.]+ instead of 32$/);
  assert.doesNotMatch((await facts(page))[0], /^7\.4 %$/);
});

test("a mission that is to be planned is planned, and a refusal is shown as it is", { skip, ...patience }, async (t) => {
  const page = await open(t, "survey-path");
  const steps = await page.locator(".mission-what-if input[type=range]").evaluateAll((all) => all.map(({ min, step }) => min / step));
  for (const from of steps) assert.ok(Math.abs(from - Math.round(from)) < 1e-6, "what is shown is what is flown");
  await move(page, "Wind", 5);
  await settled(page);
  assert.match(await page.textContent(".mission-what-if .command code"),
    /^flightwatt plan survey-path\.toml -o planned\.toml && flightwatt simulate planned\.toml/);
  await move(page, "Wind", 15);
  await page.waitForSelector(".refused", patience);
  const changed = (await readFile(path.join(missions, "synthetic/survey-path.toml"), "utf8"))
    .replace("speed_m_per_s = 4", "speed_m_per_s = 15");
  const file = path.join(missions, "synthetic/changed.toml");
  writeFileSync(file, changed);
  const { stderr } = spawnSync(program, ["plan", file], { encoding: "utf8" });
  const reason = /error: (.*)/.exec(stderr)[1];
  assert.ok((await page.textContent(".refused")).includes(reason), reason);
});

for (const scheme of ["light", "dark"])
  test(`the sliders have no fault that axe finds, and are not wider than a phone: ${scheme}`, { skip, ...patience }, async (t) => {
    const page = await open(t, "adaptive", { width: 390, height: 844, scheme });
    await move(page, "Reserve", 12);
    await settled(page);
    await page.evaluate(await readFile(path.join(web, "node_modules/axe-core/axe.min.js"), "utf8"));
    const { violations } = await page.evaluate(() => globalThis.axe.run(".mission-card"));
    assert.deepEqual(violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 160)).join(" | ")}`), []);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  });
