// The report's pages in headless Chromium. Environment: PAGES is the folder of what page_test.sh makes, where screenshots
// are left; FLIGHTS are on more.html (none: the page of six flights alone is tested, the rest is skipped);
// FLIGHTWATT_WEB is the folder with node_modules, CHROMIUM the browser.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

const require = createRequire(path.join(process.env.FLIGHTWATT_WEB, "package.json"));
const { chromium } = require("playwright-core");
const axe = require("axe-core");

const folder = process.env.PAGES;
const flights = Number(process.env.FLIGHTS);
const isWhole = flights > 0;
const inCheck = { skip: isWhole ? false : "scripts/check integration runs it" };
const screenshots = path.join(folder, "screenshots");
const address = (name) => pathToFileURL(path.join(folder, name)).href;
let browser;

before(async () => {
  mkdirSync(screenshots, { recursive: true });
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox", "--disable-gpu"] });
});
after(() => browser?.close());

/** Opens a page and notes what it should not do; `blocksOpened` counts its compressed blocks that were opened. */
async function open(name, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  context.setDefaultTimeout(0); // a busy machine takes what it takes; CTest ends what never comes
  const page = await context.newPage();
  const faults = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && faults.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => faults.push(`exception: ${error.message}`));
  page.on("dialog", (dialog) => (faults.push(`dialog: ${dialog.message()}`), dialog.dismiss()));
  page.on("request", (request) => {
    if (request.url() !== address(name) && !/^(data|blob):/.test(request.url())) faults.push(`request: ${request.url()}`);
  });
  await page.addInitScript(() => {
    window.blocksOpened = 0;
    window.DecompressionStream = class extends window.DecompressionStream {
      constructor(...options) {
        super(...options);
        ++window.blocksOpened;
      }
    };
  });
  await page.goto(address(name));
  return { page, faults };
}

/** Opens every folded part. */
const openAll = (page) => page.evaluate(() => document.querySelectorAll("main details").forEach((details) => (details.open = true)));

/** Opens every flight and draws every figure; how many there are. */
async function drawAll(page) {
  return page.evaluate(async () => {
    for (const details of document.querySelectorAll("main details")) details.open = true;
    const { draw, figures, views } = window.flightwatt;
    for (const figure of figures) if (!views.has(figure)) await draw(figure);
    await new Promise((done) => {
      const wait = () => ([...figures].every((figure) => figure.dataset.drawn) ? done() : setTimeout(wait, 50));
      wait();
    });
    return figures.length;
  });
}

/** Waits until every figure that has room on the page is drawn for the width that it has. */
const allDrawn = (page) =>
  page.waitForFunction(() => window.flightwatt.figures.every(({ clientWidth, dataset }) => clientWidth === 0 || (!dataset.drawing && Number(dataset.width) === clientWidth)));

/** Draws every figure that has room on the page: the first flight is open. */
async function drawShown(page) {
  await page.evaluate(async () => {
    const { draw, figures, views } = window.flightwatt;
    for (const figure of figures) if (figure.clientWidth > 0 && !views.has(figure)) await draw(figure);
  });
  await allDrawn(page);
}

/** Asks until it is so; CTest ends what never comes. */
async function eventually(condition) {
  while (!(await condition())) await new Promise((resolve) => setTimeout(resolve, 20));
}

/** Figures whose drawing holds no mark that is seen. */
const withoutMarks = (page) =>
  page.evaluate(() =>
    [...window.flightwatt.figures]
      .filter((figure) => ![...figure.querySelectorAll("svg .role-mark path, svg .role-mark rect")].some((mark) => (mark.getAttribute("d") || "rect").length > 8 || mark.tagName === "rect"))
      .map((figure) => figure.dataset.name),
  );

const domain = (page, name) => page.evaluate((figure) => window.flightwatt.views.get(document.querySelector(`[data-name="${figure}"]`)).scale("x").domain(), name);
const width = ([low, high]) => high - low;

/** What axe finds in a part of the page. */
async function seriousFaults(page, part = "html") {
  await page.evaluate(axe.source);
  const { violations } = await page.evaluate((where) => window.axe.run(where), part);
  return violations;
}

