// What is known of the aircraft: its power by phase, how well it is predicted, its pack; and which flights have warnings.
import type { AircraftPanel, FlightRow } from "../documents";
import { Mark } from "../ui/basics";
import { number, power } from "../ui/format";
import { capital, phase_tones, phase_words, plural } from "./words";

interface PanelProps {
  panel: AircraftPanel;
  flights: FlightRow[];
  /// Warnings and notes at the foot of the page.
  notes: number;
  onFlight: (flight: number) => void;
}

export function Panel({ panel, flights, notes, onFlight }: PanelProps) {
  const most = Math.max(...panel.phases.map(({ high_w, mean_power_w }) => Math.max(high_w, mean_power_w)), 1e-9);
  const count = Math.max(0, ...panel.phases.map((phase) => phase.flights));
  return (
    <section class="card panel" id="aircraft" aria-label="The aircraft">
      <h2 class="panel-title">The aircraft</h2>
      {panel.phases.length > 0 && <h3>Mean power by phase <span class="plain">of {plural(count, "flight")}</span></h3>}
      {panel.phases.map(({ phase, mean_power_w, low_w, high_w }) => (
        <div class={`phase-power tone-${phase_tones[phase]}`}>
          <span>{capital(phase_words[phase])}</span>
          <b>{power(mean_power_w)}</b>
          <svg viewBox="0 0 100 8" preserveAspectRatio="none" aria-hidden="true">
            <rect class="rail" width="100" height="8" rx="1" />
            <rect fill="currentColor" width={Math.max(1, (100 * mean_power_w) / most)} height="8" rx="1" />
          </svg>
          <span class="phase-range">{high_w > low_w && `${number(low_w, low_w >= 99.95 ? 0 : 1)} to ${power(high_w)}`}</span>
        </div>
      ))}
      {panel.facts.map(({ name, value, text }) => (
        <>
          <h3>{name}</h3>
          <p class="panel-value">{value}</p>
          <p class="panel-text">{text}</p>
        </>
      ))}
      {(panel.warned_flights.length > 0 || panel.rejected_logs > 0 || notes > 0) && (
        <ul class="panel-notes">
          {panel.warned_flights.map(({ flight, text, warnings }) => (
            <li>
              <Mark grade="doubt" />
              <span>
                <a href="#flight" onClick={() => onFlight(flight)}>{plural(warnings, "warning")} on {flights[flight]?.title ?? "a flight"}</a>: {text}
              </span>
            </li>
          ))}
          {panel.rejected_logs > 0 && <li><Mark grade="none" /> <span><a href="#not-used">{plural(panel.rejected_logs, "log")} not used</a></span></li>}
          {notes > 0 && <li><Mark grade="none" /> <span><a href="#notes">{plural(notes, "note")} on models and contents</a></span></li>}
        </ul>
      )}
    </section>
  );
}
