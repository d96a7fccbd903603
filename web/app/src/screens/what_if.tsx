// The sliders: each changes one option of `flightwatt answer`.
import { useRef } from "preact/hooks";
import { duration, distance, quantity } from "../ui/format";
import { NumberField } from "../ui/basics";
import { Slider } from "../ui/slider";
import type { Aircraft, Answered, Project } from "../work/project";
import { baseOf, isMeasured } from "../work/project";
import type { Question } from "../work/question";
import { basisOf, changeOf, mainTime } from "./answer";

interface SliderOf {
  name: string;
  key: keyof Question;
  label: string;
  unit: string;
  decimals: number;
  basis: "measured" | "physics" | "assumption";
  range: [min: number, max: number, step: number];
  /// The value as measured; null: none is stated.
  base: number | null;
  base_words: string;
}

/// `middle_ah` is in the middle of the capacities.
function slidersOf(measured: Answered, { question, own_capacity_ah: own_ah }: Aircraft, middle_ah: number): SliderOf[] {
  const { answer } = measured;
  const speed = answer.airspeed_m_per_s.value;
  return [
    {
      name: "reserve",
      key: "reserve",
      label: "Reserve",
      unit: "%",
      decimals: 0,
      basis: "assumption",
      range: [0, 50, 1],
      base: 20,
      base_words: "20 %",
    },
    {
      name: "payload",
      key: "payload_kg",
      label: "Payload",
      unit: "kg",
      decimals: 2,
      basis: "physics",
      range: [0, 3, 0.05],
      base: null,
      base_words: "as flown",
    },
    {
      name: "wind",
      key: "wind",
      label: "Wind",
      unit: "m/s",
      decimals: 1,
      basis: "assumption",
      range: [0, 15, 0.5],
      base: 0,
      base_words: "calm",
    },
    {
      name: "airspeed",
      key: "airspeed",
      label: "Airspeed",
      unit: "m/s",
      decimals: 1,
      basis: "physics",
      range: [1, Math.max(10, Math.ceil(2 * (speed ?? 5))), 0.5],
      base: null,
      base_words: answer.is_hover ? "hover" : speed != null ? `as flown, ${quantity(speed, 1, "m/s")}` : "as flown",
    },
    {
      name: "capacity",
      key: "capacity_ah",
      label: "Pack capacity",
      unit: "Ah",
      decimals: 1,
      basis: question.capacity_ah != null ? "assumption" : basisOf(answer.capacity_ah.basis),
      range: [Math.ceil(2.5 * middle_ah) / 10, Math.ceil(2 * middle_ah), 0.1],
      base: question.capacity_ah == null ? answer.capacity_ah.value : null,
      base_words: own_ah == null && answer.capacity_ah.value == null ? "unknown" : quantity(own_ah ?? answer.capacity_ah.value, 1, "Ah"),
    },
    {
      name: "temperature",
      key: "temperature",
      label: "Pack temperature",
      unit: "°C",
      decimals: 0,
      basis: "assumption",
      range: [-20, 45, 1],
      base: null,
      base_words: "as flown",
    },
  ];
}

/// Where a slider stands while it asks for nothing.
function restOf(slider: SliderOf, measured: Answered): number {
  if (slider.base != null) return slider.base;
  if (slider.name === "airspeed") return measured.answer.airspeed_m_per_s.value ?? slider.range[0];
  return slider.name === "temperature" ? 20 : slider.range[0];
}

function hintOf(aircraft: Aircraft, slider: SliderOf): string {
  const step = aircraft.hints[slider.name];
  const base = aircraft.measured;
  if (!step || !base) return "";
  const value = step.question[slider.key];
  const time = changeOf(mainTime(step.answer).value, mainTime(base.answer).value, duration);
  const way = changeOf(step.answer.distance_m.value, base.answer.distance_m.value, distance);
  const change = /wind|airspeed/.test(slider.name) && way ? way : time;
  return change && value != null
    ? `${quantity(value, slider.decimals === 2 ? 1 : slider.decimals, slider.unit)}: ${change}`
    : "";
}

/// Returns the capacity that the slider has in its middle, which a move of it does not change.
function useMiddle(capacity_ah: number | null): number {
  const middle = useRef(capacity_ah);
  const { current } = middle;
  if (capacity_ah != null && (current == null || capacity_ah < 0.25 * current || capacity_ah > 2 * current))
    middle.current = capacity_ah;
  return middle.current ?? 5;
}

export function WhatIf({ project, aircraft, asking }: { project: Project; aircraft: Aircraft; asking: boolean }) {
  const { question, now } = aircraft;
  const measured = aircraft.measured ?? now;
  const shown = aircraft.moving ?? now;
  const middle_ah = useMiddle(question.capacity_ah ?? measured?.answer.capacity_ah.value ?? null);
  if (!measured || !shown) return null;
  const base = baseOf(aircraft);
  const set = (key: keyof Question, value: number | undefined) => project.ask(
    aircraft.id,
    { ...question, [key]: value },
  );
  return (
    <section class="card what-if" aria-label="What if">
      <header class="card-head">
        <h2>What if</h2>
        <button type="button" class="quiet" disabled={isMeasured(question) && question.capacity_ah === base.capacity_ah}
          onClick={() => project.ask(aircraft.id, base)}>
          As measured
        </button>
      </header>
      <p class="what-if-result" aria-hidden="true">
        <b>{duration(mainTime(shown.answer).value)}</b> {shown.answer.distance_m.value != null && <b>
          ·{" "}
          {distance(shown.answer.distance_m.value)}
        </b>}{" "}
        <span class="soft">{asking && aircraft.moving ? "half of the flights" : asking ? "computing" : shown.answer.time_in_air_95_s.value != null ? "95 of 100" : ""}</span>
      </p>
      {slidersOf(measured, aircraft, middle_ah).map((slider) => {
        const asked = question[slider.key];
        const value = asked ?? restOf(slider, measured);
        const changed = asked != null && (slider.name !== "capacity" || asked !== base.capacity_ah);
        return (
          <Slider key={slider.name} label={slider.label} basis={slider.basis} changed={changed} value={value}
            min={slider.range[0]} max={slider.range[1]} step={slider.range[2]}
            shown={asked != null ? quantity(asked, slider.decimals, slider.unit) : slider.base_words}
            hint={hintOf(aircraft, slider) || (changed ? `as measured: ${slider.base_words}` : undefined)}
            onChange={(next) => set(slider.key, next)}
          />
        );
      })}
      {question.payload_kg != null && (
        <label class="mass">
          <span>Mass as it flew, without this payload</span>
          <NumberField size={5} value={question.mass_kg} onNumber={(kg) => set("mass_kg", kg)} />
          <span>kg</span>
        </label>
      )}
      <p class="key">
        <span class="basis measured" /> measured <span class="basis physics" /> physics <span
          class="basis assumption"
        /> assumption
      </p>
    </section>
  );
}
