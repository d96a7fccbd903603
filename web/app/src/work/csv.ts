// Tables of the stages (CSV) as columns of texts and numbers.

export interface Csv {
  head: string[];
  rows: string[][];
}

function cells(line: string): string[] {
  if (!line.includes('"')) return line.split(",");
  const result: string[] = [];
  let at = 0;
  while (at <= line.length) {
    if (line[at] === '"') {
      let text = "";
      for (at += 1; at < line.length; at += 1) {
        if (line[at] !== '"') text += line[at];
        else if (line[at + 1] === '"') text += line[(at += 1)];
        else break;
      }
      result.push(text);
      at += 2;
    } else {
      const end = line.indexOf(",", at);
      result.push(line.slice(at, end < 0 ? undefined : end));
      at = end < 0 ? line.length + 1 : end + 1;
    }
  }
  return result;
}

/// Reads a table; lines with # before it are comments.
export function parseCsv(text: string): Csv {
  const lines = text.split("\n").map((line) => line.replace(/\r$/, ""));
  const first = lines.findIndex((line) => line !== "" && !line.startsWith("#"));
  if (first < 0) return { head: [], rows: [] };
  const rows = lines.slice(first + 1).filter((line) => line !== "");
  return { head: cells(lines[first] ?? ""), rows: rows.map(cells) };
}

/// Returns a column of numbers; an empty cell is null. A column that is not there has none.
export function numbers(table: Csv, name: string): (number | null)[] {
  const at = table.head.indexOf(name);
  if (at < 0) return [];
  return table.rows.map((row) => {
    const cell = row[at];
    const value = cell ? Number(cell) : NaN;
    return Number.isFinite(value) ? value : null;
  });
}

/// Returns a column of texts.
export function texts(table: Csv, name: string): string[] {
  const at = table.head.indexOf(name);
  return at < 0 ? [] : table.rows.map((row) => row[at] ?? "");
}

/// Returns the times and values of a column where it has a value.
export function track(table: Csv, name: string): { x: number[]; y: number[] } {
  const time = numbers(table, "time_s");
  const x: number[] = [];
  const y: number[] = [];
  numbers(table, name).forEach((value, i) => {
    const at = time[i];
    if (value != null && at != null && !(x.length > 0 && at <= (x[x.length - 1] as number))) {
      x.push(at);
      y.push(value);
    }
  });
  return { x, y };
}
