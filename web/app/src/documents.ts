// The JSON documents that the screens show, as the stages print them (docs/reference). Nothing else is shown: every
// number is of a stage, with its unit in its key, and every sentence was worded by the program.

/// A 95 % interval, unless its key names another.
export interface Interval {
  low: number;
  high: number;
}

export type PhaseName = "takeoff" | "cruise" | "landing";
export type PerPhase<T> = Record<PhaseName, T>;

/// A table as the program prints it, with a caption.
export interface PrintedTable {
  caption: string;
  header: string[];
  rows: string[][];
}

/// The document of a page of `flightwatt report` or `answer`. Parts that the inputs do not have are null or empty.
export interface ReportDocument {
  format: 1;
  /// The title of the tab: "20 Faulty: 3 flights, 3 to 10 July 2020; 9 missions".
  title: string;
  /// The title in the bar: "FlightWatt report", or what --title states.
  name: string;
  /// The foot of the page: "computed", "by", "flights", "missions".
  facts: { name: string; text: string }[];
  /// The command that gives the same, without folders of the computer that made the page.
  command: string;
  /// "One of nine missions runs empty, two land below the reserve".
  headline: string;
  /// One for each aircraft: name, and "3 flights, 3 to 10 July 2020 · 1 h 6 min in the air · 26.1 Wh".
  aircraft: { name: string; text: string }[];
  /// Of `flightwatt LOG...`: the question, and its answer for one aircraft.
  answer: AnswerDocument | null;
  panel: AircraftPanel | null;
  /// The worst first.
  missions: MissionDocument[];
  /// One for each flight, software and battery that missions share.
  quality: QualityGrid[];
  schedules: ScheduleNotes | null;
  /// Software on board with its profiled power, each once.
  software: SoftwareProfile[];
  /// Missions over several packs.
  packs: PackMission[];
  flights: FlightRow[];
  /// Flights, phases and logs that are not used, grouped by reason.
  exclusions: Exclusion[];
  /// Lines and rings of --outline, [longitude, latitude] in degrees.
  outlines: [number, number][][];
  /// The flights' model first, then those of missions that differ.
  models: ModelDocument[];
  physical: PhysicalDocument | null;
  validation: ValidationDocument | null;
  battery: BatteryDocument | null;
  trends: TrendsDocument | null;
  replay: ReplayDocument | null;
  /// Warnings of the fits.
  warnings: string[];
  /// Contents that are absent, with reasons.
  notes: string[];
  /// With --interactive, what the missions name, at places that fit together.
  files: { path: string; text: string }[];
}

// ---- answer (docs/reference/answer.md)

/// A value with what it rests on, or why it is unknown.
export interface Answered {
  value: number | null;
  basis: string;
  unknown: string;
}

export interface BestSpeed {
  purpose: string;
  airspeed_m_per_s: number | null;
  airspeed_low_m_per_s: number | null;
  airspeed_high_m_per_s: number | null;
  below_flown: boolean;
  above_flown: boolean;
  cost: number | null;
  unit: string;
}

export interface VoltageThreshold {
  voltage_v: number;
  probability_too_late: number | null;
  probability_too_early: number | null;
}

export interface FailsafeAction {
  soc_percent: number;
  used_mah: number;
  remaining_mah: number;
  current_a: number;
  probability_too_late: number | null;
  probability_too_late_interval_95: Interval | null;
  voltage: VoltageThreshold | null;
  voltage_alone: VoltageThreshold | null;
}

export interface FailsafeCard {
  capacity_mah: number;
  reserve_percent: number;
  probability: number;
  probability_is_known: boolean;
  home_distance_m: number | null;
  home_duration_s: number | null;
  low: FailsafeAction | null;
  low_missing: string;
  critical: FailsafeAction;
  probability_landed_short: number | null;
  empty_voltage_v: number | null;
  rests_on: { ground: "measured" | "physics" | "assumption"; text: string }[];
}

