// The work of the engine, one run at a time; what a person waits for goes first.
import { Cancelled } from "../engine/engine";

interface Job {
  run: () => Promise<void>;
  drop: (error: Error) => void;
}

/// Returns whether work ended because the engine was told to end it.
const isCancelled = (error: unknown) => error instanceof Error && error.name === "Cancelled";

export class WorkQueue {
  private urgent: Job[] = [];
  private idle: Job[] = [];
  private is_working = false;
  /// Work under way of which nobody waits for the result.
  private under_way: Job | null = null;
  /// The same, once it was told to end.
  private interrupted: Job | null = null;

  /// `failed` hears of errors that nobody awaits, `done` that nothing is left. `interrupt` ends the engine's run: idle
  /// work rejects with Cancelled then, and is done again from its beginning.
  constructor(
    private readonly failed: (error: Error) => void,
    private readonly done: () => void,
    private readonly interrupt: () => void = () => {},
  ) {}

  /// Does work when its turn comes; the result is what it returns. Urgent work interrupts idle work.
  result<T>(work: () => Promise<T>, is_urgent: boolean): Promise<T> {
    return new Promise((resolve, reject) => {
      const job: Job = {
        run: () =>
          work().then(resolve, (error) => {
            if (this.interrupted === job && isCancelled(error)) this.idle.unshift(job);
            else reject(error);
          }),
        drop: reject,
      };
      (is_urgent ? this.urgent : this.idle).push(job);
      if (is_urgent && this.under_way && !this.interrupted) {
        this.interrupted = this.under_way;
        this.interrupt();
      }
      void this.next();
    });
  }

  /// The same, where nobody waits for a result.
  add(work: () => Promise<void>, is_urgent = false) {
    this.result(work, is_urgent).catch((error: Error) => {
      if (!isCancelled(error)) this.failed(error);
    });
  }

  /// Before all other work of which nobody waits for the result.
  addNext(work: () => Promise<void>) {
    this.add(work);
    const job = this.idle.pop();
    if (job) this.idle.unshift(job);
  }

  /// Drops what has not begun, and what was interrupted.
  clear() {
    this.interrupted = null;
    const dropped = [...this.urgent.splice(0), ...this.idle.splice(0)];
    for (const job of dropped) job.drop(new Cancelled());
  }

  private async next() {
    if (this.is_working) return;
    this.is_working = true;
    for (let job = this.urgent.shift(); job || this.idle.length > 0; job = this.urgent.shift()) {
      this.under_way = job ? null : this.idle[0] ?? null;
      await (job ?? this.idle.shift())?.run();
      this.under_way = null;
      this.interrupted = null;
    }
    this.is_working = false;
    this.done();
  }
}
