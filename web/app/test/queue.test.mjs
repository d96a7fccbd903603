// The order of the engine's work.
import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../../bundled.mjs";

const { WorkQueue } = await bundled("work/queue.ts");

/// A queue over an engine whose runs last until `finish` or `interrupt` ends them; `order` lists what began and ended.
function queueOfRuns() {
  const order = [];
  let running = null;
  const errors = [];
  const queue = new WorkQueue(
    (error) => errors.push(error.message),
    () => order.push("done"),
    () => running.reject(Object.assign(new Error("cancelled"), { name: "Cancelled" })),
  );
  const run = (name) => () => {
    order.push(name);
    return new Promise((resolve, reject) => (running = { resolve: () => resolve(name), reject }));
  };
  const finish = async () => {
    running.resolve();
    await new Promise((resolve) => setTimeout(resolve));
  };
  return { queue, run, finish, order, errors };
}

test("urgent work interrupts idle work, which is done again from its beginning", async () => {
  const { queue, run, finish, order, errors } = queueOfRuns();
  const idle = queue.result(run("validate"), false);
  const urgent = queue.result(run("slider"), true);
  await new Promise((resolve) => setTimeout(resolve));
  assert.deepEqual(order, ["validate", "slider"]);
  await finish();
  assert.equal(await urgent, "slider");
  await finish();
  assert.equal(await idle, "validate");
  assert.deepEqual(order, ["validate", "slider", "validate", "done"]);
  assert.deepEqual(errors, []);
});

test("urgent work waits for urgent work", async () => {
  const { queue, run, finish, order } = queueOfRuns();
  queue.add(run("first"), true);
  queue.add(run("second"), true);
  await finish();
  await finish();
  assert.deepEqual(order, ["first", "second", "done"]);
});

test("what was interrupted is dropped with the rest", async () => {
  const { queue, run, finish, order } = queueOfRuns();
  const idle = queue.result(run("trends"), false);
  queue.add(run("slider"), true);
  await new Promise((resolve) => setTimeout(resolve));
  queue.clear();
  await assert.rejects(idle, { name: "Cancelled" });
  await finish();
  assert.deepEqual(order, ["trends", "slider", "done"]);
});

test("an error of idle work is told once", async () => {
  const { queue, errors } = queueOfRuns();
  queue.add(() => Promise.reject(new Error("no such file")));
  await new Promise((resolve) => setTimeout(resolve));
  assert.deepEqual(errors, ["no such file"]);
});
