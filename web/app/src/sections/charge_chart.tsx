// The state of charge over a flight: the curve, how far flights differ, the reserve, phases, and where the charge ends.
import { useState } from "preact/hooks";
import type { ChargeCurve, MissionDocument, Outcome } from "../documents";
import { areaOf, Chart, lineOf, minuteTicks, spread, type Place } from "../ui/chart";
import { duration, number, quantity } from "../ui/format";
import { grade_tones, grades, phase_tones, phase_words } from "./words";

/// What the chart shows of a flight.
export interface ChargeFlight {
  title: string;
  outcome: Outcome;
  curve: ChargeCurve;
  landing_soc_percent: number | null;
  end_s: number;
  duration_s: number;
  reserve_soc_percent: number;
  band?: MissionDocument["band"];
  phases?: MissionDocument["phases"];
}

export const toneOf = (outcome: Outcome) => grade_tones[grades[outcome]];
export const chargeFlight = (mission: MissionDocument): ChargeFlight => ({
  ...mission,
  duration_s: mission.summary.duration_s,
  reserve_soc_percent: mission.summary.reserve_soc_percent,
});

export function describe(flight: ChargeFlight): string {
  const end = flight.landing_soc_percent == null ? `the battery fails at ${duration(flight.end_s)} of ${duration(flight.duration_s)}` : `${quantity(flight.landing_soc_percent, 1, "%")} at landing after ${duration(flight.duration_s)}`;
  const reserve = flight.reserve_soc_percent > 0 ? `, reserve ${quantity(flight.reserve_soc_percent, 0, "%")}` : "";
  return `State of charge of ${flight.title}: ${end}${reserve}.`;
}

const minutes = (values: number[]) => values.map((value) => value / 60);
const charge = { title: "State of charge [%]", range: [0, 100] as [number, number], ticks: [0, 25, 50, 75, 100] };

/// The index of the sample that is nearest to a time.
export function nearest(times: number[], time: number): number {
  let [low, high] = [0, times.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((times[middle] as number) <= time) low = middle;
    else high = middle;
  }
  return Math.abs((times[high] ?? Infinity) - time) < Math.abs((times[low] as number) - time) ? high : low;
}

function timeAxis(duration_s: number, most: number) {
  const end = duration_s / 60;
  const ticks = minuteTicks(end, most);
  return { title: "minutes since lift-off", range: [0, Math.max(end, 0.1)] as [number, number], ticks, label: (value: number) => number(value, Number.isInteger(value) ? 0 : 1) };
}

export function Reserve({ place, percent, wide = true, words_at }: { place: Place; percent: number; wide?: boolean; words_at?: number }) {
  if (percent <= 0) return null;
  const y = place.y(percent);
  return (
    <>
      <line class="reserve" x1={place.left} x2={place.right} y1={y} y2={y} />
      {wide && <text class="halo" x={place.left + 6} y={words_at ?? y - 5}>reserve {quantity(percent, percent % 1 ? 1 : 0, "%")}</text>}
    </>
  );
}

function Phases({ place, phases }: { place: Place; phases: MissionDocument["phases"] }) {
  return (
    <>
      {phases.map(({ phase, start_s, end_s }) => (
        <rect class={`tone-${phase_tones[phase]}`} fill="currentColor" x={place.x(start_s / 60)} y={place.bottom + 6} height="6"
          width={Math.max(1.5, place.x(end_s / 60) - place.x(start_s / 60) - 1)}>
          <title>{`${phase_words[phase]}, ${duration(end_s - start_s)}`}</title>
        </rect>
      ))}
    </>
  );
}

