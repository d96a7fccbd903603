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

/// Returns that path, or where it is taken one in a folder of its own: "2/flight.bin".
export function freePath(path: string, taken: (path: string) => boolean): string {
  for (let i = 1; ; i += 1) {
    const free = i === 1 ? path : `${i}/${path}`;
    if (!taken(free)) return free;
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
