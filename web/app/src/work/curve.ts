// The charge over a mission, from the table of `simulate`.
import { numbers, parseCsv, texts } from "./csv";
import type { Simulation } from "./documents";
import type { Curve } from "./state";

/// Returns the charge and the phases of a table of `simulate`.
export function curveOf(csv: string, simulation: Simulation): Curve {
  const table = parseCsv(csv);
  const time_s = numbers(table, "time_s").map((value) => value ?? 0);
  const phases: Curve["phases"] = [];
  texts(table, "phase").forEach((name, i) => {
    const at = time_s[i] ?? 0;
    const last = phases[phases.length - 1];
    if (last?.name === name) last.to = at;
    else phases.push({ name, from: last?.to ?? at, to: at });
  });
  return { time_s, soc: numbers(table, "soc_percent"), compute_w: numbers(table, "compute_w"), phases, simulation, csv };
}
