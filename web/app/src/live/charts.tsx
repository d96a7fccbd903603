// Charts of a flight in the air: solid is flown, dotted predicted, shaded to the high end of the energy. Time is in minutes.
import { areaOf, Chart, lineOf, minuteTicks, type Place, roundTicks } from "../ui/chart";
import { number } from "../ui/format";
import type { LiveFlight, LiveState, Point } from "./flight";
import { reserveText } from "./words";

interface Row {
  t: number;
  value: number;
  /// With the high end of the energy.
  low?: number;
}

interface LiveChartProps {
  id: "charge" | "power" | "altitude";
  title: string;
  unit: string;
  height: number;
  flown: Row[];
  predicted?: Row[];
  flight: LiveFlight;
}

const begin = ({ points, state }: LiveFlight) => state?.lift_off_s ?? points[0]?.t ?? 0;

function rowsOf(flight: LiveFlight, key: keyof Point): Row[] {
  const from = begin(flight);
  return flight.points.flatMap(({ t, [key]: value }) => (value != null && t >= from ? [{ t: (t - from) / 60, value }] : []));
}

/// Returns the means of 10 s.
function means(rows: Row[]): Row[] {
  const bins = new Map<number, { t: number; sum: number; count: number }>();
  for (const { t, value } of rows) {
    const bin = Math.floor(6 * t);
    const last = bins.get(bin);
    bins.set(bin, { t, sum: (last?.sum ?? 0) + value, count: (last?.count ?? 0) + 1 });
  }
  return [...bins.values()].map(({ t, sum, count }) => ({ t, value: sum / count }));
}

function chargeAhead(flight: LiveFlight): Row[] {
  const { time_s = [], soc_percent: soc = [] } = flight.state?.ahead ?? {};
  const last = soc.length - 1;
  if (flight.hasLanded() || last < 0) return [];
  const spread = Math.max(0, (soc[last] as number) - (flight.state?.prediction?.battery?.at_landing_high_energy.soc_percent ?? 0));
  return soc.map((value, i) => ({ t: ((time_s[i] as number) - begin(flight)) / 60, value, low: Math.max(0, value - (i / (last || 1)) * spread) }));
}

/// The last point of a line, with its value.
function End({ place, row, x_end, dy, text }: { place: Place; row: Row; x_end: number; dy: number; text: string }) {
  const [x, y] = [place.x(row.t), place.y(row.value)];
  const is_left = row.t < 0.3 * x_end;
  return (
    <>
      <circle class="dot" cx={x} cy={y} r="5" />
      <text class="halo end" x={x + (is_left ? 8 : -4)} y={y + dy + 5} text-anchor={is_left ? "start" : "end"}>{text}</text>
    </>
  );
}

function Reserve({ place, state }: { place: Place; state: LiveState }) {
  const text = reserveText(state);
  const y = place.y(state.reserve_soc_percent ?? 0);
  return text ? (
    <>
      <line class="reserve" x1={place.left} x2={place.right} y1={y} y2={y} />
      <text x={place.left + 6} y={y + 15}>{text}</text>
    </>
  ) : null;
}

function LiveChart({ id, title, unit, height, flown, predicted = [], flight }: LiveChartProps) {
  const all = [...flown, ...predicted];
  if (all.length < 2) return null;
  const is_charge = id === "charge";
  const x_end = all.reduce((most, { t }) => Math.max(most, t), 1);
  const values = all.map(({ value }) => value);
  const low = id === "altitude" ? Math.min(...values) : 0;
  const range: [number, number] = is_charge ? [0, 100] : [low, low + 1.25 * Math.max(1, Math.max(...values) - low)]; // with room for a label
  const ticks = minuteTicks(x_end, 8);
  const [now, landing] = [flown[flown.length - 1], is_charge ? predicted[predicted.length - 1] : undefined];
  const is_near = now && landing && landing.t - now.t < 0.25 * x_end;
  const now_text = flight.hasLanded() || is_near ? "" : `${id === "power" ? "" : "now "}${number(now?.value, 0)} ${unit}`;
  const dy = ({ value }: Row) => (!is_charge ? -12 : value > 35 ? 17 : (value - 35) * 1.6);
  const line = (place: Place, rows: Row[]) => lineOf(place, rows.map(({ t }) => t), rows.map(({ value }) => value));
  return (
    <div id={id} data-points={all.length}>
      <Chart height={height} aside={22} description={`${id} over time`}
        x={{ title: "", range: [0, x_end], ticks, label: (t) => `${number(t, t % 1 ? 1 : 0)}${t === ticks[ticks.length - 1] ? " min" : ""}` }}
        y={{ title, range, ticks: roundTicks(range, 5) }}>
        {(place) => (
          <>
            {is_charge && <path class="band" d={areaOf(place, predicted.map(({ t }) => t), predicted.map((row) => row.low ?? null), predicted.map(({ value }) => value))} />}
            <path class="line" d={line(place, flown)} />
            <path class={`line predicted ${id}`} d={line(place, predicted)} />
            {is_charge && flight.state && <Reserve place={place} state={flight.state} />}
            {now && <End place={place} row={now} x_end={x_end} dy={dy(now)} text={now_text} />}
            {landing && <End place={place} row={landing} x_end={x_end} dy={dy(landing)} text={`${number(landing.value, 0)} % at landing`} />}
          </>
        )}
      </Chart>
    </div>
  );
}

export function Charts({ flight }: { flight: LiveFlight }) {
  return (
    <>
      <LiveChart id="charge" title="Charge [%]" unit="%" height={254} flown={rowsOf(flight, "soc")} predicted={chargeAhead(flight)} flight={flight} />
      <LiveChart id="power" title="Power [W], mean of 10 s; dotted: expected" unit="W" height={164} flown={means(rowsOf(flight, "power"))}
        predicted={means(rowsOf(flight, "expected"))} flight={flight} />
      <LiveChart id="altitude" title="Altitude [m]" unit="m" height={144} flown={rowsOf(flight, "altitude")} flight={flight} />
    </>
  );
}
