// The parts of a report show what their document holds, in its order, and leave out what it does not have.
import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled, html, words } from "./helpers/bundle.mjs";
import { empty, flight, grid, mission, sortie } from "./helpers/documents.mjs";

globalThis.location ??= { hash: "" };
const app = await bundled("screens/report.tsx", "screens/plan.tsx", "screens/answer.tsx", "work/question.ts", "sections/charge_chart.tsx", "sections/quality_map.tsx", "sections/flights.tsx", "sections/flight.tsx", "sections/missions.tsx", "sections/mission_map.tsx", "sections/answer.tsx", "sections/several_packs.tsx", "ui/chart.tsx", "ui/printed.tsx");
const show = (type, props) => html(app.h(type, props), app);

test("a document without parts is its headline, its facts and its command", () => {
  const page = show(app.Report, { document: empty() });
  assert.match(words(page), /Headline of the page by flightwatt 0 The same as a command: flightwatt report runs/);
  assert.equal((page.match(/<section/g) ?? []).length, 0);
});

test("the worst mission is the card, with its words and its curve in words", () => {
  const missions = [mission("long", "fails"), mission("short", "keeps")];
  const page = show(app.Report, { document: { ...empty(), missions } });
  assert.match(words(page), /Worst of two: runs empty Lead of long long No software/);
  assert.match(page, /aria-label="State of charge of long: the battery fails at 8 min 0 s of 10 min 0 s, reserve 20 %\."/);
  assert.ok(page.indexOf("Lead of long") < page.indexOf("short"));
});

test("a mission's landing is in the words of the document, not rounded again", () => {
  const page = show(app.MissionCard, { mission: mission("m", "keeps", { card: { landing: "33.49 %", probability: "unknown" } }), index: 0, count: 1 });
  assert.match(words(page), /Charge at landing 33\.49 % Keeps the reserve of 20 % unknown/);
});

test("a mission that keeps its reserve is not told what would help", () => {
  const keeps = words(show(app.MissionCard, { mission: mission("m", "keeps", { card: { help: "4 s of cruise to spare" } }), index: 0, count: 1 }));
  assert.match(keeps, /4 s of cruise to spare/);
  assert.doesNotMatch(keeps, /What would help/);
  assert.match(words(show(app.MissionCard, { mission: mission("m", "fails", { card: { help: "2 min less" } }), index: 0, count: 1 })), /What would help: 2 min less\./);
});

