// How long and how far, with sliders for what is asked; all numbers are of `flightwatt answer` and `simulate`.
import { useEffect, useMemo, useState } from "preact/hooks";
import uPlot from "uplot";
import { Dots } from "../sections/answer";
import { Card, Command, Figure, Folded, Mark, Verdict, type Grade } from "../ui/basics";
import { distance, duration, number, quantity } from "../ui/format";
import { Plot, type Line } from "../ui/plot";
import type { Answer, Known } from "../work/documents";
import { type Aircraft, type Answered, type Curve, type Project } from "../work/project";
import { asWords, inPageWords, optionsOf, quoted } from "../work/question";
import { FailsafeCard } from "./failsafe";
import { WhatIf } from "./what_if";

/// Returns the time that an answer stands for: what 95 of 100 flights reach, or where that is unknown, as modelled.
export function mainTime(answer: Answer): Known {
  return answer.time_in_air_95_s.value != null ? answer.time_in_air_95_s : answer.time_in_air_s;
}

/// Returns "1 min 55 s less" between two values in the same unit.
export function changeOf(
  now: number | null | undefined,
  before: number | null | undefined,
  words: (value: number) => string,
): string {
  if (now == null || before == null) return "";
  const text = words(Math.abs(now - before));
  return /[1-9]/.test(text) ? `${text} ${now < before ? "less" : "more"}` : "no change";
}

function Change({ text }: { text: string }) {
  return text ? <span class={`change${/less/.test(text) ? " less" : ""}`}> · {text}</span> : null;
}

/// Whether the capacity that was stated is none that the flights allow.
const contradictsFlights = ({ capacity_ah: { value }, flights_capacity_ah_interval_95: flights }: Answer) =>
  value != null && flights != null && (value < flights.low || value > flights.high);

/// Whether the pack is colder than in every flight, so that it holds less than is assumed.
function isColderThanFlown({ temperature_c, battery_temperature_c_range: battery, air_temperature_c_range: air }: Answer) {
  const flown = battery ?? air;
  return temperature_c != null && flown != null && temperature_c < flown.low;
}

interface FiguresProps {
  now: Answered;
  measured?: Answered;
  asking: boolean;
  /// Whether they are as modelled while a slider moves, and their chance is computed when it rests.
  awaits_chance?: boolean;
  /// Whether they answer another question than that of now.
  is_old: boolean;
}

export function Figures({ now, measured, asking, awaits_chance, is_old }: FiguresProps) {
  const { answer } = now;
  const time = mainTime(answer);
  const is_chance = answer.time_in_air_95_s.value != null;
  const before = measured && now !== measured ? measured.answer : undefined;
  const time_before = is_chance ? before && mainTime(before) : before?.time_in_air_s;
  const speed = answer.airspeed_m_per_s.value;
  const known_down_to = answer.voltage_known_down_to_percent;
  return (
    <section class={`card figures${is_old ? " old" : ""}`} aria-label="Time and distance" aria-busy={asking}>
      <Figure
        label={`In the air, ${isColderThanFlown(answer) ? "at most, " : ""}until ${number(answer.reserve_soc_percent, 0)} % is left`}
        value={duration(time.value)}
      >
        {is_chance && <Dots of_100={95} />}
        <p class="figure-note">
          {is_chance
            ? <b class={contradictsFlights(answer) ? "" : "ok"}>in 95 of 100 flights</b>
            : awaits_chance ? <><b>half of the flights</b>; 95 of 100: computing</>
            : time.value != null ? `no chances yet: ${answer.time_in_air_95_s.unknown}` : inPageWords(time.unknown)}
          <Change text={changeOf(time.value, time_before?.value, duration)} />
        </p>
        {is_chance && <p class="soft">half of the flights: {duration(answer.time_in_air_s.value)}</p>}
        {time.value != null && known_down_to != null && known_down_to > answer.reserve_soc_percent && (
          <p class="soft">no flight went below {number(known_down_to, 0)} %: the voltage there is assumed</p>
        )}
      </Figure>
      <Figure
        label={speed != null && !answer.is_hover
          ? `Along the track, at ${quantity(speed, 1, "m/s")}`
          : "Along the track"}
        value={distance(answer.distance_m.value)}
      >
        <p class="figure-note">
          {answer.distance_m.value != null
            ? <>{is_chance || awaits_chance ? <b>half of the flights</b> : "as modelled"}, out and back</>
            : inPageWords(answer.distance_m.unknown)}
          <Change text={changeOf(answer.distance_m.value, before?.distance_m.value, distance)} />
        </p>
        {answer.distance_across_m != null && <p class="soft">across the wind: {distance(answer.distance_across_m)}</p>}
      </Figure>
    </section>
  );
}

