// Names of files, tables and plans as the page reads them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../../bundled.mjs";

const files = await bundled("work/files.ts");
const csv = await bundled("work/csv.ts");
const curve = await bundled("work/curve.ts");
const shapes = await bundled("work/plan_shapes.ts");
const question = await bundled("work/question.ts");
const { Project } = await bundled("work/project.ts");
const flown = await bundled("work/flown_plan.ts");

test("a path never leads out of its folder", () => {
  assert.equal(files.safePath("../../etc/passwd"), "etc/passwd");
  assert.equal(files.safePath("..\\..\\boot.ini"), "boot.ini");
  assert.equal(files.safePath("/a/./b//c.bin"), "a/b/c.bin");
  assert.equal(files.safePath(".."), "unnamed");
});

test("a name has no control characters and no marks that turn its direction", () => {
  assert.equal(files.safePath("fl\u0000ight\n\u202egpj.bin"), "fl_ight__gpj.bin");
});

test("a long name keeps its ending", () => {
  const name = files.safePath(`${"ä".repeat(500)}.data.gz`);
  assert.ok([...name].length <= 100 && name.endsWith(".data.gz"));
});

test("the same name twice has a folder of its own, and a log that grew the place of its beginning", async () => {
  const known = new Map([["a.bin", new Blob(["first"])], ["2/a.bin", new Blob(["second"])]]);
  const placeOf = (path, text) => files.placeOfLog(path, new Blob([text]), (one) => known.get(one));
  assert.deepEqual(await placeOf("b.bin", "first"), { place: "b.bin", is_new: true });
  assert.deepEqual(await placeOf("a.bin", "third"), { place: "3/a.bin", is_new: true });
  assert.deepEqual(await placeOf("a.bin", "second"), { place: "2/a.bin", is_new: false });
  assert.deepEqual(await placeOf("a.bin", "first and more"), { place: "a.bin", is_new: true });
  assert.deepEqual(await placeOf("a.bin", "fir"), { place: "a.bin", is_new: false });
});

test("a file that is no longer there is not readable", async () => {
  const gone = { size: 3, slice: () => ({ arrayBuffer: () => Promise.reject(new DOMException("gone", "NotReadableError")) }) };
  assert.equal(await files.isReadable(gone), false);
  assert.equal(await files.isReadable(new Blob(["log"])), true);
  assert.match(question.inPageWords("cannot be read: I/O error"), /drop it again$/);
});

test("between the flights of several packs is a gap, and no pack is charged", () => {
  const table = "time_s,phase,soc_percent,compute_w\n0,takeoff,100,0\n9,landing,40,0\n19,takeoff,100,0\n28,landing,30,0\n";
  const { time_s, soc, phases } = curve.curveOf(table, { flights: [{ start_s: 0 }, { start_s: 19 }] });
  assert.deepEqual([time_s, soc], [[0, 9, 14, 19, 28], [100, 40, null, 100, 30]]);
  assert.deepEqual(phases.map(({ name, from, to }) => [name, from, to]),
    [["takeoff", 0, 0], ["landing", 0, 9], ["takeoff", 19, 19], ["landing", 19, 28]]);
});

/// A project whose engine keeps the names of what is written.
function projectOf() {
  const written = [];
  const engine = { write: async (name) => written.push(name), run: async () => ({ code: 1, out: "", err: "" }), cancel() {} };
  return { project: new Project(engine), written };
}

test("definitions go with their log, also where another log has its name", async () => {
  const { project, written } = projectOf();
  const drop = (data, log) => project.add([
    { path: "a.log", file: new File([log], "a.log", { lastModified: 1 }) },
    { path: "a.data", file: new File([data], "a.data", { lastModified: data.length }) },
  ]);
  await drop("one", "x");
  await drop("one and more", "x");
  await drop("another", "y");
  assert.deepEqual(written, ["logs/a.data", "logs/a.log", "logs/a.data", "logs/2/a.data", "logs/2/a.log"]);
});

