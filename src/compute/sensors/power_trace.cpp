#include "compute/sensors/power_trace.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "compute/powprofiler/powprofiler.h"
#include "compute/sensors/power_rails.h"

#include <ctime>
#include <iomanip>
#include <regex>
#include <sstream>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

/// Name, power now, average. Other values have another unit ("RAM 2448/7850MB") or no slash.
const std::regex& rail_pattern() {
    static const std::regex pattern(R"((\w+) (\d+)(?:mW)?/\d+(?:mW)?(?=\s|$))");
    return pattern;
}

/// Date at the beginning of a line of newer versions, in seconds of the epoch.
std::optional<double> date_s(const std::string& line) {
    std::tm date{};
    std::istringstream text(line);
    if (!(text >> std::get_time(&date, "%m-%d-%Y %H:%M:%S"))) return std::nullopt;
    return static_cast<double>(::timegm(&date));
}

double total_w(const std::string& line, const Location& where) {
    std::vector<std::string> names;
    std::vector<double> power_mw;
    for (std::sregex_iterator it(line.begin(), line.end(), rail_pattern()), end; it != end; ++it) {
        names.push_back((*it)[1].str());
        power_mw.push_back(number_or_nan((*it)[2].str()));
    }
    double total_mw = 0.0;
    for (const auto rail : rails_of_total(names, {})) total_mw += power_mw[rail];
    if (!names.empty()) return units::watt_from_milliwatt(total_mw);
    throw InputError(where, "has no rail with its power, 'VDD_IN 4936mW/4936mW'", "keep complete lines of tegrastats");
}

/// Whether a line has a rail with power now and average, "VDD_IN 4936mW/4936mW", or "POM_5V_IN 2545/2600" (older
/// boards).
bool is_tegrastats(const std::string& line) { return std::regex_search(line, rail_pattern()); }

/// Sum of rails_of_total(). Times since the first line by the dates, "11-21-2022 13:41:31", which are whole seconds; or
/// with steps of `interval_s`.
PowerTrace trace_of_tegrastats(const std::string& text, const std::string& file, std::optional<double> interval_s) {
    PowerTrace trace;
    std::optional<double> first_date_s;
    std::istringstream lines(text);
    std::string line;
    Location where{file};
    while (std::getline(lines, line)) {
        ++where.line;
        if (line.empty() || line.front() == '#') continue;
        const auto now_s = date_s(line);
        if (!first_date_s) first_date_s = now_s;
        if (!interval_s && !now_s) {
            throw InputError(where, "has no date and no interval is given",
                             "give the sampler's interval_s, tegrastats --interval");
        }
        const double time_s =
            interval_s ? static_cast<double>(trace.time_s.size()) * *interval_s : *now_s - *first_date_s;
        if (!trace.time_s.empty() && time_s <= trace.time_s.back()) {
            throw InputError(where, "date is not after that of the previous line",
                             "dates count whole seconds: give the sampler's interval_s");
        }
        trace.add(time_s, total_w(line, where));
    }
    return trace;
}

PowerTrace trace_of_csv(const CsvTable& table) {
    const auto time = column_index(table, "time_s");
    const auto power = column_index(table, "power_w");
    PowerTrace trace;
    for (const auto& row : table.rows) {
        const double time_s = cell_number(table, row, time);
        if (!trace.time_s.empty() && time_s <= trace.time_s.back()) {
            throw InputError({table.file, row.line}, fmt::format("time_s = {} follows {}", time_s, trace.time_s.back()),
                             "sort the recording by time");
        }
        trace.add(time_s, cell_number(table, row, power));
    }
    if (trace.time_s.empty()) throw InputError({table.file}, "has a header and no samples");
    return trace;
}

PowerTrace trace_of_layer1(const CsvTable& table, std::optional<double> interval_s) {
    if (!interval_s) {
        throw InputError({table.file}, "has no time stamps", "give the sampler's interval_s");
    }
    PowerTrace trace;
    trace.power_w = layer1_power_w(table);
    for (std::size_t i = 0; i < trace.power_w.size(); ++i) trace.time_s.push_back(static_cast<double>(i) * *interval_s);
    return trace;
}

/// The first line that is not a comment.
std::string first_line(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line))
        if (!line.empty() && line.front() != '#') return line;
    return "";
}

}  // namespace

PowerTrace read_power_trace(const std::filesystem::path& path, std::optional<double> interval_s) {
    const auto text = read_file(path);
    const auto file = path.string();
    const auto first = first_line(text);
    // tegrastats has no header and no commas.
    if (is_tegrastats(first)) return trace_of_tegrastats(text, file, interval_s);
    if (first.find("time_s") != std::string::npos) return trace_of_csv(parse_csv(text, file));
    const auto table = parse_csv(text, file, CsvHeader::absent);
    if (powprofiler_columns(table)) return trace_of_layer1(table, interval_s);
    throw InputError({file, table.rows.front().line},
                     "is not a recording of power: neither time_s,power_w nor 100,... nor tegrastats");
}

std::string to_csv(const PowerTrace& trace, const std::vector<std::string>& comments) {
    std::string text;
    for (const auto& comment : comments) text += fmt::format("# {}\n", comment);
    text += "time_s,power_w\n";
    for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
        text += fmt::format("{:.6f},{:.6g}\n", trace.time_s[i], trace.power_w[i]);
    }
    return text;
}

}  // namespace flightwatt::compute
