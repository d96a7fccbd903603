// The page of `flightwatt report` and `flightwatt LOG...`: the answer first, then what it rests on. Parts that the
// document does not have are left out.
import type { ComponentChildren } from "preact";
import { useMemo, useState } from "preact/hooks";
import type { ReportDocument } from "../documents";
import "../report.css";
import { Panel } from "../sections/aircraft_panel";
import { Answer, answerSentence } from "../sections/answer";
import { Certainty, hasCertainty } from "../sections/certainty";
import { AllCharges } from "../sections/charge_chart";
import { Flights } from "../sections/flights";
import { MissionCard, MissionTable } from "../sections/missions";
import { Packs } from "../sections/packs";
import { QualityMap } from "../sections/quality_map";
import { Replay } from "../sections/replay";
import { SeveralPacks } from "../sections/several_packs";
import { Strips, withSoftware } from "../sections/software";
import { Command } from "../ui/basics";
import { Shell } from "../ui/shell";
import { MissionWhatIf } from "./mission_what_if";

interface Part {
  id: string;
  /// In the bar, and above the part if it has no other title.
  name: string;
  title?: string;
  show: () => ComponentChildren;
}

/// The state that parts share: the selected mission and the selected flight.
interface Selection {
  mission: number;
  flight: number;
  selectMission: (mission: number) => void;
  selectFlight: (flight: number) => void;
}

interface PartProps {
  of: ReportDocument;
  selection: Selection;
}

function AnswerPart({ of, selection }: PartProps) {
  const [mission] = of.missions;
  if (!of.answer) return null;
  return <Answer answer={of.answer} panel={aircraftPanel(of, selection)} curve={of.missions.length === 1 && mission && <MissionCard mission={mission} index={0} count={1} />} />;
}

const aircraftPanel = (of: ReportDocument, selection: Selection) =>
  of.panel && <Panel panel={of.panel} flights={of.flights} notes={of.warnings.length + of.notes.length} onFlight={selection.selectFlight} />;

function Missions({ of, selection }: PartProps) {
  const { missions } = of;
  const mission = missions[selection.mission];
  const shown = !of.answer && aircraftPanel(of, selection);
  if (!mission) return <div class="panel-wide">{shown}</div>;
  return (
    <div class="grid">
      <div class={shown ? "three-quarters" : ""}>
        <MissionCard mission={mission} index={selection.mission} count={missions.length}>
          {mission.again && <MissionWhatIf key={selection.mission} mission={mission} of={mission.again} files={of.files} />}
        </MissionCard>
        {missions.length > 1 && <MissionTable missions={missions} selected={selection.mission} onSelect={selection.selectMission} />}
      </div>
      {shown && <div class="quarter">{shown}</div>}
    </div>
  );
}

function Curves({ of, selection }: PartProps) {
  const strips = withSoftware(of.missions);
  return (
    <div class="grid">
      <section class={`card ${strips.length > 0 ? "two-thirds" : ""}`} aria-label="Curves of all missions">
        <AllCharges missions={of.missions} selected={selection.mission} onSelect={selection.selectMission} />
        <p class="chart-key">
          <span class="tone-alarm"><i class="key-line" /> does not reach its end</span>
          <span class="tone-caution"><i class="key-line" /> lands below the reserve or may miss it</span>
          <span class="tone-ok"><i class="key-line" /> keeps it in 95 of 100 flights</span>
        </p>
      </section>
      {strips.length > 0 && <div class="third"><Strips missions={strips} /></div>}
    </div>
  );
}

/// A title for each grid: with the flight, or of the software alone on the ground.
export function gridTitles({ quality, missions }: Pick<ReportDocument, "quality" | "missions">): string[] {
  const titles = quality.map((grid) => (grid.missions.length > 0 && grid.missions.every((i) => missions[i]?.summary.mechanical_energy_wh === 0) ? "Software alone" : "Flight and software"));
  return titles.map((title, i) => (titles.indexOf(title) === i ? title : `${title} of ${missions[quality[i]?.missions[0] ?? -1]?.title ?? "other missions"}`));
}