/// The end of a curve: the charge at landing, or when the battery failed.
function End({ place, flight }: { place: Place; flight: ChargeFlight }) {
  const tone = `tone-${toneOf(flight.outcome)}`;
  const x = place.x(flight.end_s / 60);
  if (flight.landing_soc_percent != null)
    return (
      <g class={tone}>
        <circle class="dot" cx={place.x(flight.duration_s / 60)} cy={place.y(flight.landing_soc_percent)} r="5" />
        <text class="halo strong" x={place.x(flight.duration_s / 60) + 9} y={place.y(flight.landing_soc_percent) + 4}>{quantity(flight.landing_soc_percent, 0, "%")}</text>
      </g>
    );
  const last = flight.curve.soc_percent[nearest(flight.curve.time_s, flight.end_s)] ?? 0;
  const y = place.y(last);
  const top = place.y(place.right - place.left > 420 ? 52 : 78);
  const is_late = x - place.left > 170;
  return (
    <g class={tone}>
      <line class="failed" x1={x} x2={place.x(flight.duration_s / 60)} y1={y} y2={y} />
      <line class="fall" x1={x} x2={x} y1={top + 6} y2={y} />
      <circle class="dot" cx={x} cy={y} r="6" />
      <text class="halo strong" x={is_late ? x + 12 : x - 12} y={top} text-anchor={is_late ? "end" : "start"}>
        {last < 1 ? "empty" : "fails"} at {duration(flight.end_s)}
      </text>
    </g>
  );
}

/// The value of the curve under the pointer.
function Pointed({ place, curve, time_s }: { place: Place; curve: ChargeCurve; time_s: number }) {
  const i = nearest(curve.time_s, time_s);
  const soc = curve.soc_percent[i];
  if (soc == null) return null;
  const [x, y] = [place.x((curve.time_s[i] as number) / 60), place.y(soc)];
  const is_right = x > (place.left + place.right) / 2;
  return (
    <g class="tone-ink pointed">
      <line x1={x} x2={x} y1={place.top} y2={place.bottom} />
      <circle class="dot" cx={x} cy={y} r="4" />
      <text class="halo strong" x={is_right ? x - 8 : x + 8} y={Math.max(place.top + 12, y - 12)} text-anchor={is_right ? "end" : "start"}>
        {quantity(soc, 1, "%")} at {duration(curve.time_s[i])}
      </text>
    </g>
  );
}

interface ChargeChartProps {
  flight: ChargeFlight;
  height?: number;
  /// Curves to compare with, drawn thin.
  others?: ChargeCurve[];
  /// One of them that is named.
  beside?: ChargeCurve;
  /// The time since lift-off under the pointer, for what is linked with the chart.
  onTime?: (time_s: number | null) => void;
}

/// The curve of one flight.
export function ChargeChart({ flight, height = 280, others = [], beside, onTime }: ChargeChartProps) {
  const [time_s, setTime] = useState<number | null>(null);
  const { band, phases = [] } = flight;
  const point = (at: number | null) => {
    setTime(at == null ? null : at * 60);
    onTime?.(at == null ? null : at * 60);
  };
  return (
    <>
      <Chart x={timeAxis(flight.duration_s, 8)} y={charge} height={height} aside={46} strip={phases.length > 0 ? 14 : 0} description={describe(flight)} onPoint={point}>
        {(place) => (
          <>
            {others.map((curve) => <path class="line other" d={lineOf(place, minutes(curve.time_s), curve.soc_percent)} />)}
            {band && <path class="band tone-ink" d={areaOf(place, minutes(band.time_s), band.low_percent, band.high_percent)} />}
            <Reserve place={place} percent={flight.reserve_soc_percent} />
            {beside && <path class="line beside tone-cruise" d={lineOf(place, minutes(beside.time_s), beside.soc_percent)} />}
            <path class="line tone-ink" d={lineOf(place, minutes(flight.curve.time_s), flight.curve.soc_percent)} />
            <Phases place={place} phases={phases} />
            <End place={place} flight={flight} />
            {time_s != null && <Pointed place={place} curve={flight.curve} time_s={time_s} />}
          </>
        )}
      </Chart>
      {(phases.length > 0 || band) && (
        <p class="chart-key">
          {phases.map(({ phase }) => <span class={`tone-${phase_tones[phase]}`}><i class="key-block" /> {phase_words[phase]}</span>)}
          {band && <span><i class="key-block shaded" /> 90 of 100 flights</span>}
        </p>
      )}
    </>
  );
}

