// The list of logs: dropped or chosen, grouped by aircraft, each used or with the reason why not.
import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import { Command, Mark, Verdict } from "../ui/basics";
import { date, duration, quantity } from "../ui/format";
import { Icon } from "../ui/icons";
import { useOnPaper } from "../ui/opened";
import { filesOfInput, type Dropped } from "../work/files";
import type { Aircraft, LogLine, Project, State } from "../work/project";
import { inPageWords } from "../work/question";

const states = {
  waiting: { grade: "none", word: "Waiting" },
  used: { grade: "good", word: "Used" },
  part: { grade: "doubt", word: "Used in part" },
  not: { grade: "none", word: "Not used" },
} as const;

/// A button that opens the computer's dialog for files or, where it has one, for a folder.
export function FilesButton(props: {
  label: string;
  folder?: boolean;
  class?: string;
  onFiles: (files: Dropped[]) => void;
}) {
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => {
    if (props.folder) field.current?.setAttribute("webkitdirectory", "");
  }, [props.folder]);
  return (
    <>
      <input ref={field} type="file" multiple hidden aria-label={props.label}
        onChange={(event) => {
          props.onFiles(filesOfInput(event.currentTarget));
          event.currentTarget.value = "";
        }}
      />
      <button type="button" class={props.class ?? "quiet"} onClick={() => field.current?.click()}>
        <Icon name={props.folder ? "logs" : "plus"} /> {props.label}
      </button>
    </>
  );
}

/// A small drawing of the power over a flight.
export function Sparkline({ values }: { values?: number[] }) {
  if (!values || values.length < 2) return <span class="spark" />;
  const top = Math.max(...values, 1);
  const points = values.map((value, i) =>
    `${((150 * i) / (values.length - 1)).toFixed(1)},${(27 - (24 * Math.max(value, 0)) / top).toFixed(1)}`);
  return (
    <svg class="spark" viewBox="0 0 150 28" preserveAspectRatio="none" aria-hidden="true">
      <path class="area" d={`M0,28L${points.join("L")}L150,28z`} />
      <path class="line" d={`M${points.join("L")}`} />
    </svg>
  );
}