test("cells of the quality map are buttons that say their setting and their end", () => {
  const page = show(app.QualityMap, { grid: grid([30, 10, null, 21]), missions: [mission("m", "keeps")], mission: 0, title: "Map" });
  assert.match(page, /<button[^>]*aria-label="5 fps, 32 key bits: lands with 30\.0 %, keeps the reserve in 0 % of flights"/);
  assert.match(page, /aria-label="5 fps, 448 key bits: the battery fails after 8 min 0 s, keeps/);
  assert.equal((page.match(/aria-pressed="true"/g) ?? []).length, 1, "one cell is selected");
});

test("the cell that is shown first is the one at the reserve", () => {
  assert.equal(app.edgeCell(grid([30, 10, null, 21])), 3);
  assert.equal(app.edgeCell(grid([null, null, null, null])), 0);
});

test("a grid of missions without flight is of software alone", () => {
  const missions = [mission("fly", "keeps"), mission("bench", "keeps", { summary: { mechanical_energy_wh: 0 } })];
  assert.deepEqual(app.gridTitles({ missions, quality: [grid([1, 2, 3, 4]), grid([1, 2, 3, 4], { missions: [1] })] }), ["Flight and software", "Software alone"]);
});

test("rows of flights are in natural order, one for each flight of a log, and a refused log has one", () => {
  const rows = app.rowsOf([flight("f10"), flight("f9", { sorties: [sortie(), sortie({ sortie: 2 })] }), flight("f1", { sorties: [], rejected: "no motion", used: "no" })]);
  assert.deepEqual(rows.map(({ log, sortie: of, index }) => [log.name, of?.sortie ?? null, index]), [["f1", null, 2], ["f9", 1, 1], ["f9", 2, 1], ["f10", 1, 0]]);
});

test("a refused log says why", () => {
  const page = words(show(app.Report, { document: { ...empty(), flights: [flight("bad", { sorties: [], rejected: "no motion in 82 s", used: "no" })] } }));
  assert.match(page, /Not used : no motion in 82 s/);
});

test("columns of a table of flights that no flight has are left out", () => {
  const page = show(app.Report, { document: { ...empty(), flights: [flight("a", { sorties: [sortie({ mean_power_w: { takeoff: null, cruise: null, landing: null } })] })] } });
  assert.doesNotMatch(page, /data-head="Cruise"/);
  assert.match(page, /data-head="Energy"/);
});

test("plots of a flight begin at lift-off, and only what the log has is plotted", () => {
  const detail = { phases: [{ sortie: 1, phase: "takeoff", start_s: 60, end_s: 90, complete: true }], power: { time_s: [0, 60, 120], power_w: [0, 30, null], model_power_w: [null, 28, 27] }, voltage: null, current: null, altitude: { time_s: [0, 120], altitude_m: [0, 40] }, throttle: null, airspeed: null };
  const plots = app.plotsOf(detail);
  assert.deepEqual(plots.map(({ title }) => title), ["Power [W]", "Altitude [m]"]);
  assert.deepEqual(plots[0].x, [-1, 0, 1]);
  assert.deepEqual(plots[0].lines.map(({ name }) => name), ["measured", "model"]);
});

test("a path changes its colour where the charge passes a step, without a gap", () => {
  const path = { elements: [], time_s: [0, 1, 2, 3], east_m: [0, 1, 2, 3], north_m: [0, 0, 0, 0], soc_percent: [100, 85, 70, null] };
  const tracks = app.pieces(path, 20);
  assert.deepEqual(tracks.map(({ colour }) => colour), ["c1", "c2"]);
  assert.deepEqual(tracks[0].places.at(-1), tracks[1].places[0]);
  assert.deepEqual(app.pieces({ ...path, soc_percent: [15, 15, 15, 15] }, 20).map(({ name }) => name), ["below the reserve"]);
});

test("flights with several packs are drawn from home, with where each returns and lands", () => {
  const flight = (pack, east_m, rest = {}) => ({ pack, track: { time_s: [0, 1, 2], east_m, north_m: [0, 0, 0], soc_percent: [90, 70, 50], wind_m_per_s: 4, wind_from_deg: 250, ...rest } });
  const drawn = app.packTracks([flight(1, [0, 100, 50], { return_index: 1 }), flight(2, [0, 50, 150]), { pack: 3, track: null }], 20);
  assert.deepEqual(drawn.wind, { m_per_s: 4, from_deg: 250 });
  assert.deepEqual(drawn.spots.map(({ name }) => name), ["pack 1 returns: 70 %", "pack 1 lands: 50 %", "pack 2 lands: 50 %"]);
  const metres = (place) => Math.round(place[1] * 111195);
  assert.deepEqual(drawn.spots.map(({ place }) => metres(place)), [100, 50, 200]);
  const degrees = app.packTracks([flight(1, [0, 1, 2], { latitude_deg: [43, 43, 43], longitude_deg: [1, 1.1, 1.2] })], 20);
  assert.deepEqual(degrees.spots.at(-1).place, [43, 1.2]);
  assert.deepEqual(app.packTracks([{ pack: 1 }], 20), { tracks: [], spots: [], wind: null });
});

test("parameters of an autopilot are shown without their comments", () => {
  assert.equal(app.parametersOf("# why\nBATT_LOW_MAH 2030\n\nBATT_CRT_MAH 1210\n"), "BATT_LOW_MAH 2030\nBATT_CRT_MAH 1210");
  assert.equal(app.parametersOf('<!--\nwhy\n-->\n<define name="A" value="1"/>'), '<define name="A" value="1"/>');
});

test("an unknown distance is a reason, and no sentence promises it", () => {
  const answered = (value, unknown = "") => ({ value, basis: "", unknown });
  assert.equal(app.answerSentence({ headline: "H", time_in_air_s: answered(610.5), distance_m: answered(null, "it hovered") }), "A full pack lasts 10 min 11 s");
  assert.equal(app.answerSentence({ headline: "H", time_in_air_s: answered(610.4), distance_m: answered(4140) }), "A full pack lasts 10 min 10 s and reaches 4.1 km");
  assert.equal(app.answerSentence({ headline: "No flight was used", time_in_air_s: answered(null, "none"), distance_m: answered(null) }), "No flight was used");
});

const simulated = (rest) => ({
  time_s: [0, 600], soc: [100, 48], compute_w: [null, null], phases: [],
  simulation: { final_soc_percent: 48, reserve_soc_percent: 20, keeps_reserve: true, duration_s: 600, ...rest },
});

test("a plan fits where its chance is known and high, and else perhaps", () => {
  const grade = (rest) => app.verdictOf(simulated(rest)).grade;
  assert.equal(grade({ probability_below_reserve: 0.01 }), "good");
  assert.equal(grade({ probability_below_reserve: 0.2 }), "doubt");
  assert.equal(grade({ probability_below_reserve: null }), "doubt");
  assert.match(app.verdictOf(simulated({})).detail, /its chance is unknown/);
  const two = app.verdictOf(simulated({ packs: 2, packs_needed: 2, flights: [] }));
  assert.deepEqual([two.grade, two.title], ["doubt", "Perhaps fits 2 packs"]);
  assert.match(two.detail, /about half of the flights/);
});

test("a plan that fits with the stated capacity alone fits perhaps", () => {
  const by_flights = (keeps_reserve) => ({ with_capacity_of_flights: { capacity_ah: 6.78, keeps_reserve } });
  assert.equal(app.verdictOf(simulated({ probability_below_reserve: 0.01, ...by_flights(true) })).grade, "good");
  const verdict = app.verdictOf(simulated({ probability_below_reserve: 0.01, ...by_flights(false) }));
  assert.equal(verdict.grade, "doubt");
  assert.match(verdict.detail, /with 6\.8 Ah, which the flights indicate, it misses the reserve/);
  assert.equal(app.verdictOf(simulated({ packs: 2, packs_needed: 2, flights: [by_flights(false)] })).grade, "doubt");
});

test("what may help is enough only where a chance is known", () => {
  const line = (help) => show(app.HelpLine, { help: { text: "2 packs", probability: null, suffices: false, ...help }, onChange() {} });
  assert.match(line({ suffices: true, probability: 0.97 }), /mark good.*enough, 97 of 100/);
  assert.match(line({ is_modelled: true }), /mark doubt.*perhaps: in about half of the flights/);
  assert.match(line({}), /mark doubt.*not enough alone/);
});

test("a distance in wind is along it, and that across it is named so", () => {
  const of = (value) => ({ value, basis: "", unknown: "" });
  const answer = {
    time_in_air_s: of(600), time_in_air_95_s: of(500), distance_m: of(40_000), airspeed_m_per_s: of(15), reserve_soc_percent: 20,
    capacity_ah: of(5), flights_capacity_ah_interval_95: { low: 4, high: 6 }, wind_m_per_s: 6, distance_across_m: 44_900, lines: [], notes: [], best_speeds: [], pastes: [], no_answer: "", failsafe_missing: "",
  };
  const page = words(show(app.Answer, { answer, curve: null, panel: null }));
  assert.match(page, /in all, out and back along a wind of 6\.0 m\/s *; *44\.9 km across it/);
  assert.match(words(show(app.Figures, { now: { answer, curve: null }, asking: false })), /half of the flights *, out and back/);
  assert.match(show(app.Figures, { now: { answer, curve: null } }), /class="ok"/);
  assert.doesNotMatch(show(app.Figures, { now: { answer: { ...answer, capacity_ah: of(12) }, curve: null } }), /class="ok"/);
  const unknown = { ...answer, time_in_air_95_s: { value: null, basis: "", unknown: "one flight" } };
  assert.match(words(show(app.Figures, { now: { answer: unknown, curve: null }, asking: false })), /as modelled *, out and back/);
});

test("what the program warns of an answer is in sight, what it warns of in a flight is folded", () => {
  const page = words(show(app.Warnings, { texts: ["f1: the log ends in the air", "the capacity contradicts the flights"], flights: ["f1"] }));
  assert.match(page, /^the capacity contradicts the flights 1 warning of a flight f1: the log/);
  assert.equal(show(app.Warnings, { texts: [], flights: ["f1"] }), "");
});

test("a line has a gap where a value is missing", () => {
  const place = { x: (value) => value, y: (value) => value };
  assert.equal(app.lineOf(place, [0, 1, 2, 3], [5, null, 6, 7]), "M0.0 5.0M2.0 6.0L3.0 7.0");
  assert.equal(app.areaOf(place, [0, 1], [null, null], [1, 2]), "");
});

test("words beside a chart are apart, in order and within its ends", () => {
  assert.deepEqual(app.spread([10, 12, 100], 19, 0, 110), [10, 29, 100]);
  assert.deepEqual(app.spread([100, 105, 110], 19, 0, 110), [72, 91, 110]);
});

test("printed tables keep the program's texts; columns of numbers are at the right", () => {
  const page = show(app.Printed, { table: { caption: "C", header: ["name", "value"], rows: [["a0", "-0.9016"], ["xi", "0.15"]] } });
  assert.match(page, /<th scope="col" class="numeric">value/);
  assert.match(page, /−0\.9016/);
});

test("names with markup are text", () => {
  const page = show(app.Report, { document: { ...empty(), missions: [mission("<script>x</script>", "keeps")] } });
  assert.ok(!page.includes("<script>"));
  assert.ok(page.includes("&lt;script&gt;"));
});
