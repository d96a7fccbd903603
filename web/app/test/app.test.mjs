// The page that reads logs, in Chromium from a file and without a network: node --test web/app/test/
// FLIGHTWATT is the program that the page's engine is then, FLIGHTWATT_PAGE a flightwatt.html with its own; CHROMIUM the browser.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync } from "node:fs";
import { copyFile, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { giveNativeEngine } from "./native_engine.mjs";

const here = path.dirname(fileURLToPath(import.meta.url));
const logs = path.resolve(here, "../../../logs");
const y6 = path.resolve(here, "../../../../shared/archives/autopilots/ardupilot/y6_2004.bin");
const program = process.env.FLIGHTWATT && path.resolve(process.env.FLIGHTWATT);
const page_file = process.env.FLIGHTWATT_PAGE;
const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
const skip = (program || page_file) && existsSync(executablePath)
  ? false
  : "neither FLIGHTWATT nor FLIGHTWATT_PAGE, or no browser";
const patience = { timeout: 300_000 };

let browser;
let folder;
let address;

before(async () => {
  if (skip) return;
  browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
  folder = await mkdtemp(path.join(os.tmpdir(), "flightwatt-page-"));
  address = page_file ? pathToFileURL(path.resolve(page_file)).href : await plainPage();
});
after(async () => {
  await browser?.close();
  if (folder) await rm(folder, { recursive: true, force: true });
});

/// The bundle alone, whose engine is given to it.
async function plainPage() {
  execFileSync("node", [path.resolve(here, "../../build.mjs"), folder]);
  const file = path.join(folder, "page.html");
  await writeFile(
    file,
    '<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>FlightWatt</title><link rel="stylesheet" href="app.css"><div id="app"></div><script src="app.js"></script>',
  );
  return pathToFileURL(file).href;
}

/// Opens the page; anything that it fetches, or any error of it, fails the test.
async function open(t, { width = 1440, height = 900, scheme = "light" } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, offline: true });
  t.after(() => context.close());
  const page = await context.newPage();
  page.on("pageerror", (error) => assert.fail(error));
  page.on("request", (request) => assert.match(request.url(), /^(file|blob|data):/));
  if (!page_file) await giveNativeEngine(page, program);
  await page.goto(address);
  await page.waitForSelector("h1");
  return page;
}

const named = (name, buffer) => ({ name, mimeType: "application/octet-stream", buffer });
const sample = (number) => ["data", "log"].map((ending) => path.join(logs, `opterra_synthetic_0${number}.${ending}`));
const choose = (page, files, label = "Choose files") => page.setInputFiles(`input[aria-label="${label}"]`, files);

async function dropThree(page) {
  await choose(page, [1, 2, 3].flatMap(sample));
  await page.waitForSelector(".log.used", patience);
}

/// The sample logs do not state their pack.
async function showAnswer(page) {
  await page.click('nav a[href="#answer"]');
  await page.fill("#asked-capacity", "3.2", patience);
  await page.click(".asked button");
  await page.waitForSelector(".figures .figure-value b", patience);
}

