// Whether a plan or an area fits a pack: new-mission, path and simulate on the aircraft of the answer.
import { useCallback, useEffect, useMemo, useState } from "preact/hooks";
import { Card, Command, Facts, Folded, Mark, save, type Grade } from "../ui/basics";
import { chance, distance, duration, number, quantity } from "../ui/format";
import { Icon } from "../ui/icons";
import { ChargeKey, packTracks } from "../sections/mission_map";
import { TrackMap, type Place, type Spot, type Track } from "../ui/map";
import { Plot } from "../ui/plot";
import { Slider } from "../ui/slider";
import { track } from "../work/csv";
import type { Answer, PlanBlock, PlanRemedy, Simulation } from "../work/documents";
import { blocksOf, flyPlan, isAboveTerrain, missionShown, planCommand, planFiles, remediesOf, type FlownPlan, type PlanOptions } from "../work/flown_plan";
import { useLatest } from "../work/latest";
import { inPageWords } from "../work/question";
import { areaFile, shapeOf, type PlanShape } from "../work/plan_shapes";
import { errorsOf, terrain_folder, type Aircraft, type Answered, type Curve, type Project, type State } from "../work/project";
import { ChargePlot, NoLogs } from "./answer";
import { FilesButton, takeFiles } from "./logs";

const fileName = (path: string) => path.split("/").pop() ?? path;
/// With the folder that it came from.
const planName = (path: string) => path.replace(/^(plans|missions)\//, "");
const no_plan: PlanOptions = { plan: "FILE", blocks: [], packs: 1 };
const drawn_area = "plans/drawn area.geojson";

/// Why a plan that keeps its reserve as modelled may not keep it; nothing where none of that is the case.
function doubtsOf(simulation: Simulation, kept: number | null, awaits_chance: boolean): string[] {
  const by_flights = [simulation, ...(simulation.flights ?? [])]
    .find((one) => one.with_capacity_of_flights?.keeps_reserve === false)?.with_capacity_of_flights;
  return [
    ...(simulation.uncertain ?? []).map(inPageWords),
    ...(by_flights ? [`with ${quantity(by_flights.capacity_ah, 1, "Ah")}, which the flights indicate, it misses the reserve`] : []),
    ...(kept != null
      ? []
      : [awaits_chance ? "that is as modelled: its chance is computed next" : simulation.packs
        ? "that is as modelled: each flight lands with less in about half of the flights"
        : "nothing shows how the power of flights differs: its chance is unknown"]),
  ];
}

/// What a simulated plan comes to, in words; it fits where 95 of 100 flights keep the reserve, as in `check`.
export function verdictOf({ simulation, time_s, soc }: Curve, awaits_chance = false): {
  grade: Grade;
  title: string;
  detail: string;
  chance: string;
} {
  const reserve = simulation.reserve_soc_percent;
  const packs = simulation.packs
    ? (simulation.packs_needed === 1 ? "one pack" : `${simulation.packs_needed ?? simulation.packs} packs`)
    : "one pack";
  const below = soc.findIndex((value) => value != null && value < reserve);
  const empty = simulation.depleted_at_s ?? simulation.cut_off_at_s;
  const kept = simulation.probability_below_reserve != null ? 1 - simulation.probability_below_reserve : null;
  const lands =
    `Lands with ${number(simulation.final_soc_percent, 1)} % of its charge after ${duration(simulation.duration_s)}.`;
  const words = kept != null ? chance(kept) : "";
  const doubts = doubtsOf(simulation, kept, awaits_chance);
  const doubt = doubts.length > 0 ? `${lands.slice(0, -1)}, but ${doubts.join("; ")}.` : lands;
  if (!simulation.keeps_reserve) {
    const where = below >= 0 && time_s[below] != null
      ? `Below the reserve of ${number(reserve, 0)} % after ${duration(time_s[below])}`
      : `Misses the reserve of ${number(reserve, 0)} %`;
    return {
      grade: "bad",
      title: `Does not fit ${packs}`,
      detail: `${where}${empty != null ? `; empty after ${duration(empty)}` : ""}.`,
      chance: words,
    };
  }
  if (kept != null && kept < 0.95) return {
    grade: "doubt",
    title: "May miss the reserve",
    detail: doubt,
    chance: words,
  };
  if (doubts.length > 0) return {
    grade: "doubt",
    title: simulation.packs ? `Perhaps fits ${packs}` : "Perhaps",
    detail: doubt,
    chance: words,
  };
  return { grade: "good", title: `Fits ${packs}`, detail: lands, chance: words };
}

/// Returns that the pack of a plan is not known, where the answer lacks its capacity; missions have their own pack.
export function unknownPack(answer: Answer | undefined, plan: string): string {
  if (!answer || answer.capacity_ah.value != null || /\.toml$/i.test(plan)) return "";
  const interval = answer.flights_capacity_ah_interval_95;
  const indicated = interval ? `: the flights indicate ${number(interval.low, 1)} to ${quantity(interval.high, 1, "Ah")}, and one between is flown` : "";
  return `The capacity of the pack is unknown${indicated}. State it on the screen Answer: the result is then that of your pack.`;
}

function Band({ flown: { options, curve, awaits_chance }, answer, asking }: { flown: FlownPlan; answer?: Answer; asking: boolean }) {
  const verdict = verdictOf(curve, awaits_chance);
  const [figure, ...rest] = verdict.chance.split(" of ");
  return (
    <section
      class={`verdict-band ${verdict.grade}${asking && !awaits_chance ? " old" : ""}`}
      aria-label="Verdict"
      aria-live="polite"
      aria-busy={asking}
    >
      <Mark grade={verdict.grade} />
      <div>
        <h1>{verdict.title}</h1>
        <p>{verdict.detail}</p>
        {unknownPack(answer, options.plan) && <p>{unknownPack(answer, options.plan)}</p>}
      </div>
      {verdict.chance && (
        <p class="band-chance">
          <b>{figure}</b> of {rest.join(" of ")} flights keep the reserve{curve.simulation.packs ? ", with each pack" : ""}
        </p>
      )}
    </section>
  );
}

/// The sliders of a plan and what each is where nothing is asked.
function PlanSliders({ flown, options, change }: {
  flown: FlownPlan;
  options: PlanOptions;
  change: (next: Partial<PlanOptions>) => void;
}) {
  const speed = options.airspeed ?? flown.airspeed;
  return (
    <>
      {flown.is_area && flown.spacing != null && (
        <SpacingSlider value={options.spacing ?? flown.spacing} options={options} change={change} />
      )}
      {flown.is_area && flown.heading != null && (
        <Slider
          label="Heading of the lines"
          value={options.heading ?? flown.heading}
          min={0}
          max={179}
          step={1}
          shown={`${number(options.heading ?? flown.heading, 0)}°`}
          changed={options.heading != null}
          onChange={(heading) => change({ heading })}
        />
      )}
      {speed != null && (
        <Slider
          label="Airspeed"
          value={speed}
          min={1}
          max={Math.max(20, Math.ceil(1.5 * speed))}
          step={0.1}
          shown={quantity(speed, 1, "m/s")}
          changed={options.airspeed != null}
          onChange={(airspeed) => change({ airspeed })}
        />
      )}
      <Slider
        label="Wind"
        value={options.wind ?? 0}
        min={0}
        max={15}
        step={0.5}
        shown={options.wind ? quantity(options.wind, 1, "m/s") : "calm"}
        changed={!!options.wind}
        onChange={(wind) => change({ wind })}
      />
      {!!options.wind && (
        <Slider
          label="Wind from"
          value={options.wind_from ?? 0}
          min={0}
          max={355}
          step={5}
          shown={`${options.wind_from ?? 0}°`}
          changed
          onChange={(wind_from) => change({ wind_from })}
        />
      )}
      <Slider
        label="Packs"
        value={options.packs}
        min={1}
        max={6}
        step={1}
        shown={String(options.packs)}
        changed={options.packs > 1}
        onChange={(packs) => change({ packs })}
      />
    </>
  );
}

export interface Help extends Pick<PlanRemedy, "text" | "suffices" | "probability"> {
  /// Enough as modelled, of which no chance is known.
  is_modelled?: boolean;
  /// Absent: none of this page's.
  change?: Partial<PlanOptions>;
}

const changed_by: Partial<Record<PlanRemedy["kind"], keyof PlanOptions>> = {
  airspeed: "airspeed",
  heading: "heading",
  spacing: "spacing",
};

/// Changes that may make a plan fit, each simulated: another pack, and of one pack what `check` tries.
function useHelp(project: Project, aircraft: Aircraft, answered: Answered | undefined, flown: FlownPlan | null) {
  const [help, setHelp] = useState<Help[]>([]);
  useEffect(() => {
    setHelp([]);
    if (!answered || !flown || flown.awaits_chance || verdictOf(flown.curve).grade === "good" || /\.toml$/i.test(flown.options.plan)) return;
    let is_wanted = true;
    const { options, curve } = flown;
    const add = (more: Help[]) => is_wanted && setHelp((before) => [...before, ...more]);
    void (async () => {
      if (!curve.simulation.keeps_reserve) {
        const packs = curve.simulation.packs_needed ?? options.packs + 1;
        const found = await flyPlan(project, aircraft, answered, { ...options, packs });
        if (typeof found !== "string") add([{
          text: `${packs} packs`,
          change: { packs },
          suffices: false,
          is_modelled: verdictOf(found.curve).grade !== "bad",
          probability: null,
        }]);
      }
      if (!is_wanted || options.packs > 1) return;
      const remedies = await remediesOf(project, aircraft, answered, options);
      add(remedies.map(({ kind, value, ...rest }) => {
        const option = changed_by[kind];
        const is_modelled = rest.suffices && rest.probability == null;
        return { ...rest, suffices: rest.suffices && !is_modelled, is_modelled, change: option && { [option]: value } };
      }));
    })();
    return () => {
      is_wanted = false;
    };
  }, [flown]);
  return help;
}

/// A change that may help; those of this page are made by a click.
export function HelpLine({ help: { text, suffices, is_modelled, probability, change }, onChange }: {
  help: Help;
  onChange: (change: Partial<PlanOptions>) => void;
}) {
  const words = suffices ? "enough" : is_modelled ? "perhaps: in about half of the flights" : "not enough alone";
  const line = (
    <>
      <Mark grade={suffices ? "good" : "doubt"} />
      <span>
        <b>{text}</b>
        <span class="under">{probability != null ? `${words}, ${chance(probability)}` : words}</span>
      </span>
    </>
  );
  if (!change) return <p class="help">{line}</p>;
  return <button type="button" class="help" onClick={() => onChange(change)}>{line}<Icon name="arrow" /></button>;
}

function useShape(project: Project, plan: string, dropped: State["dropped"]): PlanShape {
  const [shape, setShape] = useState<PlanShape>({ lines: [], areas: [], named: [] });
  useEffect(() => {
    if (plan) void project.text(plan).then(
      (text) => setShape(shapeOf(plan, text)),
      () => setShape({ lines: [], areas: [], named: [] }),
    );
    else setShape({ lines: [], areas: [], named: [] });
  }, [plan, dropped]);
  return shape;
}

/// The way of the aircraft's first flight, behind an area that is drawn.
function useFlownPlaces(project: Project, aircraft: Aircraft | undefined): Place[] {
  const [places, setPlaces] = useState<Place[]>([]);
  useEffect(() => {
    const flight = aircraft?.logs[0]?.flight;
    if (!aircraft || !flight) return;
    void project.series(aircraft.folder, flight).then((series) => {
      const [latitude, longitude] = [track(series, "latitude_deg").y, track(series, "longitude_deg").y];
      setPlaces(latitude.slice(0, longitude.length).map((value, i): Place => [value, longitude[i] as number]));
    }, () => undefined);
  }, [aircraft?.folder]);
  return places;
}

interface MapProps {
  shape: PlanShape;
  flown: Place[];
  drawing: Place[] | null;
  plan: FlownPlan | null;
  onPlace: (place: Place) => void;
}

/// The tracks of a plan as it is flown, which are drawn where the earth's place of its path is known.
function flownTracks(plan: FlownPlan | null) {
  const simulation = plan?.curve.simulation;
  const flights = simulation?.flights ?? [{ pack: 1, track: plan?.path?.track }];
  const known = flights.filter(({ track }) => track?.latitude_deg);
  return { ...packTracks(known, simulation?.reserve_soc_percent ?? 0), several: known.length > 1 };
}

function PlanMap({ shape, flown, drawing, plan, onPlace }: MapProps) {
  const way = useMemo(() => flownTracks(plan), [plan]);
  const tracks = useMemo((): Track[] => {
    if (drawing) return [
      { name: "flown before", colour: "ink3", places: flown, weight: 1.5 },
      { name: "the area", colour: "link", places: drawing, closed: drawing.length > 2 },
    ];
    return [
      ...shape.areas.map((places): Track => ({ name: "area", colour: "link", places, closed: true })),
      ...(way.tracks.length > 0
        ? way.tracks
        : shape.lines.map((places): Track => ({ name: "plan", colour: "cruise", places }))),
    ];
  }, [shape, flown, drawing, way]);
  const spots = useMemo((): Spot[] => {
    if (drawing) return drawing.map((place, i) => ({ name: `corner ${i + 1}`, colour: "link", place }));
    const first = shape.home ?? shape.lines[0]?.[0];
    const named = [
      ...shape.named.map(({ name, place }): Spot => ({ name, colour: "cruise", place })),
      ...(way.several ? way.spots : []),
    ];
    return first ? [{ name: "home", colour: "ink", place: first }, ...named] : named;
  }, [shape, drawing, way]);
  const click = useCallback((place: Place) => drawing && onPlace(place), [drawing, onPlace]);
  const map = <TrackMap
    tracks={tracks}
    spots={spots}
    wind={drawing ? null : way.wind}
    still={drawing != null && drawing.length > 0}
    view={flown[0]}
    height={380}
    onClick={click}
    description="The plan on a map, north at the top, coloured by the charge that is left."
  />;
  if (drawing || !plan || way.tracks.length === 0) return map;
  return <>{map}<ChargeKey reserve={plan.curve.simulation.reserve_soc_percent} /></>;
}

function SoftwareStrip({ curve }: { curve: Curve }) {
  if (!curve.compute_w.some((value) => value)) return null;
  return (
    <Plot
      x={curve.time_s.map((value) => value / 60)}
      lines={[{ name: "software", colour: "cruise", y: curve.compute_w }]}
      legend={false}
      height={110}
      x_title="Time [min]"
      y_title="Software [W]"
      description="The power of the software over the flight."
    />
  );
}

const plan_formats = [
  ["plan", "Plan, QGroundControl"], ["waypoints", "Plan, Mission Planner"], ["blocks", "Plan, Paparazzi"],
] as const;

const export_formats = [
  [
    "failsafe-ardupilot",
    "Failsafe, ArduPilot",
    ".parm",
  ], ["failsafe-px4", "Failsafe, PX4", ".params"], ["failsafe-inav", "Failsafe, INAV", ".txt"],
  [
    "failsafe-paparazzi",
    "Failsafe, Paparazzi",
    ".xml",
  ], ["px4", "Estimator, PX4", ".params"], ["inav", "Estimator, INAV", ".txt"], [
    "paparazzi",
    "Estimator, Paparazzi",
    ".xml",
  ],
] as const;

function SaveButtons({ project, aircraft, answered, flown }: {
  project: Project;
  aircraft: Aircraft;
  answered?: Answered;
  flown: FlownPlan;
}) {
  const is_mission = /\.toml$/i.test(flown.options.plan);
  const plans = is_mission || !answered ? [] : plan_formats;
  const [chosen, setFormat] = useState("");
  const format = chosen || (plans[0] ?? export_formats[0])[0];
  const [said, setSaid] = useState<{ of: FlownPlan; failed: string; remarks: string[] } | null>(null);
  const say = (failed: string, remarks: string[] = []) => setSaid({ of: flown, failed, remarks });
  const name = fileName(flown.options.plan).replace(/\.\w+$/, "");
  const mission = is_mission ? flown.mission : missionShown(flown.mission, aircraft.folder, project.folderShown(aircraft));
  const savePlan = async () => {
    if (!answered) return;
    const planned = await planFiles(project, aircraft, answered, flown.options, format);
    if (typeof planned === "string") return say(planned);
    say("", planned.remarks);
    for (const file of planned.files) save(`${name}-${file.name}`, file.text, "text/plain");
  };
  const saveExport = async () => {
    const path = is_mission ? flown.options.plan : "export-mission.toml";
    // Other plans and questions may have been flown since.
    if (!is_mission) await project.write(path, flown.mission);
    const args = ["export", path, "--format", format];
    const result = await (answered ? project.runOnAnswer(aircraft.id, answered, args) : project.run(args));
    if (result.code !== 0) return say(errorsOf(result));
    say("");
    save(`${name}-${format}${export_formats.find((one) => one[0] === format)?.[2] ?? ""}`, result.out, "text/plain");
  };
  return (
    <>
      <h2 class="section">Save</h2>
      <p class="buttons">
        <button type="button" class="quiet" onClick={() => save(`${name}-mission.toml`, mission, "text/plain")}>
          <Icon name="save" /> Mission
        </button>
        <button
          type="button"
          class="quiet"
          onClick={() => save(`${name}-charge.csv`, flown.curve.csv, "text/csv")}
        >
          <Icon name="save" /> Charge (CSV)
        </button>
      </p>
      <p class="buttons">
        <select
          aria-label="Format for the autopilot"
          value={format}
          onChange={(event) => setFormat(event.currentTarget.value)}
        >
          {[...plans, ...export_formats].map(([id, words]) => (
            <option value={id}>{words}</option>
          ))}
        </select>
        <button
          type="button"
          class="quiet"
          onClick={() => void (plans.some(([id]) => id === format) ? savePlan() : saveExport())}
        >
          <Icon name="save" /> File
        </button>
      </p>
      {said?.of === flown && said.failed && <p class="small">{said.failed}</p>}
      {said?.of === flown && said.remarks.length > 0 && (
        <ul class="rests" aria-label="What was planned">{said.remarks.map((one) => <li>{one}</li>)}</ul>
      )}
    </>
  );
}

function PacksTable({ simulation }: { simulation: Simulation }) {
  if (!simulation.flights) return null;
  return (
    <ul class="pack-flights">
      {simulation.flights.map((flight) => (
        <li>
          <b>Pack {flight.pack}</b> {duration(flight.duration_s)}, lands with {number(flight.final_soc_percent, 1)} %
          {flight.probability_below_reserve != null && `, ${chance(1 - flight.probability_below_reserve)} keep the reserve`}
          {flight.return_from ? `; leaves at ${flight.return_from}` : ""}
        </li>
      ))}
    </ul>
  );
}

function BlockChoice({ blocks, options, change }: {
  blocks: PlanBlock[];
  options: PlanOptions;
  change: (next: Partial<PlanOptions>) => void;
}) {
  if (blocks.length === 0) return null;
  const toggle = (name: string, on: boolean) =>
    change({ blocks: blocks.map((one) => one.block).filter((one) => (one === name
      ? on
      : options.blocks.includes(one))) });
  return (
    <fieldset class="blocks">
      <legend>Blocks that are flown</legend>
      {blocks.map((one) => (
        <label>
          <input
            type="checkbox"
            checked={options.blocks.includes(one.block)}
            onChange={(event) => toggle(one.block, event.currentTarget.checked)}
          /> {one.block}{" "}
          <span class="soft">{one.flown}{one.length_m > 0 ? `, ${distance(one.length_m)}` : ""}</span>
        </label>
      ))}
    </fieldset>
  );
}

function NoPlan({ project, onDraw }: { project: Project; onDraw: () => void }) {
  return (
    <div class="drop plan-drop">
      <Icon name="plan" size={48} />
      <p class="drop-title">Drop a plan or an area here</p>
      <p class="soft">
        .plan of QGroundControl, .waypoints of Mission Planner, a flight plan of Paparazzi (.xml), .kml, .geojson, or
        the folder of a mission
      </p>
      <p class="drop-buttons">
        <FilesButton label="Choose a plan" class="primary" onFiles={(files) => void takeFiles(project, files)} />{" "}
        <button type="button" class="quiet" onClick={onDraw}>
          Draw an area
        </button>
      </p>
    </div>
  );
}

/// The options of the plan on the screen; another plan begins with its own, an edited one keeps them.
function usePlanOptions(project: Project, state: State) {
  const [options, setOptions] = useState<PlanOptions | null>(null);
  const [blocks, setBlocks] = useState<PlanBlock[]>([]);
  const open = useCallback(async (plan: string) => {
    const found = await blocksOf(project, plan);
    setBlocks(found);
    const survey = found.find((one) =>
      /survey/i.test(one.block)) ?? [...found].sort((a, b) => b.length_m - a.length_m)[0];
    const chosen = survey ? [survey.block] : [];
    setOptions((before) => {
      if (before?.plan !== plan) return { plan, blocks: chosen, packs: 1 };
      const blocks = before.blocks.filter((name) => found.some((one) => one.block === name));
      return { ...before, blocks: blocks.length > 0 ? blocks : chosen };
    });
  }, [project]);
  const last = state.plans[state.plans.length - 1];
  useEffect(() => {
    const plan = state.dropped.plan ?? options?.plan ?? last;
    if (plan) void open(plan);
  }, [state.dropped, !last]);
  return { options, setOptions, blocks, open };
}

/// The folder of the dropped tiles, for a plan whose altitudes are above the terrain.
function useTerrain(project: Project, plan: string | undefined, { tiles, dropped }: State): string | undefined {
  const [is_above, setAbove] = useState(false);
  useEffect(() => {
    setAbove(false);
    if (plan && /\.(plan|waypoints)$/i.test(plan)) void project.text(plan).then((text) => setAbove(isAboveTerrain(text)));
  }, [plan, dropped]);
  return is_above && tiles > 0 ? terrain_folder : undefined;
}

export function PlanScreen({ project, state, aircraft }: { project: Project; state: State; aircraft?: Aircraft }) {
  const { options, setOptions, blocks, open } = usePlanOptions(project, state);
  const terrain = useTerrain(project, options?.plan, state);
  const [drawing, setDrawing] = useState<Place[] | null>(null);
  const answered = aircraft?.now;
  const { found: flown, failed, asking } = useLatest(
    options,
    async (latest) => (aircraft && answered ? flyPlan(project, aircraft, answered, { ...latest, terrain }, false) : ""),
    [options, answered, terrain],
    (latest, { awaits_chance }) => (aircraft && answered && awaits_chance ? flyPlan(project, aircraft, answered, { ...latest, terrain }) : null),
  );
  const places = useFlownPlaces(project, aircraft);
  const shape = useShape(project, options?.plan ?? "", state.dropped);
  const onPlace = useCallback((place: Place) => setDrawing((before) => [...(before ?? []), place]), []);
  if (!aircraft) return <NoLogs project={project} />;
  const change = (next: Partial<PlanOptions>) => options && setOptions({ ...options, ...next });
  const finish = async () => {
    if (!drawing || drawing.length < 3) return;
    await project.write(drawn_area, areaFile(drawing), true);
    setDrawing(null);
  };
  const last = flown && options && flown.options.plan === options.plan ? flown : null;
  const shown = failed ? null : last;
  return (
    <>
      {!shown && <h1>
        {drawing
          ? "Click the corners of the area"
          : options
            ? (failed ? `${planName(options.plan)}: not flown` : `${planName(options.plan)}: computing`)
            : "Does a plan fit?"}
      </h1>}
      {failed && <Card class="failed"><p role="alert"><Mark grade="bad" /> {inPageWords(failed)}</p></Card>}
      {shown && <Band flown={shown} answer={answered?.answer} asking={asking} />}
      <div class={`plan${options || drawing ? "" : " alone"}`}>
        <div class="plan-left">
          {!options && !drawing ? (
            <NoPlan project={project} onDraw={() => setDrawing([])} />
          ) : (
            <Card title={drawing ? "Draw an area" : planName(options?.plan ?? "")} aside={
              drawing ? (
                <span class="buttons">
                  <button
                    type="button"
                    class="quiet"
                    disabled={drawing.length === 0}
                    onClick={() => setDrawing(drawing.slice(0, -1))}
                  >Undo</button>
                  <button
                    type="button"
                    class="primary"
                    disabled={drawing.length < 3}
                    onClick={() => void finish()}
                  >Done</button>
                  <button type="button" class="quiet" onClick={() => setDrawing(null)}>Cancel</button>
                </span>
              ) : (
                <span class="buttons">
                  {state.plans.length > 1 && (
                    <select
                      aria-label="Plan"
                      value={options?.plan}
                      onChange={(event) => void open(event.currentTarget.value)}
                    >
                      {state.plans.map((one) => <option value={one}>{planName(one)}</option>)}
                    </select>
                  )}
                  <FilesButton label="Open" onFiles={(files) => void takeFiles(project, files)} />
                  <button type="button" class="quiet" onClick={() => setDrawing([])}>Draw an area</button>
                </span>
              )
            }>
              <PlanMap shape={shape} flown={places} drawing={drawing} plan={shown} onPlace={onPlace} />
              {shown && !drawing && <PlanFacts flown={shown} />}
            </Card>
          )}
          {shown && !drawing && (
            <Card title="Charge over time">
              <ChargePlot curve={shown.curve} old={null} name={fileName(shown.options.plan)} />
              <SoftwareStrip curve={shown.curve} />
              <PacksTable simulation={shown.curve.simulation} />
            </Card>
          )}
        </div>
        {options && !drawing && (
          <PlanSide
            project={project}
            aircraft={aircraft}
            answered={answered}
            flown={shown}
            last={last}
            failed={failed}
            options={options}
            blocks={blocks}
            change={change}
          />
        )}
      </div>
      <Command line={planCommand(
        project.inputsShown(aircraft.logs, aircraft), project.folderShown(aircraft), shown?.options ?? options ?? no_plan, answered?.question,
      )} />
    </>
  );
}

function PlanFacts({ flown }: { flown: FlownPlan }) {
  const turns = flown.legs.filter((leg) => leg.kind === "circles").length;
  const facts: [string, string | null][] = [
    ["Way", flown.path ? distance(flown.path.length_m) : null],
    ["Time", duration(flown.curve.simulation.duration_s)],
    ["Energy", quantity(flown.curve.simulation.energy_wh, 1, "Wh")],
    ["Power on the way", flown.path ? quantity(flown.path.mechanical_w, flown.path.mechanical_w < 100 ? 1 : 0, "W") : null],
    ["Turns", flown.is_area && turns > 0 ? String(turns) : null],
  ];
  return (
    <p class="plan-facts">
      {facts.map(([name, value]) => value && <span>{name} <b>{value}</b></span>)}
    </p>
  );
}

interface SideProps {
  project: Project;
  aircraft: Aircraft;
  answered?: Answered;
  flown: FlownPlan | null;
  /// The same, or where it cannot be flown any more what was flown before: its sliders take that back.
  last: FlownPlan | null;
  /// Why it cannot be flown.
  failed: string;
  options: PlanOptions;
  blocks: PlanBlock[];
  change: (next: Partial<PlanOptions>) => void;
}

function SpacingSlider({ value, options, change }: { value: number } & Pick<SideProps, "options" | "change">) {
  return (
    <Slider
      label="Spacing of the lines"
      value={value}
      min={5}
      max={200}
      step={1}
      shown={quantity(value, 0, "m")}
      changed={options.spacing != null}
      onChange={(spacing) => change({ spacing })}
    />
  );
}

function PlanSide({ project, aircraft, answered, flown, last, failed, options, blocks, change }: SideProps) {
  const help = useHelp(project, aircraft, answered, flown);
  // Of an area that was never flown, as its lines are too far apart.
  const unfit_m = last ? null : /no lines ([\d.]+) m apart fit into the area/.exec(failed)?.[1];
  if (!last && !unfit_m && blocks.length === 0) return null;
  const error = flown?.curve.simulation.power_model?.mean_absolute_error_percent;
  return (
    <section class="card plan-side" aria-label="Change the plan">
      {help.length > 0 && <h2>What would help</h2>}
      {help.map((one) => <HelpLine help={one} onChange={change} />)}
      <BlockChoice blocks={blocks} options={options} change={change} />
      {unfit_m && <SpacingSlider value={options.spacing ?? Number(unfit_m)} options={options} change={change} />}
      {last && !/\.toml$/i.test(options.plan) && <PlanSliders flown={last} options={options} change={change} />}
      {flown && <SaveButtons project={project} aircraft={aircraft} answered={answered} flown={flown} />}
      {flown && (
        <Folded title="What it rests on">
          <Facts
            rows={[
              ["Power", flown.curve.simulation.power_model?.model],
              ["Off", error != null ? quantity(error, 1, "%") : null],
            ]}
          />
          <ul class="rests">{flown.remarks.map((one) => <li>{one}</li>)}</ul>
        </Folded>
      )}
    </section>
  );
}
