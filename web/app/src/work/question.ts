// What is asked of an aircraft, and the commands that answer it.
import type { Answer } from "./documents";

/// The options of `flightwatt answer` that the sliders set; absent is "as measured".
export interface Question {
  capacity_ah?: number;
  reserve?: number;
  payload_kg?: number;
  mass_kg?: number;
  wind?: number;
  airspeed?: number;
  temperature?: number;
  home_m?: number;
}

/// Returns the options of a question.
export function optionsOf(question: Question): string[] {
  const options: string[] = [];
  const add = (name: string, value: number | undefined) => {
    if (value != null) options.push(`--${name}`, String(value));
  };
  add("capacity", question.capacity_ah);
  add("reserve", question.reserve);
  add("payload", question.payload_kg);
  if (question.payload_kg != null) add("mass", question.mass_kg);
  add("wind", question.wind);
  add("airspeed", question.airspeed);
  add("temperature", question.temperature);
  add("home-distance", question.home_m);
  return options;
}

/// Returns the options of a battery failsafe for the answer to a question.
export function failsafeOptions(question: Question, answer: Answer): string[] {
  const home_m = question.home_m ?? answer.failsafe?.home_distance_m;
  const airspeed = answer.return_airspeed_m_per_s.value;
  return [
    ...(home_m != null ? ["--home-distance", String(home_m)] : []),
    ...(airspeed != null ? ["--airspeed", String(airspeed)] : []),
    ...(question.wind ? ["--wind", String(question.wind)] : []),
    "--reserve",
    String(answer.reserve_soc_percent),
  ];
}

/// Returns a text as a shell takes it.
export function quoted(text: string): string {
  return /^[\w@%+=:,./-]+$/.test(text) && !text.startsWith("-") ? text : `'${text.replaceAll("'", `'\\''`)}'`;
}

const by_folder = 4;

/// Returns logs as a command line has them: by name, or where they are many their folder.
export function logsShown(logs: string[]): string {
  if (logs.length > by_folder) return "LOGS";
  return logs.map((log) => quoted(log.replace(/^logs\//, ""))).join(" ");
}
