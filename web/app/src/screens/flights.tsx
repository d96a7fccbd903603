// All flights as a table, one of them as linked plots with its place on a map, and the packs.
import { useCallback, useEffect, useMemo, useState } from "preact/hooks";
import { Card, Command, Facts, Verdict, save } from "../ui/basics";
import { date, distance, duration, number, quantity } from "../ui/format";
import { Icon } from "../ui/icons";
import { TrackMap } from "../ui/map";
import { Plot } from "../ui/plot";
import { Table, type Column } from "../ui/table";
import { numbers, parseCsv, texts, track, type Csv } from "../work/csv";
import type { Pack } from "../work/documents";
import type { Aircraft, LogLine, Project, State } from "../work/project";
import { healthGrade, healthWord, NoLogs } from "./answer";
import { Sparkline } from "./logs";

interface Row {
  aircraft: Aircraft;
  line: LogLine;
}

const columns: Column<Row>[] = [
  {
    head: "Flight",
    cell: ({ aircraft, line }) => (
      <>
        <bdi>{line.flight}</bdi>
        <span class="under">
          {[
            line.flown?.date ? date(line.flown.date) : aircraft.name,
            line.state === "part" ? "in part" : "",
          ].filter(Boolean).join(" · ")}
        </span>
      </>
    ),
    by: ({ line }) => line.flight,
  },
  { head: "Power", cell: ({ line }) => <Sparkline values={line.power} /> },
  {
    head: "In the air",
    cell: ({ line }) => (line.flown ? duration(line.flown.in_air_s) : ""),
    by: ({ line }) => line.flown?.in_air_s,
    numeric: true,
  },
  {
    head: "Energy",
    cell: ({ line }) => (line.flown ? quantity(line.flown.energy_wh, 1, "Wh") : ""),
    by: ({ line }) => line.flown?.energy_wh,
    numeric: true,
  },
  {
    head: "Cruise",
    cell: ({ line }) => (line.flown ? quantity(line.flown.cruise_power_w, 0, "W") : ""),
    by: ({ line }) => line.flown?.cruise_power_w,
    numeric: true,
  },
  {
    head: "Drawn",
    cell: ({ line }) => (line.flown ? quantity(line.flown.charge_ah, 2, "Ah") : ""),
    by: ({ line }) => line.flown?.charge_ah,
    numeric: true,
  },
];

interface FlightData {
  series: Csv;
  phases: {
    name: string;
    from: number;
    to: number;
    power_w: number | null;
    duration_s: number | null;
    energy_wh: number | null;
  }[];
}

async function readFlight(project: Project, { aircraft, line }: Row): Promise<FlightData> {
  const [series, table] = await Promise.all([
    project.series(aircraft.folder, line.flight),
    project.text(`${aircraft.folder}/flights/${line.flight}.phases.csv`).then(parseCsv),
  ]);
  const [from, to, power, time, energy] = [
    "start_s",
    "end_s",
    "mean_power_w",
    "duration_s",
    "energy_wh",
  ].map((name) => numbers(table, name));
  const phases = texts(table, "phase").map((name, i) => ({
    name,
    from: from?.[i] ?? 0,
    to: to?.[i] ?? 0,
    power_w: power?.[i] ?? null,
    duration_s: time?.[i] ?? null,
    energy_wh: energy?.[i] ?? null,
  }));
  return { series, phases };
}

function useFlight(project: Project, row: Row | undefined): FlightData | string | null {
  const [data, setData] = useState<FlightData | string | null>(null);
  useEffect(() => {
    if (!row) return;
    let is_wanted = true;
    readFlight(project, row).then(
      (found) => is_wanted && setData(found),
      (error) => is_wanted && setData(String(error)),
    );
    return () => {
      is_wanted = false;
    };
  }, [row?.line.flight, row?.aircraft.folder]);
  return data;
}

const shown_tracks = [
  { column: "power_w", title: "Power [W]", unit: "W", decimals: 0, colour: "ink" },
  { column: "voltage_v", title: "Voltage [V]", unit: "V", decimals: 1, colour: "cruise" },
  { column: "current_a", title: "Current [A]", unit: "A", decimals: 1, colour: "take-off" },
  { column: "altitude_m", title: "Altitude [m]", unit: "m", decimals: 0, colour: "landing" },
  { column: "throttle_percent", title: "Throttle [%]", unit: "%", decimals: 0, colour: "ink2" },
];
const phase_colours: Record<string, string> = { takeoff: "take-off", cruise: "cruise", landing: "landing" };
const phase_words: Record<string, string> = { takeoff: "Take-off", cruise: "Cruise", landing: "Landing" };

/// The last index of sorted values that is not after one.
function before(values: number[], value: number): number {
  let [low, high] = [0, values.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((values[middle] as number) <= value) low = middle + 1;
    else high = middle;
  }
  return Math.max(low - 1, 0);
}

