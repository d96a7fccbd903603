// Figures for papers from the document of a report (app/src/documents.ts): figuresOf(document) returns each as {id, spec}, a
// Vega-Lite specification with its data, made of a template in figures/.
import { readFileSync } from "node:fs";
import { inflateSync } from "node:zlib";

const template = (name) => JSON.parse(readFileSync(new URL(`figures/${name}.vl.json`, import.meta.url), "utf8"));

/** A part of a template with each "{{FIELD}}" replaced by that value, if there is one, and without layers whose data are null. */
function filled(part, values) {
  if (typeof part === "string") {
    const field = part.match(/^\{\{(.*)\}\}$/)?.[1];
    return field !== undefined && field in values ? values[field] : part;
  }
  if (Array.isArray(part)) return part.map((one) => filled(one, values)).filter((one) => one?.data !== null);
  if (part === null || typeof part !== "object") return part;
  return Object.fromEntries(Object.entries(part).map(([key, value]) => [key, filled(value, values)]));
}

/** A figure of a template; the template's panel in "concat" is repeated with each of `panels`. */
function figure(name, id, description, values = {}, panels) {
  const spec = filled(template(name), values);
  if (panels) spec.concat = panels.map((panel) => filled(spec.concat[0], panel));
  return { id, spec: { ...spec, description } };
}

/** Columns of one length as rows; a value that is no array is that of every row. */
function rows(columns) {
  const length = Object.values(columns).find(Array.isArray).length;
  return Array.from({ length }, (_, i) => Object.fromEntries(Object.entries(columns).map(([name, values]) => [name, Array.isArray(values) ? values[i] : values])));
}
const table = (...parts) => ({ values: parts.flatMap(rows) });
const word = (phase) => (phase === "takeoff" ? "take-off" : phase);
const hasNumber = (values) => values.some((value) => value !== null);

function flightFigure({ name }, detail, id) {
  const [other, ofPower] = template("flight").vconcat;
  const panels = [
    ["altitude", "altitude_m", "altitude [m]", 110],
    ["throttle", "throttle_percent", "throttle [%]", 80],
  ].filter(([key]) => detail[key]).map(([key, column, title, height]) => filled(other, { rows: table(detail[key]), column, title, height }));
  const { time_s, power_w, model_power_w } = detail.power;
  const curves = [{ time_s, power_w, curve: "measured" }, ...(model_power_w ? [{ time_s, power_w: model_power_w, curve: "model" }] : [])];
  panels.push(filled(ofPower, { rows: table(...curves) }));
  const views = panels.map((_, i) => `panel_${i}`);
  const made = figure("flight", id, `Altitude, throttle and power of flight ${name} over time, with its phases.`, {
    views,
    power_view: views.at(-1),
    phases: detail.phases.map(({ phase, start_s, end_s }) => ({ phase: word(phase), start_s, end_s })),
    edges: detail.edges.map(({ name: edge, time_s: at, evidence }) => ({ edge, time_s: at, evidence })),
  });
  made.spec.vconcat = panels.map((panel, i) => filled(panel, { name: views[i] }));
  return made;
}

function modelFigure(model, id) {
  const drawn = ["model", ...(model.curves[1].band ? ["95 % band"] : []), ...(model.curves[1].flights ? ["range of the flights"] : [])];
  const legend = drawn.length > 1 ? { values: drawn, symbolType: "square", symbolOpacity: 1, columns: 3 } : null;
  const panels = model.curves.map(({ phase, time_s, power_w, band, flights }) => ({
    phase: word(phase),
    legend,
    envelope: flights && table(flights),
    band: band && table(band),
    model: table({ time_s, power_w }),
  }));
  return figure("model", id, `Mechanical power model ${model.name} over each phase.`, {}, panels);
}

