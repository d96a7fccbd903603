#include "base/csv.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/number.h"
#include "base/text.h"

#include <algorithm>
#include <cctype>
#include <forward_list>
#include <regex>
#include <stdexcept>

#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <fmt/ranges.h>

namespace flightwatt {
namespace {

/// The widest table of ours, a series, has some forty columns.
constexpr std::size_t max_columns = 1000;
/// Of a table in memory, where a row costs as much as two cells: some 500 MB. Series are read row by row.
constexpr std::size_t max_cells = 8'000'000;

/// A decimal number with one comma: "-4,94", "1,5e3".
bool has_decimal_comma(std::string_view cell) {
    const auto comma = cell.find(',');
    return comma != std::string_view::npos && cell.find_first_not_of("0123456789,+-eE") == std::string_view::npos &&
           cell.find(',', comma + 1) == std::string_view::npos;
}

/// Splits lines into cells, in place of those of the last line.
class LineSplitter {
  public:
    LineSplitter(const std::string& file, CsvRowView& row, const CsvDialect& dialect)
        : file_(file), row_(row), separator_(dialect.separator), turns_commas_(dialect.has_decimal_comma) {}

    /// `text` ends before the line break.
    void split(std::string_view text) {
        row_.cells.clear();
        owned_.clear();
        for (std::size_t p = 0;; ++p) {
            if (row_.cells.size() == max_columns) {
                throw InputError({file_, row_.line}, fmt::format("has more than {} cells", max_columns),
                                 "is it a CSV table?");
            }
            p = after_blanks(text, p);
            p = p < text.size() && text[p] == '"' ? add_quoted(text, p) : add_plain(text, p);
            if (turns_commas_) turn_comma(row_.cells.back().text);
            if (p >= text.size()) return;
        }
    }

  private:
    bool is_blank(char c) const { return (c == ' ' || c == '\t') && c != separator_; }

    std::size_t after_blanks(std::string_view text, std::size_t p) const {
        while (p < text.size() && is_blank(text[p])) ++p;
        return p;
    }

    /// Where the cell that begins at `p` ends.
    std::size_t add_plain(std::string_view text, std::size_t p) {
        const auto begin = p;
        while (p < text.size() && text[p] != separator_) ++p;  // cells are short, and many are empty
        auto end = p;
        while (end > begin && is_blank(text[end - 1])) --end;
        row_.cells.push_back({text.substr(begin, end - begin), begin + 1});
        return p;
    }

    std::size_t add_quoted(std::string_view text, std::size_t p) {
        const auto column = p + 1;
        auto& cell = owned_.emplace_front();
        while (true) {
            const auto quote = text.find('"', p + 1);
            if (quote == std::string_view::npos)
                throw InputError({file_, row_.line, column}, "a quote is opened and not closed");
            cell += text.substr(p + 1, quote - p - 1);
            p = quote + 1;
            if (p >= text.size() || text[p] != '"') break;
            cell += '"';
        }
        p = after_blanks(text, p);
        if (p < text.size() && text[p] != separator_) {
            throw InputError({file_, row_.line, p + 1}, "text follows a closing quote",
                             fmt::format("put a '{}' between the cells", separator_));
        }
        row_.cells.push_back({cell, column});
        return p;
    }

    void turn_comma(std::string_view& cell) {
        if (!has_decimal_comma(cell)) return;
        auto& turned = owned_.emplace_front(cell);
        turned[turned.find(',')] = '.';
        cell = turned;
    }

