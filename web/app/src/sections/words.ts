// Words and colours that several parts share.
import type { Outcome, PhaseName } from "../documents";
import type { Grade } from "../ui/basics";

export const phase_words: Record<PhaseName, string> = { takeoff: "take-off", cruise: "cruise", landing: "landing" };
/// Names of colours in tokens.css.
export const phase_tones: Record<PhaseName, string> = { takeoff: "take-off", cruise: "cruise", landing: "landing" };
export const phase_names: PhaseName[] = ["takeoff", "cruise", "landing"];

export const grades: Record<Outcome, Grade> = { keeps: "good", "may-miss": "doubt", misses: "doubt", fails: "bad" };
export const grade_tones: Record<Grade, string> = { good: "ok", doubt: "caution", bad: "alarm", none: "ink3" };

export const health: Record<string, { grade: Grade; words: string }> = {
  healthy: { grade: "good", words: "Healthy" },
  watch: { grade: "doubt", words: "Watch" },
  retire: { grade: "bad", words: "Retire" },
  unknown: { grade: "none", words: "Too early to say" },
};

const counts = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];
export const countWord = (count: number) => counts[count] ?? String(count);

export const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);
export const plural = (count: number, one: string, more = `${one}s`) => `${count} ${count === 1 ? one : more}`;

const model_names: Record<string, string> = { fourier: "curve of each phase", constant_mean: "mean power of each phase", physical: "physical model", by_phase: "chosen for each phase" };
export const modelName = (id: string) => model_names[id] ?? id.replaceAll("_", " ");

/// Returns "8 to 30.2" with a unit, or an empty text.
export function span(interval: { low: number; high: number } | null | undefined, show: (value: number) => string): string {
  return interval ? `${show(interval.low)} to ${show(interval.high)}` : "";
}
