// The battery as identified from the flights: open-circuit voltage, voltages under load, resistances of each flight.
import { useState } from "preact/hooks";
import type { BatteryDocument, IdentifiedBattery } from "../documents";
import { areaOf, Chart, lineOf, rangeOf } from "../ui/chart";
import { number, quantity } from "../ui/format";
import { Printed } from "../ui/printed";
import { Table, type Column } from "../ui/table";
import { plural, span } from "./words";

function OpenCircuit({ curve }: { curve: NonNullable<BatteryDocument["open_circuit"]> }) {
  const { soc_percent, voltage_v, low_v, high_v, from_flights } = curve;
  const of = (flown: boolean) => voltage_v.map((value, i) => (from_flights[i] === flown || (!flown && from_flights[i - 1] !== from_flights[i + 1]) ? value : null));
  return (
    <div>
      <h3>Open-circuit voltage</h3>
      <Chart height={250} x={{ title: "State of charge [%]", range: [0, 100] }} y={{ title: "Voltage [V]", range: rangeOf([voltage_v, low_v, high_v]) }}
        description={`Open-circuit voltage over the state of charge: ${quantity(voltage_v[0], 2, "V")} at ${quantity(soc_percent[0], 0, "%")} to ${quantity(voltage_v[voltage_v.length - 1], 2, "V")} at ${quantity(soc_percent[soc_percent.length - 1], 0, "%")}.`}>
        {(place) => (
          <g class="tone-cruise">
            <path class="band" d={areaOf(place, soc_percent, low_v, high_v)} />
            <path class="line dashed" d={lineOf(place, soc_percent, of(false))} />
            <path class="line" d={lineOf(place, soc_percent, of(true))} />
            {soc_percent.map((soc, i) => <circle class={from_flights[i] ? "dot" : "ring"} cx={place.x(soc)} cy={place.y(voltage_v[i] as number)} r="3" />)}
          </g>
        )}
      </Chart>
      <p class="soft">With the 95 % intervals of its knots. {curve.text}</p>
    </div>
  );
}

function Voltages({ voltages }: { voltages: BatteryDocument["voltages"] }) {
  const [chosen, setChosen] = useState(0);
  const one = voltages[chosen];
  if (!one) return null;
  const minutes = one.time_s.map((time) => time / 60);
  return (
    <div>
      <h3>Voltage under load</h3>
      <label class="choose"><span>Flight</span>
        <select value={chosen} onChange={(event) => setChosen(Number(event.currentTarget.value))}>
          {voltages.map(({ flight }, i) => <option value={i}>{flight}</option>)}
        </select>
      </label>
      <Chart height={220} x={{ title: "minutes of the log", range: [minutes[0] ?? 0, minutes[minutes.length - 1] ?? 1] }} y={{ title: "Voltage [V]", range: rangeOf([one.measured_v, one.model_v]) }}
        description={`Terminal voltage of ${one.flight}, measured and by the model.`}>
        {(place) => (
          <>
            <path class="line thin tone-ink" d={lineOf(place, minutes, one.measured_v)} />
            <path class="line thin tone-take-off" d={lineOf(place, minutes, one.model_v)} />
          </>
        )}
      </Chart>
      <p class="chart-key"><span><i class="key-line tone-ink" /> measured</span><span><i class="key-line tone-take-off" /> model</span></p>
      <p class="soft">The modelled voltage is from the measured current and the charge missing at the start. Both curves are broken where the current contradicts the motor's state.</p>
    </div>
  );
}

type BatteryFlight = IdentifiedBattery["flights"][number] & { left_out?: NonNullable<IdentifiedBattery["leave_one_out"]>[number] };
const ohm = (value: number) => number(value, 4);