function Quality({ of, selection }: PartProps) {
  const titles = gridTitles(of);
  return (
    <>
      <p class="lead">Charge at landing with one setting of the software throughout{of.quality.some(({ flights_drawn }) => flights_drawn > 0) && `, and how probably it keeps the reserve (${of.quality[0]?.flights_drawn} drawn flights a cell)`}. Select a cell to see its flight.</p>
      {of.quality.map((grid, i) => <QualityMap grid={grid} missions={of.missions} mission={selection.mission} title={titles[i] ?? ""} />)}
    </>
  );
}

function partsOf(of: ReportDocument, selection: Selection): Part[] {
  const packs = of.trends != null || (of.answer?.packs.length ?? 0) > 0;
  const parts: (Part | false)[] = [
    of.answer != null && { id: "answer", name: "Answer", title: "", show: () => <AnswerPart of={of} selection={selection} /> },
    (of.answer ? of.missions.length > 1 : of.missions.length > 0 || of.panel != null) && { id: "missions", name: of.missions.length > 0 ? "Missions" : "Aircraft", title: of.answer ? of.headline : "", show: () => <Missions of={of} selection={selection} /> },
    of.packs.length > 0 && { id: "several-packs", name: "Several packs", show: () => of.packs.map((mission) => <SeveralPacks mission={mission} />) },
    of.missions.length > 1 && { id: "curves", name: "Curves", title: "All missions", show: () => <Curves of={of} selection={selection} /> },
    of.quality.length > 0 && { id: "quality", name: "Quality of service", show: () => <Quality of={of} selection={selection} /> },
    of.replay != null && { id: "replay", name: "Replay", show: () => of.replay && <Replay replay={of.replay} /> },
    of.flights.length > 0 && {
      id: "flights", name: "Flights",
      show: () => <Flights flights={of.flights} exclusions={of.exclusions} outlines={of.outlines} selected={selection.flight} onSelect={selection.selectFlight} />,
    },
    packs && { id: "packs", name: "Packs", title: "Packs and trends", show: () => <Packs trends={of.trends} answer={of.answer?.packs ?? []} /> },
    hasCertainty(of) && { id: "certain", name: "How certain?", title: "How certain is this?", show: () => <Certainty of={of} /> },
  ];
  return parts.filter((part): part is Part => Boolean(part));
}

function Page({ of, parts }: { of: ReportDocument; parts: Part[] }) {
  return (
    <div class="report">
      {of.aircraft.slice(0, 6).map(({ name, text }) => <p class="report-aircraft"><b><bdi>{name}</bdi></b> {text}</p>)}
      {of.aircraft.length > 6 && <p class="report-aircraft">and {of.aircraft.length - 6} more aircraft</p>}
      <h1>{of.answer ? answerSentence(of.answer) : of.headline || of.title}</h1>
      {parts.map(({ id, name, title, show }) => (
        <section class="part" id={id} aria-label={title || name} key={id}>
          {title !== "" && <h2 class="part-title">{title ?? name}</h2>}
          {show()}
        </section>
      ))}
      <dl class="report-facts">
        {of.facts.map(({ name, text }) => <div><dt>{name}</dt><dd>{text}</dd></div>)}
      </dl>
      {of.command && <Command line={of.command} />}
    </div>
  );
}

/// The first flight that has something to show.
const firstFlight = ({ flights }: ReportDocument) => Math.max(0, flights.findIndex(({ detail }) => detail != null));

export function Report({ document: of }: { document: ReportDocument }) {
  const [mission, setMission] = useState(0);
  const [flight, setFlight] = useState(() => firstFlight(of));
  const selectMission = (next: number) => {
    setMission(next);
    // The card is above its table: it is shown if it was scrolled away.
    setTimeout(() => {
      const box = document.getElementById("mission")?.getBoundingClientRect();
      if (box && (box.bottom < 120 || box.top > innerHeight - 120)) document.getElementById("mission")?.scrollIntoView({ block: "start" });
    });
  };
  const parts = partsOf(of, { mission, flight, selectMission, selectFlight: setFlight });
  const links = useMemo(() => parts.map(({ id, name }) => ({ id, name })), [of]);
  return <Shell name={of.name || "FlightWatt report"} screens={[{ id: "report", name: "Report", parts: links, show: () => <Page of={of} parts={parts} /> }]} />;
}
