// The battery failsafe of an answer as parameters of autopilots, as `flightwatt export` writes them.
import { useEffect, useState } from "preact/hooks";
import { Card, CopyButton, Folded, NumberField, save } from "../ui/basics";
import { chance, number, quantity } from "../ui/format";
import { Icon } from "../ui/icons";
import type { Failsafe } from "../work/documents";
import { errorsOf, type Aircraft, type Answered, type Project } from "../work/project";
import { failsafeOptions, inPageWords } from "../work/question";

const autopilots = [
  { id: "ardupilot", name: "ArduPilot", ending: ".parm" },
  { id: "px4", name: "PX4", ending: ".params" },
  { id: "inav", name: "INAV", ending: ".txt" },
  { id: "paparazzi", name: "Paparazzi", ending: ".xml" },
] as const;
type Autopilot = (typeof autopilots)[number];

/// Returns the names and values of a file of parameters.
export function parametersOf(text: string): [string, string][] {
  const rows: [string, string][] = [];
  for (const line of text.replace(/<!--[\s\S]*?-->/g, "").split("\n")) {
    const found =
      /^([A-Z][A-Z0-9_]+)[ ,]+([-\d.]+)$/.exec(line) ?? /^\d+\t\d+\t(\w+)\t([-\d.]+)/.exec(line) ??
      /^set (\w+) = (\S+)/.exec(line) ?? /<define name="(\w+)" value="([^"]+)"/.exec(line);
    if (found?.[1] && found[2]) rows.push([found[1], found[2]]);
  }
  return rows;
}

const percent = (value: number | null | undefined) => quantity(value, 0, "%");

/// The charge of a pack in parts: out and work, the way home, the reserve.
function Budget({ card }: { card: Failsafe }) {
  const low = card.low?.soc_percent;
  const critical = card.critical?.soc_percent;
  const parts = low != null
    ? [["out", low, 100], ["return", card.reserve_percent, low]]
    : [["out", card.reserve_percent, 100]];
  return (
    <div
      class="budget"
      role="img"
      aria-label={`Return at ${percent(low)}, land at ${percent(critical)}, reserve ${percent(card.reserve_percent)}.`}
    >
      <svg viewBox="0 0 100 16" preserveAspectRatio="none" aria-hidden="true">
        {parts.map(([name, from, to]) => (
          <rect
            class={`part ${name}`}
            x={100 - Number(to)}
            y="3"
            height="10"
            width={Math.max(Number(to) - Number(from), 0)}
          />
        ))}
        <rect class="part reserve" x={100 - card.reserve_percent} y="3" height="10" width={card.reserve_percent} />
        {[low, critical].map((at) => at != null && <rect
          class="at"
          x={100 - at - 0.3}
          y="0"
          height="16"
          width="0.8"
        />)}
      </svg>
      <p class="budget-words">
        {low != null && <span>return at <b>{low} %</b></span>}
        {critical != null && <span>land at <b>{critical} %</b></span>}
        <span>reserve <b>{number(card.reserve_percent, 0)} %</b></span>
      </p>
    </div>
  );
}

function useExport(project: Project, aircraft: Aircraft, answered: Answered, autopilot: Autopilot) {
  const [text, setText] = useState<{ text: string; failed: string } | null>(null);
  const [stale, setStale] = useState(true);
  useEffect(() => {
    let is_wanted = true;
    setStale(true);
    const { folder } = aircraft;
    const args = [
      "export",
      `${folder}/answer-mission.toml`,
      "--format",
      `failsafe-${autopilot.id}`,
      ...failsafeOptions(answered.question, answered.answer),
    ];
    void project.runOnAnswer(aircraft.id, answered, args).then((result) => {
      if (!is_wanted) return;
      setStale(false);
      setText(result.code === 0 ? { text: result.out, failed: "" } : { text: "", failed: errorsOf(result) });
    }, () => undefined);
    return () => {
      is_wanted = false;
    };
  }, [answered, autopilot]);
  return { text, stale };
}

interface FailsafeProps {
  project: Project;
  aircraft: Aircraft;
  answered: Answered;
  /// Whether that answers another question than that of now: nothing of it is to be copied.
  is_old: boolean;
}

function Parameters({ project, aircraft, answered, autopilot, is_old }: FailsafeProps & { autopilot: Autopilot }) {
  const { text: written, stale } = useExport(project, aircraft, answered, autopilot);
  if (!written) return <p class="soft">Computing</p>;
  if (written.failed) return <p>{written.failed}</p>;
  return (
    <>
      <dl class={`facts parameters${is_old || stale ? " old" : ""}`} aria-busy={stale}>
        {parametersOf(written.text).map(([name, value]) => (
          <div>
            <dt><code>{name}</code></dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
      <p class="buttons">
        <CopyButton primary text={written.text} label={`Copy for ${autopilot.name}`} disabled={is_old || stale} />
        <button
          type="button"
          class="quiet"
          disabled={is_old || stale}
          onClick={() => save(`failsafe-${autopilot.id}${autopilot.ending}`, written.text, "text/plain")}
        >
          <Icon name="save" /> File
        </button>
      </p>
      <Folded title="The file with its reasons"><pre tabIndex={0}>{written.text}</pre></Folded>
    </>
  );
}

export function FailsafeCard({ project, aircraft, answered, is_old }: FailsafeProps) {
  const [chosen, setChosen] = useState<Autopilot>(autopilots[answered.answer.aircraft_name.startsWith("PX4") ? 1 : 0]);
  const { failsafe: card, failsafe_missing } = answered.answer;
  const in_new = card?.low?.probability_too_late_interval_95;
  const flown_m = card?.home_distance_m;
  const home_m = aircraft.question.home_m ?? (flown_m != null ? Math.round(flown_m) : undefined);
  const setHome = (value: number | undefined) => project.ask(aircraft.id, { ...aircraft.question, home_m: value });
  return (
    <Card title="Failsafe">
      <label class="field">
        <span>Farthest from home</span>
        <span>
          <NumberField size={6} value={home_m} is_whole onNumber={setHome} /> m
        </span>
      </label>
      {!card && <p>None: {inPageWords(failsafe_missing)}</p>}
      {card && <Budget card={card} />}
      {card?.low_missing && <p class="small">{card.low_missing}</p>}
      {card && (
        <>
          <div class="segments" role="group" aria-label="Autopilot">
            {autopilots.map((one) => (
              <button type="button" aria-pressed={one === chosen} onClick={() => setChosen(one)}>
                {one.name}
              </button>
            ))}
          </div>
          <Parameters project={project} aircraft={aircraft} answered={answered} autopilot={chosen} is_old={is_old} />
          {card.low && <p class="small">
            The return begins too late in{" "}
            {card.low.probability_too_late != null ? `${chance(card.low.probability_too_late)} flights` : "an unknown part of the flights"}
            {in_new && `; of new flights in ${number(100 * in_new.low, 1)} to ${number(100 * in_new.high, 1)} of 100`}.
          </p>}
          <Folded title="What the failsafe rests on">
            <ul class="rests">
              {card.rests_on.map((one) => (
                <li><span class={`basis ${one.ground}`} aria-hidden="true" /> <span>{one.text}</span></li>
              ))}
            </ul>
          </Folded>
        </>
      )}
    </Card>
  );
}
