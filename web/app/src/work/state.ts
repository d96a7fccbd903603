// What the screens show: the logs of this visit, their aircraft and what was answered of them.
import type { Answer, FlownFlight, Simulation } from "./documents";
import type { Question } from "./question";

export const logs_folder = "logs";

/// A line of the list of logs.
export interface LogLine {
  path: string;
  bytes: number;
  state: "waiting" | "used" | "part" | "not";
  /// Why it is not used, or what of it is not; empty if all is.
  reason: string;
  flight: string;
  flown?: FlownFlight;
  power?: number[];
}

/// Charge over time of the answer's mission.
export interface Curve {
  time_s: number[];
  soc: (number | null)[];
  compute_w: (number | null)[];
  phases: { name: string; from: number; to: number }[];
  band?: { time_s: number[]; low: (number | null)[]; high: (number | null)[] };
  simulation: Simulation;
  /// The same as the table that the program wrote.
  csv: string;
}

export interface Answered {
  question: Question;
  answer: Answer;
  curve: Curve | null;
  seconds: number;
  /// Of the program, in its words.
  warnings: string[];
}

export interface Aircraft {
  id: string;
  name: string;
  kind: string;
  folder: string;
  logs: LogLine[];
  question: Question;
  /// The capacity that its logs state.
  own_capacity_ah?: number;
  /// Without what-if, see baseOf().
  measured?: Answered;
  now?: Answered;
  /// To a question of a slider that moves: as modelled, without chances; gone once `now` answers it.
  moving?: Answered;
  failed?: string;
  /// What a step of a slider changes.
  hints: Record<string, Answered | null>;
}

export interface Progress {
  text: string;
  done: number;
  of: number;
}

export interface State {
  ready: boolean;
  failed: string;
  aircraft: Aircraft[];
  chosen: string;
  unused: LogLine[];
  waiting: LogLine[];
  plans: string[];
  /// What was dropped or drawn last: another object whenever a file of a plan or mission was written, even one of a name
  /// that is known. No plan: a file of a mission alone.
  dropped: { plan?: string };
  /// Of terrain, which is there.
  tiles: number;
  progress: Progress | null;
  read_s: number | null;
  busy: boolean;
}
