// The page that reads logs: its screens, and files dropped anywhere.
import { useEffect, useState } from "preact/hooks";
import "./engine.css";
import { Icon } from "../ui/icons";
import { Shell } from "../ui/shell";
import { Verdict } from "../ui/basics";
import { filesOfDrop } from "../work/files";
import { useProject, type Project, type State } from "../work/project";
import { AnswerScreen } from "./answer";
import { FlightsScreen } from "./flights";
import { LogsScreen, takeFiles } from "./logs";
import { PlanScreen } from "./plan";

/// Takes files that are dropped anywhere on the page; true while some are above it.
function useDrop(project: Project): boolean {
  const [over, setOver] = useState(false);
  useEffect(() => {
    const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    const drag = (event: DragEvent) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      setOver(true);
    };
    const leave = (event: DragEvent) => {
      if (event.relatedTarget == null) setOver(false);
    };
    const drop = (event: DragEvent) => {
      if (!event.dataTransfer || !hasFiles(event)) return;
      event.preventDefault();
      setOver(false);
      void filesOfDrop(event.dataTransfer).then((files) => takeFiles(project, files));
    };
    addEventListener("dragover", drag);
    addEventListener("dragleave", leave);
    addEventListener("drop", drop);
    return () => {
      removeEventListener("dragover", drag);
      removeEventListener("dragleave", leave);
      removeEventListener("drop", drop);
    };
  }, [project]);
  return over;
}

function AircraftChoice({ project, state }: { project: Project; state: State }) {
  if (state.aircraft.length < 2) return state.aircraft[0] ? <span class="soft">{state.aircraft[0].name}</span> : null;
  return (
    <select
      aria-label="Aircraft"
      value={project.aircraft()?.id}
      onChange={(event) => project.choose(event.currentTarget.value)}
    >
      {state.aircraft.map((one) => (
        <option value={one.id}>{one.name === one.id ? one.name : `${one.name} ${one.id}`}</option>
      ))}
    </select>
  );
}

export function EngineApp({ project }: { project: Project }) {
  const state = useProject(project);
  const over = useDrop(project);
  const aircraft = project.aircraft();
  const screens = [
    {
      id: "logs",
      name: "Logs",
      icon: <Icon name="logs" />,
      show: () => <LogsScreen project={project} state={state} />,
    },
    {
      id: "answer",
      name: "Answer",
      icon: <Icon name="answer" />,
      show: () => <AnswerScreen key={aircraft?.id} project={project} aircraft={aircraft} />,
    },
    {
      id: "plan",
      name: "Plan",
      icon: <Icon name="plan" />,
      show: () => <PlanScreen key={aircraft?.id} project={project} state={state} aircraft={aircraft} />,
    },
    {
      id: "flights",
      name: "Flights and packs",
      icon: <Icon name="flights" />,
      show: () => <FlightsScreen project={project} state={state} />,
    },
  ];
  const aside = (
    <>
      <span class="promise-short">
        <Icon name="lock" size={15} /> Nothing leaves this computer
      </span>
      <AircraftChoice project={project} state={state} />
    </>
  );
  return (
    <div class={`engine-app${over ? " over" : ""}`}>
      <Shell screens={screens} aside={aside} />
      {state.failed && (
        <p class="failure" role="alert">
          <Verdict grade="bad">{state.failed}</Verdict>
        </p>
      )}
    </div>
  );
}
