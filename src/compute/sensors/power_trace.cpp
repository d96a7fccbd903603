#include "compute/sensors/power_trace.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "compute/powprofiler/power_recording.h"
#include "compute/powprofiler/powprofiler_csv.h"
#include "compute/sensors/tegrastats.h"

#include <sstream>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

void refuse_stamps_that_do_not_rise(const PowerTrace& trace, const CsvTable& table) {
    for (std::size_t i = 1; i < trace.time_s.size(); ++i) {
        if (trace.time_s[i] > trace.time_s[i - 1]) continue;
        throw InputError({table.file, table.rows[i].line},
                         fmt::format("time_s = {} follows {}", trace.time_s[i], trace.time_s[i - 1]),
                         "the time stamps of a recording rise");
    }
}

PowerTrace trace_of_csv(const CsvTable& table) {
    const auto time = column_index(table, "time_s");
    const auto power = column_index(table, "power_w");
    PowerTrace trace;
    for (const auto& row : table.rows) {
        trace.time_s.push_back(cell_number(table, row, time));
        trace.power_w.push_back(cell_number(table, row, power));
    }
    if (trace.time_s.empty()) throw InputError({table.file}, "has a header and no samples");
    refuse_stamps_that_do_not_rise(trace, table);
    return trace;
}

PowerTrace trace_of_layer1(const CsvTable& table, std::optional<double> interval_s) {
    if (!interval_s) {
        throw InputError({table.file}, "has no time stamps", "give the sampler's interval_s");
    }
    PowerTrace trace;
    trace.power_w = power_recording_from(table, 1.0 / *interval_s).power_w;
    for (std::size_t i = 0; i < trace.power_w.size(); ++i) {
        trace.time_s.push_back(static_cast<double>(i) * *interval_s);
    }
    return trace;
}

/// The first line that is no comment.
std::string first_line(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    while (std::getline(lines, line)) {
        if (!line.empty() && line.front() != '#') return line;
    }
    return "";
}

}  // namespace

PowerTrace read_power_trace(const std::filesystem::path& path, std::optional<double> interval_s) {
    const auto text = read_file(path);
    const auto file = path.string();
    const auto first = first_line(text);
    // tegrastats knows no header, and its lines no comma at their places.
    if (is_tegrastats(first)) return parse_tegrastats(text, file, interval_s);
    if (first.find("time_s") != std::string::npos) return trace_of_csv(parse_csv(text, file));
    const auto table = parse_csv(text, file, CsvHeader::absent);
    if (powprofiler_columns(table)) return trace_of_layer1(table, interval_s);
    throw InputError({file, table.rows.front().line},
                     "is no recording of power: neither time_s,power_w nor 100,... nor tegrastats");
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
