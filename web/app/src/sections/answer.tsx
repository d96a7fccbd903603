// The answer of `flightwatt LOG...`: how long and how far a full pack lasts, what that rests on, and the failsafe.
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import type { AnswerDocument, Answered, BestSpeed, FailsafeCard } from "../documents";
import { Card, CopyButton, Facts, Figure } from "../ui/basics";
import { distance, duration, number, quantity } from "../ui/format";
import { Opened } from "../ui/opened";
import { capital } from "./words";

/// The answer as a sentence.
export function answerSentence(answer: AnswerDocument): string {
  if (answer.time_in_air_s.value == null) return answer.headline;
  const far = answer.distance_m.value == null ? "" : ` and reaches ${distance(answer.distance_m.value)}`;
  return `A full pack lasts ${duration(answer.time_in_air_s.value)}${far}`;
}

/// Twenty dots are 100 flights.
export function Dots({ of_100 }: { of_100: number }) {
  return (
    <svg class="dots tone-ok" viewBox="0 0 240 10" width="240" height="10" aria-hidden="true">
      {Array.from({ length: 20 }, (_, i) => <circle class={5 * i + 2.5 < of_100 ? "full" : "ring"} cx={6 + 11.8 * i} cy="5" r="3.6" />)}
    </svg>
  );
}

function Unknown({ of }: { of: Answered }) {
  return of.value == null && of.unknown ? <p class="figure-reason">{of.unknown}</p> : null;
}

function Figures({ answer }: { answer: AnswerDocument }) {
  const { time_in_air_s: time, time_in_air_95_s: often, distance_m: far, reserve_soc_percent: reserve } = answer;
  return (
    <section class="card figures" aria-label="The answer">
      <Figure label={`In the air, from a full pack to ${quantity(reserve, 0, "%")}`} value={duration(time.value)}>
        <Unknown of={time} />
        {often.value != null && (
          <>
            <Dots of_100={95} />
            <p><b class="tone-ok">{duration(often.value)} in 95 of 100 flights</b></p>
          </>
        )}
        {time.value != null && often.value == null && often.unknown && <p class="figure-reason">no chances yet: {often.unknown}</p>}
      </Figure>
      <Figure label={answer.airspeed_m_per_s.value == null ? "Distance" : `Distance at ${quantity(answer.airspeed_m_per_s.value, 1, "m/s")}`} value={distance(far.value)}>
        <Unknown of={far} />
        {far.value != null && far.basis && <p class="figure-reason">{far.basis}</p>}
        {answer.distance_across_m != null && (
          <p class="figure-reason">in all, out and back along a wind of {quantity(answer.wind_m_per_s, 1, "m/s")}; {distance(answer.distance_across_m)} across it</p>
        )}
      </Figure>
      {answer.requirement_missed && <p class="answer-missed">{answer.requirement_missed}</p>}
    </section>
  );
}

function Lines({ answer }: { answer: AnswerDocument }) {
  return (
    <Card title="What it rests on" aside={answer.headline}>
      <dl class="answer-lines">
        {answer.lines.map(({ label, value, basis }) => (
          <div>
            <dt>{label}</dt>
            <dd><b>{value}</b>{basis && <span>{basis}</span>}</dd>
          </div>
        ))}
      </dl>
      {answer.notes.length > 0 && <ul class="soft">{answer.notes.map((note) => <li>{note}</li>)}</ul>}
    </Card>
  );
}

/// The charge of a pack in parts: until the return, the way home, the reserve.
function Budget({ card }: { card: FailsafeCard }) {
  const { low, critical, reserve_percent: reserve } = card;
  const words = `${low ? `Return at ${quantity(low.soc_percent, 0, "%")} of charge, ` : ""}land at ${quantity(critical.soc_percent, 0, "%")}, reserve ${quantity(reserve, 0, "%")}.`;
  const back = low?.soc_percent ?? critical.soc_percent;
  return (
    <div class="charge-budget">
      <svg viewBox="0 0 100 14" preserveAspectRatio="none" role="img" aria-label={words}>
        <rect class="tone-cruise" fill="currentColor" x="0" y="2" width={100 - back} height="10" />
        <rect class="tone-landing" fill="currentColor" x={100 - back} y="2" width={Math.max(0, back - reserve)} height="10" />
        <rect class="budget-reserve" x={100 - Math.min(reserve, back)} y="2" width={Math.min(reserve, back)} height="10" />
        <rect class="tone-ink" fill="currentColor" x={100 - critical.soc_percent - 0.3} y="0" width=".7" height="14" />
      </svg>
      <p class="chart-key">
        <span class="tone-cruise"><i class="key-block" /> out and work</span>
        <span class="tone-landing"><i class="key-block" /> the way home</span>
        <span class="tone-alarm"><i class="key-block budget-key" /> reserve</span>
      </p>
    </div>
  );
}

