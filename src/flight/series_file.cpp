#include "flight/series_file.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/toml_reader.h"
#include "telemetry/log_configuration.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

/// Where each column of the file goes; time_s is a channel here too.
std::vector<std::vector<double> FlightSeries::*> bind_columns(const CsvTable& table) {
    std::vector<std::vector<double> FlightSeries::*> targets;
    std::vector<std::string> known{"time_s"};
    for (const auto& channel : series_channels()) known.emplace_back(channel.name);
    for (auto column_at = table.columns.begin(); column_at != table.columns.end(); ++column_at) {
        const auto& column = *column_at;
        if (std::find(table.columns.begin(), column_at, column) != column_at) {
            throw InputError({table.file, 1}, fmt::format("column '{}' stands there twice", column),
                             "keep one of them");
        }
        if (column == "time_s") {
            targets.push_back(&FlightSeries::time_s);
            continue;
        }
        const auto& channels = series_channels();
        const auto found = std::find_if(channels.begin(), channels.end(),
                                        [&](const SeriesChannel& channel) { return channel.name == column; });
        if (found == channels.end()) {
            const auto near = nearest_word(column, known);
            throw InputError({table.file, 1}, fmt::format("unknown column '{}'", column),
                             near.empty() ? fmt::format("a series has {}", fmt::join(known, ", "))
                                          : fmt::format("did you mean '{}'?", near));
        }
        targets.push_back(found->values);
    }
    return targets;
}

}  // namespace

const std::vector<SeriesChannel>& series_channels() {
    static const std::vector<SeriesChannel> channels{
        {"altitude_m", &FlightSeries::altitude_m},
        {"throttle_percent", &FlightSeries::throttle_percent},
        {"voltage_v", &FlightSeries::voltage_v},
        {"current_a", &FlightSeries::current_a},
        {"power_w", &FlightSeries::power_w},
        {"charge_ah", &FlightSeries::charge_ah},
        {"energy_wh", &FlightSeries::energy_wh},
        {"east_m", &FlightSeries::east_m},
        {"north_m", &FlightSeries::north_m},
        {"ground_speed_m_per_s", &FlightSeries::ground_speed_m_per_s},
    };
    return channels;
}

std::string to_csv(const FlightSeries& series) {
    std::vector<const std::vector<double>*> columns{&series.time_s};
    fmt::memory_buffer text;
    fmt::format_to(std::back_inserter(text), "time_s");
    for (const auto& channel : series_channels()) {
        if ((series.*channel.values).empty()) continue;
        columns.push_back(&(series.*channel.values));
        fmt::format_to(std::back_inserter(text), ",{}", channel.name);
    }
    for (std::size_t row = 0; row < series.time_s.size(); ++row) {
        for (std::size_t column = 0; column < columns.size(); ++column) {
            fmt::format_to(std::back_inserter(text), "{}{}", column == 0 ? '\n' : ',',
                           (*columns[column])[row]);
        }
    }
    text.push_back('\n');
    return fmt::to_string(text);
}

FlightSeries read_series_csv(const std::filesystem::path& path) {
    const auto table = read_csv(path);
    const auto time_column = column_index(table, "time_s");
    column_index(table, "power_w");
    const auto targets = bind_columns(table);
    if (table.rows.size() < 2) throw InputError({table.file}, "has fewer than two samples");
    FlightSeries series;
    series.flight = telemetry::flight_name(path);
    series.file = path.string();
    series.power_source = "series CSV";
    for (const auto& column : table.columns) series.sources[column] = "series CSV";
    for (const auto& row : table.rows) {
        const double time_s = cell_number(table, row, time_column);
        if (!series.time_s.empty() && time_s <= series.time_s.back()) {
            throw InputError({table.file, row.line, row.cells[time_column].column},
                             fmt::format("time_s = {} does not rise from {}", time_s, series.time_s.back()),
                             "sort the rows by time and keep one of each");
        }
        for (std::size_t i = 0; i < targets.size(); ++i) {
            (series.*targets[i]).push_back(cell_number(table, row, i));
        }
    }
    return series;
}

}  // namespace flightwatt::flight