test("a log that grew takes its place, though what was dropped cannot be read any more", async () => {
  const { project, written } = projectOf();
  const drop = (file) => project.add([{ path: "a.tlog", file }]);
  const dropped = new File(["one"], "a.tlog", { lastModified: 1 });
  await drop(dropped);
  dropped.slice = () => ({ arrayBuffer: () => Promise.reject(new DOMException("changed", "NotReadableError")) });
  await drop(new File(["one and more"], "a.tlog", { lastModified: 2 }));
  assert.deepEqual(written, ["logs/a.tlog", "logs/a.tlog"]);
});

test("logs that come with a mission are read, and what the mission names stays beside it", async () => {
  const { project, written } = projectOf();
  const files_of = (...names) => names.map((name) => ({ path: `my/${name}`, file: new File(['mechanical = "model.toml"'], name) }));
  await project.add(files_of("mission.toml", "flights/1.bin", "profile.csv", "field.kml"));
  assert.deepEqual(written, ["missions/my/mission.toml", "logs/my/flights/1.bin", "missions/my/profile.csv", "missions/my/field.kml"]);
});

test("plans of one name in two folders are two plans, and one that is known is shown again", async () => {
  const { project } = projectOf();
  const plan = (folder) => ({ path: `${folder}/field.kml`, file: new File([folder], "field.kml", { lastModified: 1 }) });
  await project.add([plan("north"), plan("south")]);
  assert.deepEqual(project.state.plans, ["plans/north/field.kml", "plans/south/field.kml"]);
  assert.deepEqual(await project.add([plan("north")]), ["plans/north/field.kml"]);
  assert.equal(project.state.dropped.plan, "plans/north/field.kml");
});

test("a model is no map of columns, and a message names it as not used", async () => {
  const { project, written } = projectOf();
  await project.add([{ path: "model.toml", file: new File(["name = \"fitted\"\n[cruise]\n"], "model.toml") }]);
  assert.deepEqual(written, []);
  assert.match(project.state.failed, /^Not used: model\.toml: neither a mission/);
});

test("a .log beside its .data has definitions; alone it is a log", () => {
  const names = new Set(["x/a.data", "x/a.log"]);
  assert.equal(files.kindOf("x/a.log", names), "definitions");
  assert.equal(files.kindOf("x/b.log", names), "log");
  assert.equal(files.kindOf("survey.KML", names), "plan");
  assert.equal(files.kindOf("photo.jpg", names), "log");
  assert.equal(files.kindOf("srtm/n47e008.HGT", names), "terrain");
  assert.equal(files.tileName("srtm/n47e008.HGT"), "N47E008.hgt");
  assert.equal(files.kindOf(".DS_Store", names), "ignored");
});

test("a table has comments, quotes and empty cells", () => {
  const table = csv.parseCsv('# format = 1\ntime_s,leg,power_w\n0,"a, ""b""",1.5\n1,c,\n');
  assert.deepEqual(csv.texts(table, "leg"), ['a, "b"', "c"]);
  assert.deepEqual(csv.numbers(table, "power_w"), [1.5, null]);
  assert.deepEqual(csv.track(table, "power_w"), { x: [0], y: [1.5] });
  assert.deepEqual(csv.numbers(table, "none"), []);
});

test("an area that is drawn is an area when it is read", () => {
  const corners = [[48, 11], [48.01, 11], [48.01, 11.02]];
  assert.deepEqual(shapes.shapeOf("a.geojson", shapes.areaFile(corners)).areas, [[...corners, corners[0]]]);
  const several = { type: "MultiPolygon", coordinates: [[[[11, 48], [12, 48], [12, 49]]], [[[1, 8], [2, 8], [2, 9]]]] };
  assert.equal(shapes.shapeOf("a.geojson", JSON.stringify(several)).areas.length, 2);
});

