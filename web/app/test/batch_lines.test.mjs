// The logs of a batch as the lines of the page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../../bundled.mjs";

const { namedBy } = await bundled("work/batch_lines.ts");

test("a log of the name of another aircraft's has its own flight, not that of the next log", () => {
  const flights = [
    { flight: "00000001", log: "logs/b/00000001.BIN", why_not_fitted: "" },
    { flight: "00000001_2", log: "logs/c/00000001.BIN", why_not_fitted: "" },
  ];
  const lines = [
    { path: "logs/b/00000001.BIN", flight: "00000001_2" }, { path: "logs/c/00000001.BIN", flight: "00000001_3" },
  ];
  assert.deepEqual(namedBy({ flights }, lines).map(({ flight }) => flight), ["00000001", "00000001_2"]);
});
