// The page of `flightwatt watch --serve`: the state of a flight in the air, from the server's events. Charts need
// Vega-Lite, all else no library.
(() => {
  const element = (id) => document.getElementById(id);
  const maxPoints = 4000; // of a chart; beyond, every second of the older ones is removed
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const theme = JSON.parse(element("theme").textContent || "{}");
  let points = [];
  let ahead = [];
  let run = null;
  let drawn = {}; // chart -> Vega view

  const number = (value, digits, unit) => (value === null || value === undefined ? "\u2013" : `${value.toFixed(digits)} ${unit}`);
  const minutes = (seconds) => number(seconds === null || seconds === undefined ? null : seconds / 60, 1, "min");
  const runText = (run) => {
    if (!run) return "\u2013";
    const names = Object.entries(run).map(([name, qos]) => [name, ...Object.entries(qos).map(([key, value]) => `${key}=${value}`)].join(" "));
    return names.join(", ") || "nothing";
  };

  // The rows of the tables: name, text of the state.
  const rows = {
    now: [
      ["phase", (s) => s.phase + (s.began_in_air ? " (telemetry starts in flight)" : "")],
      ["in the air", (s) => minutes(s.flight_time_s)],
      ["energy so far", (s) => number(s.energy_wh, 3, "Wh")],
      ["power", (s) => `${number(s.power_w, 1, "W")}, expected ${number(s.expected_power_w, 1, "W")}`],
      ["voltage", (s) => number(s.voltage_v, 2, "V")],
      ["altitude", (s) => number(s.altitude_m, 0, "m")],
      ["state of charge", (s) => `${number(s.battery?.soc_percent, 1, "%")} by charge, ${number(s.battery?.soc_by_voltage_percent, 1, "%")} by voltage`],
    ],
    landing: [
      ["energy to the landing", (s) => (s.prediction ? s.energyAhead : s.no_prediction_reason ? `no prediction: ${s.no_prediction_reason}` : "\u2013")],
      ["at landing", (s) => s.atLanding],
      ["reserve in", (s) => minutes(s.battery?.reserve_in_s)],
      ["probability of landing below it", (s) => number(s.battery?.probability_below_reserve == null ? null : 100 * s.battery.probability_below_reserve, 1, "%")],
      ["turn home", (s) => (!s.turn_home ? "\u2013" : s.turn_home.latest_in_s === null ? "too late to keep the reserve" : s.turn_home.path_can_be_flown ? "home from anywhere on the path" : `within ${minutes(s.turn_home.latest_in_s)}`)],
    ],
    schedule: [
      ["runs now", (s) => runText(s.decision?.run)],
      ["next", (s) => (s.decision?.next ? `${runText(s.decision.next)} in ${number(s.decision.next_in_s, 0, "s")}` : "\u2013")],
      ["utility to the end", (s) => number(s.decision?.remaining_utility_per_s, 3, "a second")],
      ["changes so far", (s) => s.decision?.changes ?? "\u2013"],
    ],
    link: [
      ["messages", (s) => s.messages],
      ["silent for", (s) => number(s.time_since_message_s, 0, "s")],
      ["restarts", (s) => s.restarts],
      ["not used", (s) => Object.entries(s.unusable).map(([reason, count]) => `${count} ${reason}`).join("; ") || "nothing"],
      ["other senders", (s) => Object.entries(s.others).map(([name, count]) => `${name} (${count})`).join(", ") || "none"],
    ],
  };
  for (const [id, list] of Object.entries(rows)) {
    element(id).replaceChildren(...list.flatMap(([name]) => [Object.assign(document.createElement("dt"), { textContent: name }), document.createElement("dd")]));
  }

  function list(id, texts, none) {
    const items = (texts.length ? texts : [none]).map((text) => Object.assign(document.createElement("li"), { textContent: text }));
    const before = [...element(id).children].map((item) => item.textContent);
    if (before.join("\n") !== items.map((item) => item.textContent).join("\n")) element(id).replaceChildren(...items);
  }

  function texts(state) {
    const { prediction } = state;
    if (!prediction) return { ...state, atLanding: "\u2013" };
    const { low, high } = prediction.remaining_energy_wh_interval_95;
    const energyAhead = `${number(prediction.remaining_energy_wh, 2, "Wh")} (${low.toFixed(2)} to ${number(high, 2, "Wh")})`;
    const { battery } = prediction;
    const landing = (b) => (b.fails_after_s !== null ? `the battery fails in ${minutes(b.fails_after_s)}` : `${number(b.soc_percent, 1, "%")}, ${number(b.voltage_v, 2, "V")}`);
    const atLanding = battery ? `${landing(battery.at_landing)}; at the high end ${landing(battery.at_landing_high_energy)}` : "\u2013";
    return { ...state, energyAhead, atLanding };
  }

  function show(state) {
    if (!state) return;
    const known = texts(state);
    element("title").textContent = state.aircraft_id ? `Aircraft ${state.aircraft_id}` : "No aircraft yet";
    document.title = `${state.phase} \u2013 ${element("title").textContent}`;
    for (const [id, listed] of Object.entries(rows)) listed.forEach(([, text], i) => (element(id).children[2 * i + 1].textContent = text(known)));
    list("alarms", state.alarms.map(({ kind, text }) => `${kind}: ${text}`), "none");
    element("alarms").classList.toggle("alarm", state.alarms.length > 0);
    list("warnings", state.warnings, "none");
    ahead = (state.ahead?.time_s ?? []).map((t, i) => ({ t, value: state.ahead.soc_percent[i], of: "predicted" }));
  }

  function add(point) {
    if (points.length && point.t < points[points.length - 1].t) points = []; // a clock reset
    points.push(point);
    if (points.length > maxPoints) points = points.filter((_, i) => i % 2 === 0 || i > (maxPoints * 3) / 4);
  }

  // --- charts ---
  const series = (key, of) => points.filter((point) => point[key] !== null && point[key] !== undefined).map((point) => ({ t: point.t, value: point[key], of }));
  const charts = {
    charge: { title: "State of charge [%]", values: () => [...series("soc", "flown, by charge"), ...series("soc_by_voltage", "flown, by voltage"), ...ahead] },
    power: { title: "Power [W]", values: () => [...series("power", "measured"), ...series("expected", "expected")] },
    altitude: { title: "Altitude [m]", values: () => series("altitude", "altitude") },
  };
  const phases = () => {
    const spans = [];
    for (const { t, phase } of points) {
      const last = spans[spans.length - 1];
      if (last) last.end = t;
      if (!last || last.phase !== phase) spans.push({ begin: t, end: t, phase });
    }
    return spans;
  };
  const specification = (title, width) => ({
    width,
    height: 180,
    layer: [
      { data: { name: "phases" }, mark: { type: "rect", opacity: 0.12 }, encoding: { x: { field: "begin", type: "quantitative" }, x2: { field: "end" }, color: { field: "phase", type: "nominal", title: "phase", scale: { domain: ["ground", "takeoff", "cruise", "landing", "landed"], range: ["#888888", "#d98200", "#0072b2", "#009e73", "#888888"] } } } },
      { data: { name: "values" }, mark: { type: "line", clip: true }, encoding: { x: { field: "t", type: "quantitative", title: "time of the telemetry [s]", scale: { zero: false } }, y: { field: "value", type: "quantitative", title, scale: { zero: false } }, strokeDash: { field: "of", type: "nominal", title: null } } },
    ],
    resolve: { legend: { color: "independent" } },
  });

  // A chart is created with its first values: Vega has no scale without values.
  async function begin(id, values, spans) {
    const box = element(id);
    if (!box || typeof vegaEmbed === "undefined" || box.dataset.begun) return;
    box.dataset.begun = "yes";
    const spec = { ...specification(charts[id].title, Math.max(160, box.clientWidth - 240)), datasets: { values, phases: spans } };
    const result = await vegaEmbed(box, spec, { mode: "vega-lite", renderer: "svg", config: dark.matches ? theme.dark : theme.light, actions: false });
    drawn[id] = result.view;
  }

  function draw() {
    const spans = phases();
    for (const id of Object.keys(charts)) {
      const values = charts[id].values();
      if (values.length < 2) continue;
      if (drawn[id]) drawn[id].data("values", values).data("phases", spans).runAsync();
      else begin(id, values, spans);
      if (element(id)) element(id).dataset.points = values.length;
    }
  }
  let due = null;
  const drawSoon = () => (due ??= setTimeout(() => ((due = null), draw()), 250));

  // --- events ---
  const events = new EventSource("events");
  events.addEventListener("begin", ({ data }) => {
    const begin = JSON.parse(data);
    points = [];
    ahead = [];
    begin.points.forEach(add);
    if (run !== begin.run) element("page").dataset.runs = Number(element("page").dataset.runs || 0) + 1;
    run = begin.run;
    element("connection").textContent = "";
    drawSoon();
  });
  events.addEventListener("state", ({ data }) => {
    const state = JSON.parse(data);
    if (!state) return;
    show(state);
    add(state.point);
    element("page").dataset.time = state.time_s;
    drawSoon();
  });
  events.addEventListener("error", () => (element("connection").textContent = "No connection to flightwatt watch: retrying every second."));

  dark.addEventListener("change", () => {
    drawn = {};
    for (const id of Object.keys(charts)) if (element(id)) delete element(id).dataset.begun;
    draw();
  });
})();
