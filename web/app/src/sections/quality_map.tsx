// Which settings of the software keep the reserve: a map whose cells are buttons, and the flight of the selected cell.
import { useMemo, useState } from "preact/hooks";
import type { MissionDocument, QualityGrid } from "../documents";
import { Facts } from "../ui/basics";
import { duration, number, quantity } from "../ui/format";
import { ChargeChart } from "./charge_chart";
import { capital } from "./words";

type Cell = QualityGrid["cells"][number];
type Colour = [number, number, number];

/// Of "detection fps" the "fps".
const unitOf = (name: string) => name.split(" ").slice(1).join(" ").replaceAll("_", " ");
const words = (name: string) => name.replaceAll("_", " ");

function settingOf(grid: QualityGrid, i: number): string {
  const x = `${grid.x[i % grid.x.length]} ${unitOf(grid.x_name)}`.trim();
  return grid.y_name ? `${x}, ${grid.y[Math.floor(i / grid.x.length)]} ${unitOf(grid.y_name)}`.trim() : x;
}

const mix = (from: Colour, to: Colour, part: number): Colour =>
  [0, 1, 2].map((i) => Math.round((from[i] as number) + ((to[i] as number) - (from[i] as number)) * Math.min(1, Math.max(0, part)))) as Colour;

function shade(cell: Cell, reserve: number, best: number): Colour {
  if (cell.landing_soc_percent == null) return [61, 38, 28];
  if (cell.landing_soc_percent < reserve) return mix([255, 217, 168], [196, 96, 32], (reserve - cell.landing_soc_percent) / reserve);
  return mix([208, 229, 245], [38, 100, 154], (cell.landing_soc_percent - reserve) / Math.max(1, best - reserve));
}

/// WCAG's relative luminance: at 0.18 black and white have the same contrast.
function luminance(colour: Colour): number {
  const parts = colour.map((value) => (value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
  return 0.2126 * (parts[0] as number) + 0.7152 * (parts[1] as number) + 0.0722 * (parts[2] as number);
}

/// The cell whose charge at landing is nearest to the reserve.
export function edgeCell({ cells, reserve_soc_percent: reserve }: QualityGrid): number {
  const distanceOf = (cell: Cell) => Math.abs((cell.landing_soc_percent ?? 0) - reserve);
  return cells.reduce((best, cell, i) => (distanceOf(cell) < distanceOf(cells[best] as Cell) ? i : best), 0);
}

function CellButton({ grid, i, best, is_selected, onSelect }: { grid: QualityGrid; i: number; best: number; is_selected: boolean; onSelect: () => void }) {
  const cell = grid.cells[i] as Cell;
  const colour = shade(cell, grid.reserve_soc_percent, best);
  const soc = cell.landing_soc_percent;
  const label = `${settingOf(grid, i)}: ${soc == null ? `the battery fails after ${duration(cell.end_s)}` : `lands with ${quantity(soc, 1, "%")}`}${cell.keeps ? `, keeps the reserve in ${cell.keeps} of flights` : ""}`;
  return (
    <button type="button" class="quality-cell" aria-pressed={is_selected} aria-label={label} onClick={onSelect}
      style={{ background: `rgb(${colour})`, color: luminance(colour) < 0.18 ? "#fff" : "#000" }}>
      <b>{soc == null ? "empty" : quantity(soc, 1, "%")}</b>
      {cell.keeps && <small>{cell.keeps}</small>}
    </button>
  );
}

function Grid({ grid, selected, onSelect }: { grid: QualityGrid; selected: number; onSelect: (cell: number) => void }) {
  const best = useMemo(() => Math.max(...grid.cells.map(({ landing_soc_percent }) => landing_soc_percent ?? 0)), [grid]);
  const rows = (grid.y.length > 0 ? grid.y : [0]).map((_, row) => row).reverse();
  return (
    <table class="quality-grid">
      <caption>Charge at landing over {words(grid.x_name)}{grid.y_name && ` and ${words(grid.y_name)}`}</caption>
      <tbody>
        {rows.map((row) => (
          <tr>
            <th scope="row">{grid.y_name ? `${grid.y[row]} ${unitOf(grid.y_name)}` : ""}</th>
            {grid.x.map((_, column) => {
              const i = row * grid.x.length + column;
              return <td><CellButton grid={grid} i={i} best={best} is_selected={i === selected} onSelect={() => onSelect(i)} /></td>;
            })}
          </tr>
        ))}
        <tr>
          <td />
          {grid.x.map((value) => <th scope="col">{value} {unitOf(grid.x_name)}</th>)}
        </tr>
      </tbody>
    </table>
  );
}

interface QualityProps {
  grid: QualityGrid;
  missions: MissionDocument[];
  /// The selected mission.
  mission: number;
  title: string;
}

export function QualityMap({ grid, missions, mission, title }: QualityProps) {
  const [selected, setSelected] = useState(() => edgeCell(grid));
  const cell = grid.cells[selected] as Cell;
  const beside = missions[grid.missions.includes(mission) ? mission : (grid.missions[0] ?? -1)];
  const soc = cell.landing_soc_percent;
  const others = useMemo(() => grid.cells.filter((one) => one !== cell).map(({ curve }) => curve), [grid, cell]);
  const end = soc == null ? `fails after ${duration(cell.end_s)}` : `lands with ${quantity(soc, 1, "%")}`;
  const outcome = soc == null ? "fails" : soc < grid.reserve_soc_percent ? "misses" : "keeps";
  const compared = (own: string, other: string | null) => (beside && other != null ? <>{own} <span class="beside-value">{beside.title}: {other}</span></> : own);
  return (
    <section class="card quality" aria-label={title}>
      <header class="card-head">
        <h3>{title}</h3>
        <span class="aside">charge at landing{grid.cells.some(({ keeps }) => keeps) && ", and how probably it keeps the reserve"}</span>
      </header>
      <div class="quality-parts">
        <div>
          <p class="soft">{grid.y_name && `${capital(words(grid.y_name))} upwards, `}{words(grid.x_name)} to the right{grid.others && `; ${words(grid.others)}`}</p>
          <Grid grid={grid} selected={selected} onSelect={setSelected} />
          <p class="chart-key">
            <span><i class="key-block quality-keeps" /> keeps the reserve</span>
            {grid.reserve_soc_percent > 0 && <span><i class="key-block quality-below" /> lands below it</span>}
            <span><i class="key-block quality-empty" /> runs empty</span>
          </p>
        </div>
        <div aria-live="polite">
          <h4>{settingOf(grid, selected)} {end}</h4>
          <ChargeChart height={250} others={others} beside={beside?.curve}
            flight={{ title: settingOf(grid, selected), outcome, curve: cell.curve, landing_soc_percent: soc, end_s: cell.end_s, duration_s: cell.duration_s, reserve_soc_percent: grid.reserve_soc_percent }} />
          <p class="chart-key">
            <span><i class="key-line tone-ink" /> this setting</span>
            {beside && <span><i class="key-line tone-cruise" /> {beside.title}</span>}
            <span><i class="key-line tone-line" /> other settings</span>
          </p>
          <Facts rows={[
            ["Keeps the reserve", cell.keeps && compared(cell.keeps, beside?.card.probability ?? null)],
            ["Charge at landing", compared(soc == null ? "empty" : quantity(soc, 1, "%"), beside?.card.landing ?? null)],
            ["Utility", cell.utility != null && compared(number(cell.utility, 1), beside?.summary.utility == null ? null : number(beside.summary.utility, 1))],
          ]} />
        </div>
      </div>
    </section>
  );
}
