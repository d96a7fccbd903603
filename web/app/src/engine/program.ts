// One run of the program over a tree of files: the same in a worker and in node.
import { Fd, WASI, wasi } from "@bjorn3/browser_wasi_shim";
import type { RunResult } from "./engine";
import { Folder, OpenRoot, OpenStoredFile, StoredFile } from "./tree";

/// The standard error, in lines as they are printed. A line that is written over (progress) is passed on and not kept.
class Lines extends Fd {
  text = "";
  private readonly decoder = new TextDecoder();
  private pending = "";

  constructor(private readonly onLine: (line: string) => void) { super(); }

  override fd_fdstat_get() {
    return { ret: wasi.ERRNO_SUCCESS, fdstat: new wasi.Fdstat(wasi.FILETYPE_REGULAR_FILE, 0) };  // no terminal
  }
  override fd_filestat_get() {
    return { ret: wasi.ERRNO_SUCCESS, filestat: new wasi.Filestat(0n, wasi.FILETYPE_REGULAR_FILE, 0n) };
  }
  override fd_write(data: Uint8Array) {
    this.pending += this.decoder.decode(data, { stream: true });
    const complete = this.pending.match(/[^\r\n]*[\r\n]/g) ?? [];
    for (const line of complete) {
      if (line.endsWith("\n")) this.text += line;
      if (line.trim() !== "") this.onLine(line.slice(0, -1));
    }
    this.pending = this.pending.slice(complete.reduce((length, line) => length + line.length, 0));
    return { ret: wasi.ERRNO_SUCCESS, nwritten: data.length };
  }
  end(): void {
    if (this.pending === "") return;
    this.text += this.pending;
    this.onLine(this.pending);
  }
}

/// As the shim's two, which count characters where they write bytes.
function passArguments(engine: WASI, args: string[]): void {
  const texts = args.map((arg) => new TextEncoder().encode(arg + "\0"));
  const memory = () => (engine.inst as unknown as { exports: { memory: WebAssembly.Memory } }).exports.memory.buffer;
  engine.wasiImport.args_sizes_get = (count: number, bytes: number) => {
    const view = new DataView(memory());
    view.setUint32(count, texts.length, true);
    view.setUint32(bytes, texts.reduce((sum, text) => sum + text.length, 0), true);
    return wasi.ERRNO_SUCCESS;
  };
  engine.wasiImport.args_get = (pointers: number, at: number) => {
    const view = new DataView(memory());
    const bytes = new Uint8Array(memory());
    for (const text of texts) {
      view.setUint32(pointers, at, true);
      bytes.set(text, at);
      pointers += 4;
      at += text.length;
    }
    return wasi.ERRNO_SUCCESS;
  };
}

export interface ProgramRun extends RunResult { memoryBytes: number }

/// Runs `flightwatt ARGS` in the folder "/" of the tree. A defect of the module itself rejects.
export async function runProgram(module: WebAssembly.Module, args: string[], root: Folder,
                                  onErrorLine: (line: string) => void = () => {},
                                  environment: Record<string, string> = {}): Promise<ProgramRun> {
  const out = new StoredFile();
  const err = new Lines(onErrorLine);
  if (!root.contents.has("tmp")) root.contents.set("tmp", new Folder());
  const variables = Object.entries({ PWD: "/", ...environment }).map(([name, value]) => `${name}=${value}`);
  const descriptors = [new OpenStoredFile(new StoredFile()), new OpenStoredFile(out), err, new OpenRoot(root)];
  const engine = new WASI([], variables, descriptors, { debug: false });
  passArguments(engine, ["flightwatt", ...args]);
  const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: engine.wasiImport });
  const exports = instance.exports as { memory: WebAssembly.Memory; _start: () => unknown };
  const code = engine.start({ exports });
  err.end();
  return { code, out: new TextDecoder().decode(out.bytes()), err: err.text, memoryBytes: exports.memory.buffer.byteLength };
}