const phase_colours: Record<string, string> = { takeoff: "take-off", cruise: "cruise", landing: "landing" };
const phase_words: Record<string, string> = { takeoff: "take-off", cruise: "cruise", landing: "landing" };

const minutes = (seconds: number[]) => seconds.map((value) => value / 60);

type OldCurve = Pick<Curve, "time_s" | "soc">;

/// Returns the lines of charge over a flight, the old ones dotted, on one axis of minutes.
function chargeLines(curve: Curve, old: OldCurve | null, old_name: string): { x: number[]; lines: Line[] } {
  const tables: uPlot.AlignedData[] = [[minutes(curve.time_s), curve.soc]];
  if (curve.band) tables.push([minutes(curve.band.time_s), curve.band.low, curve.band.high]);
  if (old) tables.push([minutes(old.time_s), old.soc]);
  const [x, ...columns] = uPlot.join(tables) as [number[], ...(number | null | undefined)[][]];
  const lines: Line[] = [];
  let at = 1;
  if (curve.band) {
    lines.push({ name: "90 of 100 flights", colour: "ink", band: columns[at], y: columns[at + 1] ?? [] });
    at += 2;
  }
  if (old) lines.push({ name: old_name, colour: "ink3", y: columns[at] ?? [], dashed: true });
  lines.push({ name: "charge", colour: "ink", y: columns[0] ?? [] });
  lines.push({ name: "reserve", colour: "alarm", y: x.map(() => curve.simulation.reserve_soc_percent), dashed: true });
  return { x, lines };
}

interface ChargePlotProps {
  curve: Curve;
  old: OldCurve | null;
  old_name?: string;
  name: string;
}

export function ChargePlot({ curve, old, old_name = "as measured", name }: ChargePlotProps) {
  const { x, lines } = useMemo(() => chargeLines(curve, old, old_name), [curve, old]);
  const stripes = useMemo(
    () => curve.phases.map((phase) => ({
      from: phase.from / 60,
      to: phase.to / 60,
      colour: phase_colours[phase.name] ?? "cruise",
    })),
    [curve],
  );
  const { reserve_soc_percent: reserve, final_soc_percent: final, duration_s, depleted_at_s: empty_s } =
    curve.simulation;
  const end_s = empty_s ?? duration_s;
  const words = empty_s != null
    ? `empty after ${duration(empty_s)}`
    : `${number(final, 0)} % after ${duration(duration_s)}`;
  const labels = useMemo(
    () => [
      { x: 0, y: reserve + 1, text: ` reserve ${number(reserve, 0)} %`, colour: "alarm" },
      {
        x: end_s / 60,
        y: final > 60 ? final - 14 : 88,
        text: words,
        colour: empty_s != null ? "alarm" : "ink",
        align: "right" as const,
      },
    ],
    [curve],
  );
  // Of a flight that runs empty, what would follow is left out.
  const x_range = empty_s != null ? ([0, Math.min(1.4 * empty_s, duration_s) / 60] as [number, number]) : undefined;
  return (
    <Plot
      x={x}
      lines={lines}
      stripes={stripes}
      strip
      labels={labels}
      legend={false}
      x_title="Time [min]"
      y_title="Charge [%]"
      y_range={[0, 100]}
      x_range={x_range}
      height={250}
      description={`${name}: charge over time, ${words}; reserve ${number(reserve, 0)} %.`}
    />
  );
}