/// One aircraft of `answer --json`, without the names of folders and files.
export interface AircraftAnswer {
  aircraft: string;
  aircraft_name: string;
  logs: number;
  flights_used: number;
  no_answer: string;
  reserve_soc_percent: number;
  payload_kg: number | null;
  wind_m_per_s: number;
  wind_from_deg: number | null;
  is_hover: boolean;
  power_w: Answered;
  time_in_air_s: Answered;
  time_in_air_95_s: Answered;
  airspeed_m_per_s: Answered;
  distance_m: Answered;
  distance_across_m: number | null;
  return_airspeed_m_per_s: Answered;
  best_speeds: BestSpeed[];
  capacity_ah: Answered;
  flights_capacity_ah_interval_95: Interval | null;
  voltage_known_down_to_percent: number | null;
  resistance_ohm: Answered;
  resistance_ohm_interval_95: Interval | null;
  air_temperature_c_range: Interval | null;
  battery_temperature_c_range: Interval | null;
  temperature_c: number | null;
  resistance_at_temperature_ohm: Answered;
  resistance_at_temperature_ohm_interval_95: Interval | null;
  prediction_error_percent: Answered;
  packs: Pack[];
  failsafe: FailsafeCard | null;
  failsafe_missing: string;
  requirement_missed: string;
  notes: string[];
}

export interface AnswerDocument extends AircraftAnswer {
  /// "2A002500 (ArduCopter): 3 flights used of 3 logs".
  headline: string;
  /// The lines of the terminal: a label, the value (or "unknown"), and what it rests on.
  lines: { label: string; value: string; basis: string }[];
  /// Texts to copy into an autopilot, each with its name, or the reason why it is absent.
  pastes: { name: string; text: string }[];
}

// ---- the aircraft

export interface AircraftPanel {
  /// Mean power of the phases over the flights; empty for several aircraft.
  phases: { phase: PhaseName; mean_power_w: number; low_w: number; high_w: number; flights: number }[];
  /// "Level flight and climb", "22 W", "in level flight at 13.3 m/s. ...".
  facts: { name: string; value: string; text: string }[];
  /// The flights with warnings: the number of the flight in `flights`, the first warning, and how many there are.
  warned_flights: { flight: number; text: string; warnings: number }[];
  rejected_logs: number;
}

// ---- missions (docs/reference/simulate.md, report.md)

/// keeps: in 95 of 100 flights, or as modelled; may-miss: also where a part is uncertain; misses: lands below the
/// reserve; fails: runs empty, is cut off or lacks power.
export type Outcome = "keeps" | "may-miss" | "misses" | "fails";

/// The state of charge over time.
export interface ChargeCurve {
  time_s: number[];
  soc_percent: (number | null)[];
}

/// A mission as `simulate --json` prints it.
export interface MissionSummary {
  mission: string;
  schedule?: string;
  final_soc_percent: number | null;
  reserve_soc_percent: number;
  keeps_reserve: boolean;
  energy_wh: number;
  mechanical_energy_wh: number;
  compute_energy_wh: number;
  delivered_energy_wh: number;
  duration_s: number;
  depleted_at_s: number | null;
  cut_off_at_s: number | null;
  feasible: boolean;
  power_model?: { model: string; flights: number; mean_absolute_error_percent: number };
  utility?: number;
  decisions?: number;
  decisions_without_plan?: number;
  learned_mechanical_factor?: number;
  probability_below_reserve?: number | null;
  probability_below_reserve_interval_95?: Interval | null;
  probability_below_reserve_standard_error?: number | null;
  probability_depleted?: number | null;
  probability_battery_failure?: number | null;
  samples?: number;
  seed?: number;
  final_soc_mean_percent?: number | null;
  final_soc_sd_percent?: number | null;
  final_soc_quantiles_percent?: Record<string, number> | null;
  varied?: string[];
  fixed?: string[];
  with_capacity_of_flights?: { capacity_ah: number; final_soc_percent: number | null; fails_at_s: number | null; keeps_reserve: boolean };
}

export interface MissionDocument {
  title: string;
  /// Its place by charge at landing, as `compare` ranks: 1 is the most.
  rank: number;
  outcome: Outcome;
  summary: MissionSummary;
  /// The texts of the mission's card. Empty: there is no such text.
  card: {
    /// "below reserve".
    words: string;
    /// "Lands with 16.2 % of its charge".
    lead: string;
    /// "detection 10 fps, encryption 240 key bits, all the time".
    runs: string;
    /// "16.2 %".
    landing: string;
    /// "keeps the reserve of 20 %".
    aim: string;
    /// How probable that is: "12 %", "unknown".
    probability: string;
    reach_name: string;
    reach: string;
    /// The planned cruise: "22 min".
    planned: string;
    /// What would keep the reserve, each enough: "42 s less cruise, or a pack of 2.4 Ah". If it is kept, what is spare.
    help: string;
    /// Another mission of this page that keeps the reserve.
    better: string;
    notes: string[];
  };
  curve: ChargeCurve;
  /// Charge at landing; null: the battery fails at `end_s`.
  landing_soc_percent: number | null;
  end_s: number;
  /// 5 to 95 % of the drawn flights; null: how flights differ is unknown.
  band: { time_s: number[]; low_percent: number[]; high_percent: number[] } | null;
  phases: { phase: PhaseName; start_s: number; end_s: number }[];
  /// The software over time.
  schedule: { start_s: number; end_s: number; compute_w: number; phase: PhaseName; runs: string }[];
  /// The path of the cruise, where the mission states one; east and north of its start.
  path: MissionPath | null;
  /// With --interactive; null also for a mission over several packs.
  again: MissionAgain | null;
}

