// The report's pages in headless Chromium. Environment: PAGES is the folder of what page_test.sh makes, where screenshots
// are left; FLIGHTS are on more.html (none: the pages of six flights and of an answer alone are tested, the rest is
// skipped); FLIGHTWATT_WEB is the folder with node_modules, CHROMIUM the browser.
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
const inCheck = { skip: flights > 0 ? false : "scripts/check integration runs it" };
const screenshots = path.join(folder, "screenshots");
const address = (name) => pathToFileURL(path.join(folder, name)).href;
let browser;

before(async () => {
  mkdirSync(screenshots, { recursive: true });
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox", "--disable-gpu"] });
});
after(() => browser?.close());

/** Opens a page and notes what it should not do; `detailsOpened` counts its compressed flights that were opened. */
async function open(name, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, ...options });
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
    window.detailsOpened = 0;
    window.DecompressionStream = class extends window.DecompressionStream {
      constructor(...options) {
        super(...options);
        ++window.detailsOpened;
      }
    };
  });
  await page.goto(address(name));
  return { page, faults };
}
const documentOf = (page) => page.evaluate(() => JSON.parse(document.getElementById("document").textContent));

/** Opens every folded part, and those within. */
async function openAll(page) {
  for (;;) {
    const closed = await page.evaluate(() => {
      const parts = [...document.querySelectorAll("details:not([open])")];
      for (const part of parts) part.open = true;
      return parts.length;
    });
    if (closed === 0) return;
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50))));
  }
}

/** What axe finds. */
async function faultsFound(page) {
  await page.evaluate(axe.source);
  const { violations } = await page.evaluate(() => window.axe.run());
  return violations.map(({ id, nodes }) => [id, nodes.length, nodes[0].html.slice(0, 200), nodes[0].failureSummary]);
}

