// The logs of this visit, what the engine found in them, and the answers. Screens show its state.
import { useEffect, useState } from "preact/hooks";
import type { Engine, RunResult } from "../engine/engine";
import { naturally } from "../ui/format";
import { aircraftOf, linesOf, namedBy, type BatchFound } from "./batch_lines";
import { numbers, parseCsv, track, type Csv } from "./csv";
import { curveOf } from "./curve";
import type { Answer, Batch, FlownFlight, Known, LogRecord, Manifest, Simulation } from "./documents";
import { isReadable, kindBesideMission, kindOf, placeOfLog, safePath, stemOf, tileName, type Dropped, type Kind } from "./files";
import * as storage from "./keep";
import { rest_ms } from "./latest";
import { inputsShown, isByFolder, optionsOf, type Question } from "./question";
import { WorkQueue } from "./queue";
import { logs_folder, type Aircraft, type Answered, type Curve, type LogLine, type State } from "./state";

export type { Aircraft, Answered, Curve, LogLine, State } from "./state";

/// The program's exit code where it refused a file.
const input_rejected = 3;
const plans_folder = "plans";
const missions_folder = "missions";
/// Of tiles with the heights of the ground.
export const terrain_folder = "terrain";
const out_folder = "out";
const settings_name = "settings.json";
/// Answers quicker than this leave time for those of the sliders' steps.
const quick_s = 0.5;
const kept_files = /\.(json|toml|csv)$/;

const decoder = new TextDecoder();
const names = (path: string) => path.split("/").pop() ?? path;

/// Returns the lines of a kind ("error") that a run printed, each once and without the names of the program and of this
/// page's folders.
function printed(result: RunResult, kind: string): string[] {
  const begin = new RegExp(`^flightwatt[\\w-]*: (.*?: )??${kind}: `);
  const folders = new RegExp(`\\b(${logs_folder}|${plans_folder}|${missions_folder})/`, "g");
  const lines = result.err.split("\n").filter((line) => line.includes(`: ${kind}: `));
  return [...new Set(lines.map((line) => line.replace(begin, (_, file = "") => file).replace(folders, "")))];
}

/// Returns what a run printed as errors, or why it ended.
export function errorsOf(result: RunResult): string {
  return printed(result, "error").join("\n") ||
    result.err.trim().split("\n").pop() || `it ended with code ${result.code}`;
}

export class Project {
  state: State = {
    ready: false,
    failed: "",
    aircraft: [],
    chosen: "",
    unused: [],
    waiting: [],
    plans: [],
    dropped: {},
    tiles: 0,
    progress: null,
    read_s: null,
    busy: false,
  };
  private listeners = new Set<() => void>();
  private readonly queue = new WorkQueue(
    (error) => this.set({ failed: error.message, progress: null }),
    () => this.set({ busy: false }),
    () => this.engine.cancel(),
  );
  private files = new Map<string, File | Blob>();
  private wanted = new Map<string, Question>();
  /// The question whose pack and mission are in an aircraft's folder.
  private written = new Map<string, string>();
  /// The pack that is asked for in the last whole answer in an aircraft's folder, which `answer --again` repeats.
  private packs = new Map<string, string>();
  private resting: ReturnType<typeof setTimeout> | undefined;
  private settings: { chosen?: string; questions?: Record<string, Question>; capacities_ah?: Record<string, number> } = {};

  constructor(readonly engine: Engine) {}

  // --- state