function usePlots(data: FlightData) {
  return useMemo(() => {
    const start = data.phases[0]?.from ?? 0;
    const minutes = (seconds: number) => (seconds - start) / 60;
    const plots = shown_tracks
      .map((one) => ({ ...one, ...track(data.series, one.column) }))
      .filter((one) => one.x.length > 1)
      .map((one) => ({ ...one, x: one.x.map(minutes), lines: [{ name: one.title, colour: one.colour, y: one.y }] }));
    const stripes = data.phases.map((phase) => ({
      from: minutes(phase.from),
      to: minutes(phase.to),
      colour: phase_colours[phase.name] ?? "cruise",
    }));
    const latitude = track(data.series, "latitude_deg");
    const longitude = track(data.series, "longitude_deg");
    const places = latitude.x.map((time, i): [number, number] => [
      latitude.y[i] as number,
      longitude.y[before(longitude.x, time)] as number,
    ]);
    const ends = plots.flatMap((plot) => [plot.x[0] as number, plot.x[plot.x.length - 1] as number]);
    const x_range: [number, number] = [Math.min(...ends), Math.max(...ends)];
    return {
      plots,
      stripes,
      x_range,
      place_times: latitude.x.map(minutes),
      places: longitude.x.length > 0 ? places : [],
    };
  }, [data]);
}

function FlightPlots({ data, row }: { data: FlightData; row: Row }) {
  const { plots, stripes, x_range, place_times, places } = usePlots(data);
  const [at, setAt] = useState<number | null>(null);
  const first = plots[0];
  const onCursor = useCallback(
    (index: number | null) => setAt(index == null ? null : (first?.x[index] ?? null)),
    [first],
  );
  const tracks = useMemo(() => [{ name: row.line.flight, colour: "cruise", places }], [places]);
  const spots = useMemo(
    () => (places.length > 0
      ? [
        { name: "first place", colour: "take-off", place: places[0] as [number, number] },
        { name: "last place", colour: "landing", place: places[places.length - 1] as [number, number] },
      ]
      : []),
    [places],
  );
  return (
    <div class="flight">
      <div class="flight-plots">
        {plots.map((plot, i) => (
          <div class="flight-plot">
            <Plot
              x={plot.x}
              lines={plot.lines}
              stripes={stripes}
              x_range={x_range}
              group={`flight-${row.line.flight}`}
              legend={false}
              x_axis={i === plots.length - 1}
              x_title="Time since lift-off [min]"
              y_title={plot.title}
              height={i === plots.length - 1 ? 140 : 100}
              description={`${plot.title} over the time of ${row.line.flight}`}
              onCursor={i === 0 ? onCursor : undefined}
            />
            <output class="at-cursor">
              {at != null ? quantity(plot.lines[0]?.y[before(plot.x, at)], plot.decimals, plot.unit) : ""}
            </output>
          </div>
        ))}
        {plots.length === 0 && <p>The log has none of power, voltage, current, height and throttle.</p>}
      </div>
      <div class="flight-side">
        {places.length > 1 ? (
          <TrackMap
            tracks={tracks}
            spots={spots}
            cursor={at != null ? places[before(place_times, at)] : null}
            height={240}
            description={`The way of ${row.line.flight}, north at the top.`}
          />
        ) : (
          <p class="soft">The log has no position.</p>
        )}
        <Facts rows={[
          ...data.phases.map((phase): [string, string] => [
            phase_words[phase.name] ?? phase.name,
            `${quantity(phase.power_w, 0, "W")}, ${duration(phase.duration_s)}, ${quantity(phase.energy_wh, 2, "Wh")}`,
          ]),
          [
            "Used",
            row.line.flown
              ? `${quantity(row.line.flown.energy_wh, 1, "Wh")}, ${quantity(row.line.flown.charge_ah, 2, "Ah")}`
              : null,
          ],
          ["Way", row.line.flown?.distance_m != null ? distance(row.line.flown.distance_m) : null],
          [
            "Resistance",
            row.line.flown?.resistance_ohm != null ? quantity(1000 * row.line.flown.resistance_ohm, 0, "mΩ") : null,
          ],
        ]} />
        {row.line.reason && <p class="small">{row.line.reason}</p>}
      </div>
    </div>
  );
}

function FlightCard({ project, row }: { project: Project; row: Row }) {
  const data = useFlight(project, row);
  return (
    <Card
      title={`${row.aircraft.name}, ${row.line.flown?.date ? date(row.line.flown.date) : row.line.flight}`}
      aside="drag to zoom, double-click for all"
    >
      {data == null ? <p>Opening</p> : typeof data === "string" ? <p>{data}</p> : <FlightPlots data={data} row={row} />}
    </Card>
  );
}

function packFacts(pack: Pack): [string, string | null][] {
  const { resistance_ohm, resistance_change_percent: change, capacity_ah, capacity_ah_interval_95: interval } = pack;
  const changed = change != null ? `, ${number(change, 0)} %` : "";
  const of_label = pack.label_capacity_ah != null ? ` of ${number(pack.label_capacity_ah, 1)}` : "";
  return [
    ["Resistance", resistance_ohm != null ? `${quantity(1000 * resistance_ohm, 0, "mΩ")}${changed}` : "unknown"],
    ["Capacity", capacity_ah != null ? `${quantity(capacity_ah, 1, "Ah")}${of_label}` : "unknown"],
    ["in 95 %", interval ? `${number(interval.low, 1)} to ${quantity(interval.high, 1, "Ah")}` : null],
  ];
}