const columns: Column<BatteryFlight>[] = [
  { head: "Flight", cell: ({ flight }) => flight, by: ({ flight }) => flight },
  { head: "At rest", cell: ({ resting_voltage_v }) => quantity(resting_voltage_v, 3, "V"), by: ({ resting_voltage_v }) => resting_voltage_v, numeric: true },
  { head: "Missing at the start", cell: (of) => <span>{quantity(of.initial_depletion_ah, 2, "Ah")}<span class="small-under">{span(of.initial_depletion_ah_interval_95, (value) => number(value, 2))}</span></span>, by: ({ initial_depletion_ah }) => initial_depletion_ah, numeric: true },
  { head: "Drawn", cell: ({ drawn_ah }) => quantity(drawn_ah, 3, "Ah"), by: ({ drawn_ah }) => drawn_ah, numeric: true },
  { head: "Own resistance", cell: (of) => of.resistance_ohm != null && <span>{ohm(of.resistance_ohm)} Ω<span class="small-under">{span(of.resistance_ohm_interval_95, ohm)}</span></span>, by: ({ resistance_ohm }) => resistance_ohm, numeric: true },
  { head: "Samples", cell: ({ samples, unused_samples }) => <span>{samples}{unused_samples > 0 && <span class="small-under">{unused_samples} not used</span>}</span>, by: ({ samples }) => samples, numeric: true },
  { head: "Error of the voltage", cell: ({ voltage_rms_mv }) => quantity(voltage_rms_mv, 1, "mV"), by: ({ voltage_rms_mv }) => voltage_rms_mv, numeric: true },
  { head: "by the other flights", cell: ({ left_out }) => left_out && quantity(left_out.voltage_rms_mv, 1, "mV"), by: ({ left_out }) => left_out?.voltage_rms_mv, numeric: true },
  { head: "under load", cell: ({ left_out }) => left_out && quantity(left_out.load_voltage_rms_mv, 1, "mV"), by: ({ left_out }) => left_out?.load_voltage_rms_mv, numeric: true },
  { head: "30 s ahead", cell: ({ left_out }) => left_out && quantity(left_out.ahead_30_s_error_mv, 1, "mV"), by: ({ left_out }) => left_out?.ahead_30_s_error_mv, numeric: true },
  { head: "beyond the others", cell: ({ left_out }) => left_out && quantity(left_out.extrapolated_percent, 0, "%"), by: ({ left_out }) => left_out?.extrapolated_percent, numeric: true },
  { head: "Air", cell: ({ air_temperature_c: air }) => air != null && quantity(air, 0, "°C"), by: ({ air_temperature_c }) => air_temperature_c, numeric: true },
  { head: "Battery", cell: ({ battery_temperature_c: own }) => own != null && quantity(own, 0, "°C"), by: ({ battery_temperature_c }) => battery_temperature_c, numeric: true },
];

export function BatteryPart({ battery }: { battery: BatteryDocument }) {
  const { identified } = battery;
  const rows: BatteryFlight[] = (identified?.flights ?? []).map((flight) => ({ ...flight, left_out: identified?.leave_one_out?.find((one) => one.flight === flight.flight) }));
  const known = columns.filter(({ by }) => !by || rows.some((row) => by(row) != null));
  return (
    <>
      <p>{battery.text || battery.no_result_reason}</p>
      {battery.text && battery.no_result_reason && <p>{battery.no_result_reason}</p>}
      {battery.warnings.map((text) => <p><b>Warning:</b> {text}</p>)}
      {battery.parameters && <Printed table={battery.parameters} />}
      <div class="battery-charts">
        {battery.open_circuit && <OpenCircuit curve={battery.open_circuit} />}
        {battery.voltages.length > 0 && <Voltages voltages={battery.voltages} />}
      </div>
      {rows.length > 0 && (
        <>
          <h3>{plural(rows.length, "flight")}</h3>
          <Table caption="The battery in each flight" columns={known} rows={rows} words={rows.length > 8 ? ({ flight }) => flight : undefined} />
          <p class="soft">Missing: charge below full at the start of the flight, with its 95 % interval. By the other flights: RMS error of this flight's voltage by the battery of the others; beyond the others: fraction of its samples with more charge drawn than in any other flight.</p>
        </>
      )}
      {battery.not_checked && <p class="soft">{battery.not_checked}</p>}
      {battery.notes.map((note) => <p class="soft">{note}</p>)}
    </>
  );
}