  listen(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  private set(change: Partial<State>) {
    this.state = { ...this.state, ...change };
    for (const listener of this.listeners) listener();
  }

  private setAircraft(id: string, change: Partial<Aircraft>) {
    this.set({ aircraft: this.state.aircraft.map((one) => (one.id === id ? { ...one, ...change } : one)) });
  }

  aircraft(id = this.state.chosen): Aircraft | undefined {
    return this.state.aircraft.find((one) => one.id === id) ?? this.state.aircraft[0];
  }

  choose(id: string) {
    this.set({ chosen: id });
    this.settings.chosen = id;
    this.keepSettings();
    const aircraft = this.aircraft();
    if (aircraft && !aircraft.now) this.ask(aircraft.id, aircraft.question);
  }

  // --- work

  /// Runs the program when it is free.
  run(args: string[], is_urgent = true): Promise<RunResult> {
    return this.queue.result(() => this.engine.run(args), is_urgent);
  }

  async text(path: string): Promise<string> {
    return decoder.decode(await this.engine.read(path));
  }

  async json<T>(path: string): Promise<T> {
    return JSON.parse(await this.text(path)) as T;
  }

  // --- files

  /// Brings back what this browser kept.
  async start() {
    const kept = await storage.kept();
    const settings = kept.get(settings_name);
    if (settings) this.settings = JSON.parse(await settings.text());
    kept.delete(settings_name);
    for (const [path, data] of kept) {
      await this.engine.write(path, data instanceof File ? data : new File([data], names(path)));
      if (!path.startsWith(`${out_folder}/`)) this.files.set(path, data);
    }
    this.set({ ready: true, plans: await this.plans(), tiles: this.pathsOf(terrain_folder).length });
    if (this.logs().length > 0) this.queue.add(() => this.readLogs(), true);
  }

  private pathsOf(folder: string): string[] {
    return [...this.files.keys()].filter((path) => path.startsWith(`${folder}/`)).sort(naturally);
  }

  /// Plans, and missions among the files that came with them.
  private async plans(): Promise<string[]> {
    const paths = this.pathsOf(missions_folder);
    const missions = await missionsAmong(paths.map((path) => ({ path, file: this.files.get(path) as File })));
    return [...this.pathsOf(plans_folder), ...missions];
  }

  private logs(): string[] {
    const paths = this.pathsOf(logs_folder);
    const known = new Set(paths);
    return paths.filter((path) => kindOf(path, known) === "log");
  }

  /// Takes files in; returns the paths of plans among them.
  async add(dropped: Dropped[]): Promise<string[]> {
    const stored = new Map<string, Blob>();
    const missions = await missionsAmong(dropped);
    const incoming = new Set(dropped.map((one) => safePath(one.path)));
    const files = dropped.map(({ path, file }) => {
      const safe = safePath(path);
      const kind = kindOf(safe, incoming);
      return { safe, file, kind: missions.size > 0 ? kindBesideMission(safe, kind) : kind };
    });
    // Definitions go where their log went.
    files.sort((a, b) => Number(a.kind === "definitions") - Number(b.kind === "definitions"));
    const placed = new Map<string, string>();
    const places: string[] = [];
    const refused: string[] = [];
    // Another window of this page may have kept a log of the same name since this one was opened.
    const elsewhere = await storage.kept();
    for (const { safe, file, kind } of files) {
      if (kind === "ignored") continue;
      if (kind === "columns" && !(await isMapOfColumns(file))) {
        refused.push(safe);
        continue;
      }
      const { place, is_new } = await this.placeOf(safe, file, kind, placed, elsewhere);
      places.push(place);
      if (!is_new) continue;
      await this.engine.write(place, file);
      this.files.set(place, file);
      stored.set(place, file);
    }
    const among = (...folders: string[]) =>
      places.filter((path) => folders.some((folder) => path.startsWith(`${folder}/`)));
    const plans = among(plans_folder, missions_folder);
    const known = await this.plans();
    const latest = plans.length > 0 ? { plan: plans.find((path) => known.includes(path)) } : this.state.dropped;
    const failed = refused.length > 0
      ? `Not used: ${refused.join(", ")}: neither a mission (with the key mechanical) nor a map of the columns of tables (with the key time)`
      : "";
    this.set({ failed, plans: known, dropped: latest, tiles: this.pathsOf(terrain_folder).length });
    if ([...stored.keys()].some((path) => path.startsWith(`${logs_folder}/`))) this.queue.add(() => this.readLogs(), true);
    storage.keep(stored)
      .catch(() => this.set({ failed: "This browser keeps nothing: the logs are here until the page is closed." }));
    return plans;
  }

  /// Returns where a file is kept, and whether it is not there yet; `placed` has the folders of logs by their stems.
  private async placeOf(
    safe: string,
    file: File,
    kind: Kind | "mission",
    placed: Map<string, string>,
    elsewhere: Map<string, Blob>,
  ): Promise<{ place: string; is_new: boolean }> {
    const folders: Partial<Record<Kind | "mission", string>> = { mission: missions_folder, plan: plans_folder };
    const folder = folders[kind] ?? logs_folder;
    if (kind === "log" && !this.isSame(`${folder}/${safe}`, file)) {
      // A log that grew is no longer readable as it was dropped: its copy in this browser is.
      const known = async (one: string) => {
        const old = this.files.get(`${folder}/${one}`);
        return (await isReadable(old)) ? old : elsewhere.get(`${folder}/${one}`);
      };
      const { place, is_new } = await placeOfLog(safe, file, known);
      placed.set(stemOf(safe), place.slice(0, -safe.length));
      return { place: `${folder}/${place}`, is_new: is_new || !(await isReadable(this.files.get(`${folder}/${place}`))) };
    }
    const beside = kind === "definitions" ? placed.get(stemOf(safe)) ?? "" : "";
    const place = kind === "terrain" ? `${terrain_folder}/${tileName(safe)}` : `${folder}/${beside}${safe}`;
    return { place, is_new: !this.isSame(place, file) || !(await isReadable(this.files.get(place))) };
  }

  private isSame(path: string, file: File): boolean {
    const old = this.files.get(path);
    return old instanceof File && old.size === file.size && old.lastModified === file.lastModified;
  }

  /// Keeps a file of this page, such as a drawn area.
  async write(path: string, text: string, is_kept = false) {
    const file = new File([text], names(path));
    await this.engine.write(path, file);
    if (!is_kept) return;
    this.files.set(path, file);
    this.set({ plans: await this.plans(), dropped: { plan: path } });
    await storage.keep(new Map([[path, file]])).catch(() => undefined);
  }

  async forgetAll() {
    this.cancel();
    await storage.forget().catch(() => undefined);
    location.hash = "";
    location.reload();
  }

  /// Reads the logs whose reading was cancelled.
  readAgain() {
    this.set({ failed: "" });
    this.queue.add(() => this.readLogs(), true);
  }

  cancel() {
    clearTimeout(this.resting);
    this.queue.clear();
    this.wanted.clear();
    this.engine.cancel();
    this.set({ progress: null, busy: false });
  }

  private keepSettings() {
    const blob = new Blob([JSON.stringify(this.settings)]);
    storage.keep(new Map([[settings_name, blob]])).catch(() => undefined);
  }

  private async keepResults() {
    const results = new Map<string, Blob>();
    for (const path of (await this.engine.list()).map((file) => file.path.replace(/^\//, "")))
      if (path.startsWith(`${out_folder}/`) && kept_files.test(path))
        results.set(path, new Blob([(await this.engine.read(path)) as BlobPart]));
    await storage.keep(results).catch(() => undefined);
  }

  // --- reading logs

  /// The map of the columns of tables.
  private get columns(): string | undefined {
    return this.pathsOf(logs_folder).find((path) => kindOf(path, new Set()) === "columns");
  }

  private columnsOption(): string[] {
    return this.columns != null ? ["--columns", this.columns] : [];
  }

  /// Returns logs as a command line has them, all or those of an aircraft.
  inputsShown(logs: LogLine[], of?: Aircraft): string {
    return inputsShown(logs.map(({ path }) => path), this.columns, this.state.aircraft.length > 1 ? of?.id : undefined);
  }

  /// Returns the folder of the results of the command that answers for an aircraft.
  folderShown({ logs, folder }: Aircraft): string {
    const is_of_several = this.state.aircraft.length > 1 && isByFolder(logs.map(({ path }) => path));
    return is_of_several ? `flightwatt-out/${names(folder)}` : "flightwatt-out";
  }

  batchArguments(): string[] {
    return ["batch", ...this.logs(), "--each", "--prune", "-o", out_folder, "--json", ...this.columnsOption()];
  }

  private async readLogs() {
    const paths = this.logs();
    const started = performance.now();
    const waiting = paths.map((path): LogLine => ({
      path,
      bytes: this.files.get(path)?.size ?? 0,
      state: "waiting",
      reason: "",
      flight: "",
    }));
    this.set({ waiting, progress: { text: "Reading", done: 0, of: paths.length }, busy: true });
    const result = await this.engine.run(this.batchArguments(), (line) => {
      const found = /\[(\d+)\/(\d+)\] (.*)$/.exec(line);
      if (found) this.set({ progress: { text: `Reading ${found[3]}`, done: Number(found[1]), of: Number(found[2]) } });
    });
    const batch = result.out ? (JSON.parse(result.out) as Batch) : await this.refusedBatch(result);
    await this.showBatch(batch, waiting);
    this.set({ waiting: [], progress: null, read_s: (performance.now() - started) / 1000 });
    const first = this.aircraft();
    if (first) this.ask(first.id, first.question);
    for (const one of this.state.aircraft) this.queue.add(() => this.readTrends(one.id), false);
    // After the small drawings of all flights.
    this.queue.add(async () => {
      for (const one of this.state.aircraft)
        if (one.id !== first?.id) this.queue.add(() => this.answer(one.id, one.question), false);
      this.queue.add(() => this.keepResults(), false);
    }, false);
  }

  /// A batch without a flight prints no JSON; its folder has the reasons.
  private async refusedBatch(result: RunResult): Promise<Batch> {
    if (result.code !== input_rejected) throw new Error(errorsOf(result));
    const { flights } = await this.json<Manifest>(`${out_folder}/batch.json`);
    const records = flights.map(({ flight }) => this.json<LogRecord>(`${out_folder}/flights/${flight}.record.json`));
    const logs = (await Promise.all(records)).map(({ accepted, error }, i) => ({
      flight: flights[i]?.flight ?? "",
      accepted,
      error,
    }));
    return { aircraft: [], logs };
  }

  private async readFound(batch: Batch): Promise<BatchFound> {
    const manifest = await this.json<Manifest>(`${out_folder}/batch.json`);
    const records = new Map<string, LogRecord>();
    for (const { flight, accepted } of batch.logs)
      if (accepted) records.set(flight, await this.json<LogRecord>(`${out_folder}/flights/${flight}.record.json`));
    return { batch, manifest, records };
  }

  private async showBatch(batch: Batch, waiting: LogLine[]) {
    const found = await this.readFound(batch);
    const lines = linesOf(found, waiting);
    const questionOf = (id: string) =>
      this.state.aircraft.find((one) => one.id === id)?.question ?? this.settings.questions?.[id] ?? {};
    const aircraft = await Promise.all(aircraftOf(found, lines, questionOf).map(async (one) => ({
      ...one,
      logs: await this.named(one),
      own_capacity_ah: this.settings.capacities_ah?.[one.id],
    })));
    const unused = lines.filter(({ line }) => line.state === "not").map(({ line }) => line);
    this.set({ unused, aircraft });
    if (aircraft.some((one) => one.id === this.state.chosen)) return;
    const kept = aircraft.find((one) => one.id === this.settings.chosen);
    this.set({ chosen: (kept ?? aircraft[0])?.id ?? "" });
  }

  /// Returns the logs of an aircraft with the names of their flights in its folder as it is now.
  private async named({ folder, logs }: Aircraft): Promise<LogLine[]> {
    return namedBy(await this.json<Manifest>(`${folder}/batch.json`), logs);
  }

  private async readTrends(id: string) {
    const aircraft = this.state.aircraft.find((one) => one.id === id);
    if (!aircraft) return;
    const logs = await this.named(aircraft);
    const result = await this.engine.run(["trends", aircraft.folder, "--json", "--quiet"]);
    const flights = result.out ? (JSON.parse(result.out) as { flights: FlownFlight[] }).flights : [];
    const by_name = new Map(flights.map((flight) => [flight.flight, flight]));
    this.setAircraft(id, { logs: logs.map((line) => ({ ...line, flown: by_name.get(line.flight) })) });
    for (const line of logs) this.queue.addNext(() => this.readPower(id, line));
  }

  private async readPower(id: string, line: LogLine) {
    const aircraft = this.state.aircraft.find((one) => one.id === id);
    if (!aircraft) return;
    const power = await this.powerOf(aircraft.folder, line.flight);
    const now = this.state.aircraft.find((one) => one.id === id) ?? aircraft;
    this.setAircraft(id, { logs: now.logs.map((one) => (one.path === line.path ? { ...one, power } : one)) });
  }

  /// Returns some of the samples of power, enough for a small drawing.
  private async powerOf(folder: string, flight: string): Promise<number[]> {
    const { y } = track(await this.series(folder, flight), "power_w");
    const samples = 150;
    return y.length <= samples
      ? y
      : Array.from({ length: samples }, (_, i) => y[Math.floor((i * y.length) / samples)] ?? 0);
  }

  async series(folder: string, flight: string): Promise<Csv> {
    return parseCsv(await this.text(`${folder}/flights/${flight}.series.csv`));
  }

  // --- answers

  /// Asks; while an answer is under way, the latest question alone is next. A slider that moves gets the answer as
  /// modelled at once, and the whole one when it rests.
  ask(id: string, question: Question) {
    clearTimeout(this.resting);
    this.setAircraft(id, { question, failed: undefined });
    this.settings.questions = { ...this.settings.questions, [id]: question };
    this.keepSettings();
    const measured = this.state.aircraft.find((one) => one.id === id)?.measured;
    if (measured && isSame(measured.question, question)) {
      this.wanted.delete(id);
      this.setAircraft(id, { now: measured, moving: undefined });
      return;
    }
    const is_waiting = this.wanted.has(id);
    this.wanted.set(id, question);
    this.set({ busy: true });
    if (is_waiting) return;
    this.queue.add(async () => {
      const latest = this.wanted.get(id);
      this.wanted.delete(id);
      if (!latest) return;
      if (await this.again(id, latest)) {
        if (!this.wanted.has(id)) this.resting = setTimeout(() => this.queue.addNext(() => this.settle(id)), rest_ms);
        return;
      }
      this.setAircraft(id, { moving: undefined });
      await this.answer(id, latest);
    }, true);
  }

  /// Answers the question of now, unless it is answered; another move of a slider interrupts this.
  private async settle(id: string) {
    const aircraft = this.state.aircraft.find((one) => one.id === id);
    if (aircraft && this.isOld(id) && !aircraft.failed) await this.answer(id, aircraft.question);
  }

  /// Answers as modelled, with the model and the pack of the last answer; returns whether it can.
  private async again(id: string, question: Question): Promise<boolean> {
    const aircraft = this.state.aircraft.find((one) => one.id === id);
    const now = aircraft?.now;
    if (!aircraft || !now?.curve || this.packs.get(id) !== packOf(question) || now.question.home_m !== question.home_m)
      return false;
    const started = performance.now();
    this.written.delete(id);
    const args = this.answerArguments(aircraft, { ...question, home_m: undefined });
    const result = await this.engine.run([...args, "--again"]);
    const found = result.code === 0 ? (JSON.parse(result.out) as { aircraft: Answer[] }).aircraft[0] : undefined;
    if (found?.time_in_air_s.value == null) return false;
    if (!this.isOld(id)) return true;
    const seconds = (performance.now() - started) / 1000;
    const moving = { ...now, question, answer: asModelled(now.answer, found), seconds };
    const curve = (this.state.aircraft.find((one) => one.id === id)?.moving ?? now).curve;
    this.setAircraft(id, { moving: { ...moving, curve } });
    const flown = await this.curve(missionOf(aircraft), 0);
    if (this.isOld(id)) this.setAircraft(id, { moving: { ...moving, curve: flown } });
    return true;
  }

  /// Whether the answer that is known is one to another question: that of now is computed, or was refused.
  isOld(id: string): boolean {
    const aircraft = this.state.aircraft.find((one) => one.id === id);
    if (!aircraft) return false;
    return !aircraft.now || !isSame(aircraft.question, aircraft.now.question);
  }

  answerArguments(aircraft: Aircraft, question: Question): string[] {
    return [
      "answer",
      ...aircraft.logs.map((line) => line.path),
      ...this.columnsOption(),
      ...optionsOf(question),
      "-o",
      aircraft.folder,
      "--no-page",
      "--json",
      "--quiet",
    ];
  }

  private async answer(id: string, question: Question) {
    const aircraft = this.state.aircraft.find((one) => one.id === id);
    if (!aircraft) return;
    const base = baseOf(aircraft);
    const is_base = isMeasured(question) && question.capacity_ah === base.capacity_ah;
    if (!is_base && (!aircraft.measured || aircraft.measured.question.capacity_ah !== base.capacity_ah)) {
      const measured = await this.answered(aircraft, base);
      // Where it is refused the old one stays, whose sliders take that back.
      if (typeof measured !== "string") this.setAircraft(id, { measured, hints: {} });
    }
    const now = await this.answered(aircraft, question);
    const asked = this.state.aircraft.find((one) => one.id === id)?.question;
    if (asked && !isSame(asked, question) && !this.isOld(id)) return;
    if (typeof now !== "string" && question.capacity_ah == null) this.keepCapacity(id, now.answer.capacity_ah);
    if (typeof now === "string") this.setAircraft(id, { failed: now, moving: undefined });
    else this.setAircraft(
      id,
      { now, failed: undefined, moving: undefined, ...(is_base ? { measured: now, hints: {} } : {}) },
    );
    if (is_base && typeof now !== "string" && now.seconds < quick_s) this.queue.add(() => this.hints(id), false);
  }

  /// Keeps the capacity that the logs of an aircraft state; where they state none, its user alone knows it.
  private keepCapacity(id: string, { value, basis }: Known) {
    const { [id]: _, ...others } = this.settings.capacities_ah ?? {};
    const own_ah = value != null && !/^(estimat|assum)/.test(basis) ? value : undefined;
    this.settings.capacities_ah = own_ah != null ? { ...others, [id]: own_ah } : others;
    this.keepSettings();
    this.setAircraft(id, { own_capacity_ah: own_ah });
  }

  /// Answers for a step of each slider, one after the other, while nobody waits.
  private async hints(id: string) {
    const aircraft = this.state.aircraft.find((one) => one.id === id);
    const measured = aircraft?.measured;
    if (!aircraft || !measured) return;
    const [name, step] = stepsFrom(measured).find(([one]) => !(one in aircraft.hints)) ?? [];
    if (!name || !step) {
      // The steps had other packs than what a slider repeats.
      if (aircraft.now && this.packs.get(id) !== packOf(aircraft.now.question)) await this.answered(aircraft, aircraft.now.question);
      return;
    }
    const found = await this.answered(aircraft, { ...measured.question, ...step });
    const now = this.state.aircraft.find((one) => one.id === id);
    if (now?.measured !== measured) return;
    this.setAircraft(id, { hints: { ...now.hints, [name]: typeof found === "string" ? null : found } });
    this.queue.add(() => this.hints(id), false);
  }

  /// Does work with the engine on the files of an aircraft's answer.
  withAnswer<T>(id: string, answered: Answered, use: (engine: Engine) => Promise<T>): Promise<T> {
    return this.queue.result(async () => {
      const aircraft = this.state.aircraft.find((one) => one.id === id);
      const is_written = this.written.get(id) === JSON.stringify(answered.question);
      if (aircraft && !is_written) await this.answered(aircraft, answered.question);
      return use(this.engine);
    }, true);
  }

  /// Runs the program on the files of an answer; what-if may have left those of another question.
  runOnAnswer(id: string, answered: Answered, args: string[]): Promise<RunResult> {
    return this.withAnswer(id, answered, (engine) => engine.run(args));
  }

  /// Returns an answer, or why there is none.
  async answered(aircraft: Aircraft, question: Question): Promise<Answered | string> {
    const started = performance.now();
    this.written.delete(aircraft.id);
    const result = await this.engine.run(this.answerArguments(aircraft, question));
    this.written.set(aircraft.id, JSON.stringify(question));
    if (result.code === 0) this.packs.set(aircraft.id, packOf(question));
    if (!result.out) return errorsOf(result);
    const answer = (JSON.parse(result.out) as { aircraft: Answer[] }).aircraft[0];
    if (!answer) return errorsOf(result);
    if (answer.no_answer) return answer.no_answer;
    const curve = answer.time_in_air_s.value != null
      ? await this.curve(missionOf(aircraft))
      : null;
    const seconds = (performance.now() - started) / 1000;
    return { question, answer, curve, seconds, warnings: printed(result, "warning") };
  }

  /// Returns the charge over a mission, with a band where flights differ; without samples no flights are drawn.
  private async curve(mission: string, samples?: number): Promise<Curve | null> {
    const found = await this.curveOrError(mission, samples);
    return typeof found === "string" ? null : found;
  }

  /// The same, or why there is none.
  async curveOrError(mission: string, samples = 400): Promise<Curve | string> {
    const [csv, band] = ["curve.csv", "band.csv"];
    const simulate = ["simulate", mission, "--json", "--quiet", "--step", "2", "-o", csv];
    const drawn = samples > 0
      ? await this.engine.run([...simulate, "--samples", String(samples), "--samples-csv", band])
      : null;
    const final = drawn?.out ? drawn : await this.engine.run(simulate);
    if (!final.out) return errorsOf(final);
    const simulation = JSON.parse(final.out) as Simulation;
    const curve = curveOf(await this.text(csv), simulation);
    if (drawn?.out && simulation.probability_below_reserve != null) {
      const table = parseCsv(await this.text(band));
      curve.band = {
        time_s: numbers(table, "time_s").map((value) => value ?? 0),
        low: numbers(table, "soc_p05_percent"),
        high: numbers(table, "soc_p95_percent"),
      };
    }
    return curve;
  }
}

const missionOf = ({ folder }: Aircraft) => `${folder}/answer-mission.toml`;

const isSame = (one: Question, other: Question) => JSON.stringify(one) === JSON.stringify(other);

/// Returns which pack is asked for.
const packOf = ({ capacity_ah, temperature }: Question) => JSON.stringify([capacity_ah, temperature]);

/// Returns an answer as modelled, with the pack and what else of the whole one it was made with.
function asModelled(whole: Answer, modelled: Answer): Answer {
  const { reserve_soc_percent, is_hover, power_w, time_in_air_s, airspeed_m_per_s, distance_m, distance_across_m, notes } = modelled;
  // Where the whole one has no chance, neither will the next.
  const time_in_air_95_s = whole.time_in_air_95_s.value != null ? modelled.time_in_air_95_s : whole.time_in_air_95_s;
  return { ...whole, reserve_soc_percent, is_hover, power_w, time_in_air_s, time_in_air_95_s, airspeed_m_per_s, distance_m, distance_across_m, notes };
}

/// Returns a step of each slider from an answer.
function stepsFrom({ answer }: Answered): [string, Question][] {
  const capacity = answer.capacity_ah.value;
  const fastest = answer.best_speeds.find((one) => /range/.test(one.purpose))?.airspeed_m_per_s;
  return [
    ["reserve", { reserve: answer.reserve_soc_percent + 5 }],
    ["payload", { payload_kg: 0.5 }],
    ["wind", { wind: 4 }],
    ...(fastest ? [["airspeed", { airspeed: Math.round(2 * fastest) / 2 }] as [string, Question]] : []),
    ...(capacity ? [["capacity", { capacity_ah: Math.round(capacity) + 1 }] as [string, Question]] : []),
    ["temperature", { temperature: 0 }],
  ];
}

/// Returns the paths of mission files.
async function missionsAmong(files: Dropped[]): Promise<Set<string>> {
  const found = new Set<string>();
  for (const { path, file } of files)
    if (/\.toml$/i.test(path) && /^\s*mechanical\s*=/m.test(await file.slice(0, 20_000).text())) found.add(path);
  return found;
}

/// Returns whether a file maps the columns of tables, which has their clock; models and packs of the program have none.
async function isMapOfColumns(file: File): Promise<boolean> {
  return /^\s*(\[\s*time\s*\]|time(\.\w+)?\s*=)/m.test(await file.slice(0, 20_000).text());
}

/// Returns what "as measured" asks: no capacity where the logs state one; else that of now, which its user alone knows.
export function baseOf({ question: { capacity_ah }, own_capacity_ah }: Aircraft): Question {
  return own_capacity_ah != null || capacity_ah == null ? {} : { capacity_ah };
}

/// Returns whether a question changes nothing but the capacity.
export function isMeasured(question: Question): boolean {
  return optionsOf({ ...question, capacity_ah: undefined }).length === 0;
}

/// Shows the project's state as it changes.
export function useProject(project: Project): State {
  const [state, setState] = useState(project.state);
  useEffect(() => {
    setState(project.state);
    return project.listen(() => setState(project.state));
  }, [project]);
  return state;
}
