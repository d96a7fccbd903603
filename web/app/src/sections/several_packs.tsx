// Missions that need several packs: one flight after another, with what each lands with and where it returns from.
import { useMemo } from "preact/hooks";
import type { PackMission } from "../documents";
import { Card, Facts, Verdict, type Grade } from "../ui/basics";
import { chance, distance, duration, energy, quantity } from "../ui/format";
import { TrackMap } from "../ui/map";
import { Table, type Column } from "../ui/table";
import { ChargeKey, packTracks } from "./mission_map";

type PackFlight = PackMission["flights"][number];

function verdictOf(flight: { keeps_reserve: boolean; final_soc_percent: number | null; feasible: boolean }): { grade: Grade; words: string } {
  if (!flight.feasible || flight.final_soc_percent == null || flight.final_soc_percent <= 0) return { grade: "bad", words: "runs empty" };
  return flight.keeps_reserve ? { grade: "good", words: "keeps reserve" } : { grade: "doubt", words: "below reserve" };
}
const kept = (probability: number | null | undefined) => (probability == null ? "unknown" : chance(1 - probability));

const columns: Column<PackFlight>[] = [
  { head: "Pack", cell: ({ pack }) => `Pack ${pack}`, by: ({ pack }) => pack },
  { head: "Takes off after", cell: ({ start_s }) => duration(start_s), by: ({ start_s }) => start_s, numeric: true },
  { head: "In the air", cell: ({ duration_s }) => duration(duration_s), by: ({ duration_s }) => duration_s, numeric: true },
  { head: "Part of the cruise", cell: ({ cruise_from_s, cruise_to_s }) => `${duration(cruise_from_s)} to ${duration(cruise_to_s)}`, by: ({ cruise_from_s }) => cruise_from_s, numeric: true },
  { head: "At most until", cell: ({ largest_to_s }) => duration(largest_to_s), by: ({ largest_to_s }) => largest_to_s, numeric: true },
  { head: "Returns from", cell: ({ return_from, return_east_m: east, return_north_m: north }) => <span>{return_from}{east != null && north != null && <span class="small-under">{distance(Math.abs(east))} {east < 0 ? "west" : "east"}, {distance(Math.abs(north))} {north < 0 ? "south" : "north"} of the start</span>}</span> },
  { head: "Energy", cell: ({ energy_wh }) => energy(energy_wh), by: ({ energy_wh }) => energy_wh, numeric: true },
  {
    head: "Charge at landing", numeric: true, by: ({ final_soc_percent }) => final_soc_percent,
    cell: (flight) => <span><b>{quantity(flight.final_soc_percent, 1, "%")}</b><span class="small-under"><Verdict grade={verdictOf(flight).grade}>{verdictOf(flight).words}</Verdict></span></span>,
  },
  { head: "Keeps the reserve", cell: ({ probability_below_reserve }) => kept(probability_below_reserve), by: ({ probability_below_reserve: below }) => below, numeric: true },
];

export function SeveralPacks({ mission }: { mission: PackMission }) {
  const { tracks, spots, wind } = useMemo(() => packTracks(mission.flights, mission.reserve_soc_percent), [mission]);
  return (
    <Card title={mission.mission} aside={`${mission.packs} packs${mission.packs_needed == null || mission.packs_needed === mission.packs ? "" : `, ${mission.packs_needed} needed`}`}>
      <p>{mission.text}</p>
      <Facts rows={[
        ["In all", duration(mission.duration_s)],
        ["On the ground between flights", mission.on_ground_s > 0 && duration(mission.on_ground_s)],
        ["Energy", energy(mission.energy_wh)],
        ["All keep the reserve", mission.probability_below_reserve != null && kept(mission.probability_below_reserve)],
      ]} />
      {tracks.length > 0 && <>
        <TrackMap tracks={tracks} spots={spots} wind={wind} height={320} description={`Flights of ${mission.mission}, north at the top, coloured by the charge that is left.`} />
        <ChargeKey reserve={mission.reserve_soc_percent} />
      </>}
      <Table caption={`Flights of ${mission.mission}`} columns={columns.filter(({ by }) => !by || mission.flights.some((flight) => by(flight) != null))} rows={mission.flights} />
    </Card>
  );
}
