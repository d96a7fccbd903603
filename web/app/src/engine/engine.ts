// The program as a page sees it: commands over a tree of files. client.ts makes one that runs in a worker.

export interface RunResult { code: number; out: string; err: string }

export interface Engine {
  /// Runs the program with these arguments over the tree of files; standard error's lines arrive as they are printed.
  /// Runs wait for each other. What a run wrote is in the tree when its promise resolves.
  run(args: string[], onErrorLine?: (line: string) => void): Promise<RunResult>;
  /// Puts a file into the tree and creates its folders. A File is read where it is, when a run reads it.
  write(path: string, data: Uint8Array | File): Promise<void>;
  /// The bytes of a file; rejects where there is none.
  read(path: string): Promise<Uint8Array>;
  /// All files, by path.
  list(): Promise<{ path: string; bytes: number }[]>;
  /// Removes a file, or a folder with what is in it.
  remove(path: string): Promise<void>;
  /// Ends the run and those that wait: their promises reject with Cancelled, and the files are those of before the run.
  cancel(): void;
}

/// Why the promise of a run was rejected: Engine.cancel was called.
export class Cancelled extends Error {
  constructor() {
    super("cancelled");
    this.name = "Cancelled";
  }
}
