#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt {

/// How a table separates its cells and writes its numbers. Of tables of other programs: find_csv_header().
struct CsvDialect {
    char separator = ',';
    bool has_decimal_comma = false;  ///< its numbers are read with a point
    char line_end = '\n';            ///< '\r' where it is the only one; "\r\n" is read as '\n'
    std::size_t lines_before = 0;    ///< the header: they are passed over
    bool operator==(const CsvDialect&) const = default;
};

/// A CSV file as text cells, with the line that each row stood on. Lines that begin with '#' and blank lines
/// are passed over; blanks around cells are no part of them, and cells may be quoted with '"' (RFC 4180).
struct CsvTable {
    struct Cell {
        std::string text;
        std::size_t column;  ///< where the cell begins in its line, from 1
    };
    struct Row {
        std::size_t line;
        std::vector<Cell> cells;
    };
    std::string file;
    std::vector<std::string> columns;  ///< empty if read without a header
    std::vector<Row> rows;
};

enum class CsvHeader { present, absent };

/// Throws InputError (file:line:column) for an empty file, a row of another length than the header, or an open quote.
CsvTable read_csv(const std::filesystem::path& path, CsvHeader header = CsvHeader::present);
CsvTable parse_csv(std::string_view text, const std::string& file, CsvHeader header = CsvHeader::present);

/// A row as views into the text.
struct CsvRowView {
    struct Cell {
        std::string_view text;  ///< valid until the next row
        std::size_t column;     ///< where the cell begins in its line, from 1
    };
    std::size_t line;
    std::vector<Cell> cells;
};

using CsvRowReader = std::function<void(const CsvRowView&)>;

/// The rows of a CSV text one at a time, the header's first, for files too large to hold as cells. Throws as
/// parse_csv does; a row of another length than the header is passed to `on_ragged` instead, if there is one. Empty
/// cells behind the last column are no part of a row.
void for_each_csv_row(std::string_view text, const std::string& file, const CsvRowReader& on_row,
                      const CsvDialect& dialect = {}, const CsvRowReader& on_ragged = {});

/// The header of a table of another program, and how its cells are separated.
struct CsvHeaderLine {
    CsvDialect dialect;
    std::vector<std::string> columns;
    bool has_all = false;  ///< the names that were searched
};

/// Finds line ends, preamble, header and separator: a line "sep=;", else the line of the first 200 that has most of
/// `names` (find_columns()), else the first after `skip_lines`. A preamble before a header with none of them is no
/// error here. Throws InputError where several separators fit.
CsvHeaderLine find_csv_header(std::string_view text, const std::string& file, const std::vector<std::string>& names,
                              std::optional<std::size_t> skip_lines = std::nullopt);

/// Adds to the dialect of a header whether decimals are written with commas, by all cells. Throws InputError where
/// commas may separate decimals or thousands, and where a column has commas and points.
CsvDialect with_decimals(CsvDialect dialect, std::string_view text, const std::string& file);

/// The index of a named column. Throws InputError that lists the columns there are.
std::size_t column_index(const CsvTable& table, std::string_view name);

/// A column, and the unit that its name states.
struct CsvColumn {
    std::size_t index = 0;
    std::string unit = {};  ///< empty if the whole name was searched, or states no unit
};

/// The column of that name, else the columns that have a unit in brackets behind it: "Alt" finds "Alt(m)", "Alt [ft]".
/// Blanks around the name do not count.
std::vector<CsvColumn> find_columns(const std::vector<std::string>& columns, const std::string& name);

/// The number in a cell. Throws InputError "power_w is not a finite number: 'nan'" with its place.
double cell_number(const CsvTable& table, const CsvTable::Row& row, std::size_t column);

/// `text` as one CSV cell: quoted if it holds a comma, a quote or a line break, or blanks around it.
std::string csv_cell(std::string_view text);

/// The cells as a line, with its end.
std::string csv_line(const std::vector<std::string>& cells);

/// A CSV text, written row by row.
class CsvWriter {
  public:
    /// `digits`: the significant digits of numbers that are not whole; 0: as many as reading them back takes.
    explicit CsvWriter(const std::vector<std::string_view>& columns, int digits = 0);

    /// One row: numbers, texts (quoted where they need it), true and false; an absent optional is an empty
    /// cell. Throws std::logic_error for more or fewer cells than columns.
    template <typename... Cells>
    void add(const Cells&... cells) {
        add_row({cell(cells)...});
    }
    const std::string& text() const { return text_; }
    /// Text since the last call, for texts too large to hold.
    std::string take_text() { return std::exchange(text_, {}); }

    void add_row(const std::vector<std::string>& cells);

    /// A value as a cell of this text.
    std::string cell(double number) const;
    std::string cell(std::string_view text) const { return csv_cell(text); }
    template <typename T>
    requires std::is_integral_v<T> std::string cell(T number)
    const { return fmt::format("{}", number); }
    template <typename T>
    std::string cell(const std::optional<T>& value) const {
        return value ? cell(*value) : std::string();
    }

  private:
    std::size_t columns_;
    int digits_;
    std::string text_;
};

}  // namespace flightwatt