function ChargeCard({ now, measured }: { now: Answered; measured?: Answered }) {
  const { curve, answer } = now;
  const power = answer.power_w.value;
  const aside = power != null && `${answer.is_hover ? "hover" : "cruise"} ${quantity(power, power < 100 ? 1 : 0, "W")}`;
  const old = measured && measured !== now ? measured.curve : null;
  return (
    <Card title="Charge over the flight" aside={aside}>
      {curve
        ? <ChargePlot curve={curve} old={old} name="The longest flight" />
        : <p>Unknown: {inPageWords(answer.time_in_air_s.unknown)}</p>}
      {curve && (
        <p class="plot-key">
          {curve.phases.map((phase) => (
            <span>
              <i
                class="swatch"
                style={{ background: `var(--${phase_colours[phase.name] ?? "cruise"})` }}
              /> {phase_words[phase.name] ?? phase.name}
            </span>
          ))}
          {curve.band && <span>grey: 90 of 100 flights</span>}
          {old && <span>dashed grey: as measured</span>}
        </p>
      )}
    </Card>
  );
}

/// Returns which mark a basis gets; the program's words begin with it.
export function basisOf(text: string): "measured" | "physics" | "assumption" {
  if (/^physics/.test(text)) return "physics";
  return /^(assum|estimated|as given)/.test(text) ? "assumption" : "measured";
}

function RestsOn({ answer }: { answer: Answer }) {
  const rows: [string, Known][] = [
    [answer.is_hover ? "Power in hover" : "Power in cruise", answer.power_w],
    ["Airspeed", answer.airspeed_m_per_s],
    ["Capacity", answer.capacity_ah],
    ["Resistance", answer.resistance_ohm],
  ];
  const shown: Record<string, (value: number) => string> = {
    "Power in hover": (value) => quantity(value, value < 100 ? 1 : 0, "W"),
    "Power in cruise": (value) => quantity(value, value < 100 ? 1 : 0, "W"),
    Airspeed: (value) => quantity(value, 1, "m/s"),
    Capacity: (value) => quantity(value, 1, "Ah"),
    Resistance: (value) => quantity(1000 * value, 0, "mΩ"),
  };
  return (
    <Card title="What it rests on">
      <ul class="rests">
        {rows.map(([name, known]) => (
          <li>
            <span class={`basis ${known.value == null ? "none" : basisOf(known.basis)}`} aria-hidden="true" />
            <span>
              <b>
                {name} {known.value != null ? shown[name]?.(known.value) : "unknown"}
              </b>{" "}
              {known.value != null ? known.basis : inPageWords(known.unknown)}
            </span>
          </li>
        ))}
        {answer.notes.map((note) => (
          <li>
            <span class="basis assumption" aria-hidden="true" />
            <span>{note}</span>
          </li>
        ))}
      </ul>
    </Card>
  );
}

interface LeftOut {
  flight: string;
  used_wh: number | null;
  predicted_wh: number | null;
  off_percent: number | null;
}

/// Reads the table of validate, whose columns are set apart by two spaces or more.
function leftOut(table: string, model: string): LeftOut[] {
  const rows = table.split("\n").map((line) => line.trim().split(/ {2,}/));
  const value = (cell: string | undefined) => (cell && Number.isFinite(Number(cell)) ? Number(cell) : null);
  return rows
    .filter((row) => row[1] === "total" && row[2] === model)
    .map((row) => ({
      flight: row[0] ?? "",
      used_wh: value(row[3]),
      predicted_wh: value(row[5]),
      off_percent: value(row[7]),
    }));
}

/// How each flight is predicted by the others, of `flightwatt validate`.
function useLeftOut(project: Project, aircraft: Aircraft, model: string | undefined): LeftOut[] {
  const [rows, setRows] = useState<LeftOut[]>([]);
  useEffect(() => {
    if (!model) return;
    let is_wanted = true;
    void project.run(["validate", aircraft.folder, "--quiet", "-o", "validate.txt"], false).then(async () => {
      if (is_wanted) setRows(leftOut(await project.text("validate.txt"), model));
    }).catch(() => undefined);
    return () => {
      is_wanted = false;
    };
  }, [aircraft.folder, model]);
  return rows;
}

