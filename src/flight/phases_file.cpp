#include "flight/phases_file.h"

#include "base/csv.h"
#include "base/error.h"
#include "flight/checks/runs.h"
#include "flight/phase_statistics.h"

#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

/// One row of a table.
struct RowReader {
    const CsvTable& table;
    const CsvTable::Row& row;

    const CsvTable::Cell& cell(const std::string& column) const { return row.cells[column_index(table, column)]; }
    double number(const std::string& column) const { return cell_number(table, row, column_index(table, column)); }
    std::optional<double> maybe(const std::string& column) const {
        return cell(column).text.empty() ? std::nullopt : std::optional(number(column));
    }
    std::optional<int> maybe_whole(const std::string& column) const {
        const auto value = maybe(column);
        return value ? std::optional(static_cast<int>(std::lround(*value))) : std::nullopt;
    }
    InputError error(const std::string& column, const std::string& expected) const {
        return InputError({table.file, row.line, cell(column).column},
                          fmt::format("{} is '{}', expected {}", column, cell(column).text, expected));
    }
};

PhaseEdge edge_of(const RowReader& row, const std::string& side) {
    PhaseEdge edge;
    edge.time_s = row.number(side + "_s");
    edge.altitude_m = row.number(side + "_altitude_m");
    edge.gap_s = row.number(side + "_gap_s");
    edge.throttle_percent = row.maybe(side + "_throttle_percent");
    edge.mode = row.maybe_whole(side + "_mode");
    edge.block = row.maybe_whole(side + "_block");
    edge.takeoff_after_s = row.maybe(side + "_to_takeoff_message_s");
    return edge;
}

PhaseSpan span_of(const RowReader& row) {
    const auto phase = phase_from(row.cell("phase").text);
    if (!phase) throw row.error("phase", "takeoff, cruise or landing");
    const auto& complete = row.cell("complete").text;
    if (complete != "true" && complete != "false") throw row.error("complete", "true or false");
    return {*phase, edge_of(row, "start"), edge_of(row, "end"), complete == "true"};
}

/// Time of a rotorcraft below 2 m/s over ground [s], if its speed is known.
std::optional<double> hovering_s(const FlightData& data, const PhaseSpan& span) {
    constexpr double max_m_per_s = 2.0;
    const auto& speed = data.ground_speed_m_per_s;
    if (data.firmware != "rotorcraft" || speed.empty()) return std::nullopt;
    const auto& time_s = speed.time_s;
    const auto hovers = [&](std::size_t i) {
        return time_s[i] >= span.start.time_s && time_s[i] <= span.end.time_s && speed.value[i] < max_m_per_s;
    };
    return to_millisecond(time_where(time_s, {0, time_s.size()}, gap_threshold_s(time_s), hovers));
}

}  // namespace

std::string phases_csv(const FlightData& data, const FlightPhases& phases) {
    std::vector<std::string> columns{
        "sortie",       "phase",     "start_s",           "end_s", "duration_s",    "samples",
        "mean_power_w", "energy_wh", "counter_energy_wh", "gaps",  "longest_gap_s", "complete"};
    for (const std::string side : {"start_", "end_"})
        for (const auto* name : {"altitude_m", "gap_s", "throttle_percent", "mode", "block", "to_takeoff_message_s"})
            columns.push_back(side + name);
    columns.emplace_back("hovering_s");
    CsvWriter csv({columns.begin(), columns.end()});
    const auto altitude = [](const PhaseEdge& edge) { return fmt::format("{:.2f}", edge.altitude_m); };
    const PowerStatistics power(data);
    for (const auto& sortie : phases.sorties) {
        for (const auto& span : sortie.phases) {
            const auto& [phase, start, end, complete] = span;
            const auto statistics = power.between(start.time_s, end.time_s);
            const auto known = [&](auto value) { return power.has_power() ? std::optional(value) : std::nullopt; };
            csv.add(sortie.number, to_string(phase), start.time_s, end.time_s, span.duration_s(),
                    known(statistics.samples), known(statistics.mean_power_w), known(statistics.energy_wh),
                    statistics.counter_energy_wh, known(statistics.gaps), known(statistics.max_gap_s), complete,
                    altitude(start), start.gap_s, start.throttle_percent, start.mode, start.block,
                    start.takeoff_after_s, altitude(end), end.gap_s, end.throttle_percent, end.mode, end.block,
                    end.takeoff_after_s, hovering_s(data, span));
        }
    }
    return csv.text();
}

FlightPhases read_phases_csv(const std::filesystem::path& path) {
    const auto table = read_csv(path);
    FlightPhases phases;
    for (const auto& line : table.rows) {
        const RowReader row{table, line};
        const double sortie = row.number("sortie");
        const auto last = static_cast<double>(phases.sorties.size());
        if (sortie == last + 1.0) {
            phases.sorties.emplace_back();
        } else if (sortie != last || phases.sorties.empty()) {
            throw row.error("sortie", "sorties that count up from 1");
        }
        phases.sorties.back().phases.push_back(span_of(row));
    }
    return phases;
}

}  // namespace flightwatt::flight
