// Finds the engine of a page: embedded in it, or beside it where it is served.
import type { Engine } from "./engine";

declare global {
  /// Another engine, as tests have one.
  var flightwattEngine: Engine | undefined;
}

/// Returns whether the page has an engine.
export function hasEngine(): boolean {
  return globalThis.flightwattEngine != null;
}

/// Opens the page's engine.
export async function openEngine(): Promise<Engine> {
  if (globalThis.flightwattEngine) return globalThis.flightwattEngine;
  throw new Error("the page has no engine");
}