/** How many lines a figure shows. */
const lines = (figure) => figure.locator("svg.marks .mark-line.role-mark path").evaluateAll((paths) => paths.filter((line) => line.getAttribute("d")).length);

test("six flights: every figure is drawn, nothing is printed, nothing is asked of the network", async () => {
  const { page, faults } = await open("six.html");
  const count = await drawAll(page);
  assert.equal(count, 13, `${count} figures`);
  assert.deepEqual(await withoutMarks(page), []);
  assert.deepEqual(faults, []);
  assert.ok(statSync(path.join(folder, "six.html")).size < 3e6);
  await page.context().close();
});

test("hovering a curve shows its value with its unit", async () => {
  const { page } = await open("six.html");
  const figure = page.locator('[data-name="flight-opterra_synthetic_01-power"]');
  await figure.scrollIntoViewIfNeeded();
  await figure.locator("svg.marks").waitFor();
  const point = figure.locator("svg.marks .mark-symbol.role-mark path").nth(300);
  const box = await point.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  const tooltip = page.locator("#vg-tooltip-element.visible");
  await tooltip.waitFor();
  assert.match(await tooltip.innerText(), /\[(m|%|W)\]\s*[\d.]+/);
  await page.context().close();
});

test("Ctrl and wheel, and the keyboard, zoom the time axis; the wheel alone does not", async () => {
  const { page, faults } = await open("six.html");
  const name = "flight-opterra_synthetic_01-power";
  const figure = page.locator(`[data-name="${name}"]`);
  await figure.scrollIntoViewIfNeeded();
  await figure.locator("svg.marks").waitFor();
  const whole = await domain(page, name);
  const box = await figure.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height * 0.75);
  await page.evaluate(() => addEventListener("wheel", () => requestAnimationFrame(() => requestAnimationFrame(() => (window.wheeled = true))), { capture: true, once: true }));
  await page.mouse.wheel(0, -1);
  await page.waitForFunction(() => window.wheeled);
  assert.deepEqual(await domain(page, name), whole);
  const now = await figure.boundingBox();
  await page.mouse.move(now.x + now.width / 2, now.y + now.height * 0.75);
  await page.keyboard.down("Control");
  await page.mouse.wheel(0, -300);
  await page.keyboard.up("Control");
  await eventually(async () => width(await domain(page, name)) < 0.9 * width(whole));
  const zoomed = await domain(page, name);
  assert.ok(width(zoomed) < 0.9 * width(whole), `${zoomed} of ${whole}`);
  await figure.focus();
  await page.keyboard.press("+");
  await eventually(async () => width(await domain(page, name)) < 0.6 * width(zoomed));
  const closer = await domain(page, name);
  assert.ok(width(closer) < 0.6 * width(zoomed), `${closer} of ${zoomed}`);
  await page.keyboard.press("0");
  await eventually(async () => width(await domain(page, name)) === width(whole));
  assert.deepEqual(await domain(page, name), whole);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("a click on the legend hides a series, another shows it again", async () => {
  const { page } = await open("six.html");
  await openAll(page);
  const figure = page.locator('[data-name="schedules-soc"]');
  await figure.scrollIntoViewIfNeeded();
  await figure.locator("svg.marks").waitFor();
  const all = await lines(figure);
  const symbol = figure.locator("svg.marks .role-legend-symbol path").first();
  await symbol.click({ force: true });
  await eventually(async () => (await lines(figure)) === all - 1);
  assert.equal(await lines(figure), all - 1);
  await symbol.click({ force: true });
  await eventually(async () => (await lines(figure)) === all);
  assert.equal(await lines(figure), all);
  await page.context().close();
});

test("the page answers first: the worst mission, all others in a table, the aircraft", async () => {
  const { page } = await open("six.html");
  const { missions, title } = JSON.parse(readFileSync(path.join(folder, "six.json"), "utf8"));
  assert.equal(await page.title(), title);
  assert.match(title, /SYNTHETIC.*6 flights, 1 January 2020.*9 missions/);
  assert.equal(await page.locator("main > section").first().getAttribute("id"), "missions");
  assert.match(await page.locator("h1").innerText(), /of nine missions/);
  const shown = page.locator("article.mission:visible");
  assert.equal(await shown.count(), 1);
  assert.equal(missions[0].final_soc_percent, 0);
  assert.match(await shown.locator("h2").innerText(), /^Runs empty .* before the end$/);
  assert.deepEqual(await page.locator(".missions tbody button").allInnerTexts(), missions.map(({ mission }) => mission));
  const order = await page.locator(".missions tbody tr").evaluateAll((rows) => rows.map((row) => ["fails", "misses", "may-miss", "keeps"].indexOf(row.className)));
  assert.deepEqual(order, [...order].sort());
  const data = JSON.parse(await page.locator("#data-missions").textContent());
  assert.deepEqual(data.map(({ title: name }) => name), missions.map(({ mission }) => mission));
  assert.ok(data.every(({ soc, time_s: times }) => soc.length === times.length && soc.length > 50));
  assert.ok(!(await page.content()).includes(folder), "no path of this machine");
  await page.context().close();
});

for (const colorScheme of ["light", "dark"])
  for (const width of [1440, 390])
    test(`without script, the page of an answer begins with the lines of the terminal: ${colorScheme}, ${width} px`, async () => {
      const { page, faults } = await open("answer/answer.html", { javaScriptEnabled: false, colorScheme, viewport: { width, height: 900 } });
      const words = (text) => text.replace(/\s+/g, " ").trim();
      const terminal = words(readFileSync(path.join(folder, "answer.txt"), "utf8")).replace(/; written by [^)]*\)| Page \S*$/g, "");
      assert.equal(words(`${await page.locator("main h1").innerText()} ${await page.locator("dl.answer").innerText()}`), terminal);
      const { bottom } = await page.locator("dl.answer dd").nth(2).evaluate((line) => line.getBoundingClientRect());
      assert.ok(bottom < 900, "the time in the air is on the first screen");
      assert.ok(await page.evaluate(() => document.getElementById("answer").scrollWidth <= innerWidth), "no line is wider than the screen");
      await page.locator("#answer summary").first().click();
      assert.match(await page.locator("#answer pre").first().innerText(), /^BATT_LOW_MAH \d+$/m);
      assert.ok(!(await page.content()).includes(folder), "no path of this machine");
      assert.deepEqual(faults, []);
      await page.screenshot({ path: path.join(screenshots, `answer-${colorScheme}-${width}.png`), fullPage: true });
      await page.context().close();
      const { page: scripted } = await open("answer/answer.html", { colorScheme, viewport: { width, height: 900 } }); // axe needs timers
      assert.deepEqual((await seriousFaults(scripted, "#answer")).map(({ id }) => id), []);
      await scripted.context().close();
    });

