// The sliders of a mission's card: each changes a number of the mission file, which the program in the page then flies.
import { useState } from "preact/hooks";
import type { MissionAgain, MissionDocument, MissionSlider, ReportDocument } from "../documents";
import { Command, save, Verdict } from "../ui/basics";
import { Icon } from "../ui/icons";
import { chance, duration, quantity } from "../ui/format";
import { Slider } from "../ui/slider";
import type { Simulation } from "../work/documents";
import { useLatest } from "../work/latest";
import { changedMission, commandOf, fileName, flyAgain, samplesOf } from "../work/mission_again";
import type { Changes } from "../work/mission_text";
import type { Curve } from "../work/project";
import { ChargePlot } from "./answer";

type Flown = Pick<Simulation, "depleted_at_s" | "cut_off_at_s" | "keeps_reserve" | "duration_s"> & {
  final_soc_percent: number | null;
  probability_below_reserve?: number | null;
};

function factsOf(flown: Flown): string[] {
  const fails_s = flown.depleted_at_s ?? flown.cut_off_at_s;
  const below = flown.probability_below_reserve;
  const landing = flown.final_soc_percent == null || fails_s != null ? `fails after ${duration(fails_s)}` : quantity(flown.final_soc_percent, 1, "%");
  return [landing, below != null ? chance(1 - below) : flown.keeps_reserve ? "yes, as modelled" : "no, as modelled", duration(flown.duration_s)];
}

function Result({ mission, curve }: { mission: MissionDocument; curve: Curve }) {
  const [reserve, reserve_before] = [curve.simulation, mission.summary].map((one) => quantity(one.reserve_soc_percent, 0, "%"));
  const names = ["Charge at landing", `Keeps the reserve of ${reserve}`, "Duration"];
  const [now, before] = [factsOf(curve.simulation), factsOf(mission.summary)];
  return (
    <>
      <dl class="facts mission-facts">
        {names.map((name, i) => (
          <div>
            <dt>{name}<span class="small-under">as written{i === 1 && reserve !== reserve_before && `, ${reserve_before}`}: {before[i]}</span></dt>
            <dd>{now[i]}</dd>
          </div>
        ))}
      </dl>
      <ChargePlot curve={curve} old={{ time_s: mission.curve.time_s, soc: mission.curve.soc_percent }} old_name="as written" name={mission.title} />
      <p class="chart-key">
        <span><i class="key-line dashed" /> as written</span>
        {curve.band && <span><i class="key-block shaded" /> 90 of 100 flights</span>}
      </p>
    </>
  );
}

const known_keys: Record<string, [name: string, unit: string]> = {
  reserve_soc_percent: ["Reserve", "%"],
  payload_kg: ["Payload", "kg"],
  "wind.speed_m_per_s": ["Wind", "m/s"],
  "wind.from_deg": ["Wind from", "°"],
  airspeed_m_per_s: ["Airspeed", "m/s"],
  "path.airspeed_m_per_s": ["Airspeed", "m/s"],
  capacity_ah: ["Pack capacity", "Ah"],
};

/// Returns the name of a slider, its unit, and its step: a power of ten, in 35 steps or more.
function wordsOf({ key, value, low, high }: MissionSlider, sliders: MissionSlider[]) {
  const [name, unit] = known_keys[key] ?? [key.replace(/[._]/g, " "), ""];
  const is_one = sliders.filter((other) => other.key === key).length === 1;
  return { name: is_one ? name : `${name}, ${value} as written`, unit, digits: -Math.floor(Math.log10((high - low) / 35)) };
}

function Sliders({ sliders, changes, change }: { sliders: MissionSlider[]; changes: Changes; change: (slider: number, value: number) => void }) {
  return (
    <div>
      {sliders.map((slider, i) => {
        const { name, unit, digits } = wordsOf(slider, sliders);
        const [step, decimals] = [10 ** -digits, Math.max(0, digits)];
        // What is shown is what is flown: the values of the slider have no more decimals.
        const atStep = (steps: number) => Number((steps * step).toFixed(decimals));
        const shown = (value: number) => quantity(value, decimals, unit).trim();
        const now = changes[i];
        const written = `${shown(slider.value)}${slider.places.length > 0 ? "" : ", not stated"}`;
        return (
          <Slider key={i} label={name} value={now ?? slider.value} min={atStep(Math.ceil(slider.low / step - 1e-9))} max={atStep(Math.floor(slider.high / step + 1e-9))} step={step}
            shown={now != null ? shown(now) : written} changed={now != null} hint={now != null ? `as written: ${written}` : undefined}
            onChange={(next) => change(i, Number(next.toFixed(decimals)))} />
        );
      })}
    </div>
  );
}

export function MissionWhatIf({ mission, of, files }: { mission: MissionDocument; of: MissionAgain; files: ReportDocument["files"] }) {
  const [changes, setChanges] = useState<Changes>({});
  const asked = Object.keys(changes).length > 0 ? changes : null;
  const { found, failed, asking } = useLatest(
    asked,
    (latest) => flyAgain(files, of, latest, 0),
    [changes],
    (latest) => (samplesOf(mission) > 0 ? flyAgain(files, of, latest, samplesOf(mission)) : null),
  );
  return (
    <section class="mission-what-if" aria-label="What if">
      <header class="card-head">
        <h3>What if</h3>
        <button type="button" class="quiet" disabled={!asked} onClick={() => setChanges({})}>As written</button>
      </header>
      {asked && found && !failed && (
        <p class="what-if-result" aria-hidden="true"><b>{factsOf(found.simulation)[0]}</b> · {factsOf(found.simulation)[1]}</p>
      )}
      <Sliders sliders={of.sliders} changes={changes} change={(slider, value) => setChanges((before) => ({ ...before, [slider]: value }))} />
      <div class={`mission-again${asking ? " old" : ""}`} aria-live="polite" aria-busy={asking}>
        {!asked && <p class="soft">Each slider changes a number of the mission. The program, which is inside this page, then flies it: nothing is sent anywhere.</p>}
        {asked && asking && !found && <p>Computing</p>}
        {asked && failed && <p class="refused"><Verdict grade="bad">{failed}</Verdict></p>}
        {asked && found && !failed && <Result mission={mission} curve={found} />}
      </div>
      {asked && (
        <div class="mission-saved">
          <Command line={commandOf(mission, of, changes)} />
          <button type="button" class="quiet" onClick={() => save(fileName(of.file), changedMission(files, of, changes))}><Icon name="save" /> Save the mission</button>
        </div>
      )}
    </section>
  );
}
