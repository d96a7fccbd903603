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
  ];
}

/// Returns what is asked beyond the flights as they were: "With 0.5 kg, in 4 m/s of wind".
export function asWords(question: Question): string {
  const parts = [
    question.payload_kg != null ? `with ${question.payload_kg} kg` : "",
    question.wind ? `in ${question.wind} m/s of wind` : "",
    question.airspeed != null ? `at ${question.airspeed} m/s` : "",
    question.temperature != null ? `at ${question.temperature} °C` : "",
  ];
  return parts.filter(Boolean).join(", ");
}

/// Returns a text of the program with its options named as this page does.
export function inPageWords(text: string): string {
  return text
    .replace(/--capacity AH/g, "the capacity of the pack")
    .replace(/; select one with --aircraft ID/g, "; this page reads one aircraft of a log: the command flightwatt LOG --aircraft ID answers for another")
    .replace(/cannot be read: I\/O error/g, "a log cannot be read any more: it was moved, changed or deleted since it was dropped, or its card removed; drop it again")
    .replace(/\(option --mass\)/g, "(the mass below the slider Payload)")
    .replace(/terrain \(--terrain\) names a folder of its heights/g, "drop the tiles of its heights (N47E008.hgt)")
    .replace(/--airspeed/g, "the slider Airspeed")
    .replace(/--home-distance/g, "the distance from home")
    .replace(/--payload/g, "the slider Payload");
}

/// Returns a text as a shell takes it.
export function quoted(text: string): string {
  return /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`;
}

const by_folder = 4;

/// Whether a command names the folder of logs, and so has to say which of several aircraft it is of.
export const isByFolder = (logs: string[]) => logs.length > by_folder;

/// Returns logs as a command line has them, by name or where they are many as their folder, of which `aircraft` is read;
/// and the map of their columns.
export function inputsShown(logs: string[], columns?: string, aircraft?: string): string {
  const shown = (path: string) => quoted(path.replace(/^logs\//, "").replace(/^-/, "./-"));
  return [
    ...(isByFolder(logs) ? ["LOGS", ...(aircraft != null ? ["--aircraft", quoted(aircraft)] : [])] : logs.map(shown)),
    ...(columns != null ? ["--columns", shown(columns)] : []),
  ].join(" ");
}
