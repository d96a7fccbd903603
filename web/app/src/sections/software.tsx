// Software on board: its power over each mission as strips, and over its parameters as profiled.
import type { MissionDocument, SoftwareProfile } from "../documents";
import { Chart, lineOf, rangeOf } from "../ui/chart";
import { duration, power } from "../ui/format";
import { capital, plural } from "./words";

/// The missions whose software draws power.
export const withSoftware = (missions: MissionDocument[]) => missions.filter(({ schedule }) => schedule.some(({ compute_w }) => compute_w > 0));

function Strip({ mission, most, longest_s }: { mission: MissionDocument; most: number; longest_s: number }) {
  const words = mission.schedule.map(({ start_s, end_s, compute_w, runs }) => `${duration(start_s)} to ${duration(end_s)}: ${power(compute_w)}${runs ? `, ${runs}` : ""}`);
  return (
    <svg class="software-strip tone-cruise" viewBox={`0 0 ${longest_s} 30`} preserveAspectRatio="none" role="img" aria-label={`Software of ${mission.title}. ${words.slice(0, 6).join("; ")}${words.length > 6 ? "; and more" : ""}.`}>
      {mission.schedule.map(({ start_s, end_s, compute_w }, i) => (
        <rect fill="currentColor" x={start_s} width={Math.max(0, end_s - start_s)} y={30 - (28 * compute_w) / most} height={(28 * compute_w) / most}>
          <title>{words[i]}</title>
        </rect>
      ))}
    </svg>
  );
}

export function Strips({ missions }: { missions: MissionDocument[] }) {
  const most = Math.max(...missions.flatMap(({ schedule }) => schedule.map(({ compute_w }) => compute_w)));
  const longest_s = Math.max(...missions.map(({ summary }) => summary.duration_s));
  return (
    <section class="card" aria-label="Software over the flight">
      <header class="card-head">
        <h3>Software over the flight</h3>
        <span class="aside">height is power, up to {power(most)}</span>
      </header>
      <ul class="strips">
        {missions.map((mission) => (
          <li>
            <bdi>{mission.title}</bdi>
            <Strip mission={mission} most={most} longest_s={longest_s} />
          </li>
        ))}
      </ul>
    </section>
  );
}

const tones = ["cruise", "take-off", "landing", "link", "caution", "ink2"];

function Component({ component, missions }: { component: SoftwareProfile["components"][number]; missions: string[] }) {
  const { name, parameter, lines } = component;
  const values = lines.flatMap(({ value }) => value);
  if (!parameter || new Set(values).size < 2)
    return (
      <section class="card" aria-label={`Power of ${name}`}>
        <h3>{capital(name)}</h3>
        {lines.map((line) => <p>{line.name && `${line.name}: `}<b>{power(line.power_w[0])}</b>{line.low_w[0] != null && ` (${power(line.low_w[0])} to ${power(line.high_w[0])})`}</p>)}
      </section>
    );
  return (
    <section class="card" aria-label={`Power of ${name}`}>
      <header class="card-head"><h3>{capital(name)}</h3><span class="aside">{plural(missions.length, "mission")}</span></header>
      <Chart height={210} aside={lines.some((line) => line.name) ? 130 : 16} x={{ title: parameter.replaceAll("_", " "), range: rangeOf([values]) }}
        y={{ title: "Power [W]", range: rangeOf([...lines.map(({ power_w }) => power_w), ...lines.map(({ high_w }) => high_w)], 0) }} description={`Power of ${name} over ${parameter.replaceAll("_", " ")}: ${lines.map((line) => `${line.name} ${line.value.map((value, i) => `${value}: ${power(line.power_w[i])}`).join(", ")}`).join("; ")}.`}>
        {(place) => lines.map((line, k) => (
          <g class={`tone-${tones[k % tones.length]}`}>
            <path class="line" d={lineOf(place, line.value, line.power_w)} />
            {line.value.map((value, i) => (
              <>
                {line.low_w[i] != null && line.high_w[i] != null && <line class="error-bar" x1={place.x(value)} x2={place.x(value)} y1={place.y(line.low_w[i] as number)} y2={place.y(line.high_w[i] as number)} />}
                <circle class="dot" cx={place.x(value)} cy={place.y(line.power_w[i] as number)} r="3.5" />
              </>
            ))}
            {line.name && <text class="strong" x={place.right + 8} y={place.y(line.power_w[line.power_w.length - 1] as number) + 4}>{line.name}</text>}
          </g>
        ))}
      </Chart>
    </section>
  );
}

export function Profiles({ software }: { software: SoftwareProfile[] }) {
  return (
    <>
      <p class="soft">Points were profiled, with 95 % intervals where standard errors are known; lines are interpolated. In a mission, the powers of the running components add up.</p>
      {software.map(({ missions, components }) => (
        <>
          {software.length > 1 && <p class="soft">Of {missions.join(", ")}</p>}
          <div class="trend-cards">{components.map((component) => <Component component={component} missions={missions} />)}</div>
        </>
      ))}
    </>
  );
}