/// How a mission is flown again with other numbers.
export interface MissionAgain {
  /// Its place among the files.
  file: string;
  /// It has no schedule: `plan` makes one.
  is_planned: boolean;
  sliders: MissionSlider[];
}

/// A number of a mission file that the reader may change.
export interface MissionSlider {
  /// "wind.speed_m_per_s".
  key: string;
  /// As the mission is flown now.
  value: number;
  low: number;
  high: number;
  /// Where its key is in the file (columns count characters, from 1); empty: the file does not state it.
  places: { line: number; column: number }[];
}

/// A cruise as it is flown, with its turns, times since lift-off and the charge then (null: the battery has failed).
export interface FlownTrack {
  time_s: number[];
  east_m: number[];
  north_m: number[];
  /// null: the path is in metres from an unknown place.
  latitude_deg?: number[] | null;
  longitude_deg?: number[] | null;
  soc_percent: (number | null)[];
  /// The point where the way home to the next pack begins.
  return_index?: number | null;
  wind_m_per_s?: number;
  wind_from_deg?: number;
}

export interface MissionPath extends FlownTrack {
  elements: {
    name: string;
    kind: "leg" | "circles" | "hold" | "turn";
    start_s: number;
    duration_s: number;
    length_m: number | null;
    course_deg: number | null;
    airspeed_m_per_s: number;
    climb_m_per_s: number;
    mechanical_w: number;
  }[];
}

/// The charge at landing with one setting of the software throughout.
export interface QualityGrid {
  x_name: string;
  y_name: string;
  x: number[];
  y: number[];
  /// Values of further parameters: "planner rate 5"; may be empty.
  others: string;
  reserve_soc_percent: number;
  /// The missions with this flight, by their numbers in `missions`.
  missions: number[];
  /// Number of drawn flights of each probability.
  flights_drawn: number;
  /// For the paper's Fig. 4, with --figures only: charge at landing on a finer grid, x varying fastest.
  map?: { x: number[]; y: number[]; soc_percent: (number | null)[] };
  /// x varies fastest.
  cells: {
    landing_soc_percent: number | null;
    /// Probability of keeping the reserve: "12 %"; empty: unknown.
    keeps: string;
    utility: number | null;
    end_s: number;
    duration_s: number;
    curve: ChargeCurve;
  }[];
}

export interface ScheduleNotes {
  /// What energies and probabilities are.
  text: string;
  /// What differs between drawn flights, and of which missions.
  sources: { missions: string[]; text: string }[];
}

export interface SoftwareProfile {
  missions: string[];
  components: {
    name: string;
    /// The first parameter, which the powers are over: "fps"; empty: the component has none.
    parameter: string;
    /// One for each value of the other parameters. `low_w` and `high_w` are null without known errors.
    lines: { name: string; value: number[]; power_w: number[]; low_w: (number | null)[]; high_w: (number | null)[] }[];
  }[];
}

/// A mission over several packs, as `simulate --json` prints it.
export interface PackMission extends Omit<MissionSummary, "schedule" | "delivered_energy_wh" | "depleted_at_s" | "cut_off_at_s"> {
  text: string;
  packs: number;
  packs_needed: number | null;
  on_ground_s: number;
  flights: (MissionSummary & {
    pack: number;
    start_s: number;
    cruise_from_s: number;
    cruise_to_s: number;
    largest_to_s: number;
    return_from: string;
    return_east_m: number | null;
    return_north_m: number | null;
    track?: FlownTrack | null;
    runs: { phase: PhaseName; from_s: number; to_s: number; run: Record<string, Record<string, number>> }[];
  })[];
}

