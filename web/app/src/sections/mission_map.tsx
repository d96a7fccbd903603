// The path of a mission on a map, coloured by what is left of the charge, and its elements as a table.
import { useMemo } from "preact/hooks";
import { placesOf, type FlownTrack, type MissionDocument, type MissionPath } from "../documents";
import { distance, duration, number, power, quantity } from "../ui/format";
import { TrackMap, type Place, type Spot, type Track, type Wind } from "../ui/map";
import { Opened } from "../ui/opened";
import { Table, type Column } from "../ui/table";
import { capital } from "./words";

const steps = [80, 60, 40];

/// A name of a colour for a charge: five steps, the last below the reserve.
function toneOf(soc: number | null, reserve: number): string {
  if (soc == null || soc < reserve) return "c5";
  const step = steps.findIndex((one) => soc >= one);
  return `c${step < 0 ? 4 : step + 1}`;
}

const step_words: Record<string, string> = { c1: "80 to 100 % left", c2: "60 to 80 % left", c3: "40 to 60 % left", c4: "below 40 % left", c5: "below the reserve" };

/// Returns the path in pieces of one colour; each begins where the last ended.
export function pieces(path: FlownTrack, reserve: number): Track[] {
  const places = placesOf(path);
  const tracks: Track[] = [];
  for (let i = 0; i < places.length; ++i) {
    const colour = toneOf(path.soc_percent[i] ?? null, reserve);
    let last = tracks[tracks.length - 1];
    const place = places[i] as [number, number];
    if (!last || last.colour !== colour) {
      last?.places.push(place);
      last = { name: path.soc_percent[i] == null ? "after the battery has failed" : (step_words[colour] ?? ""), colour, places: [], dashed: path.soc_percent[i] == null };
      tracks.push(last);
    }
    last.places.push(place);
  }
  return tracks.filter((track) => track.places.length > 1);
}

/// Returns the wind of a path; null for calm air.
export function windOf(path: FlownTrack): Wind | null {
  return path.wind_m_per_s ? { m_per_s: path.wind_m_per_s, from_deg: path.wind_from_deg ?? 0 } : null;
}

/// A flight with one of several packs, on a map.
interface DrawnFlight {
  pack: number;
  track?: FlownTrack | null;
}

/// Returns the places of flights in metres from the start of the path: each but the first begins at home.
function shifted(track: FlownTrack, home: FlownTrack): FlownTrack {
  const [east, north] = [home.east_m[home.east_m.length - 1] ?? 0, home.north_m[home.north_m.length - 1] ?? 0];
  return { ...track, east_m: track.east_m.map((value) => value + east), north_m: track.north_m.map((value) => value + north) };
}

/// Returns the tracks of flights, and their landings and the places that they return from.
export function packTracks(flights: DrawnFlight[], reserve: number): { tracks: Track[]; spots: Spot[]; wind: Wind | null } {
  const first = flights[0]?.track;
  const drawn = flights.flatMap(({ track, ...flight }, i) => (track && first ? [{ ...flight, track: i > 0 ? shifted(track, first) : track }] : []));
  const spots = drawn.flatMap(({ track, pack }): Spot[] => {
    const places = placesOf(track);
    const last = places[places.length - 1];
    const from = track.return_index ?? -1;
    return [
      ...(places[from] ? [{ name: `pack ${pack} returns: ${quantity(track.soc_percent[from] ?? null, 0, "%")}`, is_named: true, colour: "cruise", place: places[from] as Place }] : []),
      ...(last ? [{ name: `pack ${pack} lands: ${quantity(track.soc_percent[places.length - 1] ?? null, 0, "%")}`, colour: "landing", place: last }] : []),
    ];
  });
  return { tracks: drawn.flatMap(({ track }) => pieces(track, reserve)), spots, wind: drawn[0] ? windOf(drawn[0].track) : null };
}

export function ChargeKey({ reserve }: { reserve: number }) {
  return (
    <p class="chart-key">
      <span>charge left:</span>
      {[["c1", "80 to 100 %"], ["c2", "60 to 80 %"], ["c3", "40 to 60 %"], ["c4", reserve > 0 ? "down to the reserve" : "below 40 %"], ...(reserve > 0 ? [["c5", "below the reserve"]] : [])].map(([tone, words]) => (
        <span class={`tone-${tone}`}><i class="key-block" /> {words}</span>
      ))}
    </p>
  );
}

const columns: Column<MissionPath["elements"][number]>[] = [
  { head: "Element", cell: ({ name, kind }) => name || capital(kind), by: ({ name }) => name },
  { head: "From", cell: ({ start_s }) => duration(start_s), by: ({ start_s }) => start_s, numeric: true },
  { head: "Takes", cell: ({ duration_s }) => duration(duration_s), by: ({ duration_s }) => duration_s, numeric: true },
  { head: "Length", cell: ({ length_m }) => (length_m == null ? "" : distance(length_m)), by: ({ length_m }) => length_m, numeric: true },
  { head: "Course", cell: ({ course_deg }) => (course_deg == null ? "" : `${number(course_deg, 0)}°`), by: ({ course_deg }) => course_deg, numeric: true },
  { head: "Airspeed", cell: ({ airspeed_m_per_s }) => quantity(airspeed_m_per_s, 1, "m/s"), by: ({ airspeed_m_per_s }) => airspeed_m_per_s, numeric: true },
  { head: "Climb", cell: ({ climb_m_per_s }) => quantity(climb_m_per_s, 1, "m/s"), by: ({ climb_m_per_s }) => climb_m_per_s, numeric: true },
  { head: "Flight power", cell: ({ mechanical_w }) => power(mechanical_w), by: ({ mechanical_w }) => mechanical_w, numeric: true },
];

interface MissionMapProps {
  mission: MissionDocument;
  path: MissionPath;
  /// The sample of the path at the cursor.
  at: number | null;
}

export function MissionMap({ mission, path, at }: MissionMapProps) {
  const { reserve_soc_percent: reserve } = mission.summary;
  const places = useMemo(() => placesOf(path), [path]);
  const tracks = useMemo(() => pieces(path, reserve), [path]);
  const spots = useMemo<Spot[]>(() => {
    const last = places.length - 1;
    return [
      { name: "start", colour: "take-off", place: places[0] as [number, number] },
      { name: `end: ${path.soc_percent[last] == null ? "the battery has failed" : quantity(path.soc_percent[last], 0, "%")}`, colour: "landing", place: places[last] as [number, number] },
    ];
  }, [path]);
  if (places.length < 2) return null;
  return (
    <div class="mission-path">
      <TrackMap tracks={tracks} spots={spots} wind={windOf(path)} cursor={at == null ? null : places[at]} height={320} description={`Path of ${mission.title}, north at the top, coloured by the charge that is left.`} />
      <ChargeKey reserve={reserve} />
      <Opened title={`The ${path.elements.length} elements of the path`}>
        {() => <Table caption={`Elements of the path of ${mission.title}`} columns={columns} rows={path.elements} />}
      </Opened>
    </div>
  );
}