/// The curve as small as a word.
export function Sparkline({ mission }: { mission: MissionDocument }) {
  const { curve, summary, landing_soc_percent } = mission;
  const [width, height] = [132, 34];
  const place = {
    x: (time: number) => 2 + (time / summary.duration_s) * (width - 9), y: (soc: number) => height - 4 - (soc / 100) * (height - 8),
    left: 2, right: width - 7, top: 4, bottom: height - 4,
  };
  const step = Math.ceil(curve.time_s.length / 60);
  const thinned = curve.time_s.map((_, i) => i).filter((i) => i % step === 0 && (curve.time_s[i] as number) <= mission.end_s);
  return (
    <svg class="spark-charge" viewBox={`0 0 ${width} ${height}`} width={width} height={height} aria-hidden="true">
      <Reserve place={place} percent={summary.reserve_soc_percent} wide={false} />
      <path class="line tone-ink" d={lineOf(place, thinned.map((i) => curve.time_s[i] as number), thinned.map((i) => curve.soc_percent[i] ?? null))} />
      <circle class={`dot tone-${toneOf(mission.outcome)}`} cx={place.x(mission.end_s)} cy={place.y(landing_soc_percent ?? 0)} r="4" />
    </svg>
  );
}

const shortened = (title: string, letters: number) => (title.length > letters ? `${title.slice(0, letters - 1)}…` : title);

/// The curves of all missions, with their names at the ends.
export function AllCharges({ missions, selected, onSelect }: { missions: MissionDocument[]; selected: number; onSelect: (mission: number) => void }) {
  const duration_s = Math.max(...missions.map(({ summary }) => summary.duration_s));
  const reserves = [...new Set(missions.map(({ summary }) => summary.reserve_soc_percent))].filter((percent) => percent > 0);
  const height = Math.max(300, 100 + 19 * missions.length);
  const words = missions.map(({ title, landing_soc_percent: soc }) => `${title}: ${soc == null ? "fails" : quantity(soc, 1, "%")}`).join("; ");
  const is_wide = typeof innerWidth === "undefined" || innerWidth > 820;
  return (
    <Chart x={timeAxis(duration_s, is_wide ? 12 : 5)} y={charge} height={height} aside={is_wide ? 236 : 136} description={`State of charge of all missions at landing. ${words}.`}>
      {(place) => {
        const ends = missions.map((mission) => place.y(mission.landing_soc_percent ?? 0));
        const labels = spread(ends, 19, place.top, place.bottom + 4);
        const reserve_words = spread(reserves.map((percent) => place.y(percent) - 5), 14, place.top, place.bottom - 4);
        const to = place.right + 22;
        return (
          <>
            {reserves.map((percent, i) => <Reserve place={place} percent={percent} words_at={reserve_words[i]} />)}
            {[...missions].map((mission, i) => ({ mission, i })).reverse().map(({ mission, i }) => (
              <path class={`line ${i === selected ? "chosen tone-ink" : `tone-${toneOf(mission.outcome)}`}`} d={lineOf(place, minutes(mission.curve.time_s), mission.curve.soc_percent)} />
            ))}
            {missions.map((mission, i) => {
              const [x, y, label] = [place.x(mission.end_s / 60), ends[i] as number, labels[i] as number];
              return (
                <g class={`tone-${toneOf(mission.outcome)} named`} onClick={() => onSelect(i)}>
                  <circle class="dot" cx={x} cy={y} r="3.5" />
                  <line class="leader" x1={x + 5} y1={y} x2={to} y2={label} />
                  <text class="strong" x={to + 4} y={label + 4}>
                    {mission.landing_soc_percent == null ? "empty" : quantity(mission.landing_soc_percent, 0, "%")}
                    <tspan class={i === selected ? "" : "plain"}> {shortened(mission.title, is_wide ? 26 : 11)}</tspan>
                  </text>
                </g>
              );
            })}
          </>
        );
      }}
    </Chart>
  );
}