function physicalFigure({ fit, level, bins, best }) {
  const slowest = Math.min(...level.map(({ airspeed_m_per_s }) => airspeed_m_per_s[0]));
  const flown = fit.airspeed_m_per_s;
  const words = best.map(({ purpose, text }) => ` ${purpose}: ${text}.`).join("");
  return figure("physical", "physical-power", `Power over airspeed in level flight, with ${fit.bins} bins of ${fit.flights.length} flights.${words}`, {
    level: table(...level.map(({ flown: range, ...curve }) => ({ ...curve, range: range ? "flown" : "slower than flown" }))),
    bins: table(...bins.map(({ level_power_w, power_w, ...bin }) => ({ ...bin, power_w: level_power_w, measured_w: power_w }))),
    best: best.length > 0 ? { values: best } : null,
    flown: { values: [flown] },
    domain: [slowest, flown.high],
  });
}

function validationFigure({ errors, scores }) {
  const ofModels = errors.map(({ title, flight, error_wh, measured_wh, predicted_wh }) => ({ model: title, flight, error_wh, measured_wh, predicted_wh }));
  return figure("validation", "validation-errors", `Error of the predicted energy of ${scores.flights} flights by leave-one-out.`, { errors: table(...ofModels) });
}

function voltageFigure({ voltages }) {
  const panels = voltages.map(({ flight, time_s, measured_v, model_v }) => ({
    flight,
    curves: table({ time_s, voltage_v: measured_v, curve: "measured" }, { time_s, voltage_v: model_v, curve: "model" }),
  }));
  return figure("voltage", "battery-voltage", `Terminal voltage of ${voltages.length} flights over time, measured and modelled.`, {}, panels);
}

function openCircuitFigure({ open_circuit: { soc_percent, voltage_v, low_v, high_v, from_flights } }) {
  const origin = from_flights.map((known) => (known ? "from flights" : "by the chart"));
  const words = `${voltage_v[0].toFixed(2)} V empty, ${voltage_v.at(-1).toFixed(2)} V full, observed down to ${soc_percent[from_flights.indexOf(true)]} %`;
  const made = figure("open_circuit", "battery-open-circuit", `Open-circuit voltage over state of charge: ${words}.`, { knots: table({ soc_percent, voltage_v, low_v, high_v, origin }) });
  if (!hasNumber(low_v)) made.spec.layer.shift(); // the intervals
  return made;
}

/** A component's panel, with lines and intervals where the profile has them. */
function profilePanel({ name, parameter, lines }, panel) {
  const nodes = panel.layer[0];
  if (!hasNumber(lines[0].low_w)) nodes.layer.splice(1, 1);
  if (lines[0].name === "") delete nodes.encoding.color;
  const ofLines = lines.map(({ name: line, value: qos, power_w, low_w, high_w }) => ({ line, qos, power_w, low_w, high_w }));
  return filled(panel, { nodes: table(...ofLines), parameter: parameter || "no parameter", component: name });
}

function profileFigure({ components }, id) {
  const made = figure("profile", id, "Profiled power of on-board software over its quality of service.");
  made.spec.concat = components.map((component) => profilePanel(component, structuredClone(made.spec.concat[0])));
  return made;
}

function scheduleFigure(missions) {
  const phases = missions[0].phases;
  const areCommon = missions.every((mission) => JSON.stringify(mission.phases) === JSON.stringify(phases));
  const words = missions.map(({ title, card }) => ` ${title}: ${card.lead}.`).join("");
  const made = figure("schedule", "schedules-soc", `State of charge over the mission.${words}`, {
    end_s: Math.max(...missions.map(({ summary }) => summary.duration_s)),
    titles: missions.map(({ title }) => title),
    shown: missions.map(({ title }) => ({ title })),
    missions: missions.map(({ title, summary, curve, band }) => ({
      title,
      time_s: curve.time_s,
      soc: curve.soc_percent,
      reserve: summary.reserve_soc_percent,
      band: band && { time_s: band.time_s, low: band.low_percent, high: band.high_percent },
    })),
    phases: areCommon ? { values: phases.map((one) => ({ ...one, phase: word(one.phase) })) } : null,
    strip: { values: missions.flatMap(({ title, schedule }) => schedule.map((part) => ({ ...part, mission: title, phase: word(part.phase) }))) },
  });
  if (!missions.some(({ schedule }) => schedule.some(({ compute_w }) => compute_w !== 0))) made.spec.vconcat.splice(1, 1);
  return made;
}