test("a file that is no plan has no places", () => {
  assert.deepEqual(shapes.shapeOf("a.plan", "no JSON"), { lines: [], areas: [], named: [] });
});

test("waypoints without a place are not drawn", () => {
  const text = "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t48\t11\t500\t1\n1\t0\t3\t178\t0\t12\t0\t0\t0\t0\t0\t1\n";
  assert.deepEqual(shapes.shapeOf("a.waypoints", text), { lines: [[[48, 11]]], areas: [], named: [], home: [48, 11] });
});

test("a question is the options of the program, and nothing is asked by nothing", () => {
  assert.deepEqual(question.optionsOf({}), []);
  assert.deepEqual(
    question.optionsOf({ payload_kg: 0.5, mass_kg: 3.4, wind: 4 }),
    ["--payload", "0.5", "--mass", "3.4", "--wind", "4"],
  );
  assert.deepEqual(question.optionsOf({ mass_kg: 3.4 }), []);
});

test("what the program asks for by an option that the page does not have is asked in other words", () => {
  const text = question.inPageWords("several aircraft flew: 1, 2; select one with --aircraft ID");
  assert.match(text, /^several aircraft flew: 1, 2; this page reads one aircraft of a log/);
});

test("a shell takes the names of logs as they are", () => {
  assert.equal(question.inputsShown(["logs/a b.bin", "logs/-rf", "logs/it's"]), `'a b.bin' ./-rf 'it'\\''s'`);
});

test("a command of many logs names the one of several aircraft, and every command the map of columns", () => {
  const logs = ["a", "b", "c", "d", "e"].map((name) => `logs/${name}.csv`);
  assert.equal(question.inputsShown(logs), "LOGS");
  assert.equal(question.inputsShown(logs, "logs/my map.toml", "Matrice 100"), "LOGS --aircraft 'Matrice 100' --columns 'my map.toml'");
  assert.equal(question.inputsShown(logs.slice(3), "logs/map.toml", "7"), "d.csv e.csv --columns map.toml");
});

test("logs that are read with a map of columns are answered with it", async () => {
  const project = new Project({ write: async () => {}, run: async () => ({ code: 1, out: "", err: "" }), cancel() {} });
  const dropped = ["a.csv", "map.toml"].map((name) => ({ path: name, file: new File(["[time]\ncolumn = \"t\"\n"], name) }));
  await project.add(dropped);
  const log = { path: "logs/a.csv" };
  const text = project.answerArguments({ logs: [log], folder: "out" }, {}).join(" ");
  assert.match(text, /^answer logs\/a\.csv --columns logs\/map\.toml /);
  assert.match(project.batchArguments().join(" "), /--columns logs\/map\.toml$/);
  assert.equal(project.inputsShown([log]), "a.csv --columns map.toml");
});

test("a saved mission names the files that the command of the screen writes and reads", () => {
  const mission = 'mechanical = "out/7/model.toml"\nbattery = "out/7/answer-pack.toml"\narea = "plans/north/field.kml"\n';
  assert.equal(
    flown.missionShown(mission, "out/7", "flightwatt-out"),
    'mechanical = "flightwatt-out/model.toml"\nbattery = "flightwatt-out/answer-pack.toml"\narea = "north/field.kml"\n',
  );
});

test("the commands of a plan work one after the other in an empty folder", () => {
  const options = { plan: "plans/field.geojson", blocks: [], packs: 1 };
  assert.equal(
    flown.planCommand("a.bin", "flightwatt-out", options, { capacity_ah: 5, temperature: 0, reserve: 30 }),
    "flightwatt a.bin --capacity 5 --temperature 0 && flightwatt new-mission --model flightwatt-out/model.toml " +
      "--battery flightwatt-out/answer-pack.toml --reserve 30 --plan field.geojson -o plan.toml && flightwatt simulate plan.toml --samples 1000",
  );
});
