// A plan flown by an aircraft: the commands new-mission, path and simulate, one after the other.
import type { Engine } from "../engine/engine";
import { numbers, parseCsv, texts } from "./csv";
import type { PathSummary, PlanBlock, PlanRemedy, Simulation } from "./documents";
import { errorsOf, type Aircraft, type Answered, type Curve, type Project } from "./project";
import { optionsOf, quoted, type Question } from "./question";

export interface PlanOptions {
  plan: string;
  blocks: string[];
  airspeed?: number;
  wind?: number;
  wind_from?: number;
  packs: number;
  /// Of an area; absent: as the program chooses.
  spacing?: number;
  heading?: number;
  /// Folder of tiles, for a plan with altitudes above the terrain.
  terrain?: string;
}

export interface FlownPlan {
  /// As asked, with the airspeed where the model asks for one.
  options: PlanOptions;
  mission: string;
  curve: Curve;
  /// Whether its chance is computed next.
  awaits_chance: boolean;
  path: PathSummary | null;
  legs: { leg: string; kind: string; start_s: number; duration_s: number }[];
  /// What the program chose or left out.
  remarks: string[];
  is_area: boolean;
  spacing: number | null;
  heading: number | null;
  airspeed: number | null;
}

const mission_name = "plan-mission.toml";

/// Returns the options of new-mission and check: the aircraft, how the plan is flown, and what is asked of it.
function flightOptions(folder: string, options: PlanOptions, question: Question): string[] {
  const wind = options.wind ? `${options.wind}@${options.wind_from ?? 0}` : undefined;
  const option = (name: string, value: number | string | undefined) => (value != null ? [`--${name}`, String(value)] : []);
  return [
    "--model", `${folder}/model.toml`, "--battery", `${folder}/answer-pack.toml`,
    ...options.blocks.flatMap((block) => ["--block", block]),
    ...option("airspeed", options.airspeed), ...option("spacing", options.spacing), ...option("heading", options.heading),
    ...option("terrain", options.terrain),
    ...option("wind", wind), ...option("reserve", question.reserve), ...option("payload", question.payload_kg),
    ...(question.payload_kg != null ? option("mass", question.mass_kg) : []),
  ];
}

/// Returns the command that makes a mission of a plan; with `has_packs` one pack, too, is a flight of [packs].
function newMissionArguments(folder: string, options: PlanOptions, question: Question, has_packs = false): string[] {
  return [
    "new-mission", ...flightOptions(folder, options, question), "--plan", options.plan,
    ...(options.packs > 1 || has_packs ? ["--packs", String(options.packs)] : []),
  ];
}

