// The JSON documents of the stages that the engine's screens show, as docs/reference has them.
import type { FlownTrack } from "../documents";

/// A value with what it rests on, or the reason why there is none.
export interface Known {
  value: number | null;
  basis: string;
  unknown: string;
}

export interface Interval {
  low: number;
  high: number;
}

export interface Pack {
  pack: string;
  aircraft: string[];
  flights: number;
  first: string | null;
  last: string | null;
  cycles: number | null;
  cells: number | null;
  resistance_ohm: number | null;
  resistance_ohm_interval_95: Interval | null;
  resistance_change_percent: number | null;
  label_capacity_ah: number | null;
  capacity_ah: number | null;
  capacity_ah_interval_95: Interval | null;
  capacity_percent_of_label: number | null;
  health: string;
  reason: string;
}

interface FailsafeAction {
  soc_percent: number;
  remaining_mah: number;
  probability_too_late: number | null;
  probability_too_late_interval_95: Interval | null;
  voltage: { voltage_v: number } | null;
}

export interface Failsafe {
  reserve_percent: number;
  home_distance_m: number | null;
  low: FailsafeAction | null;
  low_missing: string;
  critical: FailsafeAction | null;
  probability_landed_short: number | null;
  rests_on: { ground: string; text: string }[];
}

/// One aircraft of `flightwatt answer --json`.
export interface Answer {
  aircraft: string;
  aircraft_name: string;
  folder: string;
  logs: number;
  flights_used: number;
  no_answer: string;
  reserve_soc_percent: number;
  is_hover: boolean;
  power_w: Known;
  time_in_air_s: Known;
  time_in_air_95_s: Known;
  airspeed_m_per_s: Known;
  distance_m: Known;
  distance_across_m: number | null;
  return_airspeed_m_per_s: Known;
  best_speeds: { purpose: string; airspeed_m_per_s: number | null; below_flown: boolean; above_flown: boolean }[];
  capacity_ah: Known;
  flights_capacity_ah_interval_95: Interval | null;
  voltage_known_down_to_percent: number | null;
  resistance_ohm: Known;
  air_temperature_c_range: Interval | null;
  battery_temperature_c_range: Interval | null;
  temperature_c: number | null;
  prediction_error_percent: Known;
  packs: Pack[];
  failsafe: Failsafe | null;
  failsafe_missing: string;
  notes: string[];
}

/// `flightwatt batch --json`.
export interface Batch {
  aircraft: { aircraft: string; folder: string; flights: string[]; has_model: boolean }[];
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
  mission: string;
  final_soc_percent: number;
  reserve_soc_percent: number;
  keeps_reserve: boolean;
  /// Why that may be wrong whatever its probability.
  uncertain?: string[];
  energy_wh: number;
  compute_energy_wh: number;
  duration_s: number;
  depleted_at_s?: number | null;
  cut_off_at_s?: number | null;
  feasible: boolean;
  power_model?: { model: string; flights: number; mean_absolute_error_percent: number | null } | null;
  probability_below_reserve?: number | null;
  /// With the capacity that the pack's flights indicate, where it differs.
  with_capacity_of_flights?: { capacity_ah: number; keeps_reserve: boolean };
  packs?: number;
  packs_needed?: number;
  on_ground_s?: number;
  flights?: { pack: number; final_soc_percent: number; duration_s: number; energy_wh: number; return_from: string; track?: FlownTrack | null; probability_below_reserve?: number | null; with_capacity_of_flights?: Simulation["with_capacity_of_flights"] }[];
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
