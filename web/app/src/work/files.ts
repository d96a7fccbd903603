// Files that people drop or choose: their names made safe, and what each is for.

export interface Dropped {
  /// As the browser gives it, with its folders.
  path: string;
  file: File;
}

const longest_part = 100;

/// Returns a part of a path without what a file system or a command line would take for more than a name.
function safePart(part: string): string {
  // eslint-disable-next-line no-control-regex
  const clean = part.normalize("NFC").replace(/[\u0000-\u001f\u007f\\/:*?"<>|\u202a-\u202e\u2066-\u2069]/g, "_").trim();
  const letters = [...clean];
  if (letters.length <= longest_part) return clean;
  const ending = /(\.[A-Za-z0-9]{1,8}){1,2}$/.exec(clean)?.[0] ?? "";
  return letters.slice(0, longest_part - ending.length).join("") + ending;
}

/// Returns the path of a file below a folder: nothing leads out of it, nothing is hidden or empty.
export function safePath(path: string): string {
  const parts = path.split(/[/\\]/).map(safePart).filter((part) => part !== "" && !/^\.+$/.test(part));
  return parts.slice(-6).join("/") || "unnamed";
}

/// Returns the path of the n-th file of a path: from the second on in a folder of its own, "2/flight.bin".
export const numbered = (path: string, n: number) => (n === 1 ? path : `${n}/${path}`);

const part_bytes = 1 << 22;

/// Returns whether a file begins with all that another has; not where one of them cannot be read.
export async function beginsWith(file: Blob, begin: Blob): Promise<boolean> {
  if (file.size < begin.size) return false;
  try {
    for (let at = 0; at < begin.size; at += part_bytes) {
      const to = Math.min(at + part_bytes, begin.size);
      const [one, other] = await Promise.all([file, begin].map(async (of) => new Uint8Array(await of.slice(at, to).arrayBuffer())));
      if (!one?.every((byte, i) => byte === other?.[i])) return false;
    }
    return true;
  } catch {
    return false;
  }
}

/// Returns whether a file can still be read: not where it was moved, changed or deleted since it was dropped.
export async function isReadable(file: Blob | undefined): Promise<boolean> {
  return file?.slice(-1).arrayBuffer().then(() => true, () => false) ?? false;
}

/// Returns the place of a log that comes under a path: its own where it is known, also in part (a log that grew), else
/// the first that is free; `is_new`: whether it is to be written there.
export async function placeOfLog(
  path: string,
  file: Blob,
  known: (path: string) => Blob | undefined | Promise<Blob | undefined>,
): Promise<{ place: string; is_new: boolean }> {
  for (let n = 1; ; n += 1) {
    const place = numbered(path, n);
    const old = await known(place);
    if (!old) return { place, is_new: true };
    if (await beginsWith(old, file)) return { place, is_new: false };
    if (await beginsWith(file, old)) return { place, is_new: true };
  }
}

/// What a file is for; `other` is read as a log, so that the program says why it is none.
export type Kind = "log" | "definitions" | "plan" | "terrain" | "packs" | "columns" | "ignored";

/// Returns what a file is for, by its name and those that come with it.
export function kindOf(path: string, names: Set<string>): Kind {
  const name = (path.split("/").pop() ?? "").toLowerCase();
  if (/^(\.ds_store|thumbs\.db|desktop\.ini)$/.test(name) || name.startsWith("._")) return "ignored";
  if (name === "packs.toml") return "packs";
  if (/\.toml$/.test(name)) return "columns";
  if (/^[ns]\d{2}[ew]\d{3}\.hgt$/.test(name)) return "terrain";
  if (/\.(plan|waypoints|kml|geojson)$/.test(name)) return "plan";
  if (/\.xml$/.test(name)) return name === "messages.xml" ? "definitions" : "plan";
  const stem = path.replace(/\.log$/i, "");
  const has_data = [".data", ".data.gz", ".DATA"].some((ending) => names.has(stem + ending));
  return /\.log$/i.test(name) && has_data ? "definitions" : "log";
}

const ending_of_log = /\.(bin|ulg|tlog|data|log)(\.(gz|bz2|xz|zst))?$/i;

/// Returns what a file is for that came with a mission, which names its files: they stay beside it, but for logs.
export function kindBesideMission(path: string, kind: Kind): Kind | "mission" {
  const is_for_logs = kind === "ignored" || kind === "packs" || kind === "definitions" || ending_of_log.test(path);
  return is_for_logs ? kind : "mission";
}

/// Returns the part of a name that a log of Paparazzi and its definitions share.
export const stemOf = (path: string) => path.replace(/\.(log|data(\.gz)?)$/i, "");

/// Returns the name of a tile of heights as the program looks for it: "N47E008.hgt".
export function tileName(path: string): string {
  return `${(path.split("/").pop() ?? "").slice(0, 7).toUpperCase()}.hgt`;
}

async function filesOfEntry(entry: FileSystemEntry): Promise<Dropped[]> {
  if (entry.isFile) {
    const file = await new Promise<File>((done, fail) => (entry as FileSystemFileEntry).file(done, fail));
    return [{ path: entry.fullPath.replace(/^\/+/, "") || file.name, file }];
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const inside: FileSystemEntry[] = [];
  for (;;) {
    // A folder is given in parts of at most 100 entries.
    const part = await new Promise<FileSystemEntry[]>((done, fail) => reader.readEntries(done, fail));
    if (part.length === 0) break;
    inside.push(...part);
  }
  return (await Promise.all(inside.map(filesOfEntry))).flat();
}

/// Returns the files of a drop, those in folders too.
export async function filesOfDrop(transfer: DataTransfer): Promise<Dropped[]> {
  // Entries and files are gone after the first await.
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.() ?? null);
  const files = [...transfer.files];
  const found = entries.filter((entry) => entry != null);
  if (found.length === 0) return files.map((file) => ({ path: file.name, file }));
  return (await Promise.all(found.map(filesOfEntry))).flat();
}

/// Returns the files of a field for files or a folder.
export function filesOfInput(input: HTMLInputElement): Dropped[] {
  return [...(input.files ?? [])].map((file) => ({ path: file.webkitRelativePath || file.name, file }));
}
