// A flight in the air, as the events of `flightwatt watch --serve` have it.

type Known = number | null;

export type Phase = "ground" | "takeoff" | "cruise" | "landing" | "landed";

/// What is drawn over time.
export interface Point {
  t: number;
  soc: Known;
  power: Known;
  expected: Known;
  altitude: Known;
  /// The charge that was predicted then.
  at_landing: Known;
}

interface Landing {
  soc_percent: number;
  fails_after_s: Known;
}

/// The components that run, each with its quality of service.
export type Configuration = Record<string, Record<string, number>>;

/// The JSON of `watch` (docs/reference/watch.md) as far as it is shown, with the charge ahead and the latest point.
export interface LiveState {
  time_s: number;
  aircraft_id: string;
  aircraft_name: string;
  phase: Phase;
  began_in_air: boolean;
  lift_off_s: Known;
  flight_time_s: number;
  energy_wh: Known;
  power_w: Known;
  expected_power_w: Known;
  voltage_v: Known;
  altitude_m: Known;
  reserve_soc_percent: Known;
  battery: { soc_percent: Known; soc_by_voltage_percent: Known; reserve_in_s: Known; probability_below_reserve: Known } | null;
  prediction: {
    remaining_energy_wh: number;
    cruise: { overtime_s: Known; path_at_s: Known };
    battery: { at_landing: Landing; at_landing_high_energy: Landing } | null;
  } | null;
  no_prediction_reason: string | null;
  /// `latest_in_s` null: it is too late.
  turn_home: { latest_in_s: Known; path_can_be_flown: boolean } | null;
  decision: { run: Configuration | null; next: Configuration | null; next_in_s: number } | null;
  /// The most severe is first.
  alarms: { kind: string; grade: "caution" | "alarm"; text: string; action: string }[];
  warnings: string[];
  messages: number;
  restarts: number;
  time_since_message_s: number;
  silence_threshold_s: number;
  others: Record<string, number>;
  unusable: Record<string, number>;
  ahead: { time_s: number[]; soc_percent: number[] };
  point: Point;
}

const max_points = 4000; // beyond, every second of the older ones is removed

export class LiveFlight {
  points: Point[] = [];
  state: LiveState | null = null;
  is_connected = true;
  private arrival_ms = 0;

  /// Begins again with what the server has kept.
  begin(points: Point[]) {
    this.points = [];
    for (const point of points) this.add(point);
    this.is_connected = true;
  }

  take(state: LiveState) {
    this.state = state;
    this.arrival_ms = Date.now();
    this.is_connected = true;
    this.add(state.point);
  }

  /// Returns the age of the latest message [s].
  age() {
    return this.state ? this.state.time_since_message_s + (Date.now() - this.arrival_ms) / 1000 : 0;
  }

  hasLanded() {
    return this.state?.phase === "landed";
  }

  /// Returns whether the numbers are old: nothing arrived for too long.
  isOld() {
    return this.state !== null && (!this.is_connected || this.age() >= this.state.silence_threshold_s);
  }

  private add(point: Point) {
    const last = this.points[this.points.length - 1];
    if (last && point.t < last.t) this.points = []; // a clock reset
    this.points.push(point);
    if (this.points.length > max_points) this.points = this.points.filter((_, i) => i % 2 === 0 || i > (max_points * 3) / 4);
  }
}
