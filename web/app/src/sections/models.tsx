// The models of power: the curve of each phase with its coefficients, power over airspeed, and how well they predict.
import type { ModelDocument, PhysicalDocument, ValidationDocument } from "../documents";
import { areaOf, Chart, lineOf, rangeOf, type Place } from "../ui/chart";
import { energy, number, power, quantity } from "../ui/format";
import { Printed } from "../ui/printed";
import { Table, type Column } from "../ui/table";
import { capital, modelName, phase_tones, phase_words, plural, span } from "./words";

export function ModelPart({ model }: { model: ModelDocument }) {
  const { curves } = model;
  const known = curves.flatMap(({ power_w, band, flights }) => [power_w, band?.low_w ?? [], band?.high_w ?? [], flights?.low_w ?? [], flights?.high_w ?? []]);
  const range = rangeOf(known);
  return (
    <>
      <p>{model.origin} {model.description}</p>
      {model.warnings.map((text) => <p><b>Warning:</b> {text}</p>)}
      {model.notes.length > 0 && <ul class="soft">{model.notes.map((note) => <li>{note}</li>)}</ul>}
      <div class="phase-charts">
        {curves.map(({ phase, time_s, power_w, band, flights }) => (
          <div>
            <h3>{capital(phase_words[phase])}</h3>
            <Chart height={210} x={{ title: "seconds of the phase", range: [0, Math.max(time_s[time_s.length - 1] ?? 1, 1e-3)] }} y={{ title: "Power [W]", range }}
              description={`Power of ${phase_words[phase]} by the model over its time${band ? ", with the 95 % band of the mean" : ""}${flights ? " and the range of the flights" : ""}.`}>
              {(place) => (
                <g class={`tone-${phase_tones[phase]}`}>
                  {flights && <path class="band faint" d={areaOf(place, flights.time_s, flights.low_w, flights.high_w)} />}
                  {band && <path class="band" d={areaOf(place, band.time_s, band.low_w, band.high_w)} />}
                  <path class="line" d={lineOf(place, time_s, power_w)} />
                </g>
              )}
            </Chart>
          </div>
        ))}
      </div>
      <p class="soft">Power over the time of each phase, with the 95 % band of the mean and the range of the flights where they are known.</p>
      {model.table_one && <><h3>Table I</h3><Printed table={model.table_one} /><p class="soft">{model.table_text}</p></>}
    </>
  );
}

function LevelFlight({ physical }: { physical: PhysicalDocument }) {
  const { level, bins, best } = physical;
  const speeds = [...level.map(({ airspeed_m_per_s }) => airspeed_m_per_s), ...bins.map(({ airspeed_m_per_s }) => airspeed_m_per_s)];
  const powers = [...level.flatMap(({ power_w, low_w, high_w }) => [power_w, low_w, high_w]), ...bins.map(({ level_power_w }) => level_power_w)];
  const Best = ({ place }: { place: Place }) => (
    <>
      {best.filter(({ airspeed_m_per_s }) => airspeed_m_per_s != null).map(({ purpose, text, airspeed_m_per_s, power_w, low_m_per_s, high_m_per_s }, i) => (
        <g class="tone-landing">
          <line class="error-bar" x1={place.x(low_m_per_s)} x2={place.x(high_m_per_s)} y1={place.y(power_w)} y2={place.y(power_w)} />
          <circle class="dot" cx={place.x(airspeed_m_per_s as number)} cy={place.y(power_w)} r="4.5" />
          <text class="halo strong" x={place.x(airspeed_m_per_s as number)} y={place.y(power_w) + (i % 2 ? 22 : -12)} text-anchor="middle">{purpose}<title>{text}</title></text>
        </g>
      ))}
    </>
  );
  return (
    <Chart height={300} x={{ title: "Airspeed [m/s]", range: rangeOf(speeds) }} y={{ title: "Power in level flight [W]", range: rangeOf(powers) }}
      description={`Power in level flight over airspeed, with ${plural(bins.reduce((sum, { start_s }) => sum + start_s.length, 0), "part")} of flights of about 30 s. ${physical.speeds.join("; ")}.`}>
      {(place) => (
        <>
          {level.map((one) => (
            <g class="tone-cruise">
              <path class="band" d={areaOf(place, one.airspeed_m_per_s, one.low_w, one.high_w)} />
              <path class={`line ${one.flown ? "" : "dashed"}`} d={lineOf(place, one.airspeed_m_per_s, one.power_w)} />
            </g>
          ))}
          {bins.map(({ flight, airspeed_m_per_s, level_power_w, start_s }) =>
            airspeed_m_per_s.map((speed, i) => (
              <circle class="ring tone-ink3" cx={place.x(speed)} cy={place.y(level_power_w[i] as number)} r="3">
                <title>{`${flight}, ${quantity(start_s[i], 0, "s")}: ${power(level_power_w[i])} at ${quantity(speed, 1, "m/s")}`}</title>
              </circle>
            )),
          )}
          <Best place={place} />
        </>
      )}
    </Chart>
  );
}

type Term = PhysicalDocument["fit"]["terms"][number];
type Trial = PhysicalDocument["fit"]["trials"][number];
const figure = (value: number | null) => (value == null ? "" : Number(value.toPrecision(4)).toString().replace("-", "−"));

