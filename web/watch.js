// The page of `flightwatt watch --serve`: the state of a flight in the air, from the server's events. Charts need
// Vega-Lite, all else no library. Nothing here changes anything on the aircraft or in the program.
(() => {
  const element = (id) => document.getElementById(id);
  const maxPoints = 4000; // of a chart; beyond, every second of the older ones is removed
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const theme = JSON.parse(element("theme").textContent || "{}");
  let points = [];
  let state = null;
  let arrival = null; // when the latest state arrived
  let connected = true;
  let run = null;
  let drawn = {}; // chart -> Vega view

  // --- texts ---
  const isKnown = (value) => value !== null && value !== undefined;
  const number = (value, digits) => value.toFixed(digits).replace("-", "\u2212");
  // Rounded down: "12 min" from 10 minutes on, below "8:12 min", below a minute "45 s".
  function duration(seconds) {
    const whole = Math.max(0, Math.floor(seconds));
    if (whole < 60) return [String(whole), "s"];
    if (whole >= 600) return [String(Math.floor(whole / 60)), "min"];
    return [`${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`, "min"];
  }
  const durationText = (seconds) => duration(seconds).join(" ");
  // What is over has its seconds: "23:54 min".
  const wholeDuration = (seconds) => (seconds < 600 ? duration(seconds) : [`${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`, "min"]);
  const phaseNames = { ground: "On the ground", takeoff: "Take-off", cruise: "Cruise", landing: "Landing", landed: "Landed" };
  function runText(configuration) {
    const names = Object.entries(configuration ?? {}).map(([name, quality]) =>
      [name, ...Object.entries(quality).map(([key, value]) => `${key} ${value}`)].join(" "));
    return names.join(", ") || "nothing";
  }
  const age = () => (state?.time_since_message_s ?? 0) + (arrival === null ? 0 : (Date.now() - arrival) / 1000);
  const isOld = () => state !== null && (!connected || age() >= state.silence_threshold_s);
  const hasLanded = () => state?.phase === "landed";
  const landedBelow = () => hasLanded() && state.reserve_soc_percent > 0 && isKnown(state.battery?.soc_percent) && state.battery.soc_percent < state.reserve_soc_percent;

  // --- status: class of the page, headline, action ---
  function status() {
    const away = "flightwatt watch does not answer";
    if (!state?.aircraft_id) return connected ? ["waiting", "Waiting for an aircraft", ""] : ["silent", "NO CONNECTION", away];
    if (hasLanded()) {
      const text = `${landedText()}${connected ? "" : ". The watch has ended: these are its last numbers."}`;
      if (landedBelow()) return ["caution", "Landed below the reserve", `${number(state.battery.soc_percent, 1)} % left, reserve ${number(state.reserve_soc_percent, 0)} %; ${text}`];
      return ["landed", "Landed", text];
    }
    if (!connected) return ["silent", `NO CONNECTION for ${durationText(age())}`, `${away}. Numbers are old.`];
    if (isOld()) return ["silent", `NO LINK for ${durationText(age())}`, "Numbers are old. Check antenna and line of sight."];
    const [worst] = state.alarms; // the most severe is first
    if (worst) return [worst.grade, worst.grade === "alarm" ? "ALARM" : "Caution", worst.action];
    const { battery, prediction } = state;
    const overtime = prediction?.cruise.overtime_s;
    if (!prediction) return ["waiting", phaseNames[state.phase], state.no_prediction_reason ? `No prediction: ${state.no_prediction_reason}` : ""];
    if (!prediction.battery) return ["waiting", phaseNames[state.phase], `${number(prediction.remaining_energy_wh, 1)} Wh to the landing`];
    const [kept, missed] = state.reserve_soc_percent > 0 ? ["Reserve is kept", "miss the reserve"] : ["Battery lasts", "run empty"];
    const share = Math.round(100 * battery.probability_below_reserve);
    if (isKnown(overtime)) return ["ok", kept, `If it lands now: the planned cruise ended ${durationText(overtime)} ago`];
    if (!isKnown(battery.probability_below_reserve)) return ["ok", kept, `How many flights would ${missed} is unknown`];
    return ["ok", kept, `${share < 1 ? "Under 1" : share} of 100 flights would ${missed}`];
  }
  const signs = {
    ok: "M20 3a17 17 0 1 0 .01 0ZM12 20l6 6 11-12", caution: "M20 4l17 31H3ZM20 15v10M20 30v.5",
    alarm: "M13 3h14l10 10v14L27 37H13L3 27V13ZM20 11v11M20 28v.6", silent: "M4 14a24 24 0 0 1 32 0M10 21a15 15 0 0 1 20 0M20 30v.5M5 36 35 4",
    landed: "M4 33h32M8 12l20 12 6-2", waiting: "M20 3a17 17 0 1 0 .01 0ZM20 11v9l6 5",
  };
  const landedText = () => `${wholeDuration(state.flight_time_s).join(" ")} in the air${isKnown(state.energy_wh) ? `, ${number(state.energy_wh, 2)} Wh` : ""}`;

  // --- answers: [label, value, unit, note, class]; those without a value are left out ---
  const sentence = (...parts) => parts.filter(Boolean).join(", ");
  function landingAnswer() {
    const { prediction } = state;
    const landing = prediction?.battery?.at_landing;
    const worst = prediction?.battery?.at_landing_high_energy;
    if (landing && isKnown(landing.fails_after_s)) return ["Battery empty in", ...duration(landing.fails_after_s), "before the landing"];
    if (landing) {
      const reserve = state.reserve_soc_percent > 0 ? `reserve ${number(state.reserve_soc_percent, 0)} %` : "";
      const low = `at most 1 of 40 flights ${isKnown(worst.fails_after_s) ? "runs empty" : `below ${number(worst.soc_percent, 0)} %`}`;
      return [isKnown(prediction.cruise.overtime_s) ? "Charge if it lands now" : "Charge at landing", number(landing.soc_percent, 1), "%", sentence(reserve, low)];
    }
    if (prediction) return ["Energy to the landing", number(prediction.remaining_energy_wh, 1), "Wh", ""];
    if (isKnown(state.energy_wh)) return ["Energy so far", number(state.energy_wh, 2), "Wh", ""];
    return isKnown(state.battery?.soc_percent) ? ["Charge now", number(state.battery.soc_percent, 1), "%", ""] : null;
  }
  function landedAnswers() {
    const middle = (state.lift_off_s ?? 0) + state.flight_time_s / 2;
    const then = points.find((point) => point.t >= middle && isKnown(point.at_landing));
    const predicted = then && isKnown(state.lift_off_s) ? `predicted after ${durationText(then.t - state.lift_off_s)}: ${number(then.at_landing, 1)} %` : "";
    const soc = state.battery?.soc_percent;
    const reserve = state.reserve_soc_percent > 0 ? `reserve ${number(state.reserve_soc_percent, 0)} %` : "";
    return [isKnown(soc) && ["Charge left", number(soc, 1), "%", sentence(reserve, predicted)],
      isKnown(state.energy_wh) && ["Energy used", number(state.energy_wh, 2), "Wh", ""], ["In the air", ...wholeDuration(state.flight_time_s), ""]].filter(Boolean);
  }
  function answers() {
    if (hasLanded()) return landedAnswers();
    const { battery, prediction, turn_home: home } = state;
    const list = [landingAnswer()].filter(Boolean);
    const overtime = isKnown(prediction?.cruise.overtime_s);
    if (isKnown(battery?.reserve_in_s)) list.push([state.reserve_soc_percent > 0 ? "Reserve reached in" : "Empty in", ...duration(battery.reserve_in_s), overtime ? "at the mean power so far" : "if the cruise continues"]);
    const verb = isKnown(prediction?.cruise.path_at_s) ? "Turn home" : "Land";
    if (home && home.latest_in_s === null) list.push([verb, "now", "", "too late for the reserve", "home"]);
    else if (home?.path_can_be_flown) list.push(["Planned landing in", ...duration(home.latest_in_s), "keeps the reserve", "home"]);
    else if (home) list.push([`${verb} within`, ...duration(home.latest_in_s), "to keep the reserve", "home"]);
    return list;
  }
  // --- small values: [label, text] ---
  function values() {
    const { battery } = state;
    const all = [["Charge now", hasLanded() ? null : battery?.soc_percent, 0, "%"], ["By voltage", battery?.soc_by_voltage_percent, 0, "%"], ["Voltage", state.voltage_v, 1, "V"],
      ["Altitude", state.altitude_m, 0, "m"], ["Energy", hasLanded() ? null : state.energy_wh, 2, "Wh"]];
    const list = all.filter(([, value]) => isKnown(value)).map(([label, value, digits, unit]) => [label, `${number(value, digits)} ${unit}`]);
    if (!isKnown(state.power_w) || hasLanded()) return list;
    const power = [["Power", `${number(state.power_w, 0)} W`]];
    if (isKnown(state.expected_power_w)) power.push(["Expected power", `${number(state.expected_power_w, 0)} W`]);
    list.splice(Math.min(3, list.length), 0, ...power);
    return list;
  }

  const node = (tag, text, properties = {}) => Object.assign(document.createElement(tag), { textContent: text }, properties);
  function replace(id, children) {
    const box = element(id);
    const old = [...box.children].map((child) => child.outerHTML).join("");
    if (old !== children.map((child) => child.outerHTML).join("")) box.replaceChildren(...children);
  }
  const write = (id, text) => element(id).textContent !== text && (element(id).textContent = text);
  const pairs = (list) => list.flatMap(([label, text]) => [node("dt", label), node("dd", text)]);
  const group = (children, properties = {}) => {
    const box = node("div", "", properties);
    box.append(...children);
    return box;
  };

  function show() {
    const [kind, headline, action] = status();
    const old = isOld();
    const before = document.body.dataset.kind;
    document.body.dataset.kind = kind;
    document.body.className = [kind, old && !hasLanded() && "old", hasLanded() && "over"].filter(Boolean).join(" ");
    if (palette !== document.body.className) drawSoon();
    element("sign").firstElementChild.setAttribute("d", signs[kind]);
    write("status", headline);
    write("action", action);
    const name = state?.aircraft_id ? `${state.aircraft_name || "Aircraft"} ${state.aircraft_id}` : "flightwatt watch";
    const isUrgent = kind === "alarm" || kind === "silent";
    document.title = isUrgent || kind === "caution" ? `${headline}${kind === "silent" ? "" : `: ${action}`} \u2013 ${name}` : `${headline} \u2013 ${name}`;
    if (kind !== before) {
      write("spoken", `${headline}. ${action}`); // once, not every second
      if (isUrgent && navigator.userActivation?.hasBeenActive) navigator.vibrate?.([400, 150, 400]);
    }
    if (!state) return;
    const oldText = old && !hasLanded() ? `${durationText(age())} old` : "";
    replace("answers", answers().map(([label, value, unit, note, role]) => {
      const big = node("dd", value, { className: "number" });
      if (unit) big.append(node("small", unit));
      return group([node("dt", label), big, ...(oldText || note ? [node("dd", oldText || note, { className: "note" })] : [])], role ? { className: role } : {});
    }));
    const inAir = state.flight_time_s > 0 ? `, ${(hasLanded() ? wholeDuration : duration)(state.flight_time_s).join(" ")} in the air` : "";
    const hasHeard = state.messages > 0;
    write("phase", !hasHeard ? "Nothing received yet" : `${phaseNames[state.phase]}${inAir}${state.began_in_air ? " (since the first message)" : ""}`);
    write("received", !hasHeard ? "" : age() < 2 ? "received now" : `${old ? "" : "received "}${durationText(age())} ago`);
    replace("values", values().map(([label, text]) => group([node("dt", label), node("dd", text)])));
    replace("alarms", state.alarms.filter(({ kind: of }) => of !== "silence").map((alarm, i) => {
      const isInBand = i === 0 && alarm.action === action;
      return node("li", isInBand ? alarm.text : `${alarm.action} (${alarm.text})`, { className: alarm.grade });
    }));
    const { decision } = state;
    write("schedule", decision && !hasLanded() ? `Computer runs: ${runText(decision.run)}. ` +
      (decision.next ? `Next: ${runText(decision.next)} in ${durationText(decision.next_in_s)}.` : "No change until landing.") : "");
    write("more", state.warnings.length ? `Warnings (${state.warnings.length}) and link` : "Link");
    replace("warnings", state.warnings.map((text) => node("li", text)));
    replace("link", pairs([["messages", String(state.messages)], ["restarts of the clock", state.restarts ? String(state.restarts) : ""],
      ["not used", Object.entries(state.unusable).map(([reason, count]) => `${count} ${reason}`).join("; ")],
      ["other senders", Object.entries(state.others).map(([sender, count]) => `${sender} (${count})`).join(", ")]]
      .filter(([, text]) => text)));
    write("aircraft", name);
  }

  function add(point) {
    if (points.length && point.t < points[points.length - 1].t) points = []; // a clock reset
    points.push(point);
    if (points.length > maxPoints) points = points.filter((_, i) => i % 2 === 0 || i > (maxPoints * 3) / 4);
  }

  // --- charts: solid is flown, dotted predicted; shaded to the high end of the energy; time in minutes ---
  const begin = () => state?.lift_off_s ?? points[0]?.t ?? 0;
  const minutes = (t) => (t - begin()) / 60;
  const series = (key, of) => points.filter((point) => isKnown(point[key]) && point.t >= begin()).map((point) => ({ t: minutes(point.t), value: point[key], of }));
  function means(rows) { // of 10 s
    const bins = new Map();
    for (const row of rows) {
      const bin = Math.floor(row.t * 6);
      bins.set(bin, [...(bins.get(bin) ?? []), row]);
    }
    return [...bins.values()].map((group) => ({ ...group.at(-1), value: group.reduce((sum, { value }) => sum + value, 0) / group.length }));
  }
  function ahead() {
    if (hasLanded() || !state?.ahead?.time_s.length) return [];
    const { time_s: times, soc_percent: soc } = state.ahead;
    const worst = state.prediction.battery.at_landing_high_energy.soc_percent;
    const last = soc.length - 1;
    const spread = (i) => (last ? (i / last) * Math.max(0, soc[last] - worst) : 0);
    return times.map((t, i) => ({ t: minutes(t), value: soc[i], low: Math.max(0, soc[i] - spread(i)), of: "predicted" }));
  }
  const charts = {
    charge: { title: "Charge [%]", height: 190, unit: "%", values: () => [...series("soc", "flown"), ...ahead()] },
    power: { title: "Power [W], mean of 10 s; dotted: expected", height: 100, unit: "W", values: () => [...means(series("power", "flown")), ...means(series("expected", "predicted"))] },
    altitude: { title: "Altitude [m]", height: 80, unit: "m", values: () => series("altitude", "flown") },
  };
  // The last point of each line, with its value.
  function ends(id, values) {
    const flown = values.findLast(({ of }) => of === "flown");
    const last = id === "charge" ? values.findLast(({ of }) => of === "predicted") : null;
    const width = values.reduce((most, { t }) => Math.max(most, t), 0);
    const isNear = last && last.t - flown.t < 0.25 * width;
    return [flown && { ...flown, label: hasLanded() || isNear ? "" : `${id === "power" ? "" : "now "}${number(flown.value, 0)} ${charts[id].unit}` },
      last && { ...last, label: `${number(last.value, 0)} % at landing` }].filter(Boolean)
      .map((end) => ({ ...end, align: end.t < 0.3 * width ? "left" : "right", dy: id !== "charge" ? -12 : end.value > 35 ? 17 : (end.value - 35) * 1.6 }));
  }
  const colour = (name) => getComputedStyle(document.body).getPropertyValue(name).trim();
  // Of both axes: Vega's own ends have none while a line is empty.
  function domains(id, values) {
    const all = values.map(({ value }) => value);
    const low = id === "altitude" ? Math.min(...all) : 0;
    return { across: [0, Math.max(1, ...values.map(({ t }) => t))], up: id === "charge" ? [0, 100] : [low, low + 1.25 * Math.max(1, Math.max(...all) - low)] }; // with room for a label
  }
  const between = (name) => [{ expr: `${name}[0]` }, { expr: `${name}[1]` }];
  function specification(id, values, width) {
    const { title, height } = charts[id];
    const [ink, page, statusColour] = ["--chart", "--page", "--status"].map(colour);
    const x = { field: "t", type: "quantitative", scale: { domain: between("across"), nice: false } };
    const y = { field: "value", type: "quantitative", scale: { domain: between("up"), nice: id !== "charge" } };
    const text = { type: "text", align: { expr: "datum.align" }, dx: { expr: "datum.align === 'left' ? 8 : -4" }, dy: { expr: "datum.dy" }, fontSize: 14, fontWeight: 600 };
    const label = { ...x, title: null, axis: { tickCount: 6, labelExpr: "datum.label + (datum.index === 1 ? ' min' : '')", labelFontSize: 12 } };
    const line = (of, dashes, color) => ({
      data: { name: "values" }, transform: [{ filter: `datum.of === '${of}'` }], mark: { type: "line", clip: true, strokeWidth: 2.5, strokeDash: dashes, color },
      encoding: { x: label, y: { ...y, title: null, axis: { tickCount: 4, labelFontSize: 12 } } } });
    return {
      width, height, autosize: { type: "fit-x", contains: "padding" }, background: null, padding: { left: 0, right: 22, top: 2, bottom: 2 },
      description: title,
      title: { text: title, anchor: "start", fontSize: 14, fontWeight: "normal", color: colour("--ink2"), offset: 4 },
      params: Object.entries(domains(id, values)).map(([name, value]) => ({ name, value })),
      layer: [
        { data: { name: "values" }, transform: [{ filter: "isValid(datum.low)" }], mark: { type: "area", opacity: 0.18, color: statusColour }, encoding: { x, y, y2: { field: "low" } } },
        line("flown", [1, 0], ink), line("predicted", [3, 3], id === "charge" ? statusColour : ink),
        { data: { name: "reserve" }, mark: { type: "rule", strokeDash: [6, 4], color: ink }, encoding: { y } },
        { data: { name: "reserve" }, mark: { type: "text", align: "left", baseline: "top", dx: 6, dy: 4, fontSize: 13, color: ink }, encoding: { y, x: { value: 0 }, text: { field: "label" } } },
        { data: { name: "ends" }, mark: { type: "point", filled: true, opacity: 1, size: 80, color: ink }, encoding: { x, y } },
        { data: { name: "ends" }, mark: { ...text, color: page, stroke: page, strokeWidth: 4 }, encoding: { x, y, text: { field: "label" } } },
        { data: { name: "ends" }, mark: { ...text, color: ink }, encoding: { x, y, text: { field: "label" } } },
      ].map((layer) => ({ ...layer, mark: { ...layer.mark, aria: false } })), // the description is read instead
    };
  }
  const datasets = (id, values) => ({ values, ends: ends(id, values), reserve: id === "charge" && state?.reserve_soc_percent > 0 ? [{ value: state.reserve_soc_percent, label: `reserve ${number(state.reserve_soc_percent, 0)} %` }] : [] });

  // A chart is created with its first values: Vega has no scale without values.
  async function create(id, values) {
    const box = element(id);
    if (!box || typeof vegaEmbed === "undefined" || box.dataset.begun) return;
    box.dataset.begun = "yes";
    const spec = { ...specification(id, values, box.clientWidth), datasets: datasets(id, values) };
    const result = await vegaEmbed(box, spec, { mode: "vega-lite", renderer: "svg", config: dark.matches ? theme.dark : theme.light, actions: false });
    drawn[id] = result.view;
  }
  function update(id, values) {
    for (const [name, rows] of Object.entries(datasets(id, values))) drawn[id].data(name, rows);
    for (const [name, ends] of Object.entries(domains(id, values))) drawn[id].signal(name, ends);
    drawn[id].runAsync();
  }
  let palette = null;
  function draw() {
    if (palette !== document.body.className) forget(); // other colours
    palette = document.body.className;
    for (const id of Object.keys(charts)) {
      const values = charts[id].values();
      if (values.length < 2) continue;
      if (drawn[id]) update(id, values);
      else create(id, values);
      if (element(id)) element(id).dataset.points = values.length;
    }
  }
  function forget() {
    for (const view of Object.values(drawn)) view.finalize();
    drawn = {};
    for (const id of Object.keys(charts)) if (element(id)) delete element(id).dataset.begun;
  }
  const redraw = () => (forget(), draw());
  let due = null;
  const drawSoon = () => (due ??= setTimeout(() => ((due = null), draw()), 250));

  // --- events ---
  const events = new EventSource("events");
  events.addEventListener("begin", ({ data }) => {
    const first = JSON.parse(data);
    points = [];
    first.points.forEach(add);
    if (run !== first.run) element("page").dataset.runs = Number(element("page").dataset.runs || 0) + 1;
    run = first.run;
    connected = true;
    show();
    drawSoon();
  });
  events.addEventListener("state", ({ data }) => {
    const next = JSON.parse(data);
    if (!next) return;
    state = next;
    arrival = Date.now();
    connected = true;
    add(state.point);
    element("page").dataset.time = state.time_s;
    show();
    drawSoon();
  });
  events.addEventListener("error", () => ((connected = false), show()));
  setInterval(show, 1000);
  dark.addEventListener("change", redraw);
  let width = window.innerWidth;
  window.addEventListener("resize", () => {
    if (window.innerWidth !== width) setTimeout(redraw, 200);
    width = window.innerWidth;
  });
})();