/** The map as the paper's Fig. 4: a cell has the mean of its corners. */
function qualityFigure({ x_name: x, y_name: y, map }, id) {
  const at = (i, j) => map.soc_percent[j * map.x.length + i];
  const corners = (i, j) => [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
  const cells = map.y.slice(1).flatMap((y_high, j) =>
    map.x.slice(1).map((x_high, i) => ({
      x_low: map.x[i],
      x_high,
      y_low: map.y[j],
      y_high,
      soc_percent: corners(i, j).includes(null) ? null : corners(i, j).reduce((sum, value) => sum + value, 0) / 4,
    })),
  );
  return figure("quality", id, `Final state of charge over ${x} and ${y}, where one configuration runs throughout.`, {
    x,
    x_from: `${x} from`,
    x_domain: [map.x[0], map.x.at(-1)],
    y,
    y_from: `${y} from`,
    y_domain: [map.y[0], map.y.at(-1)],
    cells: { values: cells },
  });
}

/** The known trends of one aircraft. */
function trendsFigure(trends, aircraft, id) {
  const dated = ({ clock_s, value }) => ({ date: clock_s.map((second) => 1000 * second), value });
  const panels = trends.map(({ title, flights, lines }) => {
    // The interval of few flights is cut: it would hide them.
    const [low, high] = [Math.min(...flights.value), Math.max(...flights.value)];
    const margin = Math.max(high - low, 0.05 * Math.abs(high));
    return { title, flights: table(dated(flights)), slopes: table(...lines.map((one) => ({ ...dated(one), slope: one.name }))), domain: [low - margin, high + margin] };
  });
  return figure("trends", id, `Trends of ${aircraft} and its pack over the dates of flights.`, {}, panels);
}

/** Unique names of files: "flight-20_07_03__12_17_45-power". */
function flightIds(flights) {
  const taken = new Set();
  return flights.map(({ name }, i) => {
    let id = `flight-${name.slice(0, 60).replace(/[^0-9A-Za-z_]+/g, "-")}`;
    if (taken.has(id)) id += `-${i + 1}`;
    taken.add(id);
    return `${id}-power`;
  });
}

export function figuresOf(document) {
  const { flights, models, physical, validation, battery, trends, quality, software, missions } = document;
  const figures = [];
  const ids = flightIds(flights);
  flights.forEach((flight, i) => {
    const detail = typeof flight.detail === "string" ? JSON.parse(inflateSync(Buffer.from(flight.detail, "base64")).toString()) : flight.detail;
    if (detail?.power) figures.push(flightFigure(flight, detail, ids[i]));
  });
  const fitted = models.filter(({ is_of_missions }) => !is_of_missions);
  figures.push(...fitted.map((model) => modelFigure(model, "model-curves")));
  if (physical) figures.push(physicalFigure(physical));
  if (validation) figures.push(validationFigure(validation));
  if (battery?.identified) figures.push(voltageFigure(battery), openCircuitFigure(battery));
  const known = (trends?.trends ?? []).filter(({ lines }) => lines);
  [...new Set(known.map(({ aircraft }) => aircraft))].forEach((name, i) =>
    figures.push(trendsFigure(known.filter(({ aircraft }) => aircraft === name), name, `trends-${i + 1}`)),
  );
  quality.forEach((grid, i) => grid.map && figures.push(qualityFigure(grid, `quality-${i + 1}`)));
  figures.push(...models.filter(({ is_of_missions }) => is_of_missions).map((model, i) => modelFigure(model, `mission-model-${i + 1}-curves`)));
  figures.push(...software.map((one, i) => profileFigure(one, `profile-${i + 1}`)));
  if (missions.length > 0) figures.push(scheduleFigure(missions));
  return figures;
}