// ---- flights

/// A log, and what is known of it without its details.
export interface FlightRow {
  name: string;
  /// "3 July 2020, 12:17", or the name.
  title: string;
  aircraft: string;
  /// "2020-07-03 12:17", UTC; empty: unknown.
  date: string;
  /// Why the log is not used; empty: it is. Then all below is empty.
  rejected: string;
  /// Use by the fit.
  used: "all" | "in part" | "no";
  /// "20 Faulty, 2020-07-03 12:17, 23 min 55 s in the air, 19.52 km, up to 118 m".
  text: string;
  /// The flights of the log.
  sorties: SortieRow[];
  warnings: string[];
  notes: string[];
  /// FlightDetail, or with many flights its compressed JSON: see detailOf().
  detail: FlightDetail | string | null;
}

export interface SortieRow {
  sortie: number;
  in_air_s: number;
  distance_m: number | null;
  air_distance_m: number | null;
  /// Highest above the ground at lift-off.
  height_m: number | null;
  energy_wh: number | null;
  /// The same by the autopilot's counter.
  counter_energy_wh: number | null;
  /// Energy less that of the counter.
  energy_closure_percent: number | null;
  cruise_airspeed_m_per_s: number | null;
  duration_s: PerPhase<number>;
  mean_power_w: PerPhase<number | null>;
}

/// Tracks over time, in the time of the log, each reduced to what draws the same line on 250 pixel columns (100 on a
/// page of more than 20 flights); null: the log has none.
export interface FlightDetail {
  /// File of the log.
  log: string;
  /// Origin of the power: "ENERGY.voltage * ENERGY.current".
  power_source: string;
  circuits: { name: string; energy_wh: number; percent: number }[];
  phases: { phase: PhaseName; start_s: number; end_s: number }[];
  /// Where phases begin and end, with the evidence.
  edges: { time_s: number; name: string; evidence: string }[];
  /// The model's curve is of each complete phase, scaled to its duration.
  power: { time_s: number[]; power_w: (number | null)[]; model_power_w: (number | null)[] | null } | null;
  altitude: { time_s: number[]; altitude_m: (number | null)[] } | null;
  throttle: { time_s: number[]; throttle_percent: (number | null)[] } | null;
  voltage: { time_s: number[]; voltage_v: (number | null)[] } | null;
  current: { time_s: number[]; current_a: (number | null)[] } | null;
  airspeed: { time_s: number[]; airspeed_m_per_s: (number | null)[] } | null;
  track: FlightTrack | null;
}

/// The ground track: east and north in metres within 2 m of the flown one, and where the log has them latitude and
/// longitude (else both are null).
export interface FlightTrack {
  /// "22 min 52 s in block Standby, of 4 blocks"; may be empty.
  text: string;
  /// The phases, split at gaps.
  lines: {
    phase: PhaseName;
    time_s: number[];
    east_m: number[];
    north_m: number[];
    latitude_deg: number[] | null;
    longitude_deg: number[] | null;
  }[];
  /// Every 5 minutes or more: "5 min: 78 %", with the charge left where the pack is known.
  marks: { time_s: number; text: string; east_m: number; north_m: number; latitude_deg: number | null; longitude_deg: number | null }[];
}

export interface Exclusion {
  /// At most ten, then "12 more".
  flights: string[];
  number: number;
  /// "at all", "for the model", "for the battery".
  not_used: string;
  reason: string;
}

// ---- models (docs/reference/fit.md, validate.md)

export interface ModelDocument {
  /// It is of missions, and not of the flights.
  is_of_missions: boolean;
  /// "Fitted by flightwatt batch to the flights above (order 3, weights: ...)."
  origin: string;
  description: string;
  name: string;
  warnings: string[];
  notes: string[];
  /// Power over the time of each phase; bands are null where they are unknown.
  curves: {
    phase: PhaseName;
    time_s: number[];
    power_w: number[];
    /// 95 % band of the mean.
    band: { time_s: number[]; low_w: number[]; high_w: number[] } | null;
    /// Range of the flights.
    flights: { time_s: number[]; low_w: number[]; high_w: number[] } | null;
  }[];
  /// Coefficients as the paper's Table I.
  table_one: PrintedTable | null;
  /// What stands below that table.
  table_text: string;
}