function packHistory(pack: Pack, aircraft: Aircraft): string {
  const flights = pack.flights === 1 ? "1 flight" : `${pack.flights} flights`;
  const cycles = pack.cycles != null ? `${number(pack.cycles, 0)} cycles` : "";
  const days = pack.first ? `${date(pack.first)}${pack.last !== pack.first ? ` to ${date(pack.last)}` : ""}` : "";
  return [aircraft.name, flights, cycles, days].filter(Boolean).join(" · ");
}

function PackCard({ pack, aircraft }: { pack: Pack; aircraft: Aircraft }) {
  const grade = healthGrade[pack.health] ?? "none";
  return (
    <section class={`card pack ${grade}`} aria-label={`Pack ${pack.pack} of ${aircraft.name}`}>
      <header class="card-head">
        <h3>{pack.pack === "unnamed" ? `${aircraft.name}, unnamed pack` : pack.pack}</h3>
        <Verdict grade={grade}>{healthWord[pack.health] ?? pack.health}</Verdict>
      </header>
      <p class="soft">{packHistory(pack, aircraft)}</p>
      <Facts rows={packFacts(pack)} />
      <p class="small">{pack.reason}</p>
    </section>
  );
}

const worst_first = ["retire", "watch", "unknown", "healthy"];

function Packs({ state }: { state: State }) {
  const packs = state.aircraft.flatMap((aircraft) => (aircraft.now?.answer.packs ?? []).map((pack) => ({
    pack,
    aircraft,
  })));
  if (packs.length === 0) return null;
  const unanswered = state.aircraft.filter((aircraft) => !aircraft.now).length;
  packs.sort((a, b) => worst_first.indexOf(a.pack.health) - worst_first.indexOf(b.pack.health));
  return (
    <>
      <h2 class="section">Packs, worst first</h2>
      {unanswered > 0 && (
        <p class="soft">
          Without those of {unanswered === 1 ? "1 aircraft" : `${unanswered} aircraft`}: choose each under Answer, which
          shows its packs.
        </p>
      )}
      <div class="packs">
        {packs.map((one) => (
          <PackCard pack={one.pack} aircraft={one.aircraft} />
        ))}
      </div>
    </>
  );
}

function SaveTable({ project, state }: { project: Project; state: State }) {
  const saveAll = async () => {
    for (const aircraft of state.aircraft) save(
      `flights-${aircraft.id}.csv`,
      await project.text(`${aircraft.folder}/flights.csv`),
      "text/csv",
    );
  };
  return (
    <button type="button" class="quiet" onClick={() => void saveAll()}>
      <Icon name="save" /> CSV
    </button>
  );
}

/// The command of one aircraft's flights and packs.
function trendsCommand(project: Project, aircraft: Aircraft): string {
  return `flightwatt trends ${project.inputsShown(aircraft.logs, aircraft)} --ledger packs.csv`;
}

export function FlightsScreen({ project, state }: { project: Project; state: State }) {
  const rows = useMemo(
    () => state.aircraft.flatMap((aircraft) => aircraft.logs.map((line) => ({ aircraft, line }))),
    [state.aircraft],
  );
  const [selected, setSelected] = useState("");
  if (rows.length === 0) return <NoLogs project={project} />;
  const row = rows.find((one) => one.line.path === selected) ?? rows[0];
  const packs = state.aircraft.flatMap((one) => one.now?.answer.packs ?? []);
  const count = (health: string, words: string) => {
    const found = packs.filter((pack) => pack.health === health).length;
    return found > 0 ? [`${found} ${words}`] : [];
  };
  const answered = state.aircraft.filter((one) => one.now).length;
  const of_some = answered < state.aircraft.length ? ` of ${answered} aircraft` : "";
  const verdicts = [...count("retire", "to retire"), ...count("watch", "to watch")].join(", ");
  return (
    <>
      <header class="screen-head">
        <div>
          <p class="over">{state.aircraft.length === 1 ? row?.aircraft.name : `${state.aircraft.length} aircraft`}</p>
          <h1>
            {rows.length === 1 ? "1 flight" : `${rows.length} flights`}
            {packs.length > 0 ? `, ${packs.length === 1 ? "1 pack" : `${packs.length} packs`}${of_some}` : ""}
            {verdicts && `: ${verdicts}`}
          </h1>
        </div>
        <div class="screen-buttons">
          <SaveTable project={project} state={state} />
        </div>
      </header>
      <div class="flights">
        <section class="card list" aria-label="Flights">
          <Table
            caption="Flights"
            columns={columns}
            rows={rows}
            page={12}
            selected={row}
            onSelect={(one) => setSelected(one.line.path)}
            words={({ aircraft, line }) => `${line.flight} ${line.path} ${aircraft.name} ${line.flown?.date ?? ""}`}
          />
        </section>
        {row && <FlightCard key={row.line.path} project={project} row={row} />}
      </div>
      <Packs state={state} />
      {row && <Command line={trendsCommand(project, row.aircraft)} />}
    </>
  );
}