test("a row or a cell, by mouse or keyboard, changes the curve", async () => {
  const { page, faults } = await open("six.html");
  const shown = page.locator("article.mission:visible");
  const before = await shown.locator("svg .curve").first().getAttribute("d");
  const button = page.locator(".missions tbody button").nth(2);
  await button.focus();
  await page.keyboard.press("Enter");
  assert.equal(await shown.getAttribute("id"), "mission-2");
  assert.equal(await button.getAttribute("aria-pressed"), "true");
  assert.notEqual(await shown.locator("svg .curve").first().getAttribute("d"), before);
  await page.locator(".missions tbody tr").nth(1).click();
  assert.equal(await shown.getAttribute("id"), "mission-1");
  const cells = page.locator("[data-draw=grid]").first().locator("button");
  assert.equal(await cells.count(), 20);
  const cell = page.locator("[data-draw=cell]").first();
  for (const i of [0, 19]) {
    await cells.nth(i).focus();
    await page.keyboard.press("Enter");
    assert.equal(await cells.nth(i).getAttribute("aria-pressed"), "true");
    const [setting, end] = (await cells.nth(i).getAttribute("aria-label")).split(/: |, keeps/);
    assert.ok((await cell.locator("h3").innerText()).startsWith(setting), setting);
    if (end.startsWith("lands")) assert.ok((await cell.locator("h3").innerText()).endsWith(end), end);
  }
  assert.match(await cell.innerText(), /Charge, against .*\n[+\u2212][\d.]+ points/);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("the legend's series by keyboard", async () => {
  const { page } = await open("six.html");
  await openAll(page);
  const figure = page.locator('[data-name="schedules-soc"]');
  await figure.scrollIntoViewIfNeeded();
  await figure.locator("svg.marks").waitFor();
  const all = await lines(figure);
  const button = page.locator("figure:has([data-name='schedules-soc']) .series button").first();
  assert.equal(await button.getAttribute("aria-pressed"), "true");
  await button.focus();
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.activeElement.getAttribute("aria-pressed") === "false");
  assert.equal(await lines(figure), all - 1);
  await page.keyboard.press(" ");
  await page.waitForFunction(() => document.activeElement.getAttribute("aria-pressed") === "true");
  assert.equal(await lines(figure), all);
  await page.context().close();
});

test("saving a figure gives an SVG that parses, and a PNG", async () => {
  const { page } = await open("six.html", { acceptDownloads: true });
  await openAll(page);
  const figure = page.locator('[data-name="model-curves"]');
  await figure.scrollIntoViewIfNeeded();
  await figure.locator("svg.marks").waitFor();
  await figure.locator("summary").click();
  const save = async (label) => {
    const [download] = await Promise.all([page.waitForEvent("download"), figure.getByText(label).click()]);
    return { name: download.suggestedFilename(), content: readFileSync(await download.path()) };
  };
  const svg = await save("Save as SVG");
  assert.equal(svg.name, "model-curves.svg");
  const paths = await page.evaluate((text) => {
    const xml = new DOMParser().parseFromString(text, "image/svg+xml");
    return xml.querySelector("parsererror") ? -1 : xml.querySelectorAll("path").length;
  }, svg.content.toString("utf8"));
  assert.ok(paths > 10, `${paths} paths`);
  const png = await save("Save as PNG");
  assert.equal(png.content.subarray(1, 4).toString(), "PNG");
  await page.context().close();
});

test("the table of flights sorts by any column", async () => {
  const { page } = await open("six.html");
  const table = page.locator("#flights table.sortable").first();
  const column = async () => (await table.locator("tbody tr td:nth-child(9)").allInnerTexts()).map(Number);
  await table.locator("th:nth-child(9) button").click();
  const rising = await column();
  assert.deepEqual(rising, [...rising].sort((a, b) => a - b));
  await page.keyboard.press("Enter"); // the button has the focus
  assert.deepEqual(await column(), [...rising].reverse());
  await page.context().close();
});

test("on a phone a row is a block with its labels, and no text is smaller than 12 px", async () => {
  const { page } = await open("six.html", { viewport: { width: 390, height: 844 } });
  const cell = page.locator("#flights table").first().locator("tbody td").nth(3);
  assert.match(await cell.evaluate((td) => getComputedStyle(td, "::before").content), /Distance \[km\]/);
  await drawAll(page);
  const small = await page.evaluate(() => {
    const texts = [...document.querySelectorAll("main *")].filter((part) => [...part.childNodes].some((node) => node.nodeType === 3 && node.data.trim()) && part.getClientRects().length > 0);
    return texts.filter((part) => Number.parseFloat(getComputedStyle(part).fontSize) < 12).map((part) => part.outerHTML.slice(0, 90));
  });
  assert.deepEqual(small.slice(0, 3), []);
  await page.context().close();
});

const faultsOf = (violations) => violations.map(({ id, nodes }) => [id, nodes.length, nodes[0].html.slice(0, 200), nodes[0].failureSummary]);

test("axe finds nothing in the first screen", async () => {
  const { page } = await open("six.html");
  assert.deepEqual(faultsOf(await seriousFaults(page, "#missions")), []);
  await page.context().close();
});

for (const scheme of ["light", "dark"]) {
  test(`axe finds nothing, ${scheme}`, inCheck, async () => {
    const { page } = await open("six.html", { colorScheme: scheme });
    await drawAll(page);
    assert.deepEqual(faultsOf(await seriousFaults(page)), []);
    await page.context().close();
  });
}

test("names with markup, quotes, unicode and 300 characters break nothing", inCheck, async () => {
  const { page, faults } = await open("hostile.html");
  await drawAll(page);
  assert.deepEqual(await withoutMarks(page), []);
  assert.deepEqual(faults, []);
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal(await page.locator("main script:not([type='application/json'])").count(), 0);
  const text = await page.locator("body").innerText();
  for (const part of ["<script>window.hacked=1</script>", "\u03b1\u03b2\u03b3", '"quoted"', "m".repeat(300)]) assert.ok(text.includes(part), part);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.ok(overflow <= 0, `${overflow} px outside of the page`);
  await page.context().close();
});

/** The rows of every table of a specification, whatever form they are in: numbers as numbers, gaps as null. */
function tablesOf(part) {
  if (part === null || typeof part !== "object") return [];
  if (!Array.isArray(part) && part.values && !part.format) return [part.values.map((row) => Object.values(row))];
  if (!Array.isArray(part) && typeof part.values === "string") {
    const [head, ...lines] = part.values.split("\n").map((line) => line.split(","));
    return [lines.map((cells) => cells.map((cell, i) => (head[i] in part.format.parse ? (cell === "" ? null : Number(cell)) : cell)))];
  }
  return Object.values(part).flatMap(tablesOf);
}

test("many flights are compressed, and each opens to what its figures are as files", inCheck, async () => {
  const { page, faults } = await open("many.html");
  const flights = page.locator("details.flight");
  const count = await flights.count();
  assert.ok(count > 20, `${count} flights`);
  assert.equal(await page.locator("script.block").count(), count - 1);
  await page.evaluate(() => document.querySelectorAll("details.flight").forEach((details) => (details.open = true)));
  await page.waitForFunction(() => !document.querySelector("script.block"));
  const specs = await page.evaluate(() => window.flightwatt.figures.map((figure) => [figure.dataset.name, window.flightwatt.specOf(figure)]));
  assert.ok(specs.length > count, `${specs.length} figures`);
  for (const [name, spec] of specs) {
    const written = JSON.parse(readFileSync(path.join(folder, "many_figures", `${name}.vl.json`), "utf8"));
    const tables = tablesOf(spec);
    assert.ok(tables.length > 0, name);
    assert.deepEqual(tables, tablesOf(written), name);
    assert.equal(spec.description, written.description);
  }
  await page.evaluate(async () => {
    const { draw, figures, views } = window.flightwatt;
    for (const figure of figures.slice(-2)) if (!views.has(figure)) await draw(figure);
  });
  assert.equal(await page.locator("details.flight").last().locator("table[aria-label='Edges of the phases']").count(), 1);
  assert.deepEqual(faults, []);
  assert.deepEqual((await seriousFaults(page, "details.flight:last-of-type")).map(({ id }) => id), []);
  await page.context().close();
});

test("a link to a compressed flight opens it, and paper has what is open", inCheck, async () => {
  const { page, faults } = await open("many.html");
  const link = page.locator("#flights table.sortable").first().locator("tbody tr:last-child a");
  const target = await link.getAttribute("href");
  await link.click();
  await page.locator(`${target} [data-drawn]`).first().waitFor();
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  await page.waitForFunction((id) => [...document.querySelectorAll(`${id} [data-spec]`)].every((figure) => figure.dataset.drawn), target);
  assert.equal(await page.locator(`${target} > script.block`).count(), 0);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("a browser that cannot open a compressed flight states what to do; so does a damaged page", inCheck, async () => {
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.addInitScript(() => delete window.DecompressionStream);
  await page.goto(address("many.html"));
  const last = page.locator("details.flight").last();
  await last.locator("summary").first().click();
  assert.match(await last.locator("[role=alert]").innerText(), /no DecompressionStream.*Firefox 113.*--since/s);
  assert.ok((await page.locator("details.flight").first().locator("[data-spec]").count()) > 0, "the first flight is plain");
  await context.close();
  const { page: damaged } = await open("many.html");
  const flight = damaged.locator("details.flight").nth(1);
  await flight.locator("script.block").evaluate((block) => (block.textContent = block.textContent.slice(0, 400)));
  await flight.locator("summary").first().click();
  assert.match(await flight.locator("[role=alert]").innerText(), /damaged: write the page again/);
  await damaged.context().close();
});

for (const [name, count] of [["many.html", 30], ["more.html", flights]]) {
  test(`${count} flights open with few figures drawn and no block unpacked`, inCheck, async () => {
    const { size } = statSync(path.join(folder, name));
    assert.ok(size < 5e6, `${size} bytes`);
    const begin = performance.now();
    const { page, faults } = await open(name);
    await page.locator('[data-name$="-power"]').first().scrollIntoViewIfNeeded();
    await page.locator('[data-name$="-power"][data-drawn]').first().waitFor();
    const took = performance.now() - begin;
    console.log(`${count} flights: ${(size / 1e6).toFixed(1)} MB; ${took.toFixed(0)} ms to the first figure`);
    assert.equal(await page.locator("details.flight").count(), count);
    const drawn = await page.locator("[data-drawn]").count();
    assert.ok(drawn < 20, `${drawn} figures are drawn before they are opened`);
    assert.equal(await page.locator("script.block").count(), count - 1);
    assert.equal(await page.evaluate(() => window.blocksOpened), 0);
    const last = page.locator("details.flight").last();
    await last.locator("summary").first().click();
    await last.locator("[data-drawn]").first().waitFor();
    assert.equal(await page.evaluate(() => window.blocksOpened), 1);
    assert.deepEqual(faults, []);
    await page.context().close();
  });
}

// Without FLIGHTS: the narrowest screen.
const sizes = { phone: { width: 390, height: 844 }, tablet: { width: 1024, height: 768 }, desktop: { width: 1440, height: 900 }, wide: { width: 1920, height: 1080 } };
for (const colorScheme of ["light", "dark"]) {
  for (const [name, viewport] of Object.entries(sizes)) {
    const isQuick = name === "phone" && colorScheme === "light";
    test(`${name} in ${colorScheme}: nothing is outside of the page`, isQuick ? {} : inCheck, async () => {
      const { page, faults } = await open("six.html", { colorScheme, viewport });
      await page.evaluate(() => document.querySelectorAll("main details").forEach((details) => (details.open = !details.matches(".flight ~ .flight"))));
      await drawShown(page);
      const wide = await page.evaluate(() => ({
        page: document.documentElement.scrollWidth - document.documentElement.clientWidth,
        tables: [...document.querySelectorAll("table")].filter((table) => table.scrollWidth > table.parentElement.clientWidth + 1).map((table) => table.getAttribute("aria-label")),
        cut: [...document.querySelectorAll("td, th:not(.missions th), dd, .card p, .card h2, summary")].filter((cell) => cell.clientWidth > 0 && cell.scrollWidth > cell.clientWidth + 1).map((cell) => cell.textContent.slice(0, 60)),
        figures: [...window.flightwatt.figures].filter((figure) => figure.clientWidth > 0 && figure.scrollWidth > figure.clientWidth + 1).map((figure) => figure.dataset.name),
      }));
      await page.screenshot({ path: path.join(screenshots, `${name}-${colorScheme}.png`), fullPage: true });
      assert.deepEqual(wide, { page: 0, tables: [], cut: [], figures: [] });
      assert.deepEqual(faults, []);
      await page.context().close();
    });
  }
}

test("print: light, whatever the screen, and all of what is open is drawn", inCheck, async () => {
  const { page, faults } = await open("six.html", { colorScheme: "dark" });
  const pdf = await page.pdf({ format: "A4", path: path.join(screenshots, "print.pdf") });
  assert.ok(pdf.length > 50_000, `${pdf.length} bytes`);
  await page.emulateMedia({ media: "print" });
  await page.setViewportSize({ width: 794, height: 1123 }); // A4 at 96 dots an inch
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  await allDrawn(page);
  const cut = await page.evaluate(() => [...document.querySelectorAll("table")].filter((table) => table.scrollWidth > document.documentElement.clientWidth).length);
  assert.equal(cut, 0, "tables wider than the paper");
  const closed = await page.evaluate(() => getComputedStyle(document.querySelector("details.flight:not([open]) > summary"), "::after").content);
  assert.match(closed, /not printed/);
  const backgrounds = await page.evaluate(() => [...document.querySelectorAll(".figure svg.marks > rect")].map((rect) => rect.getAttribute("fill")));
  await page.screenshot({ path: path.join(screenshots, "print.png"), fullPage: true });
  assert.deepEqual(backgrounds.filter((color) => color !== "#ffffff"), []);
  assert.deepEqual(faults, []);
  await page.context().close();
});
