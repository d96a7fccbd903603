#include "base/csv.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/number.h"

#include <algorithm>
#include <stdexcept>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/ranges.h>

namespace flightwatt {
namespace {

/// The widest table of ours, a series, has some forty columns.
constexpr std::size_t most_columns = 1000;
/// Of a table in memory, where a row costs as much as two cells: some 500 MB. Series are read row by row.
constexpr std::size_t most_cells = 8'000'000;

/// One line into cells, in place of those of the last line: most of them keep their memory. `text` ends before the line
/// break.
void split_line(std::string_view text, const std::string& file, std::size_t line, std::vector<CsvTable::Cell>& cells) {
    std::size_t p = 0;
    for (std::size_t count = 1;; ++count) {
        if (cells.size() < count) cells.emplace_back();
        auto& cell = cells[count - 1];
        cell.text.clear();
        cell.column = p + 1;
        if (p < text.size() && text[p] == '"') {
            while (true) {
                const auto quote = text.find('"', p + 1);
                if (quote == std::string_view::npos) {
                    throw InputError({file, line, cell.column}, "a quote is opened and not closed");
                }
                cell.text += text.substr(p + 1, quote - p - 1);
                p = quote + 1;
                if (p >= text.size() || text[p] != '"') break;
                cell.text += '"';
            }
            if (p < text.size() && text[p] != ',') {
                throw InputError({file, line, p + 1}, "text follows a closing quote", "put a comma between the cells");
            }
        } else {
            const auto comma = std::min(text.find(',', p), text.size());
            cell.text.assign(text, p, comma - p);
            p = comma;
        }
        if (count > most_columns) {
            throw InputError({file, line}, fmt::format("has more than {} cells", most_columns), "is it a CSV table?");
        }
        if (p >= text.size()) {
            cells.resize(count);
            return;
        }
        ++p;
    }
}

}  // namespace

void for_each_csv_row(std::string_view text, const std::string& file,
                      const std::function<void(CsvTable::Row&)>& on_row) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // spreadsheets begin with it
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    std::size_t line_number = 0;
    std::size_t width = 0;
    CsvTable::Row row{0, {}};
    while (!text.empty()) {
        const auto end = std::min(text.find('\n'), text.size());
        auto line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++line_number;
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        if (line.empty() || line.front() == '#') continue;
        row.line = line_number;
        row.cells.reserve(width);
        split_line(line, file, line_number, row.cells);
        if (width == 0) width = row.cells.size();
        if (row.cells.size() != width) {
            throw InputError({file, line_number},
                             fmt::format("{} cells, expected {} as in the first line", row.cells.size(), width));
        }
        on_row(row);
    }
    if (width == 0) throw InputError({file}, "is empty, expected a CSV table");
}

CsvTable parse_csv(std::string_view text, const std::string& file, CsvHeader header) {
    CsvTable table{file, {}, {}};
    std::size_t cells = 0;
    for_each_csv_row(text, file, [&](CsvTable::Row& row) {
        cells += row.cells.size() + 2;
        if (cells > most_cells) {
            throw InputError({file, row.line}, fmt::format("holds more than {} rows and cells", most_cells),
                             "is it the file that was meant?");
        }
        if (header == CsvHeader::present && table.columns.empty()) {
            for (auto& cell : row.cells) table.columns.push_back(std::move(cell.text));
        } else {
            table.rows.push_back(std::move(row));
        }
    });
    return table;
}

CsvTable read_csv(const std::filesystem::path& path, CsvHeader header) {
    return parse_csv(read_file(path), path.string(), header);
}

std::size_t column_index(const CsvTable& table, std::string_view name) {
    const auto found = std::ranges::find(table.columns, name);
    if (found == table.columns.end()) {
        throw InputError({table.file, 1}, fmt::format("has no column '{}'", name),
                         "its columns are " + short_list(table.columns));
    }
    if (std::ranges::count(table.columns, name) > 1) {
        throw InputError({table.file, 1}, fmt::format("column '{}' stands there twice", name), "keep one of them");
    }
    return static_cast<std::size_t>(found - table.columns.begin());
}

double cell_number(const CsvTable& table, const CsvTable::Row& row, std::size_t column) {
    const auto& cell = row.cells.at(column);
    if (const auto value = parse_number(cell.text)) return *value;
    const auto name = table.columns.empty() ? fmt::format("column {}", column + 1) : table.columns[column];
    throw InputError({table.file, row.line, cell.column},
                     fmt::format("{} is not a finite number: '{}'", name, cell.text));
}

std::string csv_cell(std::string_view text) {
    if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
    return fmt::format("\"{}\"", boost::replace_all_copy(std::string(text), "\"", "\"\""));
}

CsvWriter::CsvWriter(const std::vector<std::string_view>& columns, int digits)
    : columns_(columns.size()), digits_(digits), text_(fmt::format("{}\n", fmt::join(columns, ","))) {}

std::string CsvWriter::cell(double number) const {
    return digits_ > 0 ? fmt::format("{:.{}g}", number, digits_) : fmt::format("{}", number);
}

void CsvWriter::add_row(const std::vector<std::string>& cells) {
    if (cells.size() != columns_) throw std::logic_error("a CSV row of another length than its header");
    text_ += fmt::format("{}\n", fmt::join(cells, ","));
}

}  // namespace flightwatt
