// Draws the missions' curves, the grid of quality of service and the flown tracks as SVG for the width at hand, from the
// JSON that src/report/sections/page_data.cpp and tracks_section.cpp write; selects missions and cells.
(() => {
  const read = (id) => JSON.parse(document.getElementById(`data-${id}`)?.textContent ?? "[]");
  const missions = read("missions");
  const tracks = read("tracks").map(centred);
  const selected = { mission: 0, cells: new Map() };
  const paper = { mission: 400, spark: 96, curves: 670, cell: 330, track: 214 }; // widths of print [px]
  let printing = false;
  const widthOf = (box) => (printing ? paper[box.dataset.draw] : box.clientWidth - Number.parseFloat(getComputedStyle(box).paddingLeft) * 2);

  function svg(tag, attributes, ...children) {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.append(...children);
    return element;
  }
  const html = (tag, className, ...children) => {
    const element = document.createElement(tag);
    if (className) element.className = className;
    element.append(...children);
    return element;
  };
  const text = (x, y, content, className = "", anchor = "start") => svg("text", { x, y, class: className, "text-anchor": anchor }, content);
  const line = (x1, y1, x2, y2, className) => svg("line", { x1, y1, x2, y2, class: className });
  const dot = (x, y, r, className) => svg("circle", { cx: x, cy: y, r, class: className });
  const percent = (value, decimals = 0) => (value === null ? "empty" : `${value.toFixed(decimals)} %`);
  const duration = (time_s) => {
    const [h, min, s] = [Math.floor(time_s / 3600), Math.floor((time_s % 3600) / 60), Math.round(time_s % 60)];
    return [h && `${h} h`, min && `${min} min`, (s || time_s < 60) && `${s} s`].filter(Boolean).join(" ");
  };

  function valueAt(times, values, time) {
    const i = Math.max(1, times.findIndex((t) => t >= time));
    const span = times[i] - times[i - 1];
    return span > 0 ? values[i - 1] + ((time - times[i - 1]) / span) * (values[i] - values[i - 1]) : values[i];
  }
  /** The first time at which a curve is below `level`; undefined if never. */
  function crossing({ time_s, soc }, level) {
    const i = soc.findIndex((value) => value < level);
    if (i < 1) return undefined;
    return time_s[i - 1] + ((soc[i - 1] - level) / (soc[i - 1] - soc[i])) * (time_s[i] - time_s[i - 1]);
  }

  /** Axes of charge over minutes; x and y lead from seconds and percent to pixels. */
  function frame(box, { height, duration_s, right, below = 40, label }) {
    const width = widthOf(box);
    const [left, top, bottom] = [38, 26, height - below];
    const minutes = duration_s / 60;
    const step = [0.5, 1, 2, 4, 5, 10, 15, 20, 30, 60, 120, 240].find((s) => minutes / s <= Math.max(3, width / 62)) ?? 480;
    const end = (Math.ceil(minutes / step - 0.1) * step || step) * 60;
    const x = (time_s) => left + (time_s / Math.max(end, duration_s)) * (width - left - right);
    const y = (soc) => bottom - (soc / 100) * (bottom - top);
    const root = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
    root.append(text(0, 12, "State of charge [%]"));
    for (const soc of [0, 25, 50, 75, 100]) root.append(line(left, y(soc), width - right, y(soc), "grid"), text(left - 8, y(soc) + 4, soc, "", "end"));
    for (let m = 0; m * 60 <= end + 1; m += step) if (x(m * 60) <= width - right + 1) root.append(text(x(m * 60), bottom + below - 20, m, "", "middle"));
    root.append(text(width - right, bottom + below - 4, "minutes since lift-off", "", "end"));
    return { root, x, y, width, left, right, bottom, top };
  }
  const pathOf = ({ x, y }, times, values) => times.map((t, i) => `${i ? "L" : "M"}${x(t).toFixed(1)} ${y(values[i]).toFixed(1)}`).join("");
  const curveOf = (axes, { time_s, soc }, className) => svg("path", { d: pathOf(axes, time_s, soc), class: `curve ${className}` });
  function addReserve({ root, x, y, left, width, right }, reserve) {
    if (reserve > 0) root.append(line(left, y(reserve), width - right, y(reserve), "reserve"), text(left + 6, y(reserve) - 5, `reserve ${Number(reserve.toFixed(1))} %`, "halo"));
  }
  function addBand(axes, band, duration_s) {
    const { root, x, y, width } = axes;
    const back = [...band.time_s.keys()].reverse();
    root.append(svg("path", { d: `${pathOf(axes, band.time_s, band.high)}${back.map((i) => `L${x(band.time_s[i]).toFixed(1)} ${y(band.low[i]).toFixed(1)}`).join("")}Z`, class: "band" }));
    const time = 0.5 * duration_s;
    const [px, py] = [x(time), y(valueAt(band.time_s, band.low, time))];
    if (width > 420 && py < y(30)) root.append(line(px - 46, py + 15, px - 1, py - 2, "leader"), text(px - 50, py + 19, "90 of 100 flights", "halo", "end"));
  }
  function addPhases({ root, x, bottom, right, width }, phases, below) {
    let start = 0;
    let at = x(0);
    for (const { phase, end_s } of phases) {
      const name = phase.replace("-", "");
      root.append(svg("rect", { x: x(start), y: bottom + 6, width: Math.max(1.5, x(end_s) - x(start) - 1), height: 6, class: name }));
      if (at + phase.length * 7 < width - right - 134) root.append(text(at, bottom + below - 4, phase, name));
      at += phase.length * 7 + 16;
      start = end_s;
    }
  }
  function addEnd({ root, x, y, width, left }, mission) {
    const { end_s, duration_s, landing, soc, time_s } = mission;
    if (landing !== null) {
      root.append(dot(x(duration_s), y(landing), 5, "end"), text(x(duration_s) + 9, y(landing) + 4, percent(landing), "halo strong outcome"));
      return;
    }
    const last = valueAt(time_s, soc, end_s);
    const height = y(width > 480 ? 52 : 75);
    const isLate = x(end_s) - left > 170;
    root.append(line(x(end_s), y(last), x(duration_s), y(last), "failed"), line(x(end_s), height + 5, x(end_s), y(last), "fall"), dot(x(end_s), y(last), 6, "end"));
    root.append(text(x(end_s) + (isLate ? 14 : -14), height, `${last < 1 ? "empty" : "fails"} at ${duration(end_s)}`, "halo strong outcome", isLate ? "end" : "start"));
  }

  const draw = {};
  draw.mission = (box) => {
    const mission = missions[box.dataset.mission];
    const below = 54;
    const label = `State of charge of ${mission.title}: ${mission.landing === null ? `the battery fails at ${duration(mission.end_s)} of ${duration(mission.duration_s)}` : `${percent(mission.landing, 1)} at landing`}.`;
    const axes = frame(box, { height: widthOf(box) > 480 ? 272 : 256, duration_s: mission.duration_s, right: 46, below, label });
    if (mission.band) addBand(axes, mission.band, mission.duration_s);
    addReserve(axes, mission.reserve);
    axes.root.append(curveOf(axes, mission, "ink"));
    const missed = mission.reserve > 0 ? crossing(mission, mission.reserve) : undefined;
    if (missed !== undefined) {
      const [px, py] = [axes.x(missed), axes.y(mission.reserve)];
      axes.root.append(dot(px, py, 5, "ring"));
      if (axes.y(0) - py > 22 && px > axes.left + 210) axes.root.append(text(px - 6, py + 17, `below the reserve from ${duration(missed)}`, "halo", "end"));
    }
    addPhases(axes, mission.phases, below);
    addEnd(axes, mission);
    return [axes.root];
  };
  draw.spark = (box) => {
    const { time_s, soc, reserve, duration_s, end_s, landing } = missions[box.dataset.mission];
    const [width, height] = [Math.max(60, widthOf(box)), 34];
    const axes = { x: (t) => 2 + (t / duration_s) * (width - 9), y: (c) => height - 4 - (c / 100) * (height - 8) };
    const root = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true" });
    if (reserve > 0) root.append(line(2, axes.y(reserve), width - 7, axes.y(reserve), "reserve"));
    root.append(svg("path", { d: pathOf(axes, time_s, soc), class: "curve ink" }), dot(axes.x(end_s), axes.y(landing ?? 0), 4, "end"));
    return [root];
  };
  draw.curves = (box) => {
    const wide = widthOf(box) > 620;
    const duration_s = Math.max(...missions.map((mission) => mission.duration_s));
    const letters = wide ? 30 : 11;
    const short = (title) => (title.length > letters ? `${title.slice(0, letters - 1)}…` : title);
    const axes = frame(box, { height: Math.max(300, 90 + 19 * missions.length), duration_s, right: wide ? 270 : 152, label: `State of charge of ${missions.map(({ title, landing }) => `${title}: ${percent(landing, 1)}`).join("; ")}.` });
    const reserves = new Set(missions.map(({ reserve }) => reserve));
    for (const reserve of reserves) addReserve(axes, reserve);
    const ends = missions.map((mission, i) => ({ ...mission, i, at: axes.y(mission.landing ?? 0) }));
    for (const mission of [...ends].reverse()) axes.root.append(curveOf(axes, mission, `${mission.outcome} ${mission.i === selected.mission ? "selected" : ""}`));
    ends.sort((a, b) => a.at - b.at || b.i - a.i);
    ends.forEach((end, k) => (end.label = k ? Math.max(end.at, ends[k - 1].label + 18) : end.at));
    for (let k = ends.length - 1, limit = axes.bottom + 4; k >= 0; --k, limit -= 18) ends[k].label = Math.min(ends[k].label, limit);
    for (const { at, label, title, landing, outcome, duration_s: end, i } of ends) {
      const from = axes.x(end);
      const to = axes.width - axes.right + 22;
      const name = svg("tspan", { class: i === selected.mission ? "strong" : "plain" }, ` ${short(title)}`);
      const words = text(to + 4, label + 4, "", `strong ${outcome}`);
      words.append(percent(landing), name);
      axes.root.append(dot(from, at, 3.5, `end ${outcome}`), line(from + 5, at, to, label, "leader"), words);
    }
    return [axes.root];
  };

  // Quality of service: a table of buttons and the flight of the selected cell.
  const grids = new Map();
  const gridOf = (box) => {
    const id = box.dataset.from;
    if (!grids.has(id)) {
      grids.set(id, read(id));
      const near = ({ landing, soc }) => Math.abs((landing ?? Math.min(...soc, 0)) - grids.get(id).reserve);
      const { cells } = grids.get(id);
      selected.cells.set(id, cells.indexOf(cells.reduce((best, cell) => (near(cell) < near(best) ? cell : best))));
    }
    return grids.get(id);
  };
  const unitOf = (name) => name.split(" ").slice(1).join(" ").replaceAll("_", " ");
  const settingOf = ({ x, y, xs, ys }, i) => `${xs[i % xs.length]} ${unitOf(x)}, ${ys[Math.floor(i / xs.length)]} ${unitOf(y)}`;
  const mix = (from, to, part) => from.map((value, i) => Math.round(value + (to[i] - value) * Math.min(1, Math.max(0, part))));
  function shade(cell, { reserve, cells }) {
    const best = Math.max(...cells.map(({ landing }) => landing ?? 0));
    if (cell.landing === null) return [122, 38, 12];
    if (cell.landing < reserve) return mix([248, 213, 172], [160, 66, 20], (reserve - cell.landing) / reserve);
    return mix([214, 229, 242], [38, 100, 154], (cell.landing - reserve) / Math.max(1, best - reserve));
  }
  /** WCAG's relative luminance: at 0.18 black and white have the same contrast. */
  const luminance = (color) => color.map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4)).reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  draw.grid = (box) => {
    const grid = gridOf(box);
    const { x, y, xs, ys, cells } = grid;
    const body = html("tbody");
    for (let row = ys.length - 1; row >= 0; --row) {
      const head = html("th", "", `${ys[row]} ${unitOf(y)}`);
      head.scope = "row";
      const tr = html("tr", "", head);
      for (let column = 0; column < xs.length; ++column) {
        const i = row * xs.length + column;
        const cell = cells[i];
        const button = html("button", "", html("b", "", percent(cell.landing, 1)), ...(cell.keeps ? [html("small", "", html("span", "", "keeps: "), cell.keeps)] : []));
        button.type = "button";
        const color = shade(cell, grid);
        button.style.cssText = `background: rgb(${color}); color: ${luminance(color) < 0.18 ? "#fff" : "#000"}`;
        button.setAttribute("aria-pressed", i === selected.cells.get(box.dataset.from));
        button.setAttribute("aria-label", `${settingOf(grid, i)}: ${cell.landing === null ? "the battery fails" : `lands with ${percent(cell.landing, 1)}`}${cell.keeps ? `, keeps the reserve in ${cell.keeps} of flights` : ""}`);
        button.addEventListener("click", () => {
          selected.cells.set(box.dataset.from, i);
          for (const other of box.querySelectorAll("button")) other.setAttribute("aria-pressed", other === button);
          redraw("cell");
        });
        tr.append(html("td", "", button));
      }
      body.append(tr);
    }
    const heads = xs.map((value) => html("th", "", `${value} ${unitOf(x)}`));
    body.append(html("tr", "", html("td"), ...heads));
    const table = html("table", "grid", body);
    table.setAttribute("aria-label", `Charge at landing over ${x} and ${y}`.replaceAll("_", " "));
    return [html("p", "soft", `${y} upwards, ${x} to the right`.replaceAll("_", " ")), table];
  };
  draw.cell = (box) => {
    const grid = gridOf(box);
    const i = selected.cells.get(box.dataset.from);
    const cell = grid.cells[i];
    const other = missions[grid.missions.includes(selected.mission) ? selected.mission : grid.missions[0]];
    const end = cell.landing === null ? `fails after ${duration(cell.end_s)}` : `lands with ${percent(cell.landing, 1)}`;
    const axes = frame(box, { height: 250, duration_s: cell.duration_s, right: 46, label: `State of charge with ${settingOf(grid, i)}: ${end}.` });
    for (const one of grid.cells) if (one !== cell) axes.root.append(curveOf(axes, one, "other"));
    addReserve(axes, grid.reserve);
    axes.root.append(curveOf(axes, other, "shown"), curveOf(axes, cell, "ink"));
    addEnd(axes, { ...cell });
    const signed = (value, decimals, unit) => `${value < 0 ? "\u2212" : "+"}${Math.abs(value).toFixed(decimals)}${unit}`;
    const facts = html("dl", "");
    const add = (name, value) => facts.append(html("div", "", html("dt", "", name), html("dd", "", value)));
    if (cell.keeps) add("Keeps the reserve", cell.keeps);
    add(`Charge, against ${other.title}`, signed((cell.landing ?? 0) - (other.landing ?? 0), 1, " points"));
    if (cell.utility !== null && other.utility !== null) add(`Utility, against ${other.title}`, signed(cell.utility - other.utility, 1, ""));
    const key = html("p", "soft key", html("span", "ink", "this setting"), html("span", "shown", other.title), html("span", "other", "other settings"));
    return [html("h3", "", `${settingOf(grid, i)} ${end}`), axes.root, key, facts];
  };

  // Flown tracks, all on one scale.
  /** A track in metres from its middle, with its half extent and the outlines at its place. */
  function centred(track) {
    const points = track.lines.flatMap((one) => one.points);
    const [low, high] = [Math.min, Math.max].map((end) => [0, 1].map((axis) => end(...points.map((point) => point[axis]))));
    const middle = low.map((value, axis) => (value + high[axis]) / 2);
    const moved = ([east, north]) => [east - middle[0], north - middle[1]];
    const projected = ([longitude, latitude]) => {
      const [east, north, atLongitude, atLatitude] = track.place;
      const perDegree = 111195; // m
      return moved([east + (longitude - atLongitude) * perDegree * Math.cos((atLatitude * Math.PI) / 180), north + (latitude - atLatitude) * perDegree]);
    };
    return {
      ...track,
      half_m: Math.max(1, high[0] - middle[0], high[1] - middle[1]),
      lines: track.lines.map((one) => ({ ...one, points: one.points.map(moved) })),
      marks: track.marks.map((mark) => ({ ...mark, point: moved(mark.point) })),
      outlines: track.place ? read("outlines").map((points) => points.map(projected)) : [],
    };
  }
  tracks.forEach(({ title, text: words }, i) => {
    const box = html("div", "drawn");
    Object.assign(box.dataset, { draw: "track", track: i });
    document.querySelector(".maps").append(html("div", "card", html("h3", "", title), html("p", "soft", words), box));
  });
  draw.track = (box) => {
    const { title, lines, marks, outlines } = tracks[box.dataset.track];
    const size = Math.max(160, widthOf(box));
    const half = 1.12 * Math.max(...tracks.map(({ half_m }) => half_m));
    const at = ([east, north]) => [size / 2 + (east / half) * (size / 2), size / 2 - (north / half) * (size / 2)];
    const d = (points) => points.map((point, i) => `${i ? "L" : "M"}${at(point).map((v) => v.toFixed(1)).join(" ")}`).join("");
    const root = svg("svg", { width: size, height: size, viewBox: `0 0 ${size} ${size}`, role: "img", "aria-label": `Ground track of ${title}. ${marks.map((mark) => mark.text).join("; ")}` });
    for (const points of outlines) root.append(svg("path", { d: d(points), class: "outline" }));
    const bar = [100, 200, 500, 1000, 2000, 5000, 10000].find((metres) => (metres / half) * (size / 2) > 50) ?? 20000;
    const step = (bar / half) * (size / 2);
    for (let v = size / 2 % step; v < size; v += step) root.append(line(v, 0, v, size, "grid"), line(0, v, size, v, "grid"));
    for (const phase of ["cruise", "take-off", "landing"]) for (const one of lines) if (one.phase === phase) root.append(svg("path", { d: d(one.points), class: `flown ${phase.replace("-", "")}` }));
    const sides = [[], []];
    for (const mark of marks) {
      const [x, y] = at(mark.point);
      sides[Number(x >= size / 2)].push({ x, y, text: mark.text });
    }
    sides.forEach((side, right) => {
      side.sort((a, b) => a.y - b.y);
      side.forEach((mark, k) => (mark.label = Math.max(mark.y, k ? side[k - 1].label + 17 : 40)));
      for (let k = side.length - 1, limit = size - 34; k >= 0; --k, limit -= 17) side[k].label = Math.min(side[k].label, limit);
      for (const { x, y, label, text: words } of side) {
        const edge = right ? size - 4 : 4;
        root.append(line(x, y, right ? edge - words.length * 6.7 - 3 : edge + words.length * 6.7 + 3, label - 4, "leader"), dot(x, y, 3.5, "mark"), text(edge, label, words, "halo strong", right ? "end" : "start"));
      }
    });
    for (const [point, name, phase] of [[lines[0].points[0], "lift-off", "takeoff"], [lines.at(-1).points.at(-1), "touchdown", "landing"]]) {
      const [x, y] = at(point);
      root.append(dot(x, y, 4.5, `end ${phase}`), text(x, y + 18, name, `halo strong ${phase}`, "middle"));
    }
    root.append(line(8, size - 10, 8 + step, size - 10, "scale"), text(12 + step, size - 6, bar < 1000 ? `${bar} m` : `${bar / 1000} km`, "halo"));
    root.append(svg("path", { d: `M${size - 16} 28V8m-5 6 5-6 5 6`, class: "north" }), text(size - 16, 42, "N", "", "middle"));
    return [root];
  };

  const drawings = () => [...document.querySelectorAll("[data-draw]")];
  function redraw(kind) {
    for (const box of drawings()) if (!kind || box.dataset.draw === kind) if (printing || box.clientWidth > 0) box.replaceChildren(...draw[box.dataset.draw](box));
  }
  function select(index) {
    selected.mission = index;
    document.querySelectorAll("article.mission").forEach((card, i) => (card.hidden = i !== index));
    for (const button of document.querySelectorAll("[data-select]")) button.setAttribute("aria-pressed", Number(button.dataset.select) === index);
    for (const kind of ["mission", "curves", "cell"]) redraw(kind);
    const card = document.getElementById(`mission-${index}`);
    const { top, bottom } = card.getBoundingClientRect();
    if (bottom < 80 || top > window.innerHeight - 80) card.scrollIntoView({ block: "start" });
  }
  document.querySelector("table.missions")?.addEventListener("click", (event) => {
    const row = event.target.closest("tbody tr");
    if (row) select(Number(row.querySelector("[data-select]").dataset.select));
  });
  let resized = 0;
  window.addEventListener("resize", () => {
    clearTimeout(resized);
    resized = setTimeout(redraw, 150);
  });
  for (const [event, value] of [["beforeprint", true], ["afterprint", false]])
    window.addEventListener(event, () => {
      printing = value;
      redraw();
    });
  redraw();
})();
