// Parts that are closed at first and built when they are opened; on paper they are open.
import { options, type ComponentChildren } from "preact";
import { useCallback, useLayoutEffect, useState } from "preact/hooks";

const openers = new Set<() => void>();
let listens = false;

/// Opens all parts before a page is printed, and builds them at once: the browser does not wait.
function listen() {
  if (listens || typeof addEventListener === "undefined") return;
  listens = true;
  addEventListener("beforeprint", () => {
    const later = options.debounceRendering;
    options.debounceRendering = (work) => work();
    for (let before = -1; before !== openers.size; ) {
      before = openers.size; // a part that was opened may hold others
      for (const open of [...openers]) open();
    }
    options.debounceRendering = later;
  });
}

/// Does something before the page is printed, so that all of a part is on paper.
export function useOnPaper(open: () => void) {
  useLayoutEffect(() => {
    listen();
    openers.add(open);
    return () => void openers.delete(open);
  }, [open]);
}

interface OpenedProps {
  title: string;
  id?: string;
  /// Beside the title, also while the part is closed.
  aside?: ComponentChildren;
  children: () => ComponentChildren;
}

export function Opened({ title, id, aside, children }: OpenedProps) {
  const [is_open, setOpen] = useState(false);
  const open = useCallback(() => setOpen(true), []);
  useOnPaper(open);
  useLayoutEffect(() => {
    const follow = () => id && location.hash === `#${id}` && open();
    addEventListener("hashchange", follow);
    follow();
    return () => removeEventListener("hashchange", follow);
  }, []);
  return (
    <details class="folded opened" id={id} open={is_open} onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>
        {title} {aside && <span class="aside">{aside}</span>}
      </summary>
      {is_open && <div>{children()}</div>}
    </details>
  );
}
