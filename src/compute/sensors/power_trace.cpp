#include "compute/sensors/power_trace.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "compute/powprofiler/powprofiler.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

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

}  // namespace

PowerTrace read_power_trace(const std::filesystem::path& path, std::optional<double> interval_s) {
    const auto text = read_file(path);
    const auto file = path.string();
    const auto table = parse_csv(text, file, CsvHeader::absent);
    const auto& first = table.rows.front();
    if (std::ranges::count(first.cells, "time_s", &CsvTable::Cell::text) > 0)
        return trace_of_csv(parse_csv(text, file));
    if (powprofiler_columns(table)) return trace_of_layer1(table, interval_s);
    throw InputError({file, first.line}, "is not a recording of power: neither time_s,power_w nor 100,...");
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
