// The worker: it has the tree of files and runs the program. Files come and go as Blobs, which are not copied.
import { runProgram } from "./program";
import { files, Folder, put, remove, StoredFile, type Source } from "./tree";

export type ToWorker =
  | { kind: "module"; module: WebAssembly.Module; environment: Record<string, string> }
  | { kind: "write"; path: string; blob: Blob; modifiedMs: number }
  | { kind: "remove"; path: string }
  | { kind: "run"; args: string[] };
export type FromWorker =
  | { kind: "line"; line: string }
  | { kind: "done"; code: number; out: string; err: string; written: { path: string; blob: Blob }[]; removed: string[] }
  | { kind: "failed"; reason: string };

/// A file of the user's, or one that an earlier run wrote: read in windows, and small ones once.
class BlobSource implements Source {
  private from = 0;
  private window = new Uint8Array(0);

  constructor(private readonly blob: Blob) {}

  get size(): number { return this.blob.size; }

  read(from: number, to: number): Uint8Array {
    if (from < this.from || to > this.from + this.window.length) {
      const end = Math.min(this.size, Math.max(to, from + (1 << 20)));
      this.window = new Uint8Array(new FileReaderSync().readAsArrayBuffer(this.blob.slice(from, end)));
      this.from = from;
    }
    return this.window.subarray(from - this.from, to - this.from);
  }
}

const scope = self as unknown as DedicatedWorkerGlobalScope;
const root = new Folder();
let known = new Map<string, StoredFile>();
let module: WebAssembly.Module | null = null;
let environment: Record<string, string> = {};
const post = (message: FromWorker) => scope.postMessage(message);

/// What a run left in the tree, against what was there before.
function changes() {
  const now = files(root);
  const written: { path: string; blob: Blob }[] = [];
  for (const [path, file] of now) {
    if (path.startsWith("/tmp/") || (known.get(path) === file && !file.isChanged)) continue;
    written.push({ path, blob: new Blob([file.bytes() as Uint8Array<ArrayBuffer>]) });
    file.isChanged = false;
  }
  const removed = [...known.keys()].filter((path) => !now.has(path));
  known = now;
  return { written, removed };
}

async function run(args: string[]): Promise<void> {
  if (!module) throw new Error("the module is not there");
  const result = await runProgram(module, args, root, (line) => post({ kind: "line", line }), environment);
  post({ kind: "done", code: result.code, out: result.out, err: result.err, ...changes() });
}

scope.onmessage = ({ data }: MessageEvent<ToWorker>) => {
  if (data.kind === "module") {
    module = data.module;
    environment = data.environment;
  } else if (data.kind === "write") {
    const file = new StoredFile(new BlobSource(data.blob), data.modifiedMs);
    put(root, data.path, file);
    known.set(data.path, file);
  } else if (data.kind === "remove") {
    remove(root, data.path);
    known = files(root);
  } else {
    run(data.args).catch((error: unknown) => {
      changes();  // a trap leaves what it wrote
      post({ kind: "failed", reason: error instanceof Error ? error.message : String(error) });
    });
  }
};