    const std::string& file_;
    CsvRowView& row_;
    char separator_;
    bool turns_commas_;
    std::forward_list<std::string> owned_;  ///< texts of cells that are not in the line as they are read
};

[[noreturn]] void refuse_length(const std::string& file, const CsvRowView& row, std::size_t width, char separator) {
    const bool are_decimals = separator == ',' && row.cells.size() > width;
    const bool has_semicolons =
        std::ranges::any_of(row.cells, [](const auto& cell) { return cell.text.find(';') != cell.text.npos; });
    throw InputError({file, row.line},
                     fmt::format("{} cells, expected {} as in the first line", row.cells.size(), width),
                     !are_decimals    ? ""
                     : has_semicolons ? "separate the cells by commas, and write decimals with a point"
                                      : "if commas are its decimals too, separate the cells by semicolons");
}

// The dialect of a table of another program is found in steps: line ends, a line sep=, the header, the separator,
// decimals. Each uses what the steps before it found.

constexpr std::size_t searched_lines = 200;  // for a header
constexpr std::size_t compared_rows = 20;    // with the header's number of cells
constexpr std::string_view separators = ",;\t";
constexpr auto nowhere = std::string_view::npos;

/// Old spreadsheets end lines by '\r' alone.
char line_end_of(std::string_view text) {
    return text.find('\n') == nowhere && text.find('\r') != nowhere ? '\r' : '\n';
}

struct Line {
    std::size_t before;  ///< lines before it
    std::string_view text;
};

/// The first lines that a table may have: no comments, no blank ones. A line that is cut by the end of the text is one.
std::vector<Line> first_lines(std::string_view text, char line_end) {
    text = without_byte_order_mark(text);
    std::vector<Line> lines;
    for (std::size_t before = 0; !text.empty() && lines.size() < searched_lines; ++before) {
        auto line = take_word(text, line_end);
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line.find_first_not_of(" \t") != nowhere && line.front() != '#') lines.push_back({before, line});
    }
    return lines;
}

/// The separator that a line "sep=;" states, as spreadsheets read it.
std::optional<char> stated_separator(std::string_view line) {
    if (line.starts_with('"') && line.ends_with('"') && line.size() > 1) line = line.substr(1, line.size() - 2);
    const bool states = line.size() == 5 && std::tolower(static_cast<unsigned char>(line[0])) == 's' &&
                        std::tolower(static_cast<unsigned char>(line[1])) == 'e' &&
                        std::tolower(static_cast<unsigned char>(line[2])) == 'p' && line[3] == '=';
    return states ? std::optional(line[4]) : std::nullopt;
}

/// The cells of a line; empty where a quote is not closed, as in the text of a preamble.
std::vector<std::string> cells_of(std::string_view line, char separator) {
    CsvRowView row{0, {}};
    const std::string file;
    LineSplitter splitter(file, row, {separator});  // owns texts of the cells
    std::vector<std::string> cells;
    try {
        splitter.split(line);
    } catch (const InputError&) {
        return cells;
    }
    for (const auto& cell : row.cells) cells.emplace_back(cell.text);
    return cells;
}

/// How a line would be read as the header.
struct Candidate {
    std::size_t line;
    char separator;
    std::vector<std::string> columns;
    std::size_t names;  ///< of those that are searched
};

/// The readings of each line up to the first that has all names.
std::vector<Candidate> candidates_of(const std::vector<Line>& lines, std::string_view possible,
                                     const std::vector<std::string>& names) {
    std::vector<Candidate> candidates;
    const auto has_all = [&](const Candidate& candidate) { return candidate.names == names.size(); };
    for (std::size_t i = 0; i < lines.size() && std::ranges::none_of(candidates, has_all); ++i) {
        for (const char separator : possible) {
            auto columns = cells_of(lines[i].text, separator);
            const auto has = [&](const std::string& name) { return !find_columns(columns, name).empty(); };
            const auto found = static_cast<std::size_t>(std::ranges::count_if(names, has));
            candidates.push_back({i, separator, std::move(columns), found});
        }
    }
    return candidates;
}

/// Whether the rows after a header have as many cells; with more than one.
bool fits_rows(const Candidate& header, const std::vector<Line>& lines) {
    const auto last = std::min(lines.size(), header.line + 1 + compared_rows);
    for (auto i = header.line + 1; i < last; ++i)
        if (cells_of(lines[i].text, header.separator).size() != header.columns.size()) return false;
    return header.columns.size() > 1;
}

/// Of several readings of one line: the only one that fits the rows, else the one with most cells.
const Candidate& choose_separator(const std::vector<Candidate>& readings, const std::vector<Line>& lines,
                                  const std::string& file) {
    std::vector<const Candidate*> fitting;
    for (const auto& reading : readings)
        if (fits_rows(reading, lines)) fitting.push_back(&reading);
    if (fitting.size() > 1) {
        const auto name = [](char c) { return c == '\t' ? std::string("tabs") : fmt::format("'{}'", c); };
        throw InputError(
            {file, lines[readings.front().line].before + 1},
            fmt::format("cells may be separated by {} or {}", name(fitting[0]->separator), name(fitting[1]->separator)),
            "state it in a first line sep=; (or sep=,)");
    }
    if (!fitting.empty()) return *fitting.front();
    const auto cells = [](const Candidate& reading) { return reading.columns.size(); };
    return *std::ranges::max_element(readings, {}, cells);
}

/// A number of a cell, as far as its commas and points are concerned.
enum class Decimals { other, point, comma, comma_or_thousands, both };

/// "1,234.5" or "1.234,5".
bool is_grouped(std::string_view cell) {
    static const std::regex pattern(R"(\d{1,3}(,\d{3})+\.\d+|\d{1,3}(\.\d{3})+,\d+)");
    return std::regex_match(cell.begin(), cell.end(), pattern);
}

bool are_digits(std::string_view text) { return text.find_first_not_of("0123456789") == nowhere; }

Decimals decimals_of(std::string_view cell) {
    constexpr std::size_t thousands_digits = 3;
    if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
    if (const auto exponent = cell.find_first_of("eE"); exponent != nowhere) cell = cell.substr(0, exponent);
    const auto mark = cell.find_first_of(",.");
    if (mark == nowhere || cell.size() < 2 || cell.find_first_not_of("0123456789,.") != nowhere) return Decimals::other;
    const auto before = cell.substr(0, mark);
    const auto after = cell.substr(mark + 1);
    if (!are_digits(after)) return is_grouped(cell) ? Decimals::both : Decimals::other;
    if (cell[mark] == '.') return Decimals::point;
    const bool is_group = after.size() == thousands_digits && !before.empty() && before.size() <= thousands_digits &&
                          before.front() != '0';
    return is_group ? Decimals::comma_or_thousands : Decimals::comma;
}

/// A cell's place, and its text.
struct Seen {
    Location where;
    std::string text;
};

/// The first cells of each kind.
struct DecimalUse {
    std::optional<Seen> comma;
    std::optional<Seen> comma_or_thousands;
    bool has_points = false;
};

DecimalUse decimal_use(const CsvDialect& dialect, std::string_view text, const std::string& file) {
    DecimalUse use;
    std::vector<std::pair<bool, bool>> of_column;  // commas, points
    const auto read = [&](const CsvRowView& row) {
        of_column.resize(std::max(of_column.size(), row.cells.size()));
        for (std::size_t i = 0; i < row.cells.size(); ++i) {
            const auto kind = decimals_of(row.cells[i].text);
            if (kind == Decimals::other) continue;
            const auto seen = [&] {
                return Seen{{file, row.line, row.cells[i].column}, std::string(row.cells[i].text)};
            };
            auto& [commas, points] = of_column[i];
            commas = commas || kind == Decimals::comma;
            points = points || kind == Decimals::point;
            use.has_points = use.has_points || kind == Decimals::point;
            if (kind == Decimals::comma && !use.comma) use.comma = seen();
            if (kind == Decimals::comma_or_thousands && !use.comma_or_thousands) use.comma_or_thousands = seen();
            if (kind == Decimals::both || (commas && points))
                throw InputError(seen().where,
                                 fmt::format("'{}': its column has decimals with commas and with points", seen().text),
                                 "write all of them in one way, and thousands without separator");
        }
    };
    for_each_csv_row(text, file, read, dialect, [](const CsvRowView&) {});
    return use;
}

}  // namespace

