// A table that sorts and filters, of thousands of rows.
import type { ComponentChildren } from "preact";
import { useCallback, useMemo, useState } from "preact/hooks";
import { naturally } from "./format";
import { useOnPaper } from "./opened";

/// A column: its head, what a cell shows, and what it is sorted by (a missing value comes last).
export interface Column<Row> {
  head: string;
  cell: (row: Row) => ComponentChildren;
  by?: (row: Row) => string | number | null | undefined;
  numeric?: boolean;
}

interface TableProps<Row> {
  caption: string;
  columns: Column<Row>[];
  rows: Row[];
  /// The text that a filter looks in; without it there is no filter.
  words?: (row: Row) => string;
  /// Rows shown at once; more with a button, and all on paper.
  page?: number;
  selected?: Row;
  onSelect?: (row: Row) => void;
}

function compare(a: string | number | null | undefined, b: string | number | null | undefined): number {
  if (a == null || b == null) return Number(a == null) - Number(b == null);
  return typeof a === "number" && typeof b === "number" ? a - b : naturally(String(a), String(b));
}

export function Table<Row>(props: TableProps<Row>) {
  const { columns, rows, words, page = 50 } = props;
  const [order, setOrder] = useState<{ column: number; down: boolean } | null>(null);
  const [filter, setFilter] = useState("");
  const [shown, setShown] = useState(page);
  useOnPaper(useCallback(() => setShown(Infinity), []));
  const chosen = useMemo(() => {
    const wanted = filter.trim().toLowerCase();
    let result = wanted && words ? rows.filter((row) => words(row).toLowerCase().includes(wanted)) : rows;
    const by = order && columns[order.column]?.by;
    if (order && by) {
      result = [...result].sort((a, b) => {
        const [x, y] = [by(a), by(b)];
        return x == null || y == null ? compare(x, y) : (order.down ? -1 : 1) * compare(x, y);
      });
    }
    return result;
  }, [rows, columns, words, order, filter]);
  const sortBy = (column: number) =>
    setOrder(order?.column === column ? { column, down: !order.down } : { column, down: false });
  return (
    <div class="table">
      {words && rows.length > 8 && (
        <label class="filter">
          <span>Find</span>
          <input type="search" value={filter} onInput={(event) => setFilter(event.currentTarget.value)} />
          <span class="soft" aria-live="polite">
            {filter ? `${chosen.length} of ${rows.length}` : `${rows.length} in all`}
          </span>
        </label>
      )}
      <table>
        <caption>{props.caption}</caption>
        <thead>
          <tr>
            {columns.map((column, i) => (
              <th
                scope="col"
                class={column.numeric ? "numeric" : ""}
                aria-sort={order?.column === i ? (order.down ? "descending" : "ascending") : undefined}
              >
                {column.by ? (
                  <button type="button" onClick={() => sortBy(i)}>
                    {column.head}
                  </button>
                ) : (
                  column.head
                )}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {chosen.slice(0, shown).map((row) => (
            <tr class={row === props.selected ? "selected" : ""}>
              {columns.map((column, i) => {
                const content = column.cell(row);
                const inner =
                  i === 0 && props.onSelect ? (
                    <button
                      type="button"
                      class="row-button"
                      aria-pressed={row === props.selected}
                      onClick={() => props.onSelect?.(row)}
                    >
                      {content}
                    </button>
                  ) : (
                    content
                  );
                return i === 0 ? (
                  <th scope="row">{inner}</th>
                ) : (
                  <td class={column.numeric ? "numeric" : ""} data-head={column.head}>
                    {inner}
                  </td>
                );
              })}
            </tr>
          ))}
        </tbody>
      </table>
      {chosen.length > shown && (
        <button type="button" class="quiet" onClick={() => setShown(shown + 10 * page)}>
          Show more ({chosen.length - shown})
        </button>
      )}
    </div>
  );
}