export interface PhysicalDocument {
  /// The physical model as `fit --json` prints it.
  fit: {
    terms: { term: string; coefficient: number; coefficient_interval_95: Interval | null; unit: string }[];
    level_sd: number | null;
    degrees_of_freedom: number;
    drift_sd_w: number;
    correlation_s: number;
    flights: string[];
    bins: number;
    bin_s: number;
    samples: number;
    airspeed_m_per_s: Interval;
    climb_m_per_s: Interval;
    mean_airspeed_m_per_s: number;
    hold_out: string;
    trials: { term: string; kept: boolean; rms_without_w: number | null; rms_with_w: number | null; reason: string }[];
    speed_to_fly: { best: BestSpeed[]; test: unknown } | null;
  };
  text: string;
  trials_text: string;
  /// "best endurance: 11.8 m/s (10.9 to 12.4), 21 W".
  speeds: string[];
  /// Level flight; `flown` is false where it is slower than any flight. Bands are null for a single flight.
  level: { airspeed_m_per_s: number[]; power_w: number[]; low_w: (number | null)[]; high_w: (number | null)[]; flown: boolean }[];
  /// Parts of flights of about 30 s, less the power of their climb and turns.
  bins: { flight: string; start_s: number[]; airspeed_m_per_s: number[]; level_power_w: number[]; climb_m_per_s: number[]; power_w: number[] }[];
  /// Best speeds with the ends of their intervals, cut at the drawn airspeeds.
  best: { purpose: string; text: string; airspeed_m_per_s: number | null; power_w: number; low_m_per_s: number; high_m_per_s: number }[];
}

export interface ModelScore {
  flights: number;
  mean_absolute_error_wh: number;
  mean_absolute_error_percent: number | null;
  mean_absolute_error_rest_percent: number | null;
  bias_wh: number;
  coverage_95: number | null;
}

export interface ValidationDocument {
  text: string;
  /// Of synthetic flights; empty otherwise.
  warning: string;
  /// Of few flights; empty otherwise.
  note: string;
  /// `validate --json`: scores by model.
  scores: { flights: number; takeoff: Record<string, ModelScore>; cruise: Record<string, ModelScore>; landing: Record<string, ModelScore>; total: Record<string, ModelScore>; folds: number };
  /// The energy of whole flights, predicted from the others.
  errors: { title: string; flight: string[]; error_wh: number[]; measured_wh: number[]; predicted_wh: number[] }[];
}

// ---- battery and packs (docs/reference/battery.md, trends.md)

export interface IdentifiedBattery {
  capacity_ah: number;
  capacity_ah_interval_95: Interval | null;
  capacity_from: string;
  chemistry: string;
  flight_estimate_ah: number | null;
  flight_estimate_ah_interval_95: Interval | null;
  cells: number;
  resistance_ohm: number;
  resistance_ohm_interval_95: Interval | null;
  resistance_between_flights: { sd_ohm: number; flights: number } | null;
  rc_resistance_ohm: number;
  rc_resistance_ohm_interval_95: Interval | null;
  rc_time_constant_s: number | null;
  rc_time_constant_s_interval_95: Interval | null;
  open_circuit: { soc_percent: number[]; voltage_v: number[]; standard_error_v: number[]; known_up_to_percent: number; known_down_to_percent: number; known_down_to_ah: number };
  voltage_rms_mv: number;
  flights: {
    flight: string;
    resting_voltage_v: number;
    initial_depletion_ah: number;
    initial_depletion_ah_interval_95: Interval | null;
    drawn_ah: number;
    resistance_ohm: number | null;
    resistance_ohm_interval_95: Interval | null;
    samples: number;
    unused_samples: number;
    voltage_rms_mv: number;
    air_temperature_c: number | null;
    battery_temperature_c: number | null;
    battery_start_c: number | null;
  }[];
  leave_one_out:
    | {
        flight: string;
        initial_depletion_ah: number;
        voltage_rms_mv: number;
        load_voltage_rms_mv: number;
        load_mean_error_mv: number;
        load_interval_95_mv: number;
        load_interval_95_holds_percent: number;
        forecast_error_mv: number | null;
        updated_forecast_error_mv: number | null;
        ahead_30_s_error_mv: number;
        extrapolated_percent: number;
      }[]
    | null;
}

