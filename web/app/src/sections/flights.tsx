// The flights: a table that sorts and filters, the selected flight beside it, and what is not used.
import { useMemo } from "preact/hooks";
import type { Exclusion, FlightRow, SortieRow } from "../documents";
import { Verdict, type Grade } from "../ui/basics";
import { distance, duration, energy, naturally, number, power, quantity } from "../ui/format";
import { Opened } from "../ui/opened";
import { Table, type Column } from "../ui/table";
import { FlightCard } from "./flight";
import { plural } from "./words";

/// A row of the table: a flight of a log; a log without flights has one row too.
export interface Row {
  /// The number of the log in the document.
  index: number;
  log: FlightRow;
  sortie: SortieRow | null;
}

/// The rows in the order of their names, "flight 10" after "flight 9".
export function rowsOf(flights: FlightRow[]): Row[] {
  const rows = flights.flatMap((log, index): Row[] => (log.sorties.length > 0 ? log.sorties.map((sortie) => ({ index, log, sortie })) : [{ index, log, sortie: null }]));
  return rows.sort((a, b) => naturally(a.log.name, b.log.name));
}

const used_words: Record<FlightRow["used"], { grade: Grade; words: string }> = {
  all: { grade: "good", words: "Yes" },
  "in part": { grade: "doubt", words: "In part" },
  no: { grade: "none", words: "No" },
};
const nameOf = ({ log, sortie }: Row) => (log.sorties.length > 1 && sortie ? `${log.name}, flight ${sortie.sortie}` : log.name);

function columnsOf(severalAircraft: boolean): Column<Row>[] {
  return [
    {
      head: "Flight",
      cell: (row) => <span><bdi>{nameOf(row)}</bdi><span class="small-under">{[row.log.date, severalAircraft && row.log.aircraft].filter(Boolean).join(" · ")}</span></span>,
      by: nameOf,
    },
    { head: "In the air", cell: ({ sortie }) => sortie && duration(sortie.in_air_s), by: ({ sortie }) => sortie?.in_air_s, numeric: true },
    { head: "Energy", cell: ({ sortie }) => sortie?.energy_wh != null && energy(sortie.energy_wh), by: ({ sortie }) => sortie?.energy_wh, numeric: true },
    { head: "Cruise", cell: ({ sortie }) => sortie?.mean_power_w.cruise != null && power(sortie.mean_power_w.cruise), by: ({ sortie }) => sortie?.mean_power_w.cruise, numeric: true },
    { head: "Used", cell: ({ log }) => <Verdict grade={used_words[log.used].grade}>{used_words[log.used].words}</Verdict>, by: ({ log }) => log.used },
  ];
}

const phaseColumn = (head: string, of: (sortie: SortieRow) => number | null, show: (value: number) => string): Column<Row> => ({
  head, numeric: true,
  cell: ({ sortie }) => { const value = sortie ? of(sortie) : null; return value == null ? "" : show(value); },
  by: ({ sortie }) => (sortie ? of(sortie) : null),
});

/// All numbers of the flights.
const all_columns: Column<Row>[] = [
  { head: "Flight", cell: nameOf, by: nameOf },
  { head: "Date (UTC)", cell: ({ log }) => log.date, by: ({ log }) => log.date || null },
  phaseColumn("In the air", (of) => of.in_air_s, duration),
  phaseColumn("Cruise", (of) => of.duration_s.cruise, duration),
  phaseColumn("Distance", (of) => of.distance_m, distance),
  phaseColumn("Through the air", (of) => of.air_distance_m, distance),
  phaseColumn("Height", (of) => of.height_m, (value) => quantity(value, 0, "m")),
  phaseColumn("Airspeed", (of) => of.cruise_airspeed_m_per_s, (value) => quantity(value, 1, "m/s")),
  phaseColumn("Take-off power", (of) => of.mean_power_w.takeoff, power),
  phaseColumn("Cruise power", (of) => of.mean_power_w.cruise, power),
  phaseColumn("Landing power", (of) => of.mean_power_w.landing, power),
  phaseColumn("Energy", (of) => of.energy_wh, energy),
  phaseColumn("By the autopilot", (of) => of.counter_energy_wh, energy),
  phaseColumn("Difference", (of) => of.energy_closure_percent, (value) => `${value > 0 ? "+" : ""}${number(value, 2)} %`),
  { head: "For the model", cell: ({ log }) => log.used, by: ({ log }) => log.used },
];

/// Columns that no row has a value for are left out.
const known = (columns: Column<Row>[], rows: Row[]) => columns.filter(({ by }) => !by || rows.some((row) => by(row) != null));

function NotUsed({ exclusions }: { exclusions: Exclusion[] }) {
  return (
    <section class="card not-used" id="not-used" aria-label="Not used">
      <h3>Not used</h3>
      <ul>
        {exclusions.map(({ flights, number: count, not_used, reason }) => (
          <li><b><bdi>{flights.join(", ")}</bdi></b>{count > flights.length && ` (${count})`}, {not_used}: {reason}</li>
        ))}
      </ul>
    </section>
  );
}

interface FlightsProps {
  flights: FlightRow[];
  exclusions: Exclusion[];
  outlines: [number, number][][];
  selected: number;
  onSelect: (flight: number) => void;
}

export function Flights({ flights, exclusions, outlines, selected, onSelect }: FlightsProps) {
  const rows = useMemo(() => rowsOf(flights), [flights]);
  const columns = useMemo(() => known(columnsOf(new Set(flights.map(({ aircraft }) => aircraft).filter(Boolean)).size > 1), rows), [rows]);
  const flight = flights[selected];
  const select = (row: Row) => {
    onSelect(row.index);
    // Below the list on phones: what was asked for is shown.
    if (innerWidth <= 820) setTimeout(() => document.getElementById("flight")?.scrollIntoView({ block: "start" }));
  };
  return (
    <>
      <div class="flights-parts">
        <section class="card flush flights-table" aria-label="All flights">
          <Table caption="Flights" columns={columns} rows={rows} page={12} words={({ log }) => `${log.name} ${log.title} ${log.aircraft} ${log.used} ${log.date}`}
            selected={rows.find(({ index }) => index === selected)} onSelect={select} />
        </section>
        {flight && <FlightCard key={selected} flight={flight} outlines={outlines} />}
      </div>
      {exclusions.length > 0 && <NotUsed exclusions={exclusions} />}
      <Opened title="All numbers of the flights" aside={plural(rows.length, "flight")}>
        {() => (
          <>
            <p class="soft">Power is the mean of each phase; distance is over ground, height above the ground at lift-off. Difference: energy less that of the autopilot's counter.</p>
            <Table caption="All numbers of the flights" columns={known(all_columns, rows)} rows={rows} words={({ log }) => `${log.name} ${log.title} ${log.aircraft} ${log.used} ${log.date}`} />
          </>
        )}
      </Opened>
    </>
  );
}
