// Charts as SVG, drawn for the width at hand: the title with its unit above the axis, lines with their names at their ends.
import type { ComponentChildren } from "preact";
import { useLayoutEffect, useRef, useState } from "preact/hooks";
import "./chart.css";
import { number } from "./format";

/// Where values are on a chart, in pixels.
export interface Place {
  x: (value: number) => number;
  y: (value: number) => number;
  left: number;
  right: number;
  top: number;
  bottom: number;
}

export interface Axis {
  /// With its unit: "Power [W]".
  title: string;
  range: [number, number];
  /// Without them, round numbers.
  ticks?: number[];
  label?: (value: number) => string;
}

interface ChartProps {
  x: Axis;
  y: Axis;
  height: number;
  /// Room at the right of the axes, for words.
  aside?: number;
  /// Room between the axis and its numbers.
  strip?: number;
  /// What the chart shows, in words.
  description: string;
  /// The value of x under the pointer, or null.
  onPoint?: (x: number | null) => void;
  children: (place: Place) => ComponentChildren;
}

/// Returns the width of an element as it changes, and what to give it as `ref`.
export function useWidth(first = 640) {
  const ref = useRef<HTMLDivElement>(null);
  const [width, setWidth] = useState(first);
  useLayoutEffect(() => {
    const element = ref.current;
    if (!element) return;
    const read = () => element.clientWidth > 0 && setWidth(element.clientWidth);
    read();
    const resized = new ResizeObserver(read);
    resized.observe(element);
    return () => resized.disconnect();
  }, []);
  return { ref, width };
}

/// Returns round numbers within a range, at most about `most`.
export function roundTicks([low, high]: [number, number], most: number): number[] {
  const rough = Math.max(high - low, 1e-9) / Math.max(most, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = ([1, 2, 5].find((factor) => factor * power >= rough) ?? 10) * power;
  const ticks: number[] = [];
  for (let i = Math.ceil(low / step - 1e-6); i * step <= high + 1e-6 * step; ++i) ticks.push(i * step);
  return ticks;
}

/// Returns minutes from 0 that clocks count in.
export function minuteTicks(end: number, most: number): number[] {
  const step = [0.5, 1, 2, 5, 10, 15, 20, 30, 60, 120, 240].find((one) => end / one <= most) ?? 480;
  return Array.from({ length: Math.floor(end / step + 1e-6) + 1 }, (_, i) => i * step);
}

function decimalsOf(ticks: number[]): number {
  const step = Math.abs((ticks[1] ?? 1) - (ticks[0] ?? 0)) || 1;
  return Math.min(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), 6);
}

/// Returns the range of values, the larger of its ends a little wider.
export function rangeOf(rows: (number | null | undefined)[][], from?: number): [number, number] {
  const values = rows.flat().filter((value): value is number => value != null && Number.isFinite(value));
  if (values.length === 0) return [from ?? 0, (from ?? 0) + 1];
  let [low, high] = [from ?? Infinity, from ?? -Infinity];
  for (const value of values) [low, high] = [Math.min(low, value), Math.max(high, value)];
  const room = 0.05 * (high - low || Math.abs(high) || 1);
  return [low === from ? low : low - room, high === from ? high : high + room];
}

/// Returns the path of a line, with gaps where a value is missing.
export function lineOf(place: Place, xs: number[], ys: (number | null)[]): string {
  let path = "";
  let is_down = false;
  for (let i = 0; i < xs.length; ++i) {
    const y = ys[i];
    if (y == null) {
      is_down = false;
      continue;
    }
    path += `${is_down ? "L" : "M"}${place.x(xs[i] as number).toFixed(1)} ${place.y(y).toFixed(1)}`;
    is_down = true;
  }
  return path;
}

/// Returns the path of the area between two lines; where one of them is missing it is not drawn.
export function areaOf(place: Place, xs: number[], low: (number | null)[], high: (number | null)[]): string {
  const known = xs.map((_, i) => i).filter((i) => low[i] != null && high[i] != null);
  const at = (i: number, y: number | null | undefined) => `${place.x(xs[i] as number).toFixed(1)} ${place.y(y as number).toFixed(1)}`;
  if (known.length === 0) return "";
  return `M${known.map((i) => at(i, high[i])).join("L")}L${[...known].reverse().map((i) => at(i, low[i])).join("L")}Z`;
}

/// Returns places for words so that they are `gap` apart, in the order of `wanted`, within the ends.
export function spread(wanted: number[], gap: number, low: number, high: number): number[] {
  const order = wanted.map((_, i) => i).sort((a, b) => (wanted[a] as number) - (wanted[b] as number) || a - b);
  const placed = [...wanted];
  let last = low - gap;
  for (const i of order) last = placed[i] = Math.max(placed[i] as number, last + gap);
  let limit = high;
  for (const i of [...order].reverse()) {
    placed[i] = Math.min(placed[i] as number, limit);
    limit = (placed[i] as number) - gap;
  }
  return placed;
}

export function Chart(props: ChartProps) {
  const { ref, width } = useWidth();
  const { height, x, y, aside = 12, strip = 0 } = props;
  const y_ticks = y.ticks ?? roundTicks(y.range, height / 46);
  const y_label = y.label ?? ((value: number) => number(value, decimalsOf(y_ticks)));
  const left = 12 + 7.5 * Math.max(1, ...y_ticks.map((tick) => y_label(tick).length));
  const [top, right, bottom] = [26, width - aside, height - 38 - strip];
  const x_ticks = x.ticks ?? roundTicks(x.range, Math.max(2, (right - left) / 70));
  const x_label = x.label ?? ((value: number) => number(value, decimalsOf(x_ticks)));
  const place: Place = {
    x: (value) => left + ((value - x.range[0]) / (x.range[1] - x.range[0])) * (right - left),
    y: (value) => bottom - ((value - y.range[0]) / (y.range[1] - y.range[0])) * (bottom - top),
    left, right, top, bottom,
  };
  const point = (event: PointerEvent & { currentTarget: SVGSVGElement }) => {
    const box = event.currentTarget.getBoundingClientRect();
    const at = ((event.clientX - box.left) / box.width) * width;
    props.onPoint?.(at < left - 8 || at > right + 8 ? null : x.range[0] + ((at - left) / (right - left)) * (x.range[1] - x.range[0]));
  };
  return (
    <div class="chart" ref={ref}>
      <svg viewBox={`0 0 ${width} ${height}`} width={width} height={height} role="img" aria-label={props.description}
        onPointerMove={props.onPoint && point} onPointerLeave={props.onPoint && (() => props.onPoint?.(null))}>
        <text x="0" y="12">{y.title}</text>
        {y_ticks.map((tick) => (
          <>
            <line class="grid-line" x1={left} x2={right} y1={place.y(tick)} y2={place.y(tick)} />
            <text x={left - 8} y={place.y(tick) + 4} text-anchor="end">{y_label(tick)}</text>
          </>
        ))}
        {x_ticks.map((tick) => (
          <text x={place.x(tick)} y={bottom + strip + 18} text-anchor="middle">{x_label(tick)}</text>
        ))}
        <text x={right} y={height - 4} text-anchor="end">{x.title}</text>
        {props.children(place)}
      </svg>
    </div>
  );
}