export interface BatteryDocument {
  /// "A Thévenin circuit, identified from ... of 3 flights, 3 LiPo cells in series; RMS error 21.0 mV."
  text: string;
  warnings: string[];
  notes: string[];
  /// Why no battery was identified; empty otherwise.
  no_result_reason: string;
  /// Why it was not checked by leave-one-out; empty otherwise.
  not_checked: string;
  /// `battery --json`.
  identified: IdentifiedBattery | null;
  /// Capacity, voltage and resistances with their intervals, and what they are known from.
  parameters: PrintedTable | null;
  /// Terminal voltage of each flight; null where the record is not used.
  voltages: { flight: string; time_s: number[]; measured_v: (number | null)[]; model_v: (number | null)[] }[];
  /// The knots; `from_flights` is false where they follow the chart of the cells.
  open_circuit: { soc_percent: number[]; voltage_v: number[]; low_v: (number | null)[]; high_v: (number | null)[]; from_flights: boolean[]; text: string } | null;
}

export interface Pack {
  pack: string;
  named_by: string;
  may_be_several: boolean;
  aircraft: string[];
  flights: number;
  first: string;
  last: string;
  energy_wh: number;
  charge_ah: number;
  cycles: number | null;
  equivalent_cycles: number | null;
  partly_used: number;
  cells: number | null;
  resistance_ohm: number | null;
  resistance_ohm_interval_95: Interval | null;
  temperature_c: number | null;
  temperature_of: string;
  start_charge_percent: number | null;
  resistance_change_percent: number | null;
  resistance_change_percent_interval_95: Interval | null;
  label_capacity_ah: number | null;
  capacity_ah: number | null;
  capacity_ah_interval_95: Interval | null;
  capacity_percent_of_label: number | null;
  capacity_change_percent: number | null;
  capacity_change_percent_interval_95: Interval | null;
  rest_voltage_v: number | null;
  rest_voltage_spread_v: number | null;
  health: "healthy" | "watch" | "retire" | "unknown";
  reason: string;
  mission_until: string;
}

export interface TrendsDocument {
  packs: Pack[];
  notes: string[];
  text: string;
  /// One for each aircraft and quantity.
  trends: {
    aircraft: string;
    /// "cruise power [W]".
    title: string;
    /// "rises", "falls", "not significant", or "unknown: ..."
    direction: string;
    change_in_30_days: number | null;
    change_in_30_days_interval_95: Interval | null;
    /// The flights: seconds since 1970 (UTC), and the quantity in the unit of its key.
    flights: { clock_s: number[]; value: number[] };
    /// Lines with the median of the slopes, and with the ends of its interval; null without a trend.
    lines: { name: string; clock_s: [number, number]; value: [number, number] }[] | null;
  }[];
}

// ---- replay (docs/reference/replay.md)

export interface ReplayDocument {
  text: string;
  sentences: string[];
  notes: string[];
  /// Results of each schedule on each flight, and the models of the replays.
  tables: PrintedTable[];
}

// ---- reading

/// Returns the document that the page carries, or null: then the page waits for logs.
export function carriedDocument(): ReportDocument | null {
  const element = document.getElementById("document");
  return element?.textContent?.trim() ? (JSON.parse(element.textContent) as ReportDocument) : null;
}

/// Returns the details of a flight, which pages of many flights carry as zlib's deflate (RFC 1950) in base64. Throws
/// an Error with what to do where the browser cannot decompress them.
export async function detailOf(flight: FlightRow): Promise<FlightDetail | null> {
  if (typeof flight.detail !== "string") return flight.detail;
  if (typeof DecompressionStream === "undefined")
    throw new Error("This browser cannot open the compressed flights of a page of many flights: open the page in Firefox 113, Chrome or Edge 80, Safari 16.4 or a later one.");
  const bytes = Uint8Array.from(atob(flight.detail), (letter) => letter.charCodeAt(0));
  const text = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).text();
  return JSON.parse(text) as FlightDetail;
}

/// Returns latitude and longitude in degrees for a map. A track without them is drawn as if its zero were at 0, 0.
export function placesOf(line: { east_m: number[]; north_m: number[]; latitude_deg?: number[] | null; longitude_deg?: number[] | null }): [number, number][] {
  const metres_per_degree = 111195;
  const { latitude_deg: north, longitude_deg: east } = line;
  if (north && east) return north.map((latitude, i) => [latitude, east[i] ?? 0]);
  return line.north_m.map((metres, i) => [metres / metres_per_degree, (line.east_m[i] ?? 0) / metres_per_degree]);
}
