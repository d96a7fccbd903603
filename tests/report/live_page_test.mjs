// The page of `flightwatt watch --serve` in headless Chromium while a log is played: charts move, nothing is printed on the
// console, and it comes back when its server does. Environment: BIN, SOURCE, SCRATCH, PORT, WEB, CHROMIUM.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createWriteStream, openSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { after, before, test } from "node:test";

const { BIN, SOURCE, SCRATCH, PORT, WEB, CHROMIUM } = process.env;
const require = createRequire(path.join(WEB, "package.json"));
const { chromium } = require("playwright-core");
const axe = require("axe-core");
const log = path.join(SOURCE, "logs/opterra_synthetic_01");
const growing = path.join(SCRATCH, "growing.data");
const address = `http://127.0.0.1:${PORT}/`;
const running = [];
let browser;

function start(program, options, output = "ignore") {
  const child = spawn(path.join(BIN, program), options, { stdio: ["ignore", output, "pipe"] });
  child.stderr.pipe(createWriteStream(path.join(SCRATCH, `${program}.stderr`), { flags: "a" }));
  child.ended = new Promise((resolve) => child.once("exit", resolve));
  running.push(child);
  return child;
}
const watch = () => start("flightwatt-watch", ["--follow", growing, "--log", `${log}.log`, "--model", path.join(SOURCE, "fits/mechanical/synthetic-wing.toml"), "--battery", path.join(SOURCE, "fits/battery/synthetic-3s.toml"), "--remaining", "300", "--serve", PORT, "--json"]);

/** Asks every 100 ms, and prints every minute what for; CTest ends what never comes. */
async function eventually(what, condition) {
  for (let i = 1; !(await condition()); ++i) {
    if (i % 600 === 0) console.error(`waiting until ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
}
const answers = async () => fetch(`${address}state`).then((answer) => answer.ok, () => false);

before(async () => {
  rmSync(growing, { force: true });
  browser = await chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox", "--disable-gpu"] });
});
after(async () => {
  await browser?.close();
  for (const child of running) child.kill("SIGTERM");
  await Promise.all(running.map((child) => child.ended));
});

test("charts move while a flight is played, and the page outlives its server", async () => {
  start("flightwatt-play", [`${log}.data`, "--to", "-", "--speed", "15"], openSync(growing, "w"));
  const first = watch();
  await eventually("the server answers", answers);
  const page = await (await browser.newContext({ viewport: { width: 390, height: 844 } })).newPage();
  page.setDefaultTimeout(0);
  const faults = [];
  let serverIsDown = false;
  page.on("pageerror", (error) => faults.push(`exception: ${error.message}`));
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !serverIsDown) faults.push(`${message.type()}: ${message.text()}`);
  });
  page.on("request", (request) => {
    if (!request.url().startsWith(address) && !/^(data|blob):/.test(request.url())) faults.push(`request: ${request.url()}`);
  });
  await page.goto(address);
  const points = (id) => page.locator(`#${id}`).evaluate((box) => Number(box.dataset.points || 0));
  const time = () => page.locator("#page").evaluate((box) => Number(box.dataset.time || 0));
  for (const id of ["charge", "power", "altitude"]) {
    await eventually(`#${id} has points`, async () => (await points(id)) > 3);
    const before = await points(id);
    const lines = await page.locator(`#${id} svg path`).count();
    assert.ok(lines > 0, `#${id} draws nothing`);
    await eventually(`#${id} gets more`, async () => (await points(id)) > before);
  }
  await eventually("the cruise is seen and predicted", async () => /Charge at landing/.test(await page.locator("#answers").innerText()));
  assert.match(await page.title(), /^Battery lasts/);
  assert.equal(await page.locator("button, input, select, textarea, a").count(), 0, "the page offers no command");
  await eventually("the turn home is known", async () => (await page.locator("#answers .number").count()) === 3);
  const sizes = await page.locator("#answers .number").evaluateAll((numbers) => numbers.map((of) => parseFloat(getComputedStyle(of).fontSize)));
  assert.ok(sizes.length === 3 && sizes.every((size) => size >= 48), `three numbers of 48 px or more: ${sizes}`);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), "it scrolls sideways");
  await page.screenshot({ path: path.join(SCRATCH, "live.png"), fullPage: true });
  await page.evaluate(axe.source);
  const { violations } = await page.evaluate(() => window.axe.run());
  assert.deepEqual(violations.map(({ id, nodes }) => `${id}: ${nodes[0].html}`), []);

  serverIsDown = true; // the browser itself notes requests that fail
  first.kill("SIGTERM");
  await first.ended;
  await eventually("the page reports it", async () => /NO CONNECTION/.test(await page.locator("#status").innerText()));
  await eventually("its numbers are old", async () => /[0-9] s old/.test(await page.locator("#answers").innerText()));
  assert.match(await page.title(), /^NO CONNECTION/);
  watch();
  await eventually("the page is back", async () => !/NO CONNECTION/.test(await page.locator("#status").innerText()));
  serverIsDown = false;
  const then = await time();
  await eventually("it continues", async () => (await time()) > then);
  assert.deepEqual(faults, []);
});