const term_columns: Column<Term>[] = [
  { head: "Term", cell: ({ term }) => term, by: ({ term }) => term },
  { head: "Coefficient", cell: ({ coefficient }) => figure(coefficient), by: ({ coefficient }) => coefficient, numeric: true },
  { head: "95 % interval", cell: ({ coefficient_interval_95: interval }) => span(interval, figure), numeric: true },
  { head: "Unit", cell: ({ unit }) => unit },
];
const trial_columns: Column<Trial>[] = [
  { head: "Term that was tried", cell: ({ term }) => term, by: ({ term }) => term },
  { head: "Kept", cell: ({ kept }) => (kept ? "yes" : "no"), by: ({ kept }) => Number(kept) },
  { head: "Error without it", cell: ({ rms_without_w }) => (rms_without_w == null ? "" : quantity(rms_without_w, 2, "W")), by: ({ rms_without_w }) => rms_without_w, numeric: true },
  { head: "Error with it", cell: ({ rms_with_w }) => (rms_with_w == null ? "" : quantity(rms_with_w, 2, "W")), by: ({ rms_with_w }) => rms_with_w, numeric: true },
  { head: "Reason", cell: ({ reason }) => reason },
];

export function PhysicalPart({ physical }: { physical: PhysicalDocument }) {
  return (
    <>
      <p>{physical.text}</p>
      <LevelFlight physical={physical} />
      <p class="soft">Dashed where it is slower than flown. A ring is a part of about 30 s of a flight, less the power of its climb and turns. A bar is the 95 % interval of a best speed.</p>
      {physical.speeds.length > 0 && <ul>{physical.speeds.map((speed) => <li>{capital(speed)}</li>)}</ul>}
      <Table caption="Terms of the physical model" columns={term_columns} rows={physical.fit.terms} />
      <p class="soft">{physical.trials_text}</p>
      <Table caption="Terms that were tried" columns={trial_columns} rows={physical.fit.trials} />
    </>
  );
}

interface Score {
  phase: string;
  model: string;
  score: ValidationDocument["scores"]["total"][string];
}

function scoresOf({ scores }: ValidationDocument): Score[] {
  const phases = [["Whole flight", scores.total], ["Take-off", scores.takeoff], ["Cruise", scores.cruise], ["Landing", scores.landing]] as const;
  return phases.flatMap(([phase, models]) => Object.entries(models ?? {}).map(([model, score]) => ({ phase, model: modelName(model), score })));
}

const score_columns: Column<Score>[] = [
  { head: "Phase", cell: ({ phase }) => phase, by: ({ phase }) => phase },
  { head: "Model", cell: ({ model }) => model, by: ({ model }) => model },
  { head: "Flights", cell: ({ score }) => score.flights, by: ({ score }) => score.flights, numeric: true },
  { head: "Mean error", cell: ({ score }) => quantity(score.mean_absolute_error_wh, 3, "Wh"), by: ({ score }) => score.mean_absolute_error_wh, numeric: true },
  { head: "of the energy", cell: ({ score }) => (score.mean_absolute_error_percent == null ? "" : quantity(score.mean_absolute_error_percent, 1, "%")), by: ({ score }) => score.mean_absolute_error_percent, numeric: true },
  { head: "Bias", cell: ({ score }) => quantity(score.bias_wh, 3, "Wh"), by: ({ score }) => score.bias_wh, numeric: true },
  { head: "95 % interval covers", cell: ({ score }) => (score.coverage_95 == null ? "" : quantity(100 * score.coverage_95, 0, "%")), by: ({ score }) => score.coverage_95, numeric: true },
];

function Errors({ errors }: { errors: ValidationDocument["errors"] }) {
  const range = rangeOf([...errors.map(({ error_wh }) => error_wh), [0]]);
  const height = 74 + 44 * errors.length;
  return (
    <Chart height={height} x={{ title: "Predicted less measured energy [Wh]", range }} y={{ title: "", range: [0, errors.length], ticks: [] }}
      description={`Errors of the predicted energy of whole flights. ${errors.map(({ title, error_wh }) => `${title}: ${number(Math.min(...error_wh), 2)} to ${number(Math.max(...error_wh), 2)} Wh`).join("; ")}.`}>
      {(place) => (
        <>
          <line class="zero" x1={place.x(0)} x2={place.x(0)} y1={place.top - 4} y2={place.bottom} />
          {errors.map(({ title, flight, error_wh, measured_wh, predicted_wh }, row) => {
            const y = place.y(errors.length - row - 0.7);
            return (
              <g>
                <text class="strong halo" x={place.left} y={y - 12}>{capital(title)}</text>
                <line class="grid-line" x1={place.left} x2={place.right} y1={y} y2={y} />
                {error_wh.map((error, i) => (
                  <circle class="ring tone-cruise" cx={place.x(error)} cy={y} r="4.5">
                    <title>{`${flight[i]}: ${energy(predicted_wh[i])} predicted, ${energy(measured_wh[i])} measured`}</title>
                  </circle>
                ))}
              </g>
            );
          })}
        </>
      )}
    </Chart>
  );
}

export function ValidationPart({ validation }: { validation: ValidationDocument }) {
  return (
    <>
      {validation.warning && <p><b>{validation.warning}</b></p>}
      <p>{validation.text}</p>
      {validation.errors.length > 0 && <Errors errors={validation.errors} />}
      <p class="soft">A ring is a flight, predicted from its durations by the other flights.</p>
      <Table caption="How well flights are predicted" columns={score_columns} rows={scoresOf(validation)} />
      {validation.note && <p class="soft">{validation.note}</p>}
    </>
  );
}
