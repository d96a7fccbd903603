// A mission of a report, flown again with other numbers: `plan` where it has no schedule, then `simulate`.
import type { MissionAgain, MissionDocument, ReportDocument } from "../documents";
import { openEngine } from "../engine/open";
import { missionText, type Changes } from "./mission_text";
import { errorsOf, Project, type Curve } from "./project";
import { quoted } from "./question";
import { WorkQueue } from "./queue";

type Files = ReportDocument["files"];

/// Returns the mission file with the changed numbers.
export function changedMission(files: Files, { file, sliders }: MissionAgain, changes: Changes): string {
  return missionText(files.find(({ path }) => path === file)?.text ?? "", sliders, changes);
}

/// Returns the number of flights to draw: none where how they differ is unknown, and none of a mission that is planned
/// in flight, each of which would take as long as all else.
export function samplesOf({ summary }: MissionDocument): number {
  return summary.decisions == null ? summary.samples ?? 0 : 0;
}

export const fileName = (path: string) => path.split("/").pop() ?? path;

/// Returns the commands that give the same, with the changed keys as a comment.
export function commandOf(mission: MissionDocument, { file, is_planned, sliders }: MissionAgain, changes: Changes): string {
  const name = quoted(fileName(file));
  const samples = samplesOf(mission);
  const keys = sliders.map(({ key, value, places }, i) =>
    changes[i] != null && `${key} = ${changes[i]}${places.length > 0 ? ` instead of ${value}` : ""}`);
  const simulate = `flightwatt simulate ${is_planned ? "planned.toml" : name}${samples > 0 ? ` --samples ${samples}` : ""}`;
  return `${is_planned ? `flightwatt plan ${name} -o planned.toml && ` : ""}${simulate}  # with ${keys.filter(Boolean).join(", ")}`;
}

const queue = new WorkQueue(() => undefined, () => undefined);
let opened: Promise<Project> | null = null;

/// The engine of the page with the files of its missions, when it is needed first.
function projectWith(files: Files): Promise<Project> {
  const open = async () => {
    const project = new Project(openEngine());
    for (const { path, text } of files) await project.write(path, text);
    return project;
  };
  return (opened ??= open());
}

/// Returns the charge over the changed mission, with so many drawn flights, or why the program refuses it.
export function flyAgain(files: Files, of: MissionAgain, changes: Changes, samples: number): Promise<Curve | string> {
  return queue.result(async () => {
    const project = await projectWith(files);
    await project.write(of.file, changedMission(files, of, changes));
    if (!of.is_planned) return project.curveOrError(of.file, samples);
    const planned = of.file.replace(/[^/]*$/, "planned.toml");
    const result = await project.run(["plan", of.file, "--quiet", "-o", planned]);
    return result.code === 0 ? project.curveOrError(planned, samples) : errorsOf(result);
  }, true);
}