/// Returns the lines of a text that are no comments.
export function parametersOf(text: string): string {
  return text.replace(/<!--[\s\S]*?-->\n?/g, "").split("\n").filter((line) => line.trim() && !line.startsWith("#")).join("\n");
}

function Pastes({ pastes }: { pastes: AnswerDocument["pastes"] }) {
  const [chosen, setChosen] = useState(0);
  const paste = pastes[chosen];
  if (!paste) return null;
  const short = (name: string) => name.replace(/^Failsafe for /, "").replace(/, to paste$/, "");
  return (
    <>
      <div class="segments" role="group" aria-label="Autopilot">
        {pastes.map(({ name }, i) => <button type="button" aria-pressed={i === chosen} onClick={() => setChosen(i)}>{short(name)}</button>)}
      </div>
      <pre class="paste" tabIndex={0} aria-label={paste.name}>{parametersOf(paste.text) || paste.text}</pre>
      <p class="no-print"><CopyButton primary text={paste.text} label={`Copy for ${short(paste.name)}`} /></p>
      {parametersOf(paste.text) !== paste.text.trim() && <Opened title="The whole text with its reasons">{() => <pre class="paste" tabIndex={0} aria-label={`${paste.name}, whole text`}>{paste.text}</pre>}</Opened>}
    </>
  );
}

export function Failsafe({ answer }: { answer: AnswerDocument }) {
  const { failsafe: card, failsafe_missing, pastes } = answer;
  if (!card && !failsafe_missing && pastes.length === 0) return null;
  const action = (at: FailsafeCard["low"]) => at && `${quantity(at.soc_percent, 0, "%")}, ${quantity(at.remaining_mah, 0, "mAh")} left${at.voltage ? `, ${quantity(at.voltage.voltage_v, 2, "V")}` : ""}`;
  const late = (at: FailsafeCard["low"]) => at?.probability_too_late != null && quantity(100 * at.probability_too_late, 1, "%");
  return (
    <Card title="Failsafe" id="failsafe" class="failsafe-card">
      {card ? (
        <>
          <Budget card={card} />
          <Facts rows={[
            ["Return at", action(card.low) || card.low_missing],
            ["comes too late in", late(card.low)],
            ["Land at", action(card.critical)],
            ["comes too late in", late(card.critical)],
            ["Way home", card.home_distance_m != null && `${distance(card.home_distance_m)}${card.home_duration_s == null ? "" : `, ${duration(card.home_duration_s)}`}`],
          ]} />
        </>
      ) : (
        failsafe_missing && <p>{failsafe_missing}</p>
      )}
      <Pastes pastes={pastes} />
      {card && card.rests_on.length > 0 && (
        <Opened title="What these values rest on">
          {() => <ul class="rests">{card.rests_on.map(({ ground, text }) => <li><span class={`basis ${ground}`} /> <b>{capital(ground)}</b> {text}</li>)}</ul>}
        </Opened>
      )}
    </Card>
  );
}

function Speeds({ speeds }: { speeds: BestSpeed[] }) {
  const known = speeds.filter(({ airspeed_m_per_s }) => airspeed_m_per_s != null);
  if (known.length === 0) return null;
  return (
    <Card title="Speeds to fly">
      <Facts rows={known.map(({ purpose, airspeed_m_per_s, airspeed_low_m_per_s: low, airspeed_high_m_per_s: high, cost, unit }): [string, string] => [
        capital(purpose.replaceAll("_", " ")),
        `${quantity(airspeed_m_per_s, 1, "m/s")}${low != null && high != null ? ` (${number(low, 1)} to ${number(high, 1)})` : ""}${cost == null ? "" : `, ${number(cost, 1)} ${unit}`}`,
      ])} />
    </Card>
  );
}

interface AnswerProps {
  answer: AnswerDocument;
  /// The flight whose charge is shown below the figures.
  curve: ComponentChildren;
  panel: ComponentChildren;
}

export function Answer({ answer, curve, panel }: AnswerProps) {
  return (
    <>
      <div class="grid">
        <div class="three-quarters">
          {answer.no_answer ? <section class="card" aria-label="No answer"><p>{answer.no_answer}</p></section> : <Figures answer={answer} />}
          {curve}
        </div>
        <div class="quarter"><Failsafe answer={answer} /></div>
      </div>
      <div class="grid next-row">
        <div class={panel ? "three-quarters" : ""}>
          <Lines answer={answer} />
          <Speeds speeds={answer.best_speeds} />
        </div>
        {panel && <div class="quarter">{panel}</div>}
      </div>
    </>
  );
}
