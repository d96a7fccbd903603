// A picture of a page as Chromium shows it: node screenshot.mjs PAGE.html OUT.png WIDTH HEIGHT
// (CHROMIUM names the browser.)
import path from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [file, out, width, height] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox", "--disable-gpu"] });
const page = await browser.newPage({ viewport: { width: Number(width), height: Number(height) }, colorScheme: "light" });
await page.goto(pathToFileURL(path.resolve(file)).href);
await page.locator("main#main h1").waitFor();
await page.waitForTimeout(500); // maps and plots
await page.screenshot({ path: out });
await browser.close();
