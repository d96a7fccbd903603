// The missions, worst first: the selected one as a card with its curve, all of them as a table.
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import type { MissionDocument } from "../documents";
import { Mark, Verdict } from "../ui/basics";
import { Table, type Column } from "../ui/table";
import { ChargeChart, chargeFlight, nearest, Sparkline, toneOf } from "./charge_chart";
import { MissionMap } from "./mission_map";
import { capital, countWord, grades } from "./words";

interface MissionCardProps {
  mission: MissionDocument;
  index: number;
  count: number;
  heading?: "h1" | "h2";
  children?: ComponentChildren;
}

export function MissionCard({ mission, index, count, heading = "h2", children }: MissionCardProps) {
  const [time_s, setTime] = useState<number | null>(null);
  const { card, path } = mission;
  const grade = grades[mission.outcome];
  const Lead = heading;
  const facts: [string, string, string][] = [
    ["Charge at landing", card.landing, ""],
    [capital(card.aim), card.probability, ""],
    [card.reach_name, card.reach, card.planned && `planned: ${card.planned}`],
  ];
  return (
    <article class={`card mission-card ${grade}`} id="mission" aria-label={`Mission ${mission.title}`}>
      <div class="mission-words">
        <Verdict grade={grade}>{index === 0 && count > 1 ? `Worst of ${countWord(count)}: ${card.words}` : capital(card.words)}</Verdict>
        <Lead class="mission-lead">{card.lead}</Lead>
        <p><b><bdi>{mission.title}</bdi></b></p>
        {card.runs && <p class="mission-runs">{capital(card.runs)}</p>}
        <dl class="facts mission-facts">
          {facts.filter(([name, value]) => name && value).map(([name, value, more]) => (
            <div>
              <dt>{name}{more && <span class="small-under">{more}</span>}</dt>
              <dd>{value}</dd>
            </div>
          ))}
        </dl>
      </div>
      <div class="mission-curve">
        <ChargeChart flight={chargeFlight(mission)} onTime={path ? setTime : undefined} />
      </div>
      {(card.help || card.better || card.notes.length > 0) && (
        <div class="mission-help">
          {(card.help || card.better) && (
            <p>
              {card.help && (grade === "good" ? `${capital(card.help)}. ` : <><b>What would help:</b> {card.help}. </>)}
              {card.better && `${card.better}.`}
            </p>
          )}
          {card.notes.map((note) => <p class="mission-note">{note}.</p>)}
        </div>
      )}
      {path && <MissionMap mission={mission} path={path} at={time_s == null ? null : nearest(path.time_s, time_s)} />}
      {children}
    </article>
  );
}

/// The most frequent of some texts.
function mostFrequent(texts: string[]): string {
  const counts = new Map<string, number>();
  for (const text of texts.filter(Boolean)) counts.set(text, (counts.get(text) ?? 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1])[0]?.[0] ?? "";
}

function columnsOf(missions: MissionDocument[]): Column<MissionDocument>[] {
  const reach_name = mostFrequent(missions.map(({ card }) => card.reach_name));
  const verdict = (mission: MissionDocument, text: string) => <b class={`tone-${toneOf(mission.outcome)}`}>{text}</b>;
  const columns: (Column<MissionDocument> | false)[] = [
    {
      head: "Mission, worst first",
      cell: (mission) => (
        <span class="mission-name">
          <Mark grade={grades[mission.outcome]} />
          <span><bdi>{mission.title}</bdi>{mission.card.runs && <span class="small-under">{mission.card.runs}</span>}</span>
        </span>
      ),
      by: ({ title }) => title,
    },
    { head: "State of charge", cell: (mission) => <Sparkline mission={mission} /> },
    {
      head: "Charge at landing",
      cell: (mission) => <span>{verdict(mission, mission.card.landing)}<span class="small-under no-wrap">{mission.card.words}</span></span>,
      by: ({ landing_soc_percent }) => landing_soc_percent ?? -1, numeric: true,
    },
    {
      head: "Keeps the reserve", cell: (mission) => verdict(mission, mission.card.probability),
      by: ({ summary }) => (summary.probability_below_reserve == null ? null : -summary.probability_below_reserve), numeric: true,
    },
    missions.some(({ card }) => card.reach) && {
      head: reach_name,
      cell: ({ card }) => <span><b>{card.reach}</b>{card.reach && card.reach_name !== reach_name && <span class="small-under">{card.reach_name}</span>}</span>,
      numeric: true,
    },
    missions.some(({ card }) => card.help) && { head: "To keep the reserve in 95 of 100 flights", cell: ({ card }) => <span class="mission-to-keep">{card.help}</span> },
  ];
  return columns.filter((column): column is Column<MissionDocument> => Boolean(column));
}

export function MissionTable({ missions, selected, onSelect }: { missions: MissionDocument[]; selected: number; onSelect: (mission: number) => void }) {
  return (
    <section class="card flush mission-table" aria-label="Table of missions">
      <Table caption="Missions, worst first" columns={columnsOf(missions)} rows={missions} page={40} words={missions.length > 20 ? ({ title, card }) => `${title} ${card.runs} ${card.words}` : undefined}
        selected={missions[selected]} onSelect={(mission) => onSelect(missions.indexOf(mission))} />
    </section>
  );
}
