// Draws the figures of a report for papers: node render.mjs FOLDER WIDTH HEIGHT FONT writes FOLDER/NAME.vl.json, with the
// theme, and FOLDER/NAME.svg of each figure of FOLDER/document.json, by Vega without a browser. WIDTH and HEIGHT are in
// pixels: WIDTH 0 is 720 with the theme's type, and any other sets all type at 8 points; HEIGHT is a maximum, 0: none. FONT
// is sans or serif.
import { readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import vm from "node:vm";
import { figuresOf } from "./figures.mjs";

const [folder, ...rest] = process.argv.slice(2);
const [stated, height] = rest.slice(0, 2).map(Number);
const width = stated || 720;
const here = path.dirname(new URL(import.meta.url).pathname);
const script = (name) => readFile(path.join(here, name), "utf8");
for (const library of ["vega", "vega-lite"]) vm.runInThisContext(await script(`node_modules/${library}/build/${library}.min.js`));
const { vega, vegaLite } = globalThis;
const letter = 0.54; // mean width of a letter [type sizes]; Vega's estimate of 0.8 leaves gaps and cuts names
const wide = /[\dA-Zmw%+−]/g;
vega.textMetrics.width = ({ fontSize = 11, limit }, text) => Math.min(limit ? 1.1 * limit : Infinity, fontSize * (letter * String(text ?? "").length + 0.1 * (String(text ?? "").match(wide)?.length ?? 0)));
const typed = letter * (32 / 3); // of a letter in papers [px]

const inside = (part, change) => (Array.isArray(part) ? part.map(change) : part !== null && typeof part === "object" ? Object.fromEntries(Object.entries(part).map(([key, value]) => [key, change(value)])) : part);

/**
 * Fits a figure into a room [px] on a paper of `width`: panels side by side are stacked where they would be too narrow, rows
 * are evenly long, every panel with a width gets the available one (squares remain squares), and names at the side are
 * limited.
 */
function fitWidth(spec, room) {
  const minPanel = 90; // two panels fit into 3.5 inches
  const axis = 52; // y axis with its names and title
  const margin = Math.min(spec.usermeta?.margin_px || axis, Math.max(axis, 0.3 * room));
  const fitNames = (part) => {
    const fitted = inside(part, fitNames);
    if (fitted === part) return part;
    // A name above a panel has the panel's width, one at its side less.
    const above = room < 2 * (minPanel + margin) ? room - margin : Math.max(minPanel, 0.22 * room);
    if (fitted.type === "text" && fitted.limit) fitted.limit = Math.min(fitted.limit, fitted.baseline === "alphabetic" ? above : 0.22 * room);
    if (fitted.axis?.labelLimit) fitted.axis.labelLimit = Math.min(fitted.axis.labelLimit, margin - 20);
    return fitted;
  };
  const fit = (part, of, all) => {
    if (part.concat) {
      const most = Math.max(1, Math.min(3, Math.floor(all / (minPanel + margin))));
      const columns = Math.ceil(part.concat.length / Math.ceil(part.concat.length / most));
      return { ...part, columns, concat: part.concat.map((panel) => fit(panel, of / columns, all / columns)) };
    }
    if (part.vconcat) return { ...part, vconcat: part.vconcat.map((panel) => fit(panel, of, all)) };
    const wide = Math.max(60, Math.floor(of - margin));
    if (part.width === undefined) return part;
    const side = Math.min(wide, part.width);
    return part.width === part.height ? { ...part, width: side, height: side } : { ...part, width: wide };
  };
  return fit(fitNames(spec), room, width);
}

/** With the panels' time axes in minutes where `isLong` holds for the panel's number. */
function inMinutes(part, isLong, panel = 0) {
  if (Array.isArray(part?.concat)) return { ...part, concat: part.concat.map((one, i) => inMinutes(one, isLong, i)) };
  const changed = inside(part, (value) => inMinutes(value, isLong, panel));
  const fields = ["x", "x2"].map((channel) => part?.encoding?.[channel]?.field).filter((field) => field?.endsWith("_s"));
  if (fields.length === 0 || !isLong(panel)) return changed;
  const name = (field) => field.replace(/_s$/, "_min");
  changed.transform = [...(part.transform ?? []), ...fields.map((field) => ({ calculate: `datum.${field} / 60`, as: name(field) }))];
  for (const channel of Object.values(changed.encoding)) {
    if (fields.includes(channel.field)) channel.field = name(channel.field);
    if (channel.scale?.domain && channel === changed.encoding.x) channel.scale = { ...channel.scale, domain: channel.scale.domain.map((s) => s / 60) };
    if (channel === changed.encoding.x) channel.title = channel.title?.replace("[s]", "[min]");
  }
  return changed;
}

const titleOf = (panel, axis) => [panel, ...(panel.layer ?? [])].find(({ encoding }) => encoding?.[axis])?.encoding[axis].title;

/** Takes the name of an axis from a panel, and its labels where another panel has the same. */
function untitle(panel, axis, isShared) {
  const channel = panel.encoding?.[axis];
  if (channel) Object.assign(channel, { title: null }, isShared && { axis: { ...channel.axis, labels: false, ticks: false } });
  panel.layer?.forEach((layer) => untitle(layer, axis, isShared));
}

/** With as many ticks as have room for their labels, units below the names of low panels, and legends in few rows. */
function readable(part, size = {}) {
  const here = part?.width ? part : size;
  const changed = inside(part, (value) => readable(value, here));
  if (part?.type === "text" && part.limit) changed.limit = part.limit * (0.8 / letter); // by Vega's estimate
  if (Array.isArray(part?.concat)) {
    const isShared = (axis) => part.resolve?.scale?.[axis] === "shared";
    changed.spacing = { row: !isShared("x") ? 54 : width < 420 ? 26 : 40, column: isShared("y") ? 14 : 46 };
    const titles = part.concat.map((panel) => [titleOf(panel, "x"), titleOf(panel, "y")]);
    changed.concat.forEach((panel, i) => {
      // An axis like that of the panel below, or at its left, has no name of its own.
      if (titles[i + part.columns]?.[0] === titles[i][0]) untitle(panel, "x", isShared("x"));
      if (i % part.columns > 0 && titles[i - 1][1] === titles[i][1]) untitle(panel, "y", isShared("y"));
    });
  }
  if (part?.vconcat) {
    changed.spacing = Math.min(part.spacing ?? 12, 12);
    part.vconcat.forEach((panel, i) => i > 0 && titleOf(panel, "x") === titleOf(part.vconcat[i - 1], "x") && untitle(changed.vconcat[i - 1], "x", true));
  }
  for (const [name, channel] of Object.entries(part?.encoding ?? {})) {
    const now = changed.encoding[name];
    if (["quantitative", "temporal"].includes(channel.type) && (name === "x" ? here.width : name === "y" && here.height > 0)) {
      now.axis = { tickCount: Math.max(2, Math.floor(name === "x" ? here.width / 50 : here.height / 28)), labelSeparation: name === "x" ? 8 : 2, ...channel.axis };
      if (name === "y" && channel.title?.length * typed > here.height) now.title = channel.title.split(/ (?=\[)/);
    }
    const labels = channel.legend?.values ?? channel.scale?.domain;
    if (channel.legend?.columns && Array.isArray(labels)) {
      const widthOf = (columns) => Array.from({ length: columns }, (_, c) => 28 + typed * Math.max(...labels.filter((_, i) => i % columns === c).map((label) => Math.min(40, label.length)))).reduce((sum, w) => sum + w, 0);
      now.legend.columns = [...labels.keys()].map((i) => labels.length - i).find((columns) => widthOf(columns) <= width - (width < 420 ? 60 : 170)) ?? 1;
    }
  }
  return changed;
}

/** With panels of `factor` times their height, 36 px at least, and rows of 12; squares remain squares. */
function flattened(part, factor) {
  const inner = Object.fromEntries(["concat", "vconcat", "hconcat"].filter((key) => part[key]).map((key) => [key, part[key].map((panel) => flattened(panel, factor))]));
  if (part.height?.step) return { ...part, height: { step: Math.max(12, Math.floor(part.height.step * factor)) } };
  if (typeof part.height !== "number") return { ...part, ...inner };
  const height = Math.max(Math.min(36, part.height), Math.floor(part.height * factor));
  return { ...part, ...inner, height, width: part.width === part.height ? height : part.width };
}

const logger = vega.logger(vega.Error); // warnings are about legends of layers and about missing pointers
async function viewOf(spec) {
  return new vega.View(vega.parse(vegaLite.compile(spec, { logger }).spec), { renderer: "none", logger }).runAsync();
}

/** The specification with times of more than two minutes in minutes. */
async function withMinutes(spec) {
  const view = await viewOf(spec);
  const spanOf = (panel) => {
    const [low, high] = view.scale(spec.concat && spec.resolve?.scale?.x !== "shared" ? `concat_${panel}_x` : "x").domain();
    return high - low;
  };
  const changed = inMinutes(spec, (panel) => spanOf(panel) > 120);
  view.finalize();
  return changed;
}

async function render(wanted, room, factor) {
  const { config } = wanted; // legends in rows
  const spec = width < 420 ? { ...wanted, config: { ...config, legend: { ...config.legend, layout: { top: { direction: "vertical", anchor: "start", margin: 2, bounds: "full" } } } } } : wanted;
  const view = await viewOf(readable(flattened(fitWidth(spec, room), factor)));
  const svg = await view.toSVG();
  view.finalize();
  const [wide, tall] = ["width", "height"].map((side) => Number(svg.match(new RegExp(`<svg[^>]* ${side}="([\\d.]+)"`))[1]));
  return { svg, wide, tall };
}

/** The theme for papers. */
function inTypeOfPapers(theme) {
  const sized = (part, key) => (stated && /fontSize$/i.test(key) && typeof part === "number" ? 32 / 3 : part !== null && typeof part === "object" && !Array.isArray(part) ? Object.fromEntries(Object.entries(part).map(([name, value]) => [name, sized(value, name)])) : part);
  const config = sized(theme, "");
  if (stated) config.style["panel-name"].fontWeight = "normal";
  if (rest[2] === "serif") config.font = "'Times New Roman', 'Liberation Serif', 'DejaVu Serif', serif";
  return config;
}

const theme = inTypeOfPapers(JSON.parse(await script("theme.json")));
for (const { id: name, spec: plain } of figuresOf(JSON.parse(await readFile(path.join(folder, "document.json"), "utf8")))) {
  const whole = { ...plain, config: theme };
  await writeFile(path.join(folder, `${name}.vl.json`), `${JSON.stringify(whole)}\n`);
  const spec = await withMinutes(whole);
  // The size of axes and legends is known after drawing: a figure of another size is drawn again with less or more room.
  let room = width;
  let factor = 1;
  let drawn = await render(spec, room, factor);
  let widest = Infinity; // what smaller panels do not make smaller stays
  let tallest = Infinity;
  for (let trial = 0; trial < 12; ++trial) {
    if ((drawn.wide > width && drawn.wide < widest) || (trial === 0 && drawn.wide < width)) {
      if (drawn.wide > width) [widest, room] = [drawn.wide, room - 4]; // names at the side get a part of the room
      room -= drawn.wide - width;
    } else if (height > 0 && drawn.tall > height && drawn.tall < tallest) {
      if (drawn.wide <= width) widest = Infinity;
      tallest = drawn.tall;
      factor *= Math.max(0.5, 1 - (1.3 * (drawn.tall - height)) / drawn.tall);
    } else break;
    drawn = await render(spec, room, factor);
  }
  await writeFile(path.join(folder, `${name}.svg`), drawn.svg);
}
