// The small parts of all screens: cards, verdicts, facts, the command that gives the same.
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import { typed } from "./format";
import { Icon } from "./icons";

type Children = { children?: ComponentChildren };

/// A titled part of a screen. `aside` stands at the right of the title.
export function Card(props: Children & { title?: string; id?: string; aside?: ComponentChildren; class?: string }) {
  return (
    <section class={`card ${props.class ?? ""}`} id={props.id} aria-label={props.title}>
      {props.title && (
        <header class="card-head">
          <h2>{props.title}</h2>
          {props.aside && <div class="aside">{props.aside}</div>}
        </header>
      )}
      {props.children}
    </section>
  );
}

/// How good a result is: a colour, a shape and a word always go together.
export type Grade = "good" | "doubt" | "bad" | "none";

const shapes: Record<Grade, ComponentChildren> = {
  good: [<circle cx="8" cy="8" r="7.5" />, <path class="sign" d="m4.5 8.3 2.4 2.4 4.6-5" />],
  doubt: [<path d="M8 1 15.5 15H.5z" />, <path class="sign" d="M8 5.5v4.5M8 11.8v1.4" />],
  bad: [<rect x=".5" y=".5" width="15" height="15" rx="3" />, <path class="sign" d="m5 5 6 6m0-6-6 6" />],
  none: [<circle class="ring" cx="8" cy="8" r="6.5" />, <path class="ring" d="m4 12 8-8" />],
};

/// The shape of a grade, before a word that says the same.
export function Mark({ grade }: { grade: Grade }) {
  return (
    <svg class={`mark ${grade}`} viewBox="0 0 16 16" width="16" height="16" aria-hidden="true">
      {shapes[grade]}
    </svg>
  );
}

/// A verdict in words with its shape.
export function Verdict({ grade, children }: Children & { grade: Grade }) {
  return (
    <span class={`verdict ${grade}`}>
      <Mark grade={grade} /> {children}
    </span>
  );
}

/// A large figure with its unit, and below it what it rests on.
export function Figure(props: Children & { label: string; value: string }) {
  // "10 min 20 s": numbers large, units small.
  const parts = props.value.split(/\s+/);
  return (
    <div class="figure">
      <p class="figure-label">{props.label}</p>
      <p class={`figure-value${/\d/.test(props.value) ? "" : " in-words"}`}>
        {parts.map((part, i) => [i > 0 && " ", /\d/.test(part) ? <b>{part}</b> : <span class="unit">{part}</span>])}
      </p>
      {props.children}
    </div>
  );
}

/// Pairs of a name and a value; those without a value are left out.
export function Facts({ rows }: { rows: [string, ComponentChildren][] }) {
  return (
    <dl class="facts">
      {rows
        .filter(([, value]) => value != null && value !== "" && value !== false)
        .map(([name, value]) => (
          <div>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
    </dl>
  );
}

/// A part that is closed at first.
export function Folded(props: Children & { title: string; id?: string }) {
  return (
    <details class="folded" id={props.id}>
      <summary>{props.title}</summary>
      {props.children}
    </details>
  );
}

/// A button that copies a text and says that it did.
export function CopyButton({ text, label = "Copy", primary, disabled }: { text: string; label?: string; primary?: boolean; disabled?: boolean }) {
  const [copied, setCopied] = useState(false);
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      // Pages of files may not use the clipboard's interface everywhere.
      const area = document.body.appendChild(document.createElement("textarea"));
      area.value = text;
      area.select();
      document.execCommand("copy");
      area.remove();
    }
    setCopied(true);
    setTimeout(() => setCopied(false), 2000);
  };
  return (
    <button type="button" class={primary ? "primary" : "quiet"} disabled={disabled} onClick={copy}>
      <Icon name="copy" /> <span aria-live="polite">{copied ? "Copied" : label}</span>
    </button>
  );
}

/// The command that gives the same as a screen.
export function Command({ line }: { line: string }) {
  return (
    <p class="command">
      <span>The same as a command:</span> <code tabIndex={0}>{line}</code> <CopyButton text={line} />
    </p>
  );
}

/// A field for a number above 0, which is taken once it is left or by Enter; until then nothing else changes what is typed.
/// What is no such number is not taken: the field has its value again.
export function NumberField({ value, size, is_whole, onNumber }: {
  value: number | undefined;
  size: number;
  /// Whether it counts whole units: "1,500" are thousands.
  is_whole?: boolean;
  onNumber: (value: number | undefined) => void;
}) {
  const [typing, setTyping] = useState<string | null>(null);
  return (
    <input type="text" inputMode="decimal" size={size} value={typing ?? value ?? ""}
      onInput={(event) => setTyping(event.currentTarget.value)}
      onChange={(event) => {
        const text = event.currentTarget.value;
        const number = typed(text, is_whole);
        setTyping(null);
        if (text.trim() === "" || number != null) onNumber(number ?? undefined);
      }} />
  );
}

/// Offers bytes as a file to save.
export function save(name: string, data: BlobPart, type = "application/octet-stream") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([data], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
