// The frame of all screens: name, tabs, theme; at the foot the facts of the document.
import type { ComponentChildren } from "preact";
import { useEffect, useState } from "preact/hooks";
import { Icon } from "./icons";

export interface Screen {
  id: string;
  name: string;
  icon?: ComponentChildren;
  show: () => ComponentChildren;
  /// Parts of a screen that is alone: links to them stand in place of the tabs.
  parts?: { id: string; name: string }[];
}

/// Returns the screen that the address names, or the first.
function chosen(screens: Screen[], hash: string): Screen | undefined {
  return screens.find((screen) => `#${screen.id}` === hash) ?? screens[0];
}

function nextTheme() {
  const root = document.documentElement;
  const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  root.dataset.theme = dark ? "light" : "dark";
  document.dispatchEvent(new Event("themechange"));
}

/// Shows the screen that the address names; `aside` stands at the right of the tabs.
export function Shell(props: { name?: string; screens: Screen[]; aside?: ComponentChildren; foot?: ComponentChildren }) {
  const [hash, setHash] = useState(location.hash);
  useEffect(() => {
    const follow = () => {
      setHash(location.hash);
      if (!screen?.parts) scrollTo(0, 0);
    };
    addEventListener("hashchange", follow);
    return () => removeEventListener("hashchange", follow);
  }, []);
  const screen = chosen(props.screens, hash);
  return (
    <>
      <a class="skip" href="#main" onClick={(event) => (event.preventDefault(), document.querySelector<HTMLElement>("main")?.focus())}>
        To the content
      </a>
      <header class="bar">
        <p class="brand">
          <Icon name="brand" /> {props.name ?? "FlightWatt"}
        </p>
        {screen?.parts ? (
          <nav class="parts" aria-label="Parts of the page">
            {screen.parts.map(({ id, name }) => <a href={`#${id}`}>{name}</a>)}
          </nav>
        ) : (
          <nav aria-label="Screens">
            {props.screens.map((one) => (
              <a href={`#${one.id}`} aria-current={one.id === screen?.id ? "page" : undefined}>
                {one.icon} {one.name}
              </a>
            ))}
          </nav>
        )}
        <div class="bar-aside">
          {props.aside}
          <button type="button" class="quiet" aria-label="Light or dark" title="Light or dark" onClick={nextTheme}>
            <Icon name="theme" />
          </button>
        </div>
      </header>
      <main id="main" tabIndex={-1}>{screen?.show()}</main>
      <footer>{props.foot}</footer>
    </>
  );
}