/// Returns the commands that give the same, in an empty folder: `inputs` are the logs, whose results are in `folder`.
export function planCommand(inputs: string, folder: string, options: PlanOptions, question: Question = {}): string {
  const samples = options.packs > 1 ? "" : ` --samples ${drawn_flights}`;
  const mission = quoted(options.plan.replace(/^missions\//, ""));
  if (/\.toml$/i.test(options.plan)) return `flightwatt simulate ${mission}${samples}`;
  const args = newMissionArguments(folder, { ...options, plan: options.plan.replace(/^plans\//, "") }, question);
  const answer = ["flightwatt", inputs, ...optionsOf({ capacity_ah: question.capacity_ah, temperature: question.temperature })];
  const chances = options.packs > 1
    ? ` && flightwatt plan plan.toml --packs -o packs && for pack in packs/pack-*.toml; do flightwatt simulate "$pack" --samples ${drawn_flights}; done`
    : "";
  return `${answer.join(" ")} && flightwatt ${args.map(quoted).join(" ")} -o plan.toml && flightwatt simulate plan.toml${samples}${chances}`;
}

/// Returns a mission of a plan with its files as the command has them: its results are in `shown`, this page's in `folder`.
export function missionShown(mission: string, folder: string, shown: string): string {
  return mission.replaceAll(`"${folder}/`, `"${shown}/`).replaceAll('"plans/', '"');
}

/// Of a plan, for its chance.
const drawn_flights = 1000;

/// Returns the lines of some kinds, without the names of program and mission.
function remarksOf(err: string, kinds = "(warning|chosen|note): "): string[] {
  const begin = new RegExp(`^flightwatt[\\w-]*: ${kinds}(plan-(mission|packs): )?`);
  return [...new Set(err.split("\n").filter((line) => begin.test(line)).map((line) => line.replace(begin, "")))];
}

function keyOf(text: string, key: string): number | null {
  const found = new RegExp(`^${key} = ([-\\d.]+)`, "m").exec(text);
  return found ? Number(found[1]) : null;
}

async function missionOf(
  engine: Engine,
  folder: string,
  options: PlanOptions,
  question: Question,
): Promise<{ file: string; err: string } | string> {
  if (/\.toml$/i.test(options.plan)) return { file: options.plan, err: "" };
  const made = await engine.run([
    ...newMissionArguments(folder, options, question),
    "-o",
    mission_name,
    "--force",
    "--name",
    "plan",
  ]);
  return made.code === 0 ? { file: mission_name, err: made.err } : errorsOf(made);
}

/// The files that an autopilot flies, one a pack, as `plan --packs` writes them.
export interface PlanFile {
  name: string;
  text: string;
}

/// Returns the files of a plan's flights in a format of `plan --format` with what `plan` says of them, or why there are
/// none.
export async function planFiles(
  project: Project,
  aircraft: Aircraft,
  answered: Answered,
  options: PlanOptions,
  format: string,
): Promise<{ files: PlanFile[]; remarks: string[] } | string> {
  const [mission, folder] = ["plan-packs.toml", "plan-packs"];
  const args = newMissionArguments(aircraft.folder, options, answered.question, true);
  return project.withAnswer(aircraft.id, answered, async (engine) => {
    const made = await engine.run([...args, "-o", mission, "--force", "--name", "plan"]);
    if (made.code !== 0) return errorsOf(made);
    const planned = await engine.run(["plan", mission, "--packs", "--format", format, "-o", folder, "--json"]);
    if (planned.code !== 0) return errorsOf(planned);
    const { flights } = JSON.parse(planned.out) as Simulation;
    const files = await Promise.all((flights ?? []).map(async ({ pack }) => {
      const name = `pack-${pack}${plan_endings[format] ?? ""}`;
      return { name, text: await project.text(`${folder}/${name}`) };
    }));
    return { files, remarks: remarksOf(planned.err, "((warning|chosen|note): )?") };
  });
}

/// The ending of the files of each format of `plan --format`.
const plan_endings: Record<string, string> = { plan: ".plan", waypoints: ".waypoints", blocks: ".xml" };

/// Returns the changes that may make a plan fit one pack, each as `check` computed it.
export async function remediesOf(
  project: Project,
  aircraft: Aircraft,
  answered: Answered,
  options: PlanOptions,
): Promise<PlanRemedy[]> {
  const args = ["check", options.plan, ...flightOptions(aircraft.folder, options, answered.question), "--json", "--quiet"];
  const result = await project.runOnAnswer(aircraft.id, answered, args);
  if (!result.out) return [];
  return (JSON.parse(result.out) as { plans: { remedies: PlanRemedy[] }[] }).plans[0]?.remedies ?? [];
}

/// Returns whether a plan of QGroundControl or Mission Planner states altitudes above the terrain (MAV_FRAME 10, 11).
export function isAboveTerrain(plan: string): boolean {
  return /"frame":\s*1[01]\b|^\d+\s+[01]\s+1[01]\s/m.test(plan);
}

/// Adds the chance of each flight of several packs, drawn as `plan --packs` writes it, and the least one as the plan's.
async function addChances(engine: Engine, mission: string, simulation: Simulation) {
  const folder = "plan-chances";
  await engine.remove(folder);
  if ((await engine.run(["plan", mission, "--packs", "-o", folder, "--quiet"])).code !== 0) return;
  const below: number[] = [];
  for (const flight of simulation.flights ?? []) {
    const file = `${folder}/pack-${flight.pack}.toml`;
    const drawn = await engine.run(["simulate", file, "--samples", String(drawn_flights), "--json", "--quiet", "-o", "chance.csv"]);
    const probability = drawn.out ? (JSON.parse(drawn.out) as Simulation).probability_below_reserve : null;
    if (probability == null) return;
    flight.probability_below_reserve = probability;
    below.push(probability);
  }
  simulation.probability_below_reserve = Math.max(...below);
}

/// Flies a plan, as modelled or with its chance; returns why it cannot be flown where it cannot.
export async function flyPlan(
  project: Project,
  aircraft: Aircraft,
  answered: Answered,
  asked: PlanOptions,
  has_chance = true,
): Promise<FlownPlan | string> {
  return project.withAnswer(aircraft.id, answered, async (engine) => {
    const { question } = answered;
    let options = asked;
    let made = await missionOf(engine, aircraft.folder, options, question);
    const flown = answered.answer.airspeed_m_per_s.value;
    // A model that does not know what airspeed costs is flown at the speed of its flights, as the program asks for.
    if (typeof made === "string" && /--airspeed/.test(made) && asked.airspeed == null && flown != null) {
      options = { ...asked, airspeed: Math.round(10 * flown) / 10 };
      made = await missionOf(engine, aircraft.folder, options, question);
    }
    if (typeof made === "string") return made;
    const curve = await project.curveOrError(made.file, has_chance ? drawn_flights : 0);
    if (typeof curve === "string") return curve;
    const is_divided = curve.simulation.packs != null;
    if (has_chance && is_divided && curve.simulation.keeps_reserve) await addChances(engine, made.file, curve.simulation);
    const path = await engine.run(["path", made.file, "--json", "-o", "legs.csv"]);
    const mission = await project.text(made.file);
    const table = path.code === 0 ? parseCsv(await project.text("legs.csv").catch(() => "")) : { head: [], rows: [] };
    const [starts, times, kinds] = [numbers(table, "start_s"), numbers(table, "duration_s"), texts(table, "kind")];
    return {
      options, mission, curve,
      awaits_chance: !has_chance && (!is_divided || curve.simulation.keeps_reserve),
      path: path.code === 0 && path.out ? (JSON.parse(path.out) as PathSummary) : null,
      legs: texts(table, "leg").map((leg, i) => ({
        leg,
        kind: kinds[i] ?? "",
        start_s: starts[i] ?? 0,
        duration_s: times[i] ?? 0,
      })),
      remarks: remarksOf(`${made.err}\n${path.err}`),
      is_area: /^area = /m.test(mission), spacing: keyOf(mission, "spacing_m"), heading: keyOf(
        mission,
        "heading_deg",
      ), airspeed: keyOf(
        mission,
        "airspeed_m_per_s",
      ),
    };
  });
}

/// Returns the blocks of a flight plan of Paparazzi that can be flown.
export async function blocksOf(project: Project, plan: string): Promise<PlanBlock[]> {
  if (!/\.xml$/i.test(plan)) return [];
  const result = await project.run(["path", plan, "--json", "--quiet"]);
  if (!result.out) return [];
  return ((JSON.parse(result.out) as { blocks?: PlanBlock[] }).blocks ?? []).filter((block) => block.flown !== "");
}