async function violations(page) {
  await page.evaluate(await readFile(path.resolve(here, "../../node_modules/axe-core/axe.min.js"), "utf8"));
  const { violations: found } = await page.evaluate(() => globalThis.axe.run());
  return found.map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 160)).join(" | ")}`);
}

test("three logs become one aircraft, a line each, and an answer with its chance", { skip, ...patience }, async (t) => {
  const page = await open(t);
  const started = performance.now();
  await dropThree(page);
  assert.equal(await page.locator(".log.used").count(), 3);
  await showAnswer(page);
  t.diagnostic(`${((performance.now() - started) / 1000).toFixed(1)} s to the answer`);
  assert.match(await page.textContent("h1"), /^A full pack lasts \d/);
});

test("a log that is refused has its reason", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await choose(page, [named("holiday.jpg", Buffer.from("no log at all\n"))]);
  await page.waitForSelector(".log.not", patience);
  assert.match(await page.textContent(".log.not .log-reason"), /is no log that is known/);
});

test("logs whose reading was cancelled are counted, in the command, and read by a button", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await choose(page, [1, 2, 3].flatMap(sample));
  await page.click(".reading button", patience);
  await page.waitForSelector("h2:has-text('Reading was cancelled: 3 logs are not read')", patience);
  assert.match(await page.textContent(".command code"), /^flightwatt opterra_synthetic_01.data /);
  await page.click("button:text-is('Read')");
  await page.waitForSelector(".log.used", patience);
  assert.equal(await page.locator(".log.used").count(), 3);
  assert.equal(await page.locator("h2:has-text('cancelled')").count(), 0);
});

test("hostile names are shown and stay names", { skip, ...patience }, async (t) => {
  const page = await open(t);
  const data = await readFile(sample(1)[0]);
  const definitions = await readFile(sample(1)[1]);
  const hostile = "<img src=x onerror=\"document.title='owned'\">";
  await choose(page, [
    named(`${hostile}.data`, data), named(`${hostile}.log`, definitions), named("-o.bin", Buffer.from("x")),
    named("日本\u202ebin.data", Buffer.from("x")), named(`${"n".repeat(240)}.bin`, Buffer.from("x")),
  ]);
  await page.waitForSelector(".log.used", patience);
  assert.equal(await page.locator("main img").count(), 0);
  assert.equal(await page.title(), "FlightWatt");
  assert.equal(await page.locator(".log.not").count(), 3);
});

test("a slider asks anew, keeps the old answer in sight, and takes it back", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  const before_move = await page.textContent(".figures .figure-value");
  await page.locator('input[aria-label="Reserve"]').fill("40");
  await page.waitForFunction(() => /less/.test(document.querySelector(".figures")?.textContent ?? ""), null, patience);
  assert.notEqual(await page.textContent(".figures .figure-value"), before_move);
  assert.match(await page.textContent(".command code"), /--reserve 40/);
  await page.click("text=As measured");
  await page.waitForFunction(
    (text) => document.querySelector(".figures .figure-value")?.textContent === text,
    before_move,
    patience,
  );
});

test("a slider that moves has the time of half of the flights at once, and its chance when it rests", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  const label = (reserve) => `.figures:not(.old) .figure-label:text-is("In the air, until ${reserve} % is left")`;
  for (const reserve of [30, 35, 40]) {
    await page.locator('input[aria-label="Reserve"]').fill(String(reserve));
    await page.waitForSelector(label(reserve), patience);
  }
  assert.match(await page.textContent("h1"), /in half of the flights$/);
  const half = await page.textContent(".figures .figure-value");
  await page.waitForSelector(".figures .ok", patience);
  assert.equal(await page.locator(label(40)).count(), 1);
  assert.match(await page.textContent("h1"), /in 95 of 100 flights$/);
  assert.ok((await page.textContent(".figures .soft")).endsWith(half), "the whole answer has the same time");
});

test("the capacity of the logs is taken back, and a move of its slider does not move its ends", {
  skip: skip || !existsSync(y6),
  ...patience,
}, async (t) => {
  const page = await open(t);
  await choose(page, [y6]);
  await page.waitForSelector(".log.used", patience);
  await page.click('nav a[href="#answer"]');
  await page.waitForSelector(".figures .figure-value b", patience);
  const before = await page.textContent(".figures .figure-value");
  const slider = page.locator('input[aria-label="Pack capacity"]');
  const ends = async () => [await slider.getAttribute("min"), await slider.getAttribute("max")];
  const ends_before = await ends();
  await slider.fill("4.5");
  await page.waitForSelector(".figures .change.less", patience);
  assert.deepEqual(await ends(), ends_before);
  await page.click("text=As measured");
  await page.waitForFunction((text) => document.querySelector(".figures .figure-value")?.textContent === text, before, patience);
  assert.doesNotMatch(await page.textContent(".command code"), /--capacity/);
});

test("a refused question greys the old answer beside its error, and the sliders take it back", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  await page.waitForSelector(".parameters", patience);
  await page.fill(".field input", "99999999");
  await page.press(".field input", "Tab");
  await page.waitForSelector(".card.failed", patience);
  assert.match(await page.textContent(".card.failed"), /the distance from home/);
  assert.equal(await page.locator(".figures.old, .parameters.old").count(), 2);
  assert.ok(await page.isDisabled("button:has-text('Copy for ArduPilot')"));
  await page.click("text=As measured");
  await page.waitForSelector(".figures:not(.old)", patience);
  assert.equal(await page.locator(".card.failed").count(), 0);
  await page.waitForSelector("button:has-text('Copy for ArduPilot'):enabled", patience);
});

test("a capacity that contradicts the flights is warned of, and no time of it is green", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  assert.equal(await page.locator(".card.warned").count(), 0);
  await page.locator('input[aria-label="Pack capacity"]').fill("1.5");
  await page.waitForSelector(".card.warned", patience);
  assert.match(await page.textContent(".card.warned"), /the capacity of 1.5 Ah contradicts the flights, which indicate/);
  assert.equal(await page.locator(".figures .ok").count(), 0);
});

test("an area is flown, and has a verdict with its command", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  const corners = [[1.48, 43.56], [1.49, 43.56], [1.49, 43.565], [1.48, 43.565], [1.48, 43.56]];
  const area = JSON.stringify({
    type: "Feature",
    properties: {},
    geometry: { type: "Polygon", coordinates: [corners] },
  });
  await page.click('nav a[href="#plan"]');
  await choose(
    page,
    [{ name: "field.geojson", mimeType: "application/json", buffer: Buffer.from(area) }],
    "Choose a plan",
  );
  await page.waitForSelector(".verdict-band, [role=alert]", patience);
  assert.equal(
    await page.locator("[role=alert]").count(),
    0,
    await page.locator("[role=alert]").allTextContents().then(String),
  );
  assert.match(await page.textContent(".command code"), /new-mission .*--plan field.geojson/);
  assert.match(await page.textContent(".verdict-band"), /capacity of the pack is unknown: the flights indicate 2\.\d to 11\.\d Ah/);
  const flown = page.locator(".map path.on-c1, .map path.on-c2");
  assert.ok((await flown.count()) > 0, "what is flown is drawn, coloured by the charge");
  assert.match(await page.textContent(".chart-key"), /charge left/);
});

const placeOf = (item, latitude, longitude) => ({
  type: "SimpleItem", frame: 3, command: 16, params: [0, 0, 0, null, latitude, longitude, 60], doJumpId: item,
});

test("a plan that does not fit has what would help, and one that fits is saved for the autopilot", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  const corners = [[1.48, 43.56], [1.50, 43.56], [1.50, 43.58], [1.48, 43.58], [1.48, 43.56]];
  const area = JSON.stringify({ type: "Polygon", coordinates: [corners] });
  await page.click('nav a[href="#plan"]');
  await choose(page, [named("large.geojson", Buffer.from(area))], "Choose a plan");
  await page.waitForSelector(".verdict-band.bad", patience);
  await page.click(".help:has-text('apart'):has-text('enough')", patience);
  await page.waitForSelector(".verdict-band.good", patience);
  assert.match(await page.textContent(".command code"), /--spacing \d+/);
  const [download] = await Promise.all([page.waitForEvent("download", patience), page.click(".buttons button:text-is(' File')")]);
  assert.equal(download.suggestedFilename(), "large-pack-1.plan");
  const plan = JSON.parse(await readFile(await download.path(), "utf8"));
  assert.equal(plan.fileType, "Plan");
  assert.ok(plan.mission.items.length > 10);
  assert.match(await page.textContent('[aria-label="What was planned"]'), /no altitude is stated: 50 m above the ground/);
});

test("an area that is too small for its lines has a slider for their spacing", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  await page.click('nav a[href="#plan"]');
  await choose(page, [areaOf("small.geojson", 0.0005, 0.0002)], "Choose a plan");
  await page.waitForSelector("[role=alert]:has-text('apart fit into the area')", patience);
  await move(page, "Spacing of the lines", 10);
  await page.waitForSelector(".verdict-band", patience);
  assert.match(await page.textContent(".command code"), /--spacing 10/);
});

/// Corners of a rectangle from 43.56 N, 1.48 E on, as a file that is dropped.
function areaOf(name, width_deg, height_deg) {
  const [x, y] = [1.48, 43.56];
  const ring = [[x, y], [x + width_deg, y], [x + width_deg, y + height_deg], [x, y + height_deg], [x, y]];
  return named(name, Buffer.from(JSON.stringify({ type: "Polygon", coordinates: [ring] })));
}

const move = (page, label, value) => page.locator(`input[aria-label="${label}"]`).fill(String(value));

/// Waits until nothing is computed.
const settled = (page) => page.waitForFunction(
  () => document.querySelector(".verdict-band[aria-busy=false]") && !document.querySelector("[aria-busy=true]"), null, patience);

test("the command of a plan gives the number of the screen in an empty folder", { skip: skip || !program, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  await page.click('nav a[href="#plan"]');
  const area = areaOf("field.geojson", 0.01, 0.005);
  await choose(page, [area], "Choose a plan");
  await page.waitForSelector(".verdict-band.good", patience);
  const empty = await mkdtemp(path.join(os.tmpdir(), "flightwatt-command-"));
  t.after(() => rm(empty, { recursive: true, force: true }));
  await writeFile(path.join(empty, area.name), area.buffer);
  for (const file of [1, 2, 3].flatMap(sample)) await copyFile(file, path.join(empty, path.basename(file)));
  const line = (await page.textContent(".command code")).replaceAll(/\bflightwatt (?=\S)/g, `'${program}' `);
  const printed = execFileSync("sh", ["-c", `${line} --json`], { cwd: empty, stdio: ["ignore", "pipe", "ignore"], encoding: "utf8" });
  const { final_soc_percent } = JSON.parse(printed.slice(printed.indexOf('{\n  "format"')));
  assert.match(await page.textContent(".verdict-band"), new RegExp(`Lands with ${final_soc_percent.toFixed(1)} %`));
});

test("a plan over several packs has the least chance of its flights", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  await page.click('nav a[href="#plan"]');
  await choose(page, [areaOf("field.geojson", 0.01, 0.005)], "Choose a plan");
  await page.waitForSelector(".verdict-band.good", patience);
  await move(page, "Packs", 2);
  await page.waitForSelector(".verdict-band:has-text('with each pack')", patience);
  assert.match(await page.textContent(".pack-flights"), /Pack 1.* of 100 keep the reserve/);
});

test("an edited plan of the same name has its own verdict and keeps the sliders", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  await page.click('nav a[href="#plan"]');
  await choose(page, [areaOf("field.geojson", 0.01, 0.005)], "Choose a plan");
  await page.waitForSelector(".verdict-band.good", patience);
  await move(page, "Spacing of the lines", 70);
  await page.waitForFunction(() => /--spacing 70/.test(document.querySelector(".command code")?.textContent ?? ""), null, patience);
  await settled(page);
  const outline = () => page.locator(".map path").evaluateAll((all) => all.map((one) => one.getAttribute("d")).join());
  const [facts, drawn] = [await page.textContent(".plan-facts"), await outline()];
  await choose(page, [areaOf("field.geojson", 0.02, 0.02)], "Open");
  await page.waitForSelector(".verdict-band.bad", patience);
  assert.notEqual(await page.textContent(".plan-facts"), facts);
  assert.notEqual(await outline(), drawn);
  assert.match(await page.textContent(".command code"), /--spacing 70/);
});

test("what is saved of a plan is of that plan, whatever was flown since for what would help", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  await page.click('nav a[href="#plan"]');
  await choose(page, [areaOf("large.geojson", 0.02, 0.02)], "Choose a plan");
  await page.waitForSelector(".verdict-band.bad", patience);
  await page.waitForSelector(".help:has-text('packs'):has-text('about half of the flights')", patience);
  const saved = async (button) => {
    const [download] = await Promise.all([page.waitForEvent("download", patience), page.click(`.plan-side button:text-is("${button}")`)]);
    return readFile(await download.path(), "utf8");
  };
  const last_s = Number((await saved(" Charge (CSV)")).trim().split("\n").at(-1).split(",")[0]);
  const minutes = Math.floor(last_s / 60);
  assert.ok((await page.textContent(".plan-facts")).includes(`${Math.floor(minutes / 60)} h ${minutes % 60} min`), String(last_s));
  await page.selectOption('[aria-label="Format for the autopilot"]', "px4");
  assert.match(await saved(" File"), /BAT/);
});

test("a plan that a slider makes unflyable keeps its sliders", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  await page.click('nav a[href="#plan"]');
  await choose(page, [areaOf("field.geojson", 0.01, 0.005)], "Choose a plan");
  await page.waitForSelector(".verdict-band.good", patience);
  await move(page, "Wind", 2);
  await page.waitForSelector("[role=alert]", patience);
  assert.match(await page.textContent("h1"), /not flown/);
  assert.doesNotMatch(await page.textContent("[role=alert]"), /flightwatt-|plans\//, "no names of the page's own");
  assert.equal(await page.locator(".plan-side button").count(), 0, "what is not flown is not saved");
  await move(page, "Wind", 0);
  await page.waitForSelector(".verdict-band.good", patience);
});

test("a plan of which a movement is not flown fits perhaps", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  const endless = { type: "SimpleItem", frame: 2, command: 177, params: [1, -1, 0, 0, 0, 0, 0], doJumpId: 3 };
  const plan = JSON.stringify({
    fileType: "Plan", version: 1, groundStation: "QGroundControl",
    mission: {
      version: 2, plannedHomePosition: [43.56, 1.48, 100],
      items: [placeOf(1, 43.57, 1.48), placeOf(2, 43.57, 1.49), endless],
    },
  });
  await page.click('nav a[href="#plan"]');
  await choose(page, [named("endless.plan", Buffer.from(plan))], "Choose a plan");
  await page.waitForSelector(".verdict-band.doubt", patience);
  assert.match(await page.textContent(".verdict-band"), /Perhaps.*item 3: the jump to item 1 is not flown/);
});

test("a plan above the terrain follows its tile where that is dropped", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  const items = [placeOf(1, 43.57, 1.48), placeOf(2, 43.57, 1.49)].map((item) => ({ ...item, frame: 10 }));
  const plan = JSON.stringify({
    fileType: "Plan", version: 1, groundStation: "QGroundControl",
    mission: { version: 2, plannedHomePosition: [43.56, 1.48, 100], items },
  });
  await page.click('nav a[href="#plan"]');
  await choose(page, [named("above.plan", Buffer.from(plan))], "Choose a plan");
  await page.waitForSelector(".verdict-band.doubt", patience);
  assert.match(await page.textContent(".verdict-band"), /Perhaps.*drop the tiles of its heights \(N47E008.hgt\)/);
  await choose(page, [named("n43e001.hgt", Buffer.alloc(2 * 61 * 61))], "Open");
  await page.waitForSelector(".verdict-band.good", patience);
  assert.match(await page.textContent(".command code"), /--terrain terrain/);
});

test("the second visit has the logs, and Forget all has none", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  await page.reload();
  await page.click('nav a[href="#logs"]');
  await page.waitForSelector(".log.used", patience);
  assert.equal(await page.locator(".log.used").count(), 3);
  await page.click("text=Forget all");
  await page.waitForSelector(".empty", patience);
  await page.reload();
  await page.waitForSelector(".empty", patience);
});

test("two windows that keep logs of one name keep both", { skip, ...patience }, async (t) => {
  const page = await open(t);
  const other = await page.context().newPage();
  if (!page_file) await giveNativeEngine(other, program);
  await other.goto(address);
  await other.waitForSelector("h1");
  for (const [window, number] of [[page, 1], [other, 2]]) {
    const [data, definitions] = await Promise.all(sample(number).map((file) => readFile(file)));
    await choose(window, [named("flight.data", data), named("flight.log", definitions)]);
    await window.waitForSelector(".log.used", patience);
  }
  await page.reload();
  await page.waitForFunction(() => document.querySelectorAll(".log.used").length === 2, null, patience);
});

test("the flights on paper have each value below its head, and distances from home may have thousands", { skip, ...patience }, async (t) => {
  const page = await open(t);
  await dropThree(page);
  await showAnswer(page);
  await page.waitForSelector(".parameters", patience);
  await page.fill(".field input", "1,500");
  await page.press(".field input", "Tab");
  await page.waitForFunction(() => /--home-distance 1500\b/.test(document.querySelector(".command code")?.textContent ?? ""), null, patience);
  await page.click('nav a[href="#flights"]');
  await page.waitForSelector(".flight-plot", patience);
  await page.emulateMedia({ media: "print" });
  await page.setViewportSize({ width: 718, height: 1000 });
  const left = (cells) => cells.map((cell) => Math.round(cell.getBoundingClientRect().right));
  const heads = await page.locator(".list thead th").evaluateAll(left);
  assert.deepEqual(await page.locator(".list tbody tr:first-child > *").evaluateAll(left), heads);
});

test("everything is reached by the keyboard", { skip, ...patience }, async (t) => {
  const page = await open(t);
  const dialog = page.waitForEvent("filechooser", patience);
  const tabTo = async (name) => {
    for (let i = 0; i < 60; i += 1) {
      await page.keyboard.press("Tab");
      const focused = await page.evaluate(() =>
        document.activeElement?.getAttribute("aria-label") || document.activeElement?.textContent?.trim());
      if (focused === name) return;
    }
    assert.fail(`the keyboard does not reach ${name}`);
  };
  await tabTo("Choose files");
  await page.keyboard.press("Enter");
  await (await dialog).setFiles([1, 2, 3].flatMap(sample));
  await page.waitForSelector(".log.used", patience);
  await tabTo("Answer for Opterra_synthetic");
  await page.keyboard.press("Enter");
  await page.waitForSelector("#asked-capacity", patience);
  await page.focus("#asked-capacity");
  await page.keyboard.type("3.2");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".figures .figure-value b", patience);
  await tabTo("Reserve");
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(
    () => /--reserve 21/.test(document.querySelector(".command code")?.textContent ?? ""),
    null,
    patience,
  );
});

for (const scheme of ["light", "dark"])
  test(`no screen has a fault that axe finds, and none is wider than a phone: ${scheme}`, {
    skip,
    timeout: 240_000,
  }, async (t) => {
    const page = await open(t, { width: 390, height: 844, scheme });
    const check = async (name) => {
      await page.waitForFunction(() => !document.querySelector("[aria-busy=true]"), null, patience);
      assert.deepEqual(await violations(page), [], name);
      assert.ok(
        await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth),
        `${name} is wider than 390 px`,
      );
    };
    await check("empty");
    await dropThree(page);
    await check("logs");
    await showAnswer(page);
    await page.waitForSelector(".parameters", patience);
    await check("answer");
    await page.click('nav a[href="#flights"]');
    await page.waitForSelector(".flight-plot", patience);
    await check("flights");
    await page.click('nav a[href="#plan"]');
    await check("plan");
  });
