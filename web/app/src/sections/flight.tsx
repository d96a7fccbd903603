// One flight: its power, voltage, current, height and throttle over one time, its phases, and its way on a map.
import { useEffect, useMemo, useState } from "preact/hooks";
import { detailOf, placesOf, type FlightDetail, type FlightRow } from "../documents";
import { Facts, Verdict } from "../ui/basics";
import { distance, duration, energy, number, power, quantity } from "../ui/format";
import { TrackMap, type Spot, type Track } from "../ui/map";
import { Opened } from "../ui/opened";
import { Plot, type Line } from "../ui/plot";
import { nearest } from "./charge_chart";
import { capital, phase_names, phase_tones, phase_words } from "./words";

type Places = [number, number][];

interface FlightPlot {
  title: string;
  unit: string;
  decimals: number;
  x: number[];
  lines: Line[];
}

/// The plots of what the log has, over minutes since the first lift-off.
export function plotsOf(detail: FlightDetail): FlightPlot[] {
  const start = detail.phases[0]?.start_s ?? 0;
  const plot = (title: string, unit: string, decimals: number, track: { time_s: number[] } | null, lines: (Line | null | false)[]): FlightPlot | null =>
    track && track.time_s.length > 1 ? { title, unit, decimals, x: track.time_s.map((time) => (time - start) / 60), lines: lines.filter((line): line is Line => Boolean(line)) } : null;
  const { power: watts, voltage, current, altitude, throttle, airspeed } = detail;
  return [
    plot("Power [W]", "W", 1, watts, [
      watts && { name: "measured", colour: "ink", y: watts.power_w },
      watts?.model_power_w != null && { name: "model", colour: "alarm", y: watts.model_power_w },
    ]),
    plot("Voltage [V]", "V", 2, voltage, [voltage && { name: "voltage", colour: "cruise", y: voltage.voltage_v }]),
    plot("Current [A]", "A", 1, current, [current && { name: "current", colour: "take-off", y: current.current_a }]),
    plot("Altitude [m]", "m", 0, altitude, [altitude && { name: "altitude", colour: "landing", y: altitude.altitude_m }]),
    plot("Airspeed [m/s]", "m/s", 1, airspeed, [airspeed && { name: "airspeed", colour: "link", y: airspeed.airspeed_m_per_s }]),
    plot("Throttle [%]", "%", 0, throttle, [throttle && { name: "throttle", colour: "ink2", y: throttle.throttle_percent }]),
  ].filter((one): one is FlightPlot => one != null);
}

/// Opens the details of a flight: null until they are there, a text if they cannot be opened.
function useDetail(flight: FlightRow): FlightDetail | string | null {
  const [detail, setDetail] = useState<FlightDetail | string | null>(typeof flight.detail === "string" ? null : flight.detail);
  useEffect(() => {
    if (typeof flight.detail !== "string") return;
    let is_wanted = true;
    detailOf(flight).then(
      (found) => is_wanted && setDetail(found),
      (error: Error) => is_wanted && setDetail(error.message.includes("browser") ? error.message : "The details of this flight are damaged: write the page again."),
    );
    return () => {
      is_wanted = false;
    };
  }, [flight]);
  return detail;
}

