// The page of `flightwatt watch --serve`, readable at arm's length. It is read-only: no button, no field, no link.
import { Facts } from "../ui/basics";
import { Charts } from "./charts";
import type { LiveFlight, LiveState } from "./flight";
import { answersOf, durationText, type Kind, momentOf, nameOf, scheduleText, statusOf, valuesOf } from "./words";

const signs: Record<Kind, string> = {
  ok: "M20 3a17 17 0 1 0 .01 0ZM12 20l6 6 11-12",
  caution: "M20 4l17 31H3ZM20 15v10M20 30v.5",
  alarm: "M13 3h14l10 10v14L27 37H13L3 27V13ZM20 11v11M20 28v.6",
  silent: "M4 14a24 24 0 0 1 32 0M10 21a15 15 0 0 1 20 0M20 30v.5M5 36 35 4",
  landed: "M4 33h32M8 12l20 12 6-2",
  waiting: "M20 3a17 17 0 1 0 .01 0ZM20 11v9l6 5",
};

function Answers({ flight }: { flight: LiveFlight }) {
  const age = flight.isOld() && !flight.hasLanded() ? `${durationText(flight.age())} old` : "";
  return (
    <dl id="answers">
      {answersOf(flight).map(({ label, value, unit, note, is_home }) => (
        <div class={is_home ? "home" : undefined}>
          <dt>{label}</dt>
          <dd class="number">{value}{unit && <small>{unit}</small>}</dd>
          {(age || note) && <dd class="note">{age || note}</dd>}
        </div>
      ))}
    </dl>
  );
}

/// The alarms; the action that the band shows is not repeated.
function Alarms({ alarms, in_band }: { alarms: LiveState["alarms"]; in_band: string }) {
  return (
    <ul id="alarms" aria-label="Alarms">
      {alarms.filter(({ kind }) => kind !== "silence").map(({ grade, text, action }, i) => (
        <li class={grade}>{i === 0 && action === in_band ? text : `${action} (${text})`}</li>
      ))}
    </ul>
  );
}

function Link({ state }: { state: LiveState }) {
  const { warnings } = state;
  const unusable = Object.entries(state.unusable).map(([reason, count]) => `${count} ${reason}`);
  const others = Object.entries(state.others).map(([sender, count]) => `${sender} (${count})`);
  return (
    <details>
      <summary>{warnings.length > 0 ? `Warnings (${warnings.length}) and link` : "Link"}</summary>
      {warnings.length > 0 && <ul aria-label="Warnings">{warnings.map((text) => <li>{text}</li>)}</ul>}
      <Facts rows={[["messages", String(state.messages)], ["restarts of the clock", state.restarts ? String(state.restarts) : ""], ["not used", unusable.join("; ")], ["other senders", others.join(", ")]]} />
    </details>
  );
}

/// `spoken` is what a screen reader states when it changes.
export function LivePage({ flight, spoken }: { flight: LiveFlight; spoken: string }) {
  const { state } = flight;
  const [kind, headline, action] = statusOf(flight);
  const [phase, received] = momentOf(flight);
  const schedule = state ? scheduleText(state) : "";
  return (
    <>
      <header id="band">
        <svg viewBox="0 0 40 40" aria-hidden="true"><path d={signs[kind]} /></svg>
        <div>
          <h1 id="status">{headline}</h1>
          <p id="action">{action}</p>
        </div>
      </header>
      <main id="page" data-time={state?.time_s}>
        <p id="spoken" role="alert">{spoken}</p>
        {state && (
          <>
            <section aria-label="Answers">
              <Answers flight={flight} />
              <Alarms alarms={state.alarms} in_band={action} />
            </section>
            <section aria-label="Measurements">
              <p id="moment"><span id="phase">{phase}</span> <span id="received">{received}</span></p>
              <div id="values"><Facts rows={valuesOf(state)} /></div>
              <Charts flight={flight} />
              {schedule && <p id="schedule">{schedule}</p>}
              <Link state={state} />
            </section>
          </>
        )}
      </main>
      <footer>{state && nameOf(state)}</footer>
    </>
  );
}
