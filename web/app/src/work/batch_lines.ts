// The logs of a batch as lines and aircraft: used, used in part, or not used and why.
import { naturally } from "../ui/format";
import type { Batch, LogRecord, Manifest } from "./documents";
import type { Question } from "./question";
import { logs_folder, type Aircraft, type LogLine } from "./state";

/// What is read of a batch's folder.
export interface BatchFound {
  batch: Batch;
  manifest: Manifest;
  /// By flight; those that were accepted.
  records: Map<string, LogRecord>;
}

function withoutPath(error: string, log: string): string {
  return error.replace(log, "").replace(/^:\d*:? */, "").replaceAll(`${logs_folder}/`, "");
}

function warningOf(record: LogRecord): string {
  return record.diagnostics.find((one) => one.severity === "warning")?.text ?? "";
}

/// Returns a line with what became of its log; `owner` is the aircraft that flew it.
function judged(line: LogLine, record: LogRecord, owner: string | undefined, why_not_fitted: string): LogLine {
  const why = why_not_fitted || record.why_not_fitted || record.lacks_power;
  if (why || !owner) return {
    ...line,
    state: "not",
    reason: why || warningOf(record) || "no flight with measured power",
  };
  const excluded = record.measured?.excluded ?? [];
  const parts = [...new Set(excluded.map((one) => `${one.phase} not used: ${one.reason}`))];
  if (parts.length > 0) return { ...line, state: "part", reason: parts.join("; ") };
  return { ...line, state: "used", reason: warningOf(record) };
}

/// Returns the lines of all logs, each with its aircraft, or none where it is not used.
export function linesOf(
  { batch, manifest, records }: BatchFound,
  waiting: LogLine[],
): { line: LogLine; owner?: string }[] {
  const unnamed = new Map(waiting.map((line) => [line.path, line]));
  const results = new Map(batch.logs.map((log) => [log.flight, log]));
  const owners = new Map(batch.aircraft.flatMap((one) => one.flights.map((flight) => [flight, one.aircraft] as const)));
  const found = manifest.flights.map(({ flight, log, why_not_fitted }) => {
    const known = unnamed.get(log) ?? { path: log, bytes: 0, state: "not", reason: "", flight };
    unnamed.delete(log);
    const line: LogLine = { ...known, flight };
    const record = records.get(flight);
    if (!record) return { line: {
      ...line,
      state: "not" as const,
      reason: withoutPath(results.get(flight)?.error ?? "", log),
    } };
    const result = judged(line, record, owners.get(flight), why_not_fitted);
    return { line: result, owner: result.state === "not" ? undefined : owners.get(flight) };
  });
  const silent = [...unnamed.values()].map((line) => ({ line: {
    ...line,
    state: "not" as const,
    reason: "the program does not name it",
  } }));
  return [...found, ...silent];
}

/// Returns lines with the names of their flights in the folder of one aircraft, which counts logs of one name on its own.
export function namedBy({ flights }: Manifest, lines: LogLine[]): LogLine[] {
  const names = new Map(flights.map(({ flight, log }) => [log, flight]));
  return lines.map((line) => ({ ...line, flight: names.get(line.path) ?? line.flight }));
}

/// Returns the aircraft of a batch that have lines, those with the most first.
export function aircraftOf(
  { batch, records }: BatchFound,
  lines: { line: LogLine; owner?: string }[],
  questionOf: (id: string) => Question,
): Aircraft[] {
  const result = batch.aircraft.map(({ aircraft: id, folder, flights }): Aircraft => {
    const record = records.get(flights[0] ?? "");
    const logs = lines.filter(({ owner }) => owner === id).map(({ line }) => line);
    logs.sort((a, b) => naturally(a.path, b.path));
    return {
      id,
      name: record?.aircraft_name || id,
      kind: record?.kind ?? "",
      folder,
      logs,
      question: questionOf(id),
      hints: {},
    };
  });
  return result.filter((one) => one.logs.length > 0).sort((a, b) => b.logs.length - a.logs.length);
}
