// Numbers as people read them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "./helpers/bundle.mjs";

const { chance, date, distance, duration, energy, naturally, number, power, quantity, typed } = await bundled("ui/format.ts");

test("a missing number is unknown, never 0", () => {
  for (const show of [duration, distance, chance, power, energy]) assert.equal(show(null), "unknown");
  assert.equal(number(NaN, 1), "unknown");
  assert.equal(quantity(undefined, 1, "%"), "unknown");
});

test("minus is a minus sign, and there is no minus zero", () => {
  assert.equal(number(-1.26, 1), "−1.3");
  assert.equal(number(-0.001, 1), "0.0");
});

test("times are to the nearest second, from an hour on in minutes", () => {
  assert.equal(duration(653.855), "10 min 54 s");
  assert.equal(duration(59.7), "1 min 0 s");
  assert.equal(duration(12.2), "12 s");
  assert.equal(duration(3600 + 12 * 60 + 30), "1 h 12 min");
  assert.equal(duration(-75), "−1 min 15 s");
});

test("power has a decimal below 100 W only", () => {
  assert.equal(power(27.31), "27.3 W");
  assert.equal(power(412.6), "413 W");
  assert.equal(power(99.97), "100 W");
});

test("a chance is never none and never all", () => {
  assert.equal(chance(0), "under 1 of 100");
  assert.equal(chance(1), "over 99 of 100");
  assert.equal(chance(0.953), "95 of 100");
  assert.equal(chance(0.9496), "94 of 100", "below what is wanted");
  assert.equal(chance(1 - 0.05), "95 of 100");
});

test("kilometres from 1000 m on; dates in words; names in natural order", () => {
  assert.equal(distance(830), "830 m");
  assert.equal(distance(4140), "4.1 km");
  assert.equal(date("2020-07-03 12:17"), "3 July 2020, 12:17");
  assert.deepEqual(["f10", "f9", "f1"].sort(naturally), ["f1", "f9", "f10"]);
});

test("a number is typed with a point or a comma, and of whole units with thousands", () => {
  assert.equal(typed("3,2"), 3.2);
  assert.equal(typed("1.500"), 1.5);
  for (const text of ["1500", "1,500", "1.500", "1 500", "1\u00a0500", "1'500"]) assert.equal(typed(text, true), 1500, text);
  assert.equal(typed("1,5", true), 1.5);
  for (const text of ["", "abc", "-3", "0", "3 Ah", "1,5,0"]) assert.equal(typed(text, true), null, text);
});