function Line({ line }: { line: LogLine }) {
  const { grade, word } = states[line.state];
  const name = line.path.replace(/^logs\//, "");
  return (
    <li class={`log ${line.state}`}>
      <Verdict grade={grade}>{word}</Verdict>
      <span class="log-name">
        <bdi>{name}</bdi> <span class="soft">{line.flown?.date ? date(line.flown.date) : ""}</span>
      </span>
      <Sparkline values={line.power} />
      <span class="log-numbers">
        <span>{line.flown ? duration(line.flown.in_air_s) : ""}</span>
        <span>{line.flown ? quantity(line.flown.energy_wh, 1, "Wh") : ""}</span>
      </span>
      <span class="log-reason">{inPageWords(line.reason)}</span>
    </li>
  );
}

const most_shown = 12;

function Lines({ lines }: { lines: LogLine[] }) {
  const [all, setAll] = useState(false);
  useOnPaper(useCallback(() => setAll(true), []));
  const shown = all ? lines : lines.slice(0, most_shown);
  return (
    <>
      <ul class="logs">
        {shown.map((line) => (
          <Line key={line.path} line={line} />
        ))}
      </ul>
      {shown.length < lines.length && (
        <button type="button" class="quiet more" onClick={() => setAll(true)}>
          Show all {lines.length}
        </button>
      )}
    </>
  );
}

/// The capacity of an aircraft's pack, and where it is from; unknown it is asked for.
function PackField({ aircraft, project }: { aircraft: Aircraft; project: Project }) {
  const capacity = aircraft.measured?.answer.capacity_ah ?? aircraft.now?.answer.capacity_ah;
  const stated = aircraft.question.capacity_ah;
  const value = stated ?? capacity?.value;
  const is_measured = stated != null || (capacity?.value != null && !/estimate|assumed/.test(capacity.basis));
  const shown = value != null ? String(Math.round(value * 100) / 100) : "";
  const change = (field: HTMLInputElement) => {
    const ah = Number(field.value.replace(",", "."));
    if (field.value.trim() === "") project.ask(aircraft.id, { ...aircraft.question, capacity_ah: undefined });
    else if (ah > 0) project.ask(aircraft.id, { ...aircraft.question, capacity_ah: ah });
    else field.value = shown;
  };
  const failed = aircraft.failed && inPageWords(aircraft.failed);
  const basis = failed ? failed : stated != null
    ? "as you stated it"
    : capacity?.value != null ? capacity.basis : capacity ? "not in the logs: what does its label say?" : "";
  return (
    <div class="pack-field">
      <label>
        <span>Pack</span>
        <input
          type="text"
          inputMode="decimal"
          size={4}
          value={shown}
          aria-label={`Capacity of the pack of ${aircraft.name} in Ah`}
          onChange={(event) => change(event.currentTarget)}
        />
        <span class="soft">Ah</span>
      </label>
      {basis && (
        <span class="pack-basis">
          <Mark grade={failed ? "bad" : value != null && is_measured ? "good" : "doubt"} /> {basis}
        </span>
      )}
    </div>
  );
}

function AircraftCard({ aircraft, project }: { aircraft: Aircraft; project: Project }) {
  const cells = aircraft.now?.answer.packs[0]?.cells;
  const facts = [
    aircraft.kind === "rotorcraft" ? "copter" : aircraft.kind === "fixedwing" ? "wing" : aircraft.kind,
    aircraft.id === aircraft.name ? "" : aircraft.id,
    aircraft.logs.length === 1 ? "1 log" : `${aircraft.logs.length} logs`,
    cells ? `${cells} cells` : "",
  ];
  return (
    <section class="card aircraft" aria-label={aircraft.name}>
      <header>
        <Icon name={aircraft.kind === "fixedwing" ? "wing" : "copter"} size={32} />
        <div class="aircraft-name">
          <h2>{aircraft.name}</h2>
          <p class="soft">{facts.filter(Boolean).join(" · ")}</p>
        </div>
        <PackField aircraft={aircraft} project={project} />
        <button type="button" class="primary" aria-label={`Answer for ${aircraft.name}`}
          onClick={() => {
            project.choose(aircraft.id);
            location.hash = "answer";
          }}>
          Answer <Icon name="arrow" />
        </button>
      </header>
      <Lines lines={aircraft.logs} />
    </section>
  );
}

const formats: [string, string][] = [
  ["ArduPilot", ".bin, .log"],
  ["PX4", ".ulg"],
  ["Paparazzi", ".data with .log, SD card"],
  ["Telemetry", ".tlog, .csv with a time"],
  ["Plans", ".plan, .waypoints, .xml"],
  ["Areas", ".kml, .geojson"],
  ["Terrain", ".hgt of SRTM"],
];

function Empty({ project }: { project: Project }) {
  const add = (files: Dropped[]) => void takeFiles(project, files);
  return (
    <div class="empty">
      <h1>How long, how far, and does my plan fit?</h1>
      <p class="lead">
        Drop the logs of your drone. FlightWatt learns what it really draws and answers for tomorrow’s pack, payload
        and wind.
      </p>
      <div class="empty-parts">
        <div class="drop">
          <Icon name="logs" size={56} />
          <p class="drop-title">Drop logs, a folder or a plan here</p>
          <p class="drop-buttons">
            <FilesButton
              label="Choose files"
              class="primary"
              onFiles={add}
            /> <FilesButton label="Choose a folder" folder onFiles={add} />
          </p>
          <p class="promise">
            <Icon name="lock" /> Nothing leaves this computer. Works without a network.
          </p>
        </div>
        <section class="card" aria-label="What it reads">
          <h2>What it reads</h2>
          <dl class="facts">
            {formats.map(([name, endings]) => (
              <div>
                <dt>{name}</dt>
                <dd>{endings}</dd>
              </div>
            ))}
          </dl>
          <p class="soft">A log needs time, voltage and current. Three flights give chances; one gives a mean.</p>
        </section>
      </div>
      <Command line="flightwatt FOLDER" />
    </div>
  );
}

/// Takes files in and goes to the plan if one is among them and no log.
export async function takeFiles(project: Project, files: Dropped[]) {
  const plans = await project.add(files);
  if (plans.length > 0 && plans.length === files.length) location.hash = "plan";
}

function ReadingBar({ state, project }: { state: State; project: Project }) {
  const { progress } = state;
  if (!progress) return null;
  return (
    <section class="card reading" aria-label="Progress">
      <p aria-live="polite">
        <b>{progress.done > 0 ? `${progress.done} of ${progress.of}` : `${progress.of} to read`}</b> · {progress.text}
      </p>
      <button type="button" class="quiet" onClick={() => project.cancel()}>
        Cancel
      </button>
      <progress value={progress.done} max={Math.max(progress.of, 1)} aria-label="Logs read" />
    </section>
  );
}

/// The logs whose reading was cancelled.
const unreadOf = ({ waiting, progress, aircraft, unused }: State) => {
  const known = new Set([...aircraft.flatMap((one) => one.logs), ...unused].map(({ path }) => path));
  return progress ? [] : waiting.filter(({ path }) => !known.has(path));
};

function Unread({ state, project }: { state: State; project: Project }) {
  const unread = unreadOf(state);
  if (unread.length === 0) return null;
  return (
    <section class="card aircraft" aria-label="Not read">
      <header>
        <h2>Reading was cancelled: {unread.length === 1 ? "1 log is" : `${unread.length} logs are`} not read</h2>
        <button type="button" class="primary" onClick={() => project.readAgain()}>Read</button>
      </header>
      <Lines lines={unread} />
    </section>
  );
}

function heading(state: State): string {
  const used = state.aircraft.reduce((sum, one) => sum + one.logs.length, 0);
  if (used === 0 && (state.progress || unreadOf(state).length > 0)) return state.progress ? "Reading" : "No log is read yet";
  const aircraft = state.aircraft.length === 1 ? "1 aircraft" : `${state.aircraft.length} aircraft`;
  const unused = state.unused.length > 0 ? `, ${state.unused.length} not` : "";
  return `${aircraft}: ${used} ${used === 1 ? "log" : "logs"} used${unused}`;
}

function commandOf(project: Project, state: State): string {
  const logs = [...state.aircraft.flatMap((one) => one.logs), ...state.unused, ...unreadOf(state)];
  const only = state.aircraft.length === 1 ? state.aircraft[0] : undefined;
  const capacity = only?.question.capacity_ah;
  const each = state.aircraft.length > 1 ? " --each" : "";
  return `flightwatt ${project.inputsShown(logs)}${each}${capacity ? ` --capacity ${capacity}` : ""}`;
}

export function LogsScreen({ project, state }: { project: Project; state: State }) {
  const is_empty = state.aircraft.length === 0 && state.unused.length === 0 && state.waiting.length === 0;
  if (is_empty && !state.progress) return state.ready ? <Empty project={project} /> : <h1>Opening</h1>;
  const add = (files: Dropped[]) => void takeFiles(project, files);
  return (
    <>
      <header class="screen-head">
        <div>
          <p class="over">
            {state.read_s != null && !state.progress
              ? `Read in ${state.read_s.toFixed(1)} s`
              : "Nothing leaves this computer"}
          </p>
          <h1>{heading(state)}</h1>
        </div>
        <div class="screen-buttons">
          <span class="drop-more">Drop more logs or a plan anywhere</span>
          <FilesButton label="Add files" onFiles={add} />
          <button type="button" class="quiet" onClick={() => void project.forgetAll()}>
            Forget all
          </button>
        </div>
      </header>
      <ReadingBar state={state} project={project} />
      {state.aircraft.map((aircraft) => (
        <AircraftCard key={aircraft.id} aircraft={aircraft} project={project} />
      ))}
      <Unread state={state} project={project} />
      {state.progress && state.waiting.length > 0 && state.aircraft.length === 0 && (
        <section class="card aircraft" aria-label="To be read">
          <Lines lines={state.waiting} />
        </section>
      )}
      {state.unused.length > 0 && (
        <section class="card aircraft unused" aria-label="Not used">
          <header>
            <h2>{state.unused.length === 1 ? "1 log not used" : `${state.unused.length} logs not used`}</h2>
          </header>
          <Lines lines={state.unused} />
        </section>
      )}
      <p class="kept">
        <Icon name="lock" /> Kept in this browser until you press “Forget all”. Nothing leaves this computer.
      </p>
      <Command line={commandOf(project, state)} />
    </>
  );
}
