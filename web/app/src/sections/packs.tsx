// The ledger of packs with their health, and how quantities of the flights change over time.
import type { Pack, TrendsDocument } from "../documents";
import { Facts, Verdict } from "../ui/basics";
import { Chart, rangeOf } from "../ui/chart";
import { date, energy, number, quantity } from "../ui/format";
import { capital, health, plural, span } from "./words";

const milliohm = (ohm: number) => number(1000 * ohm, 0);
const signed = (value: number, decimals: number, unit: string) => `${value > 0 ? "+" : ""}${quantity(value, decimals, unit)}`;

export function PackCard({ pack }: { pack: Pack & { text?: string } }) {
  const { grade, words } = health[pack.health] ?? { grade: "none" as const, words: pack.health };
  const resistance = pack.resistance_ohm != null && `${milliohm(pack.resistance_ohm)} mΩ${pack.resistance_ohm_interval_95 ? ` (${span(pack.resistance_ohm_interval_95, milliohm)})` : ""}`;
  const capacity = pack.capacity_ah != null && `${quantity(pack.capacity_ah, 1, "Ah")}${pack.capacity_ah_interval_95 ? ` (${span(pack.capacity_ah_interval_95, (value) => number(value, 1))})` : ""}`;
  return (
    <section class={`card pack-card ${grade}`} aria-label={`Pack ${pack.pack}`}>
      <header class="card-head">
        <h3><bdi>{pack.pack}</bdi></h3>
        <Verdict grade={grade}>{words}</Verdict>
      </header>
      <p class="soft">{[pack.aircraft.join(", "), plural(pack.flights, "flight"), pack.cycles != null && `${number(pack.cycles, 0)} cycles`].filter(Boolean).join(" · ")}</p>
      <Facts rows={[
        ["Resistance", resistance],
        ["its change", pack.resistance_change_percent != null && signed(pack.resistance_change_percent, 0, "%")],
        ["Capacity", capacity],
        ["on its label", pack.label_capacity_ah != null && `${quantity(pack.label_capacity_ah, 1, "Ah")}${pack.capacity_percent_of_label == null ? "" : `, of it ${quantity(pack.capacity_percent_of_label, 0, "%")}`}`],
        ["change of capacity", pack.capacity_change_percent != null && signed(pack.capacity_change_percent, 0, "%")],
        ["Drawn in all", `${energy(pack.energy_wh)}, ${quantity(pack.charge_ah, 1, "Ah")}`],
        ["Full cycles by charge", pack.equivalent_cycles != null && number(pack.equivalent_cycles, 1)],
        ["Partly charged at the start", pack.partly_used > 0 && plural(pack.partly_used, "flight")],
        ["At rest", pack.rest_voltage_v != null && quantity(pack.rest_voltage_v, 2, "V")],
        ["Temperature", pack.temperature_c != null && `${quantity(pack.temperature_c, 0, "°C")}${pack.temperature_of ? ` (${pack.temperature_of})` : ""}`],
        ["Flown", pack.first && (pack.first === pack.last ? date(pack.first) : `${date(pack.first)} to ${date(pack.last)}`)],
      ]} />
      <p>{pack.text || pack.reason}</p>
      {pack.mission_until && <p><b>{capital(pack.mission_until)}</b></p>}
      {pack.may_be_several && <p class="soft">May be several packs: nothing names them.</p>}
    </section>
  );
}

const shortDate = (clock_s: number) => new Date(clock_s * 1000).toLocaleDateString("en-GB", { day: "numeric", month: "short", year: "2-digit", timeZone: "UTC" });

function TrendChart({ trend }: { trend: TrendsDocument["trends"][number] }) {
  const { clock_s, value } = trend.flights;
  const lines = trend.lines ?? [];
  const [first, last] = [Math.min(...clock_s), Math.max(...clock_s)];
  const x_range: [number, number] = first < last ? [first, last] : [first - 43200, last + 43200];
  const ticks = first < last ? [first, (first + last) / 2, last] : [first];
  return (
    <Chart height={190} aside={24} x={{ title: "", range: x_range, ticks, label: shortDate }} y={{ title: capital(trend.title), range: rangeOf([value, ...lines.map((line) => line.value)]) }}
      description={`${capital(trend.title)} of ${plural(value.length, "flight")} of ${trend.aircraft}: ${trend.direction}.`}>
      {(place) => (
        <>
          {lines.map((line, i) => (
            <line class={`line ${i === 0 ? "tone-ink" : "tone-ink3 thin"}`} x1={place.x(line.clock_s[0])} y1={place.y(line.value[0])} x2={place.x(line.clock_s[1])} y2={place.y(line.value[1])} />
          ))}
          {clock_s.map((clock, i) => <circle class="ring tone-cruise" cx={place.x(clock)} cy={place.y(value[i] as number)} r="3.5" />)}
        </>
      )}
    </Chart>
  );
}

export function Packs({ trends, answer }: { trends: TrendsDocument | null; answer: Pack[] }) {
  const packs = trends?.packs.length ? trends.packs : answer;
  const order = ["retire", "watch", "healthy", "unknown"];
  const sorted = [...packs].sort((a, b) => order.indexOf(a.health) - order.indexOf(b.health));
  return (
    <>
      {trends?.text && <p class="soft">{trends.text}</p>}
      <div class="pack-cards">{sorted.map((pack) => <PackCard pack={pack} />)}</div>
      {trends?.notes.map((note) => <p class="soft">{note}</p>)}
      {trends && trends.trends.length > 0 && (
        <div class="trend-cards">
          {trends.trends.map((trend) => (
            <section class="card" aria-label={`Trend of ${trend.title}, ${trend.aircraft}`}>
              <header class="card-head">
                <h3>{capital(trend.title)}</h3>
                <span class="aside">{trend.aircraft}</span>
              </header>
              {trend.flights.value.length > 0 && <TrendChart trend={trend} />}
              <p><b>{capital(trend.direction)}</b></p>
              {trend.change_in_30_days != null && (
                <p class="soft">
                  {signed(trend.change_in_30_days, 2, "")} in 30 days{trend.change_in_30_days_interval_95 && ` (${span(trend.change_in_30_days_interval_95, (value) => number(value, 2))})`}
                </p>
              )}
            </section>
          ))}
        </div>
      )}
    </>
  );
}