test("the page answers first: the worst mission, all others in a table, the aircraft", async () => {
  const { page, faults } = await open("six.html");
  const { missions, headline, title } = await documentOf(page);
  assert.equal(await page.title(), title);
  assert.match(title, /SYNTHETIC.*6 flights, 1 January 2020.*9 missions/);
  assert.equal(await page.locator("h1").innerText(), headline);
  assert.equal(await page.locator("h1").count(), 1);
  assert.equal(await page.locator(".mission-lead").innerText(), missions[0].card.lead);
  assert.deepEqual(await page.locator(".mission-table .row-button bdi").allInnerTexts(), missions.map((mission) => mission.title));
  const order = missions.map(({ outcome }) => ["fails", "misses", "may-miss", "keeps"].indexOf(outcome));
  assert.deepEqual(order, [...order].sort());
  assert.ok((await page.locator(".mission-lead").boundingBox()).y < 400, "the answer is on the first screen");
  assert.match(await page.locator("#aircraft").innerText(), /Cruise\s+27\.3 W/);
  assert.ok(!(await page.content()).includes(folder), "no path of this machine");
  assert.ok(statSync(path.join(folder, "six.html")).size < 2e6, "at most 2 MB for up to 10 flights");
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("a row or a cell, by mouse or keyboard, changes the curve", async () => {
  const { page, faults } = await open("six.html");
  const { missions, quality } = await documentOf(page);
  const curve = () => page.locator(".mission-card .chart path.line.tone-ink").getAttribute("d");
  const before = await curve();
  const button = page.locator(".mission-table .row-button").nth(2);
  await button.focus();
  await page.keyboard.press("Enter");
  assert.equal(await page.locator(".mission-lead").innerText(), missions[2].card.lead);
  assert.equal(await button.getAttribute("aria-pressed"), "true");
  assert.notEqual(await curve(), before);
  await page.locator(".mission-table tbody tr").nth(1).click();
  assert.equal(await page.locator(".mission-lead").innerText(), missions[1].card.lead);
  const map = page.locator(".quality").first();
  const cells = map.locator("button");
  assert.equal(await cells.count(), quality[0].cells.length);
  for (const i of [0, 19]) {
    await cells.nth(i).focus();
    await page.keyboard.press("Enter");
    assert.equal(await cells.nth(i).getAttribute("aria-pressed"), "true");
    const setting = (await cells.nth(i).getAttribute("aria-label")).split(": ")[0];
    assert.ok((await map.locator("h4").innerText()).startsWith(setting), setting);
  }
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("the pointer over a curve reads its value", async () => {
  const { page } = await open("six.html");
  const box = await page.locator(".mission-card .chart svg").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  assert.match(await page.locator(".mission-card .pointed text").textContent(), /^[\d.]+ % at \d+ min \d+ s$/);
  await page.context().close();
});

test("one cursor for all plots of a flight and its place on the map, also by the keyboard", async () => {
  const { page, faults } = await open("six.html");
  const cursor = page.locator(".flight-cursor input");
  await cursor.focus();
  for (let i = 0; i < 3; ++i) await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => [...document.querySelectorAll(".flight-plot-head output")].every(({ textContent }) => textContent));
  const early = await page.locator(".flight-plot-head output").allInnerTexts();
  assert.match(early[0], /W$/);
  assert.ok(early.length >= 3, `${early}`);
  await page.keyboard.press("End");
  await page.keyboard.press("PageDown");
  await page.waitForFunction((was) => document.querySelector(".flight-plot-head output").textContent !== was, early[0]);
  const plot = page.locator(".flight-plot-row .u-over").nth(1);
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  const places = await page.locator(".flight-card .map path").count();
  await page.mouse.move(box.x + 2, box.y + 5);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction((count) => document.querySelectorAll(".flight-card .map path").length >= count, places);
  assert.match(await cursor.getAttribute("aria-valuetext"), /after lift-off$/);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("the table of flights sorts by any column, and a row shows its flight", async () => {
  const { page } = await open("six.html");
  const column = async () => (await page.locator(".flights-table tbody tr td:nth-child(3)").allInnerTexts()).filter(Boolean).map(parseFloat);
  await page.locator(".flights-table th:nth-child(3) button").click();
  const rising = await column();
  assert.deepEqual(rising, [...rising].sort((a, b) => a - b));
  await page.keyboard.press("Enter"); // the button has the focus
  assert.deepEqual(await column(), [...rising].reverse());
  const name = await page.locator(".flights-table .row-button bdi").nth(3).innerText();
  await page.locator(".flights-table .row-button").nth(3).click();
  assert.ok((await page.locator("#flight").innerText()).includes(name));
  await page.context().close();
});

const schemes = ["light", "dark"];
const widths = [1440, 390];
for (const colorScheme of schemes)
  for (const width of widths) {
    const isQuick = width === 390 && colorScheme === "light";
    for (const name of ["six.html", "answer/answer.html"])
      test(`${name}, all opened, ${colorScheme}, ${width} px: axe finds nothing, nothing is outside, no text is below 12 px`, isQuick ? {} : inCheck, async () => {
        const { page, faults } = await open(name, { colorScheme, viewport: { width, height: 900 } });
        await openAll(page);
        await page.screenshot({ path: path.join(screenshots, `${path.basename(name, ".html")}-${colorScheme}-${width}.png`), fullPage: true });
        const seen = await page.evaluate(() => ({
          outside: document.documentElement.scrollWidth - document.documentElement.clientWidth,
          tables: [...document.querySelectorAll("table")].filter((table) => table.scrollWidth > table.parentElement.clientWidth + 1).map((table) => table.caption?.textContent),
          small: [...document.querySelectorAll("main *")]
            .filter((part) => !part.closest(".leaflet-control-container") && [...part.childNodes].some((node) => node.nodeType === 3 && node.data.trim()) && part.getClientRects().length > 0)
            .filter((part) => Number.parseFloat(getComputedStyle(part).fontSize) < 12).map((part) => part.outerHTML.slice(0, 90)).slice(0, 3),
        }));
        assert.deepEqual(seen, { outside: 0, tables: [], small: [] });
        assert.deepEqual(await faultsFound(page), []);
        assert.deepEqual(faults, []);
        await page.context().close();
      });
  }

test("an answer's page: the time in the air and the failsafe on the first screen, to copy by one button", async () => {
  const { page, faults } = await open("answer/answer.html");
  const { answer } = await documentOf(page);
  assert.match(await page.locator("h1").innerText(), /^A full pack lasts \d/);
  const { bottom } = await page.locator(".figure-value").first().evaluate((figure) => figure.getBoundingClientRect());
  assert.ok(bottom < 500, `${bottom}`);
  for (const { label, value } of answer.lines) assert.ok((await page.locator(".answer-lines").innerText()).includes(value), label);
  if (answer.pastes.length > 0) {
    assert.match(await page.locator("pre.paste").first().innerText(), /^BATT_LOW_MAH \d+$/m);
    await page.getByRole("button", { name: /^Copy for/ }).click();
    await page.getByText("Copied").waitFor();
  }
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("without script, the page of an answer is the lines of the terminal", async () => {
  const { page, faults } = await open("answer/answer.html", { javaScriptEnabled: false, viewport: { width: 390, height: 900 } });
  const words = (text) => text.replace(/\s+/g, " ").trim();
  const text = words(await page.locator("main").innerText());
  const lines = words(readFileSync(path.join(folder, "answer.txt"), "utf8"));
  for (const part of ["Cruise", "Time", "Pack"].filter((label) => lines.includes(`${label} `))) assert.ok(text.includes(part), part);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "no line is wider than the screen");
  assert.ok(!(await page.content()).includes(folder), "no path of this machine");
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("headings are in order, and every plot and map has words", async () => {
  const { page } = await open("six.html");
  await openAll(page);
  const levels = await page.locator("h1, h2, h3, h4").evaluateAll((heads) => heads.map((head) => Number(head.tagName[1])));
  assert.equal(levels[0], 1);
  assert.ok(levels.every((level, i) => i === 0 || level <= levels[i - 1] + 1), `${levels}`);
  const wordless = await page.locator(".chart svg, .plot, .map").evaluateAll((plots) => plots.filter((plot) => (plot.getAttribute("aria-label") ?? "").length < 20).length);
  assert.equal(wordless, 0);
  await page.context().close();
});

test("by the keyboard alone: the first stop leads to the content, and folds open", async () => {
  const { page } = await open("six.html");
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "To the content");
  await page.keyboard.press("Enter");
  assert.equal(await page.evaluate(() => document.activeElement.id), "main");
  const fold = page.locator("#certain summary").first();
  await fold.focus();
  await page.keyboard.press("Enter");
  await page.locator("#certain details[open] table").first().waitFor();
  await page.context().close();
});

test("names with markup, quotes, unicode and 300 characters break nothing", inCheck, async () => {
  const { page, faults } = await open("hostile.html");
  await openAll(page);
  assert.deepEqual(faults, []);
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal(await page.locator("#app script").count(), 0);
  const text = await page.locator("body").innerText();
  for (const part of ["<script>window.hacked=1</script>", "\u03b1\u03b2\u03b3", '"quoted"', "m".repeat(300)]) assert.ok(text.includes(part), part);
  for (const width of [1440, 390]) {
    await page.setViewportSize({ width, height: 900 });
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)) <= 0, `outside of ${width} px`);
  }
  await page.context().close();
});

for (const [name, count] of [["many.html", 30], ["more.html", flights]])
  test(`${count} flights: rendered in a second, one flight unpacked, found by its name`, inCheck, async () => {
    const { size } = statSync(path.join(folder, name));
    const { page, faults } = await open("six.html");
    const session = await page.context().newCDPSession(page);
    await session.send("Performance.enable", { timeDomain: "threadTicks" });
    await page.goto(address(name));
    await page.locator(".flight-plot-row canvas").first().waitFor();
    const { metrics } = await session.send("Performance.getMetrics");
    const seconds = (of) => metrics.find(({ name: metric }) => metric === of).value;
    const took = seconds("ScriptDuration") + seconds("LayoutDuration") + seconds("RecalcStyleDuration");
    console.log(`${count} flights: ${(size / 1e6).toFixed(1)} MB; ${(1000 * took).toFixed(0)} ms of the processor`);
    assert.ok(took < 1, `${took} s`);
    assert.equal(await page.evaluate(() => window.detailsOpened), 1, "only the flight that is shown");
    const { flights: all } = await documentOf(page);
    assert.equal(all.length, count);
    const last = all.at(-1).name;
    await page.locator(".flights-table input[type=search]").fill(last);
    await page.locator(".flights-table .row-button", { hasText: last }).first().click();
    await page.locator("#flight", { hasText: last }).locator(".flight-plot-row canvas").first().waitFor();
    assert.equal(await page.evaluate(() => window.detailsOpened), 2);
    assert.deepEqual(faults.filter((fault) => !fault.startsWith("request: file")), []);
    await page.context().close();
  });

test("a browser that cannot open a compressed flight states what to do; so does a damaged page", inCheck, async () => {
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.addInitScript(() => delete window.DecompressionStream);
  await page.goto(address("many.html"));
  assert.match(await page.locator("#flight [role=alert]").innerText(), /Firefox 113/);
  await context.close();
  const damaged = path.join(folder, "damaged.html");
  const html = readFileSync(path.join(folder, "many.html"), "utf8");
  const { writeFileSync } = await import("node:fs");
  writeFileSync(damaged, html.replace(/("detail":"[^"]{200})[^"]*"/, '$1"'));
  const { page: broken } = await open("damaged.html");
  assert.match(await broken.locator("#flight [role=alert]").innerText(), /damaged: write the page again/);
  await broken.context().close();
});

test("print: tables have all of their rows", inCheck, async () => {
  const { page, faults } = await open("many.html");
  const { flights: all } = await documentOf(page);
  assert.ok(all.length > 12, "more than the table shows at once");
  await page.emulateMedia({ media: "print" });
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  for (const table of ["Flights", "All numbers of the flights"])
    assert.ok((await page.locator(`table:has(caption:text-is("${table}")) tbody tr`).count()) >= all.length, table);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test("print: light, whatever the screen, every folded part open, nothing wider than the paper", inCheck, async () => {
  const { page, faults } = await open("six.html", { colorScheme: "dark" });
  await page.emulateMedia({ media: "print" });
  await page.setViewportSize({ width: 794, height: 1123 }); // A4 at 96 dots an inch
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  assert.equal(await page.locator("details:not([open])").count(), 0);
  assert.ok((await page.locator("#certain table").count()) > 3, "what was folded is there at once");
  const seen = await page.evaluate(() => ({
    cut: [...document.querySelectorAll("table")].filter((table) => table.scrollWidth > document.documentElement.clientWidth).map((table) => table.caption?.textContent),
    card: getComputedStyle(document.querySelector(".card")).backgroundColor,
    ink: getComputedStyle(document.querySelector("h1")).color,
  }));
  await page.screenshot({ path: path.join(screenshots, "print.png"), fullPage: true });
  assert.deepEqual(seen, { cut: [], card: "rgb(255, 255, 255)", ink: "rgb(18, 24, 29)" });
  const pdf = await page.pdf({ format: "A4", path: path.join(screenshots, "print.pdf") });
  assert.ok(pdf.length > 50_000, `${pdf.length} bytes`);
  assert.deepEqual(faults, []);
  await page.context().close();
});
