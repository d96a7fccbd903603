// The text of a mission file with other numbers.
import type { MissionSlider } from "../documents";

/// The numbers that were changed, by the index of their slider.
export type Changes = Record<number, number>;

interface Edit {
  line: number;
  from: number;
  to: number;
  text: string;
}

/// The number behind the equals sign of a key.
function numberAt(line: string, column: number, key: string): { from: number; to: number } {
  const start = [...line].slice(0, column - 1).join("").length + key.length;
  const from = line.indexOf("=", start) + 1;
  const [, space = "", number = ""] = /^([ \t]*)([^ \t\r,\]}#]*)/.exec(line.slice(from)) ?? [];
  return { from: from + space.length, to: from + space.length + number.length };
}

const tableOf = (key: string) => key.slice(0, key.lastIndexOf(".") + 1);
const nameOf = (key: string) => key.slice(key.lastIndexOf(".") + 1);

/// Returns a mission file with the changed numbers. Those that it does not state are lines above it, in a table all of
/// its keys.
export function missionText(text: string, sliders: MissionSlider[], changes: Changes): string {
  const lines = text.replace(/^\uFEFF/, "").split("\n");
  const edits = sliders.flatMap(({ key, places }, i): Edit[] => (changes[i] == null ? [] : places.map(({ line, column }) => ({
    line: line - 1, text: String(changes[i]), ...numberAt(lines[line - 1] ?? "", column, nameOf(key)),
  }))));
  edits.sort((a, b) => b.from - a.from);
  for (const { line, from, to, text: number } of edits) lines[line] = `${lines[line]?.slice(0, from)}${number}${lines[line]?.slice(to)}`;
  const added = sliders.filter(({ places }) => places.length === 0);
  const tables = new Set(added.filter((one) => changes[sliders.indexOf(one)] != null).map(({ key }) => tableOf(key)));
  const is_written = (one: MissionSlider) => changes[sliders.indexOf(one)] != null || (tableOf(one.key) !== "" && tables.has(tableOf(one.key)));
  return [...added.filter(is_written).map((one) => `${one.key} = ${changes[sliders.indexOf(one)] ?? one.value}`), ...lines].join("\n");
}