void for_each_csv_row(std::string_view text, const std::string& file, const CsvRowReader& on_row,
                      const CsvDialect& dialect, const CsvRowReader& on_ragged) {
    text = without_byte_order_mark(text);
    std::size_t line_number = 0;
    std::size_t width = 0;
    CsvRowView row{0, {}};
    LineSplitter splitter(file, row, dialect);
    while (!text.empty()) {
        auto line = take_word(text, dialect.line_end);
        if (++line_number <= dialect.lines_before) continue;
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        if (line.find_first_not_of(" \t") == std::string_view::npos || line.front() == '#') continue;
        row.line = line_number;
        splitter.split(line);
        if (width == 0) width = row.cells.size();
        while (row.cells.size() > width && row.cells.back().text.empty()) row.cells.pop_back();
        if (row.cells.size() == width)
            on_row(row);
        else if (on_ragged)
            on_ragged(row);
        else
            refuse_length(file, row, width, dialect.separator);
    }
    if (width == 0) throw InputError({file}, "is empty, expected a CSV table");
}

CsvTable parse_csv(std::string_view text, const std::string& file, CsvHeader header) {
    CsvTable table{file, {}, {}};
    std::size_t cells = 0;
    for_each_csv_row(text, file, [&](const CsvRowView& row) {
        cells += row.cells.size() + 2;
        if (cells > max_cells) {
            throw InputError({file, row.line}, fmt::format("holds more than {} rows and cells", max_cells),
                             "is it the file that was meant?");
        }
        if (header == CsvHeader::present && table.columns.empty()) {
            for (const auto& cell : row.cells) table.columns.emplace_back(cell.text);
            return;
        }
        auto& kept = table.rows.emplace_back(CsvTable::Row{row.line, {}});
        kept.cells.reserve(row.cells.size());
        for (const auto& cell : row.cells) kept.cells.push_back({std::string(cell.text), cell.column});
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
        throw InputError({table.file, 1}, fmt::format("duplicate column '{}'", name), "keep one of them");
    }
    return static_cast<std::size_t>(found - table.columns.begin());
}

std::vector<CsvColumn> find_columns(const std::vector<std::string>& columns, const std::string& searched) {
    const auto name = boost::trim_copy(searched);
    std::vector<CsvColumn> whole;
    std::vector<CsvColumn> with_unit;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::string_view column = columns[i];
        if (column == name) whole.push_back({i});
        const auto bracket = column.ends_with(')')   ? column.rfind('(')
                             : column.ends_with(']') ? column.rfind('[')
                                                     : std::string_view::npos;
        if (bracket == std::string_view::npos || boost::trim_right_copy(columns[i].substr(0, bracket)) != name)
            continue;
        with_unit.push_back({i, columns[i].substr(bracket + 1, column.size() - bracket - 2)});
    }
    return whole.empty() ? with_unit : whole;
}

