// Finds the engine of a page: embedded in it, or beside it where it is served.
import { startEngine } from "./client";
import type { Engine } from "./engine";
import { isModuleEmbedded } from "./module";

declare global {
  /// Another engine, as tests have one.
  var flightwattEngine: Engine | undefined;
}

const isServed = () => document.querySelector('meta[name="flightwatt-engine"]') != null;

/// Returns whether the page has an engine.
export function hasEngine(): boolean {
  return globalThis.flightwattEngine != null || isModuleEmbedded() || isServed();
}

/// Opens the page's engine; a page that is served is kept for a time without a network.
export function openEngine(): Engine {
  if (isServed() && "serviceWorker" in navigator) navigator.serviceWorker.register("service-worker.js")
    .catch(() => undefined);
  return globalThis.flightwattEngine ?? startEngine();
}
