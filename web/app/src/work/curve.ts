// The charge over a mission, from the table of `simulate`.
import { numbers, parseCsv, texts } from "./csv";
import type { Simulation } from "./documents";
import type { Curve } from "./state";

/// Returns the charge and the phases of a table of `simulate`. Between the flights of several packs is a gap: no pack is
/// charged there.
export function curveOf(csv: string, simulation: Simulation): Curve {
  const table = parseCsv(csv);
  const [times, charges, watts] = ["time_s", "soc_percent", "compute_w"].map((name) => numbers(table, name));
  const starts_s = (simulation.flights ?? []).slice(1).map(({ start_s }) => start_s);
  const curve: Curve = { time_s: [], soc: [], compute_w: [], phases: [], simulation, csv };
  const add = (at: number, soc: number | null, compute_w: number | null) => {
    curve.time_s.push(at);
    curve.soc.push(soc);
    curve.compute_w.push(compute_w);
  };
  texts(table, "phase").forEach((name, i) => {
    const at = times?.[i] ?? 0;
    const last = curve.phases[curve.phases.length - 1];
    const is_next_pack = starts_s[0] != null && at >= starts_s[0];
    if (is_next_pack) {
      starts_s.shift();
      const before = curve.time_s[curve.time_s.length - 1] ?? at;
      if (before < at) add((before + at) / 2, null, null);
    }
    add(at, charges?.[i] ?? null, watts?.[i] ?? null);
    if (last?.name === name && !is_next_pack) last.to = at;
    else curve.phases.push({ name, from: is_next_pack ? at : last?.to ?? at, to: at });
  });
  return curve;
}