double cell_number(const CsvTable& table, const CsvTable::Row& row, std::size_t column) {
    const auto& cell = row.cells.at(column);
    if (const auto value = parse_number(cell.text)) return *value;
    const auto name = table.columns.empty() ? fmt::format("column {}", column + 1) : table.columns[column];
    throw InputError({table.file, row.line, cell.column},
                     fmt::format("{} is not a finite number: '{}'", name, cell.text));
}

std::string csv_cell(std::string_view text) {
    const bool has_edges = !text.empty() && (std::isspace(static_cast<unsigned char>(text.front())) != 0 ||
                                             std::isspace(static_cast<unsigned char>(text.back())) != 0);
    if (!has_edges && text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
    return fmt::format("\"{}\"", boost::replace_all_copy(std::string(text), "\"", "\"\""));
}

std::string csv_line(const std::vector<std::string>& cells) {
    std::vector<std::string> quoted(cells.size());
    std::ranges::transform(cells, quoted.begin(), csv_cell);
    return fmt::format("{}\n", fmt::join(quoted, ","));
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

CsvHeaderLine find_csv_header(std::string_view text, const std::string& file, const std::vector<std::string>& names,
                              std::optional<std::size_t> skip_lines) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        throw InputError({file}, "is a text in UTF-16", "save it as UTF-8");
    CsvHeaderLine found;
    found.dialect.line_end = line_end_of(text);
    auto lines = first_lines(text, found.dialect.line_end);
    auto possible = std::string(separators);
    if (const auto stated = lines.empty() ? std::nullopt : stated_separator(lines.front().text)) {
        possible = *stated;
        lines.erase(lines.begin());
    }
    if (skip_lines) std::erase_if(lines, [&](const Line& line) { return line.before < *skip_lines; });
    if (lines.empty()) return found;
    const auto all = candidates_of(skip_lines ? std::vector{lines.front()} : lines, possible, names);
    const auto best = std::ranges::max_element(all, {}, &Candidate::names);
    std::vector<Candidate> readings;
    for (const auto& candidate : all)
        if (candidate.line == best->line && candidate.names == best->names) readings.push_back(candidate);
    const auto& header = choose_separator(readings, lines, file);
    found.dialect.separator = header.separator;
    found.dialect.lines_before = lines[header.line].before;
    found.columns = header.columns;
    found.has_all = header.names == names.size();
    return found;
}

CsvDialect with_decimals(CsvDialect dialect, std::string_view text, const std::string& file) {
    if (dialect.separator == ',' && text.find('"') == nowhere) return dialect;  // a comma cannot be in a cell
    const auto use = decimal_use(dialect, text, file);
    if (use.comma_or_thousands && !use.comma && !use.has_points && dialect.separator != ',')
        throw InputError(use.comma_or_thousands->where,
                         fmt::format("'{}' may have a decimal comma or a separator of thousands, as all numbers of the "
                                     "table",
                                     use.comma_or_thousands->text),
                         "write decimals with points, or thousands without separator");
    dialect.has_decimal_comma = use.comma.has_value();
    return dialect;
}

}  // namespace flightwatt
