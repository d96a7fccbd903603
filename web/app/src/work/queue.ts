// The work of the engine, one run at a time; what a person waits for goes first.
import { Cancelled } from "../engine/engine";

interface Job {
  run: () => Promise<void>;
  drop: (error: Error) => void;
}

export class WorkQueue {
  private urgent: Job[] = [];
  private idle: Job[] = [];
  private is_working = false;

  /// `failed` hears of errors that nobody awaits, `done` that nothing is left.
  constructor(private readonly failed: (error: Error) => void, private readonly done: () => void) {}

  /// Does work when its turn comes; the result is what it returns.
  result<T>(work: () => Promise<T>, is_urgent: boolean): Promise<T> {
    return new Promise((resolve, reject) => {
      (is_urgent ? this.urgent : this.idle).push({ run: () => work().then(resolve, reject), drop: reject });
      void this.next();
    });
  }

  /// The same, where nobody waits for a result.
  add(work: () => Promise<void>, is_urgent = false) {
    this.result(work, is_urgent).catch((error: Error) => {
      if (!(error instanceof Cancelled)) this.failed(error);
    });
  }

  /// Before all other work of which nobody waits for the result.
  addNext(work: () => Promise<void>) {
    this.add(work);
    const job = this.idle.pop();
    if (job) this.idle.unshift(job);
  }

  /// Drops what has not begun.
  clear() {
    const dropped = [...this.urgent.splice(0), ...this.idle.splice(0)];
    for (const job of dropped) job.drop(new Cancelled());
  }

  private async next() {
    if (this.is_working) return;
    this.is_working = true;
    for (let job = this.take(); job; job = this.take()) await job.run();
    this.is_working = false;
    this.done();
  }

  private take(): Job | undefined {
    return this.urgent.shift() ?? this.idle.shift();
  }
}
