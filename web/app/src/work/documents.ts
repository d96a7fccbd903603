// The JSON documents of the stages that the engine's screens show, as docs/reference has them.
import type { FlownTrack } from "../documents";

export type { AircraftAnswer as Answer, Answered as Known, FailsafeCard as Failsafe, Pack } from "../documents";

/// `flightwatt batch --json`.
export interface Batch {
  aircraft: { aircraft: string; folder: string; flights: string[] }[];
  logs: { flight: string; accepted: boolean; error: string }[];
}

/// OUT/batch.json: which log each flight is of.
export interface Manifest {
  flights: { flight: string; log: string; why_not_fitted: string }[];
}

/// OUT/flights/NAME.record.json, as far as it is shown: what was found in a log.
export interface LogRecord {
  accepted: boolean;
  error: string;
  aircraft_name: string;
  kind: string;
  why_not_fitted: string;
  lacks_power: string;
  diagnostics: { severity: string; kind: string; text: string }[];
  measured: { excluded: { phase: string; reason: string }[] } | null;
}

/// A flight of `flightwatt trends --json`.
export interface FlownFlight {
  flight: string;
  date: string | null;
  in_air_s: number | null;
  energy_wh: number | null;
  distance_m: number | null;
  cruise_power_w: number | null;
  resistance_ohm: number | null;
  charge_ah: number | null;
}

/// `flightwatt simulate --json`, of one pack or with `flights` of several.
export interface Simulation {
  final_soc_percent: number;
  reserve_soc_percent: number;
  keeps_reserve: boolean;
  /// Why that may be wrong whatever its probability.
  uncertain?: string[];
  energy_wh: number;
  duration_s: number;
  depleted_at_s?: number | null;
  cut_off_at_s?: number | null;
  power_model?: { model: string; flights: number; mean_absolute_error_percent: number | null } | null;
  probability_below_reserve?: number | null;
  /// With the capacity that the pack's flights indicate, where it differs.
  with_capacity_of_flights?: { capacity_ah: number; keeps_reserve: boolean };
  packs?: number;
  packs_needed?: number;
  flights?: { pack: number; start_s: number; final_soc_percent: number; duration_s: number; energy_wh: number; return_from: string; track?: FlownTrack | null; probability_below_reserve?: number | null; with_capacity_of_flights?: Simulation["with_capacity_of_flights"] }[];
}

/// A change of a plan that may make it fit, of `flightwatt check --json`.
export interface PlanRemedy {
  kind: "airspeed" | "heading" | "spacing" | "part" | "pack" | "payload";
  value: number;
  text: string;
  final_soc_percent: number | null;
  probability: number | null;
  suffices: boolean;
}

/// `flightwatt path --json` of a mission.
export interface PathSummary {
  length_m: number;
  duration_s: number;
  mechanical_w: number;
  /// null: of a mission over several packs, whose flights have theirs.
  track?: FlownTrack | null;
}

/// A block of a flight plan, of `flightwatt path PLAN --json`.
export interface PlanBlock {
  block: string;
  flown: string;
  length_m: number;
  not_flown: string[];
}
