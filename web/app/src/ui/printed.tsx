// A table as the program prints it.
import type { PrintedTable } from "../documents";

const isNumber = (text: string | undefined) => text != null && /^[-−+]?[\d.]+( .*)?$|^-$/.test(text);

export function Printed({ table }: { table: PrintedTable }) {
  const numeric = table.header.map((_, i) => table.rows.every((row) => isNumber(row[i])));
  return (
    <div class="table">
      <table>
        <caption>{table.caption}</caption>
        <thead>
          <tr>
            {table.header.map((head, i) => (
              <th scope="col" class={numeric[i] ? "numeric" : ""}>{head}</th>
            ))}
          </tr>
        </thead>
        <tbody>
          {table.rows.map((row) => (
            <tr>
              {row.map((cell, i) =>
                i === 0 ? (
                  <th scope="row">{cell}</th>
                ) : (
                  <td class={numeric[i] ? "numeric" : ""} data-head={table.header[i]}>{cell.replace(/^-(?=\d)/, "−")}</td>
                ),
              )}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
