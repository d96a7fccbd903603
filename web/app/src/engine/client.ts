// The page's side of the worker. The files are here, as Blobs that the browser holds, so that they outlive a worker; the
// worker has a tree of the same files and hands back what a run changed.
import { Cancelled, type Engine, type RunResult } from "./engine";
import { loadModule } from "./module";
import { normalized } from "./paths";
import type { FromWorker, ToWorker } from "./worker";
import workerText from "worker:./worker.ts";

interface Run {
  args: string[];
  onErrorLine: (line: string) => void;
  resolve: (result: RunResult) => void;
  reject: (error: Error) => void;
}

/// A Blob's address starts a worker also where the page was opened from a file.
function startWorker(): Worker {
  const address = URL.createObjectURL(new Blob([workerText], { type: "text/javascript" }));
  const worker = new Worker(address);
  URL.revokeObjectURL(address);
  return worker;
}

class WorkerEngine implements Engine {
  private readonly module: Promise<WebAssembly.Module>;
  private readonly blobs = new Map<string, { blob: Blob; modifiedMs: number }>();
  private readonly waiting: Run[] = [];
  private running: Run | null = null;
  private worker: Worker | null = null;

  constructor(module: Promise<WebAssembly.Module>, private readonly environment: Record<string, string>) {
    this.module = module;
    module.catch(() => {});  // each run reports it
  }

  run(args: string[], onErrorLine: (line: string) => void = () => {}): Promise<RunResult> {
    return new Promise((resolve, reject) => {
      this.waiting.push({ args, onErrorLine, resolve, reject });
      void this.next();
    });
  }

  async write(path: string, data: Uint8Array | File): Promise<void> {
    const isFile = data instanceof File;
    const blob = isFile ? data : new Blob([data as Uint8Array<ArrayBuffer>]);
    this.store(normalized(path), blob, isFile ? data.lastModified : Date.now());
  }

  async read(path: string): Promise<Uint8Array> {
    const found = this.blobs.get(normalized(path));
    if (!found) throw new Error(`there is no file ${path}`);
    return new Uint8Array(await found.blob.arrayBuffer());
  }

  async list(): Promise<{ path: string; bytes: number }[]> {
    return [...this.blobs].map(([path, { blob }]) => ({ path, bytes: blob.size }))
      .sort((one, other) => (one.path < other.path ? -1 : 1));
  }

  async remove(path: string): Promise<void> {
    const name = normalized(path);
    const folder = name === "/" ? name : name + "/";
    for (const known of [...this.blobs.keys()]) if (known === name || known.startsWith(folder)) this.blobs.delete(known);
    this.post({ kind: "remove", path: name });
  }

  cancel(): void {
    this.stopWorker();
    const ended = [...(this.running ? [this.running] : []), ...this.waiting.splice(0)];
    this.running = null;
    for (const run of ended) run.reject(new Cancelled());
  }

  private store(path: string, blob: Blob, modifiedMs: number): void {
    this.blobs.set(path, { blob, modifiedMs });
    this.post({ kind: "write", path, blob, modifiedMs });
  }

  /// To the worker that runs; a later one gets all files when it starts.
  private post(message: ToWorker): void { this.worker?.postMessage(message); }

  private stopWorker(): void {
    this.worker?.terminate();
    this.worker = null;
  }

  private async next(): Promise<void> {
    if (this.running) return;
    const run = this.waiting.shift();
    if (!run) return;
    this.running = run;
    try {
      const module = await this.module;
      if (this.running !== run) return;  // cancelled
      this.worker ??= this.startWorkerWith(module);
      this.post({ kind: "run", args: run.args });
    } catch (error) {
      this.end(() => run.reject(new Error(`the program cannot be loaded: ${error instanceof Error ? error.message : error}`)));
    }
  }

  private startWorkerWith(module: WebAssembly.Module): Worker {
    const worker = startWorker();
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => { if (worker === this.worker) this.receive(data); };
    worker.onerror = (event) => {
      if (worker === this.worker) this.receive({ kind: "failed", reason: event.message || "the worker cannot start" });
    };
    const send = (message: ToWorker) => worker.postMessage(message);
    send({ kind: "module", module, environment: this.environment });
    for (const [path, { blob, modifiedMs }] of this.blobs) send({ kind: "write", path, blob, modifiedMs });
    return worker;
  }

  private receive(message: FromWorker): void {
    const run = this.running;
    if (!run) return;
    if (message.kind === "line") {
      run.onErrorLine(message.line);
    } else if (message.kind === "done") {
      const now = Date.now();
      for (const { path, blob } of message.written) this.blobs.set(path, { blob, modifiedMs: now });
      for (const path of message.removed) this.blobs.delete(path);
      this.end(() => run.resolve({ code: message.code, out: message.out, err: message.err }));
    } else {
      this.stopWorker();  // its tree and its memory are those of a run that was broken off
      this.end(() => run.reject(new Error(`the program stopped: ${message.reason}`)));
    }
  }

  private end(settle: () => void): void {
    this.running = null;
    settle();
    void this.next();
  }
}

/// Starts loading the module and returns at once; runs wait for it. The environment holds variables of the program.
export function startEngine(module: Promise<WebAssembly.Module> = loadModule(),
                            environment: Record<string, string> = { FLIGHTWATT_PROGRESS: "1" }): Engine {
  return new WorkerEngine(module, environment);
}
