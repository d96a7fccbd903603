#include "base/csv.h"
#include "base/error.h"

#include <algorithm>
#include <cctype>
#include <regex>
#include <utility>

#include <fmt/format.h>

// The steps, in their order: line ends, a line sep=, the header, the separator, decimals. Each uses what the steps
// before it found.

namespace flightwatt {
namespace {

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
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    std::vector<Line> lines;
    for (std::size_t before = 0; !text.empty() && lines.size() < searched_lines; ++before) {
        auto line = text.substr(0, text.find(line_end));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
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
    try {
        return csv_cells(line, separator);
    } catch (const InputError&) {
        return {};
    }
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
