// Small drawings beside words; none stands for a word alone, but where its button has a label.
import type { ComponentChildren } from "preact";

const shapes = {
  logs: <path d="M10 3v9m-4-4 4 4 4-4M3 13v4h14v-4" />,
  answer: <path d="M3.5 16a7.5 7.5 0 1 1 13 0zM10 12l3.5-4" />,
  plan: <path d="M5 16h8a3 3 0 0 0 0-6H7a3 3 0 0 1 0-6h8M3.5 16a1.5 1.5 0 1 0 3 0 1.5 1.5 0 1 0-3 0M13.5 4a1.5 1.5 0 1 0 3 0 1.5 1.5 0 1 0-3 0" />,
  flights: <path d="M3 3v14h14M5 13l4-5 3 3 5-7" />,
  lock: <path d="M4.5 9h11v8h-11zM7 9V6a3 3 0 0 1 6 0v3" />,
  plus: <path d="M10 4v12M4 10h12" />,
  arrow: <path d="M4 10h12m-5-5 5 5-5 5" />,
  copy: <path d="M7 7h9v10H7zM4 13V3h9" />,
  save: <path d="M10 3v9m-4-4 4 4 4-4M4 17h12" />,
  theme: [<circle cx="10" cy="10" r="7" />, <path class="full" d="M10 3a7 7 0 0 1 0 14z" />],
  brand: [<rect class="plate" width="20" height="20" rx="5" />, <path class="sign" d="M11.5 3.5 5 11.2h4.2l-1 5.3 6.8-8h-4.3z" />],
  copter: <path d="m6 6 8 8m0-8-8 8M2.5 5a2.5 2.5 0 1 0 5 0 2.5 2.5 0 1 0-5 0m10 0a2.5 2.5 0 1 0 5 0 2.5 2.5 0 1 0-5 0m-10 10a2.5 2.5 0 1 0 5 0 2.5 2.5 0 1 0-5 0m10 0a2.5 2.5 0 1 0 5 0 2.5 2.5 0 1 0-5 0" />,
  wing: <path d="M10 2v15M1.5 8.5c4-1.5 13-1.5 17 0M7 16.5h6" />,
} satisfies Record<string, ComponentChildren>;

export type IconName = keyof typeof shapes;

export function Icon({ name, size = 18 }: { name: IconName; size?: number }) {
  return (
    <svg class={`icon icon-${name}`} viewBox="0 0 20 20" width={size} height={size} aria-hidden="true">
      {shapes[name]}
    </svg>
  );
}
