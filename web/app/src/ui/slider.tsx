// A slider with its value, and what a step of it costs.

interface SliderProps {
  label: string;
  value: number;
  min: number;
  max: number;
  step: number;
  /// The value with its unit.
  shown: string;
  /// What stands below: "5 % more: 40 s less".
  hint?: string;
  /// What the effect rests on.
  basis?: "measured" | "physics" | "assumption";
  changed?: boolean;
  onChange: (value: number) => void;
}

export function Slider(props: SliderProps) {
  return (
    <label class={`slider${props.changed ? " changed" : ""}`}>
      <span class="slider-head">
        <span>
          {props.basis && <span class={`basis ${props.basis}`} title={props.basis} />} {props.label}
        </span>
        <output>{props.shown}</output>
      </span>
      <input
        type="range"
        aria-label={props.label}
        aria-valuetext={props.shown}
        min={props.min}
        max={props.max}
        step={props.step}
        value={props.value}
        style={{ "--part": `${(100 * (props.value - props.min)) / (props.max - props.min)}%` }}
        onInput={(event) => props.onChange(event.currentTarget.valueAsNumber)}
      />
      {props.hint && <span class="soft">{props.hint}</span>}
    </label>
  );
}
