// The words of the live page: status, answers and small values of a flight.
import { number, quantity } from "../ui/format";
import type { Configuration, LiveFlight, LiveState, Phase } from "./flight";

export type Kind = "ok" | "caution" | "alarm" | "silent" | "landed" | "waiting";

/// Returns a duration rounded down, and its unit: "12 min" from 10 minutes on, below "8:12 min", below a minute "45 s".
function duration(seconds: number): [string, string] {
  const whole = Math.max(0, Math.floor(seconds));
  if (whole < 60) return [String(whole), "s"];
  return whole >= 600 ? [String(Math.floor(whole / 60)), "min"] : wholeDuration(whole);
}

/// The same with the seconds: what is over has them, "23:54 min".
function wholeDuration(seconds: number): [string, string] {
  return seconds < 60 ? duration(seconds) : [`${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`, "min"];
}

export const durationText = (seconds: number) => duration(seconds).join(" ");

const phase_names: Record<Phase, string> = { ground: "On the ground", takeoff: "Take-off", cruise: "Cruise", landing: "Landing", landed: "Landed" };

const listed = (...parts: (string | false)[]) => parts.filter(Boolean).join(", ");
const hasReserve = (state: LiveState) => (state.reserve_soc_percent ?? 0) > 0;
export const reserveText = (state: LiveState) => (hasReserve(state) ? `reserve ${quantity(state.reserve_soc_percent, 0, "%")}` : "");

function landedStatus(state: LiveState, is_connected: boolean): [Kind, string, string] {
  const soc = state.battery?.soc_percent;
  const flown = listed(`${wholeDuration(state.flight_time_s).join(" ")} in the air`, state.energy_wh != null && quantity(state.energy_wh, 2, "Wh"));
  const text = `${flown}${is_connected ? "" : ". The watch has ended: these are its last numbers."}`;
  if (hasReserve(state) && soc != null && soc < (state.reserve_soc_percent ?? 0))
    return ["caution", "Landed below the reserve", `${quantity(soc, 1, "%")} left, ${reserveText(state)}; ${text}`];
  return ["landed", "Landed", text];
}

function calmStatus(state: LiveState): [Kind, string, string] {
  const { battery, prediction } = state;
  if (!prediction) return ["waiting", phase_names[state.phase], state.no_prediction_reason ? `No prediction: ${state.no_prediction_reason}` : ""];
  if (!prediction.battery) return ["waiting", phase_names[state.phase], `${quantity(prediction.remaining_energy_wh, 1, "Wh")} to the landing`];
  const [kept, missed] = hasReserve(state) ? ["Reserve is kept", "miss the reserve"] : ["Battery lasts", "run empty"];
  const { overtime_s } = prediction.cruise;
  const probability = battery?.probability_below_reserve;
  if (overtime_s != null) return ["ok", kept, `If it lands now: the planned cruise ended ${durationText(overtime_s)} ago`];
  if (probability == null) return ["ok", kept, `How many flights would ${missed} is unknown`];
  const share = Math.round(100 * probability);
  return ["ok", kept, `${share < 1 ? "Under 1" : share} of 100 flights would ${missed}`];
}

/// Returns the kind, the headline, and the action or its reason.
export function statusOf(flight: LiveFlight): [Kind, string, string] {
  const { state, is_connected } = flight;
  const away = "flightwatt watch does not answer";
  if (!state?.aircraft_id) return is_connected ? ["waiting", "Waiting for an aircraft", ""] : ["silent", "NO CONNECTION", away];
  if (flight.hasLanded()) return landedStatus(state, is_connected);
  const age = durationText(flight.age());
  if (!is_connected) return ["silent", `NO CONNECTION for ${age}`, `${away}. Numbers are old.`];
  if (flight.isOld()) return ["silent", `NO LINK for ${age}`, "Numbers are old. Check antenna and line of sight."];
  const [worst] = state.alarms;
  return worst ? [worst.grade, worst.grade === "alarm" ? "ALARM" : "Caution", worst.action] : calmStatus(state);
}

export interface Answer {
  label: string;
  value: string;
  unit: string;
  note?: string;
  is_home?: boolean;
}

function answer(label: string, [value, unit]: [string, string], note = "", is_home = false): Answer {
  return { label, value, unit, note, is_home };
}

function landingAnswer(state: LiveState): Answer[] {
  const { battery, energy_wh, prediction } = state;
  const soc = battery?.soc_percent;
  if (prediction?.battery) {
    const { at_landing: landing, at_landing_high_energy: worst } = prediction.battery;
    if (landing.fails_after_s != null) return [answer("Battery empty in", duration(landing.fails_after_s), "before the landing")];
    const low = `at most 1 of 40 flights ${worst.fails_after_s != null ? "runs empty" : `below ${quantity(worst.soc_percent, 0, "%")}`}`;
    const label = prediction.cruise.overtime_s != null ? "Charge if it lands now" : "Charge at landing";
    return [answer(label, [number(landing.soc_percent, 1), "%"], listed(reserveText(state), low))];
  }
  if (prediction) return [answer("Energy to the landing", [number(prediction.remaining_energy_wh, 1), "Wh"])];
  if (energy_wh != null) return [answer("Energy so far", [number(energy_wh, 2), "Wh"])];
  return soc != null ? [answer("Charge now", [number(soc, 1), "%"])] : [];
}

