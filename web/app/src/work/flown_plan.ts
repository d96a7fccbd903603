// A plan flown by an aircraft: the commands new-mission, path and simulate, one after the other.
import type { Engine } from "../engine/engine";
import { numbers, parseCsv, texts } from "./csv";
import type { PathSummary, PlanBlock } from "./documents";
import { errorsOf, type Aircraft, type Answered, type Curve, type Project } from "./project";
import { quoted } from "./question";

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
}

export interface FlownPlan {
  options: PlanOptions;
  mission: string;
  curve: Curve;
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

/// Returns the options of new-mission.
export function newMissionArguments(folder: string, options: PlanOptions, payload_kg?: number): string[] {
  const wind = options.wind ? `${options.wind}@${options.wind_from ?? 0}` : undefined;
  return [
    "new-mission", "--model", `${folder}/model.toml`, "--battery", `${folder}/answer-pack.toml`, "--plan", options.plan,
    ...options.blocks.flatMap((block) => ["--block", block]),
    ...(options.airspeed != null ? ["--airspeed", String(options.airspeed)] : []),
    ...(wind ? ["--wind", wind] : []),
    ...(options.packs > 1 ? ["--packs", String(options.packs)] : []),
    ...(payload_kg != null ? ["--payload", String(payload_kg)] : []),
  ];
}

/// Returns the command that sets keys of the mission, or nothing.
function editCommand({ spacing, heading }: PlanOptions): string {
  const keys = { spacing_m: spacing, heading_deg: heading };
  const edits = Object.entries(keys).filter(([, value]) => value != null);
  const expressions = edits.map(([key, value]) => `-e ${quoted(`s/^${key} = .*/${key} = ${value}/`)}`);
  return expressions.length > 0 ? ` && sed -i ${expressions.join(" ")} plan.toml` : "";
}

/// Returns the commands that give the same.
export function planCommand(folder: string, options: PlanOptions, payload_kg?: number): string {
  const samples = options.packs > 1 ? "" : ` --samples ${drawn_flights}`;
  const mission = quoted(options.plan.replace(/^missions\//, ""));
  if (/\.toml$/i.test(options.plan)) return `flightwatt simulate ${mission}${samples}`;
  const args = newMissionArguments(folder, { ...options, plan: options.plan.replace(/^plans\//, "") }, payload_kg);
  const make = `flightwatt ${args.map(quoted).join(" ")} -o plan.toml`;
  return `${make}${editCommand(options)} && flightwatt simulate plan.toml${samples}`;
}

/// Of a plan, for its chance.
const drawn_flights = 1000;

function remarksOf(err: string): string[] {
  const lines = err.split("\n").filter((line) => /: (warning|chosen|note): /.test(line));
  return [...new Set(lines.map((line) => line.replace(
    /^flightwatt[\w-]*: (warning|chosen|note): /,
    "",
  ).replace(/^plan-mission: /, "")))];
}

function keyOf(text: string, key: string): number | null {
  const found = new RegExp(`^${key} = ([-\\d.]+)`, "m").exec(text);
  return found ? Number(found[1]) : null;
}

async function missionOf(
  engine: Engine,
  folder: string,
  options: PlanOptions,
  payload_kg?: number,
): Promise<{ file: string; err: string } | string> {
  if (/\.toml$/i.test(options.plan)) return { file: options.plan, err: "" };
  const made = await engine.run([
    ...newMissionArguments(folder, options, payload_kg),
    "-o",
    mission_name,
    "--force",
    "--name",
    "plan",
  ]);
  if (made.code !== 0) return errorsOf(made);
  let text = new TextDecoder().decode(await engine.read(mission_name));
  if (options.spacing != null) text = text.replace(/^spacing_m = .*$/m, `spacing_m = ${options.spacing}`);
  if (options.heading != null) text = text.replace(/^heading_deg = .*$/m, `heading_deg = ${options.heading}`);
  await engine.write(mission_name, new TextEncoder().encode(text));
  return { file: mission_name, err: made.err };
}

/// Flies a plan; returns why it cannot be flown where it cannot.
export async function flyPlan(
  project: Project,
  aircraft: Aircraft,
  answered: Answered,
  options: PlanOptions,
): Promise<FlownPlan | string> {
  return project.withAnswer(aircraft.id, answered, async (engine) => {
    const { payload_kg } = answered.question;
    let made = await missionOf(engine, aircraft.folder, options, payload_kg);
    const flown = answered.answer.airspeed_m_per_s.value;
    // A model that does not know what airspeed costs is flown at the speed of its flights, as the program asks for.
    if (typeof made === "string" && /--airspeed/.test(made) && options.airspeed == null && flown != null)
      made = await missionOf(
        engine,
        aircraft.folder,
        { ...options, airspeed: Math.round(10 * flown) / 10 },
        payload_kg,
      );
    if (typeof made === "string") return made;
    const curve = await project.curveOrError(made.file, drawn_flights);
    if (typeof curve === "string") return curve;
    const path = await engine.run(["path", made.file, "--json", "-o", "legs.csv"]);
    const mission = await project.text(made.file);
    const table = path.code === 0 ? parseCsv(await project.text("legs.csv").catch(() => "")) : { head: [], rows: [] };
    const [starts, times, kinds] = [numbers(table, "start_s"), numbers(table, "duration_s"), texts(table, "kind")];
    return {
      options, mission, curve,
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