function Plots({ detail, plots, at, onAt }: { detail: FlightDetail; plots: FlightPlot[]; at: number | null; onAt: (minutes: number | null) => void }) {
  const [asked, setAsked] = useState<number | null>(null);
  const start = detail.phases[0]?.start_s ?? 0;
  const stripes = useMemo(() => detail.phases.map(({ phase, start_s, end_s }) => ({ from: (start_s - start) / 60, to: (end_s - start) / 60, colour: phase_tones[phase] })), [detail]);
  const x_range = useMemo<[number, number]>(() => [Math.min(...plots.map(({ x }) => x[0] as number)), Math.max(...plots.map(({ x }) => x[x.length - 1] as number))], [plots]);
  return (
    <div class="flight-plots-column">
      <p class="chart-key">
        {phase_names.filter((name) => detail.phases.some(({ phase }) => phase === name)).map((name) => <span class={`tone-${phase_tones[name]}`}><i class="key-block" /> {phase_words[name]}</span>)}
        {detail.power?.model_power_w && <span><i class="key-line tone-alarm" /> model: each phase's curve, scaled to its duration</span>}
        <span class="no-print">drag to zoom, double-click for all</span>
      </p>
      {plots.map((plot, i) => {
        const index = at == null ? null : nearest(plot.x, at);
        const last = i === plots.length - 1;
        return (
          <div class="flight-plot-row">
            <p class="flight-plot-head">
              <span>{plot.title}</span>
              <output aria-label={`${plot.title} at the cursor`}>{index == null ? "" : plot.lines[0]?.y[index] == null ? "unknown" : quantity(plot.lines[0]?.y[index], plot.decimals, plot.unit)}</output>
            </p>
            <Plot x={plot.x} lines={plot.lines} stripes={stripes} group="flight" legend={false} x_axis={last} x_range={x_range} x_title="Minutes since lift-off" y_title=""
              height={(i === 0 ? 120 : 72) + (last ? 44 : 0)} at={i === 0 ? asked : undefined}
              onCursor={i === 0 ? (found) => onAt(found == null ? null : (plot.x[found] ?? null)) : undefined}
              description={`${plot.title} over the time of the flight, with its phases.`} />
          </div>
        );
      })}
      <label class="flight-cursor">
        <span>Cursor</span>
        <input type="range" min={x_range[0]} max={x_range[1]} step={(x_range[1] - x_range[0]) / 200} value={at ?? x_range[0]} aria-label="Time of the cursor"
          aria-valuetext={at == null ? "not shown" : `${duration(at * 60)} after lift-off`} onInput={(event) => setAsked(event.currentTarget.valueAsNumber)} />
        <output>{at == null ? "" : duration(at * 60)}</output>
      </label>
    </div>
  );
}

function trackOf(detail: FlightDetail, outlines: [number, number][][]): { tracks: Track[]; spots: Spot[]; times: number[]; places: Places } {
  const lines = detail.track?.lines ?? [];
  const has_places = lines.some(({ latitude_deg }) => latitude_deg != null);
  const drawn = lines.map((line) => ({ line, places: placesOf(line) })).filter(({ places }) => places.length > 1);
  const tracks: Track[] = drawn.map(({ line, places }) => ({ name: phase_words[line.phase], colour: phase_tones[line.phase], places }));
  if (has_places) tracks.unshift(...outlines.map((ring) => ({ name: "outline", colour: "edge", places: ring.map(([longitude, latitude]): [number, number] => [latitude, longitude]), weight: 1.5 })));
  const spots: Spot[] = (detail.track?.marks ?? []).map((mark) => ({
    name: mark.text, colour: "ink", is_named: true,
    place: placesOf({ east_m: [mark.east_m], north_m: [mark.north_m], latitude_deg: mark.latitude_deg == null ? null : [mark.latitude_deg], longitude_deg: mark.longitude_deg == null ? null : [mark.longitude_deg] })[0] as [number, number],
  }));
  const [first, last] = [drawn[0]?.places[0], drawn[drawn.length - 1]?.places.slice(-1)[0]];
  if (first) spots.push({ name: "lift-off", colour: "take-off", place: first });
  if (last) spots.push({ name: "touchdown", colour: "landing", place: last });
  return { tracks, spots, times: drawn.flatMap(({ line }) => line.time_s), places: drawn.flatMap(({ places }) => places) };
}

function Way({ flight, detail, outlines, at }: { flight: FlightRow; detail: FlightDetail; outlines: [number, number][][]; at: number | null }) {
  const { tracks, spots, times, places } = useMemo(() => trackOf(detail, outlines), [detail, outlines]);
  const start = detail.phases[0]?.start_s ?? 0;
  if (tracks.length === 0) return <p class="soft">The log has no position.</p>;
  const time_s = at == null ? null : start + at * 60;
  const is_flown = time_s != null && time_s >= (times[0] as number) - 5 && time_s <= (times[times.length - 1] as number) + 5;
  return (
    <>
      <TrackMap tracks={tracks} spots={spots} height={300} cursor={is_flown ? places[nearest(times, time_s)] : null}
        description={`Ground track of ${flight.title}, north at the top.${detail.track?.marks.length ? ` ${detail.track.marks.map(({ text }) => text).join("; ")}.` : ""}`} />
      <p class="soft">{[detail.track?.text, "north at the top"].filter(Boolean).join("; ")}</p>
    </>
  );
}

function SortieFacts({ flight, detail }: { flight: FlightRow; detail: FlightDetail | null }) {
  return (
    <>
      {flight.sorties.map((sortie) => (
        <>
          {flight.sorties.length > 1 && <h4>Flight {sortie.sortie} of the log</h4>}
          <Facts rows={[
            ...phase_names.map((phase): [string, string | null] => [
              capital(phase_words[phase]),
              sortie.mean_power_w[phase] == null ? null : `${power(sortie.mean_power_w[phase])}, ${duration(sortie.duration_s[phase])}`,
            ]),
            ["In the air", duration(sortie.in_air_s)],
            ["Energy", sortie.energy_wh != null && energy(sortie.energy_wh)],
            ["By the autopilot's counter", sortie.counter_energy_wh != null && `${energy(sortie.counter_energy_wh)}${sortie.energy_closure_percent == null ? "" : `, ${sortie.energy_closure_percent > 0 ? "+" : ""}${number(sortie.energy_closure_percent, 2)} %`}`],
            ["Distance over ground", sortie.distance_m != null && distance(sortie.distance_m)],
            ["Through the air", sortie.air_distance_m != null && sortie.air_distance_m !== sortie.distance_m && distance(sortie.air_distance_m)],
            ["Height", sortie.height_m != null && quantity(sortie.height_m, 0, "m")],
            ["Airspeed in cruise", sortie.cruise_airspeed_m_per_s != null && quantity(sortie.cruise_airspeed_m_per_s, 1, "m/s")],
          ]} />
        </>
      ))}
      {detail && detail.circuits.length > 0 && (
        <Facts rows={detail.circuits.map(({ name, energy_wh, percent }): [string, string] => [name, `${energy(energy_wh)}, ${quantity(percent, 0, "%")}`])} />
      )}
    </>
  );
}

function Evidence({ detail }: { detail: FlightDetail }) {
  return (
    <Opened title="How the phases were found">
      {() => (
        <dl class="evidence">
          {detail.edges.map(({ time_s, name, evidence }) => (
            <div><dt>{capital(name)}, at {quantity(time_s, 1, "s")} of the log</dt><dd>{evidence}</dd></div>
          ))}
        </dl>
      )}
    </Opened>
  );
}

export function FlightCard({ flight, outlines }: { flight: FlightRow; outlines: [number, number][][] }) {
  const detail = useDetail(flight);
  const [at, setAt] = useState<number | null>(null);
  const opened = detail && typeof detail !== "string" ? detail : null;
  const plots = useMemo(() => (opened ? plotsOf(opened) : []), [opened]);
  return (
    <section class="card flight-card" id="flight" aria-label={`Flight ${flight.name}`}>
      <header class="card-head">
        <h3><bdi>{flight.title}</bdi></h3>
        <span class="aside">{flight.title !== flight.name && <bdi>{flight.name}</bdi>}</span>
      </header>
      {flight.text && <p class="soft">{flight.text}</p>}
      {flight.rejected && <p><Verdict grade="none">Not used</Verdict>: {flight.rejected}</p>}
      {flight.warnings.map((warning) => <p><Verdict grade="doubt">Warning</Verdict>: {warning}</p>)}
      {typeof detail === "string" && <p role="alert">{detail}</p>}
      {typeof flight.detail === "string" && detail == null && <p>Opening</p>}
      <div class="flight-parts">
        {opened && plots.length > 0 && <Plots detail={opened} plots={plots} at={at} onAt={setAt} />}
        <div>
          {opened && <Way flight={flight} detail={opened} outlines={outlines} at={at} />}
          <SortieFacts flight={flight} detail={opened} />
        </div>
      </div>
      {flight.notes.length > 0 && <ul class="soft">{flight.notes.map((note) => <li>{note}</li>)}</ul>}
      {opened && <p class="soft">From <bdi>{opened.log}</bdi>{opened.power_source && `; power is ${opened.power_source}`}. Of many samples, the extremes of each pixel column are drawn.</p>}
      {opened && opened.edges.length > 0 && <Evidence detail={opened} />}
    </section>
  );
}
