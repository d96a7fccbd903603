// All numbers of the missions, and what differs between the flights that were drawn.
import type { MissionDocument, ScheduleNotes } from "../documents";
import { duration, energy, number, quantity } from "../ui/format";
import { Table, type Column } from "../ui/table";

const percent = (probability: number | null | undefined) => (probability == null ? "" : quantity(100 * probability, 1, "%"));

const columns: Column<MissionDocument>[] = [
  { head: "Mission", cell: ({ title, summary }) => <span><bdi>{title}</bdi>{summary.schedule && <span class="small-under">{summary.schedule}</span>}</span>, by: ({ title }) => title },
  { head: "Rank", cell: ({ rank }) => rank, by: ({ rank }) => rank, numeric: true },
  { head: "Charge at landing", cell: ({ summary }) => quantity(summary.final_soc_percent, 2, "%"), by: ({ summary }) => summary.final_soc_percent, numeric: true },
  { head: "Reserve", cell: ({ summary }) => quantity(summary.reserve_soc_percent, 1, "%"), by: ({ summary }) => summary.reserve_soc_percent, numeric: true },
  { head: "Energy", cell: ({ summary }) => energy(summary.energy_wh), by: ({ summary }) => summary.energy_wh, numeric: true },
  { head: "of it flight", cell: ({ summary }) => energy(summary.mechanical_energy_wh), by: ({ summary }) => summary.mechanical_energy_wh, numeric: true },
  { head: "of it software", cell: ({ summary }) => energy(summary.compute_energy_wh), by: ({ summary }) => summary.compute_energy_wh, numeric: true },
  { head: "Duration", cell: ({ summary }) => duration(summary.duration_s), by: ({ summary }) => summary.duration_s, numeric: true },
  { head: "Empty at", cell: ({ summary }) => (summary.depleted_at_s == null ? "" : duration(summary.depleted_at_s)), by: ({ summary }) => summary.depleted_at_s, numeric: true },
  { head: "Cut off at", cell: ({ summary }) => (summary.cut_off_at_s == null ? "" : duration(summary.cut_off_at_s)), by: ({ summary }) => summary.cut_off_at_s, numeric: true },
  { head: "Utility", cell: ({ summary }) => (summary.utility == null ? "" : number(summary.utility, 2)), by: ({ summary }) => summary.utility, numeric: true },
  {
    head: "Below the reserve in", numeric: true, by: ({ summary }) => summary.probability_below_reserve,
    cell: ({ summary: { probability_below_reserve: below, probability_below_reserve_interval_95: interval } }) => (
      <span>{percent(below)}{interval && <span class="small-under">{percent(interval.low)} to {percent(interval.high)}</span>}</span>
    ),
  },
  { head: "Drawn flights", cell: ({ summary }) => summary.samples ?? "", by: ({ summary }) => summary.samples, numeric: true },
];

export function Schedules({ missions, notes }: { missions: MissionDocument[]; notes: ScheduleNotes | null }) {
  const known = columns.filter(({ by }) => !by || missions.some((mission) => by(mission) != null));
  return (
    <>
      <Table caption="All numbers of the missions" columns={known} rows={missions} />
      {notes?.text && <p class="soft">{notes.text}</p>}
      {notes?.sources.map(({ missions: names, text }) => <p class="soft"><b>{names.join(", ")}</b>: {text}</p>)}
    </>
  );
}
