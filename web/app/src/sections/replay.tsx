// Schedules replayed on the flown flights.
import type { ReplayDocument } from "../documents";
import { Printed } from "../ui/printed";

export function Replay({ replay }: { replay: ReplayDocument }) {
  return (
    <section class="card" aria-label="Replay">
      <p>{replay.text}</p>
      {replay.sentences.length > 0 && <ul>{replay.sentences.map((text) => <li>{text}</li>)}</ul>}
      {replay.tables.map((table) => (
        <>
          <h3>{table.caption}</h3>
          <Printed table={table} />
        </>
      ))}
      {replay.notes.map((note) => <p class="soft">{note}</p>)}
    </section>
  );
}