const signed = (value: number | null) => (value != null && value > 0
  ? `+${quantity(value, 1, "%")}`
  : quantity(value, 1, "%"));

function PredictedCard({ project, aircraft, answered }: { project: Project; aircraft: Aircraft; answered: Answered }) {
  const error = answered.answer.prediction_error_percent;
  const rows = useLeftOut(project, aircraft, aircraft.measured?.curve?.simulation.power_model?.model);
  return (
    <Card title="How well are new flights predicted?">
      {error.value != null ? (
        <p>
          <b class="middle">{quantity(error.value, 1, "%")}</b> off: {error.basis}
        </p>
      ) : (
        <p>Unknown: {error.unknown}</p>
      )}
      {error.value != null && rows.length > 1 && (
        <table class="left-out">
          <thead>
            <tr>
              <th scope="col">Flight</th>
              <th scope="col">Used in the phases predicted</th>
              <th scope="col">Predicted</th>
              <th scope="col">Off</th>
            </tr>
          </thead>
          <tbody>
            {rows.slice(0, 6).map((row) => (
              <tr>
                <th scope="row"><bdi>{row.flight}</bdi></th>
                <td>{quantity(row.used_wh, 1, "Wh")}</td>
                <td>{quantity(row.predicted_wh, 1, "Wh")}</td>
                <td>{signed(row.off_percent)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      )}
      {error.value != null && rows.length > 6 && <p class="soft">and {rows.length - 6} more</p>}
    </Card>
  );
}

/// How good a health is.
export const healthGrade: Record<string, Grade> = { healthy: "good", watch: "doubt", retire: "bad", unknown: "none" };
export const healthWord: Record<string, string> = {
  healthy: "Healthy",
  watch: "Watch",
  retire: "Retire",
  unknown: "Too early to say",
};

function PackHealth({ answer }: { answer: Answer }) {
  const pack = answer.packs[0];
  if (!pack) return null;
  return (
    <Card title={pack.pack === "unnamed" ? "The pack" : pack.pack} aside={<a href="#flights">Packs</a>}>
      <p>
        <Verdict grade={healthGrade[pack.health] ?? "none"}>{healthWord[pack.health] ?? pack.health}</Verdict>
      </p>
      <p class="small">
        {pack.reason}
      </p>
    </Card>
  );
}

function headline({ answer, question }: Answered, awaits_chance: boolean): string {
  const time = mainTime(answer);
  if (time.value == null) return answer.power_w.value != null
    ? `It draws ${quantity(answer.power_w.value, answer.power_w.value < 100 ? 1 : 0, "W")}; how long is not known yet`
    : "How long it flies is not known yet";
  const chance = answer.time_in_air_95_s.value != null ? " in 95 of 100 flights" : awaits_chance ? " in half of the flights" : "";
  const asked = asWords(question);
  const begin = asked ? `${asked.charAt(0).toUpperCase()}${asked.slice(1)} a` : "A";
  return `${begin} full pack lasts ${isColderThanFlown(answer) ? "at most " : ""}${duration(time.value)}${chance}`;
}

/// What the program warns of; what it warns of in a flight, which its line of the logs has too, is folded.
export function Warnings({ texts, flights }: { texts: string[]; flights: string[] }) {
  if (texts.length === 0) return null;
  const isOfFlight = (text: string) => flights.some((flight) => text.startsWith(`${flight}: `));
  const of_flights = texts.filter(isOfFlight);
  return (
    <Card class="warned">
      {texts.filter((text) => !isOfFlight(text)).map((text) => <p><Verdict grade="doubt">{inPageWords(text)}</Verdict></p>)}
      {of_flights.length > 0 && (
        <Folded title={of_flights.length === 1 ? "1 warning of a flight" : `${of_flights.length} warnings of flights`}>
          <ul class="rests">{of_flights.map((text) => <li>{inPageWords(text)}</li>)}</ul>
        </Folded>
      )}
    </Card>
  );
}

/// What to do where the answer lacks its capacity.
function CapacityAsked({ aircraft, project }: { aircraft: Aircraft; project: Project }) {
  const answer = aircraft.now?.answer;
  if (!answer || answer.capacity_ah.value != null) return null;
  return (
    <form class="card asked" onSubmit={(event) => {
      event.preventDefault();
      const ah = Number(String(new FormData(event.currentTarget).get("capacity")).replace(",", "."));
      if (ah > 0) project.ask(aircraft.id, { ...aircraft.question, capacity_ah: ah });
    }}>
      <Mark grade="doubt" />
      <label for="asked-capacity">What capacity is on the pack’s label?</label>
      <input id="asked-capacity" name="capacity" type="text" inputMode="decimal" size={5} /> <span>Ah</span>
      <button type="submit" class="primary">Answer</button>
      <p class="soft">{inPageWords(answer.capacity_ah.unknown)}</p>
    </form>
  );
}

export function AnswerScreen({ project, aircraft }: { project: Project; aircraft?: Aircraft }) {
  if (!aircraft) return <NoLogs project={project} />;
  const { now, measured, moving } = aircraft;
  if (!now)
    return aircraft.failed ? (
      <>
        <h1>{aircraft.name}: no answer</h1>
        <Card><Verdict grade="bad">{inPageWords(aircraft.failed)}</Verdict></Card>
        {optionsOf(aircraft.question).length > 0 && (
          <button type="button" class="quiet" onClick={() => project.ask(aircraft.id, {})}>As measured</button>
        )}
      </>
    ) : (
      <h1 aria-live="polite">{aircraft.name}: computing</h1>
    );
  const is_old = project.isOld(aircraft.id);
  const asking = is_old && !aircraft.failed;
  const shown = moving ?? now;
  const awaits_chance = moving != null && now.answer.time_in_air_95_s.value != null;
  const { answer } = shown;
  const command = ["flightwatt", project.inputsShown(aircraft.logs, aircraft), ...optionsOf(aircraft.question).map(quoted)].join(" ");
  return (
    <>
      <header class="screen-head">
        <div>
          <p class="over">
            <b>{aircraft.name}</b> · {answer.flights_used === 1 ? "1 flight" : `${answer.flights_used} flights`}
            {answer.packs[0]?.cells ? ` · ${answer.packs[0].cells} cells` : ""}
            {answer.capacity_ah.value != null ? ` · ${quantity(answer.capacity_ah.value, 1, "Ah")}` : ""}
          </p>
          <h1 class={is_old && !moving ? "old" : ""} aria-live="polite">{headline(shown, awaits_chance)}</h1>
        </div>
      </header>
      {aircraft.failed && <Card class="failed"><Verdict grade="bad">{inPageWords(aircraft.failed)}</Verdict></Card>}
      <Warnings texts={now.warnings} flights={aircraft.logs.map((line) => line.flight)} />
      <CapacityAsked aircraft={aircraft} project={project} />
      <div class="answer">
        <WhatIf project={project} aircraft={aircraft} asking={asking} />
        <div class="answer-middle">
          <Figures now={shown} measured={measured} asking={asking} awaits_chance={awaits_chance} is_old={is_old && !moving} />
          <ChargeCard now={shown} measured={measured} />
          <div class="pair">
            <RestsOn answer={answer} />
            <PredictedCard project={project} aircraft={aircraft} answered={now} />
          </div>
        </div>
        <div class="answer-right">
          <FailsafeCard project={project} aircraft={aircraft} answered={now} is_old={is_old} />
          <PackHealth answer={answer} />
        </div>
      </div>
      <Command line={command} />
    </>
  );
}

/// What the screens of an aircraft show while there is none.
export function NoLogs({ project: { state } }: { project: Project }) {
  if (!state.ready || state.progress) return <h1 aria-live="polite">{state.progress ? "Reading the logs" : "Opening"}</h1>;
  return (
    <>
      <h1>No aircraft yet</h1>
      {state.unused.length > 0 || state.waiting.length > 0 ? (
        <p>None of the logs is used: <a href="#logs">why</a>.</p>
      ) : (
        <p>
          <a href="#logs">Drop its logs</a>: one flight gives a mean, three give chances.
        </p>
      )}
    </>
  );
}