/** Opens the page with events that the test sends, in place of the server's: `send(name, data)`. */
async function openWithEvents(options) {
  const page = await (await browser.newContext(options)).newPage();
  page.setDefaultTimeout(0);
  await page.addInitScript(() => {
    window.EventSource = class extends EventTarget {
      constructor() {
        super();
        window.send = (name, data) => this.dispatchEvent(name === "error" ? new Event(name) : new MessageEvent(name, { data: JSON.stringify(data) }));
      }
    };
  });
  await page.goto(address);
  return { page, send: (name, data) => page.evaluate(([event, content]) => window.send(event, content), [name, data]) };
}

const screens = { phone: { width: 390, height: 844 }, desktop: { width: 1440, height: 900 } };
for (const [name, viewport] of Object.entries(screens))
  for (const colorScheme of ["light", "dark"])
    test(`a landing below the reserve is not shown as calm, and nothing collides: ${name}, ${colorScheme}`, async () => {
      await eventually("the server has a state", async () => (await fetch(`${address}state`).then((answer) => answer.json(), () => null)) != null);
      const state = await (await fetch(`${address}state`)).json();
      const { page, send } = await openWithEvents({ viewport, colorScheme });
      const landed = { ...state, phase: "landed", flight_time_s: 1434, energy_wh: 11.93, reserve_soc_percent: 70, battery: { ...state.battery, soc_percent: 60.2 }, alarms: [], messages: 100 };
      await send("state", landed);
      assert.equal(await page.locator("#status").innerText(), "Landed below the reserve");
      assert.match(await page.locator("#action").innerText(), /60\.2 % left, reserve 70 %; 23:54 min in the air/);
      assert.match(await page.locator("body").getAttribute("class"), /caution/);
      const overlap = await page.evaluate(() => {
        const boxes = [...document.querySelectorAll("#answers .number")].map((number) => {
          const range = document.createRange();
          range.selectNodeContents(number);
          return range.getBoundingClientRect();
        });
        const collide = boxes.some((a, i) => boxes.some((b, k) => k > i && a.left < b.right && b.left < a.right && a.top < b.bottom - 1 && b.top < a.bottom - 1));
        return { collide, outside: document.documentElement.scrollWidth - innerWidth };
      });
      await page.screenshot({ path: path.join(SCRATCH, `landed-${name}-${colorScheme}.png`) });
      assert.deepEqual(overlap, { collide: false, outside: 0 });
      await send("error");
      assert.match(await page.locator("#action").innerText(), /The watch has ended: these are its last numbers/);
      await send("state", { ...landed, reserve_soc_percent: 20 });
      assert.equal(await page.locator("#status").innerText(), "Landed");
      await page.evaluate(axe.source);
      const { violations } = await page.evaluate(() => window.axe.run());
      assert.deepEqual(violations.map(({ id, nodes }) => `${id}: ${nodes[0].html}`), []);
      await page.context().close();
    });

test("before anything was received, no age of it is shown", async () => {
  const state = await (await fetch(`${address}state`)).json();
  const { page, send } = await openWithEvents({ viewport: screens.phone });
  await send("state", { ...state, messages: 0, aircraft_id: null, phase: "ground", time_since_message_s: 21, prediction: null, battery: null, turn_home: null, alarms: [] });
  assert.equal(await page.locator("#moment").innerText(), "Nothing received yet");
  assert.equal(await page.locator("#status").innerText(), "Waiting for an aircraft");
  await page.context().close();
});

test("no other page and no other name is answered", async () => {
  await eventually("the server answers", answers);
  const page = await (await browser.newContext()).newPage();
  await page.goto("data:text/html,<p>another page");
  const read = await page.evaluate((url) => fetch(`${url}state`).then(() => "read", () => "refused"), address);
  assert.equal(read, "refused");
});