function landedAnswers({ points, state }: LiveFlight): Answer[] {
  if (!state) return [];
  const { energy_wh, flight_time_s, lift_off_s } = state;
  const soc = state.battery?.soc_percent;
  const then = points.find((point) => point.t >= (lift_off_s ?? 0) + flight_time_s / 2 && point.at_landing != null);
  const predicted = then && lift_off_s != null && `predicted after ${durationText(then.t - lift_off_s)}: ${quantity(then.at_landing, 1, "%")}`;
  return [
    ...(soc != null ? [answer("Charge left", [number(soc, 1), "%"], listed(reserveText(state), predicted || ""))] : []),
    ...(energy_wh != null ? [answer("Energy used", [number(energy_wh, 2), "Wh"])] : []),
    answer("In the air", wholeDuration(flight_time_s)),
  ];
}

function homeAnswer({ prediction, turn_home: home }: LiveState): Answer[] {
  if (!home) return [];
  const verb = prediction?.cruise.path_at_s != null ? "Turn home" : "Land";
  if (home.latest_in_s == null) return [answer(verb, ["now", ""], "too late for the reserve", true)];
  if (home.path_can_be_flown) return [answer("Planned landing in", duration(home.latest_in_s), "keeps the reserve", true)];
  return [answer(`${verb} within`, duration(home.latest_in_s), "to keep the reserve", true)];
}

/// Returns the large numbers; those without a value are left out.
export function answersOf(flight: LiveFlight): Answer[] {
  const { state } = flight;
  if (!state || flight.hasLanded()) return landedAnswers(flight);
  const reserve_in_s = state.battery?.reserve_in_s;
  const basis = state.prediction?.cruise.overtime_s != null ? "at the mean power so far" : "if the cruise continues";
  const reached = reserve_in_s != null ? [answer(hasReserve(state) ? "Reserve reached in" : "Empty in", duration(reserve_in_s), basis)] : [];
  return [...landingAnswer(state), ...reached, ...homeAnswer(state)];
}

/// Returns the small values, each with its name; an empty one is unknown, or stated elsewhere.
export function valuesOf(state: LiveState): [string, string][] {
  const in_air = state.phase !== "landed";
  const known = (value: number | null | undefined, decimals: number, unit: string, is_shown = true) => (value != null && is_shown ? quantity(value, decimals, unit) : "");
  return [
    ["Charge now", known(state.battery?.soc_percent, 0, "%", in_air)],
    ["By voltage", known(state.battery?.soc_by_voltage_percent, 0, "%")],
    ["Voltage", known(state.voltage_v, 1, "V")],
    ["Power", known(state.power_w, 0, "W", in_air)],
    ["Expected power", known(state.expected_power_w, 0, "W", in_air && state.power_w != null)],
    ["Altitude", known(state.altitude_m, 0, "m")],
    ["Energy", known(state.energy_wh, 2, "Wh", in_air)],
  ];
}

/// Returns phase and time in the air, and how old the latest message is.
export function momentOf(flight: LiveFlight): [string, string] {
  const { state } = flight;
  if (!state || state.messages === 0) return ["Nothing received yet", ""];
  const flown = (flight.hasLanded() ? wholeDuration : duration)(state.flight_time_s).join(" ");
  const phase = listed(phase_names[state.phase], state.flight_time_s > 0 && `${flown} in the air`);
  const received = flight.age() < 2 ? "received now" : `${flight.isOld() ? "" : "received "}${durationText(flight.age())} ago`;
  return [`${phase}${state.began_in_air ? " (since the first message)" : ""}`, received];
}

function runText(configuration: Configuration | null): string {
  const names = Object.entries(configuration ?? {}).map(([name, quality]) => [name, ...Object.entries(quality).map(([key, value]) => `${key} ${value}`)].join(" "));
  return names.join(", ") || "nothing";
}

/// Returns what the computer runs in the air and what it will run, or an empty text.
export function scheduleText({ decision, phase }: LiveState): string {
  if (!decision || phase === "landed") return "";
  const next = decision.next ? `Next: ${runText(decision.next)} in ${durationText(decision.next_in_s)}.` : "No change until landing.";
  return `Computer runs: ${runText(decision.run)}. ${next}`;
}

/// Returns the name of the aircraft, or that of the program.
export function nameOf(state: LiveState | null): string {
  return state?.aircraft_id ? `${state.aircraft_name || "Aircraft"} ${state.aircraft_id}` : "flightwatt watch";
}
