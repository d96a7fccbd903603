// Plots over time or another axis, by uPlot: drag to zoom, double-click for all; plots of one group share their cursor.
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";

/// A missing value is a gap; undefined is only not at this place of the axis.
type Values = (number | null | undefined)[];

/// A line, or with `band` the area between two rows of values.
export interface Line {
  name: string;
  /// A name of a colour in tokens.css ("cruise", "ink", "alarm" ...).
  colour: string;
  y: Values;
  band?: Values;
  dashed?: boolean;
  points?: boolean;
}

interface PlotProps {
  /// The axes with their units: "Time [min]", "Power [W]".
  x_title: string;
  y_title: string;
  x: number[];
  lines: Line[];
  height?: number;
  /// Plots with the same group share cursor and zoom.
  group?: string;
  y_range?: [number, number];
  /// The whole of the x axis, where plots of a group have other ends.
  x_range?: [number, number];
  /// Where the cursor is moved to: a value of x.
  at?: number | null;
  /// Stripes, as phases of a flight: over the height, or with `strip` at the foot alone.
  strip?: boolean;
  stripes?: { from: number; to: number; colour: string }[];
  /// Words at places of the plot.
  labels?: { x: number; y: number; text: string; colour: string; align?: CanvasTextAlign }[];
  /// Without, the values under the cursor are not listed below.
  legend?: boolean;
  /// Without, the axis has no numbers: that of the plot below has them.
  x_axis?: boolean;
  /// What the plot shows, in words.
  description: string;
  onCursor?: (index: number | null) => void;
}

/// As in the words around it, whatever the language of the browser.
const digits = new Intl.NumberFormat("en", { useGrouping: false });
const shownNumber = (value: number | null) => (value == null ? "" : digits.format(value).replace("-", "−"));

const colour = (name: string) =>
  getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim() || name;

function options(props: PlotProps, width: number): uPlot.Options {
  const [first, last] = [props.x[0], props.x[props.x.length - 1]];
  const x_range = props.x_range;
  const axis = { stroke: colour("ink2"), grid: { stroke: colour("line"), width: 1 }, ticks: { show: false }, values: (_: uPlot, splits: number[]) => splits.map(shownNumber) };
  const value = (_: uPlot, at: number | null) => (at == null ? "--" : shownNumber(at));
  const series: uPlot.Series[] = [{ label: props.x_title, value }];
  const bands: uPlot.Band[] = [];
  for (const line of props.lines) {
    const stroke = colour(line.colour);
    if (line.band) {
      bands.push({ series: [series.length + 1, series.length], fill: `${stroke}26` });
      series.push({ label: `${line.name}, low`, value, width: 0, points: { show: false } });
      series.push({ label: `${line.name}, high`, value, width: 0, points: { show: false } });
    } else {
      series.push({
        label: line.name,
        value,
        stroke: line.points ? undefined : stroke,
        width: line.points ? 0 : 2,
        dash: line.dashed ? [6, 4] : undefined,
        points: line.points ? { show: true, size: 6, fill: stroke, stroke } : { show: false },
        spanGaps: false,
      });
    }
  }
  return {
    width,
    height: props.height ?? 220,
    padding: [8, 16, props.x_axis === false ? 2 : 0, 0],
    scales: { x: { time: false, ...(x_range && { range: (_, min, max) => (min === first && max === last ? x_range : [min, max]) }) }, y: props.y_range ? { range: props.y_range } : {} },
    axes: [
      props.x_axis === false ? { ...axis, size: 0, values: () => [] } :
      { ...axis, label: props.x_title, labelSize: 20, size: 32, font: "12px system-ui", labelFont: "12px system-ui" },
      { ...axis, label: props.y_title || undefined, labelSize: 20, size: 46, font: "12px system-ui", labelFont: "12px system-ui" },
    ],
    series,
    bands,
    legend: { show: props.legend ?? true, live: true },
    cursor: props.group ? { sync: { key: props.group, scales: ["x", null] } } : {},
    hooks: {
      drawClear: [
        (plot) => {
          for (const stripe of props.stripes ?? []) {
            const left = plot.valToPos(stripe.from, "x", true);
            const width = plot.valToPos(stripe.to, "x", true) - left;
            const height = props.strip ? 6 * devicePixelRatio : plot.bbox.height;
            plot.ctx.fillStyle = `${colour(stripe.colour)}${props.strip ? "" : "1f"}`;
            plot.ctx.fillRect(left, plot.bbox.top + plot.bbox.height - height, width, height);
          }
        },
      ],
      draw: [
        (plot) => {
          const { ctx } = plot;
          ctx.font = `600 ${12 * devicePixelRatio}px system-ui, sans-serif`;
          for (const { x, y, text, colour: name, align = "left" } of props.labels ?? []) {
            ctx.textAlign = align;
            ctx.textBaseline = "bottom";
            ctx.lineJoin = "round";
            ctx.lineWidth = 4 * devicePixelRatio;
            ctx.strokeStyle = colour("card");
            ctx.fillStyle = colour(name);
            const [left, top] = [plot.valToPos(x, "x", true), plot.valToPos(y, "y", true)];
            ctx.strokeText(text, left, top);
            ctx.fillText(text, left, top);
          }
        },
      ],
      setCursor: props.onCursor ? [(plot) => props.onCursor?.(plot.cursor.idx ?? null)] : [],
    },
  };
}

export function Plot(props: PlotProps) {
  const place = useRef<HTMLDivElement>(null);
  const shown = useRef<uPlot | null>(null);
  // At once, so that what opens for paper is drawn on it.
  useLayoutEffect(() => {
    const element = place.current;
    if (!element) return;
    const data = [props.x, ...props.lines.flatMap((line) => (line.band ? [line.band, line.y] : [line.y]))];
    let plot: uPlot | undefined;
    const draw = () => {
      plot?.destroy();
      plot = new uPlot(options(props, element.clientWidth), data as uPlot.AlignedData, element);
      shown.current = plot;
    };
    draw();
    const resized = new ResizeObserver(() => {
      if (plot && plot.width !== element.clientWidth) plot.setSize({ width: element.clientWidth, height: plot.height });
    });
    resized.observe(element);
    const media = ["(prefers-color-scheme: dark)", "print"].map((query) => matchMedia(query));
    for (const query of media) query.addEventListener("change", draw);
    document.addEventListener("themechange", draw);
    return () => {
      resized.disconnect();
      for (const query of media) query.removeEventListener("change", draw);
      document.removeEventListener("themechange", draw);
      plot?.destroy();
    };
  }, [props.x, props.lines, props.stripes, props.height]);
  useEffect(() => {
    if (props.at != null && shown.current) shown.current.setCursor({ left: shown.current.valToPos(props.at, "x"), top: 1 });
  }, [props.at]);
  return <div class="plot" role="img" aria-label={props.description} ref={place} />;
}
