#pragma once

#include "flight/flight_series.h"
#include "flight/series_file.h"
#include "helpers/selected_tracks.h"

#include <string>
#include <utility>
#include <vector>

namespace flightwatt::test {

/// A flight as a table of samples, as a user's CSV has it: every column as long as `time_s`, or empty.
struct SampleColumns {
    std::vector<double> time_s;
    std::vector<double> power_w;
    std::vector<double> altitude_m;
    std::vector<double> throttle_percent;
    std::vector<double> voltage_v;
    std::vector<double> current_a;
    std::vector<double> charge_ah;
    std::vector<double> energy_wh;
    std::vector<double> ground_speed_m_per_s;
    std::vector<double> wind_speed_m_per_s;
    std::vector<double> motor_speed_rpm;
};

inline std::vector<std::pair<std::string, std::vector<double> SampleColumns::*>> named_columns() {
    return {{"power_w", &SampleColumns::power_w},
            {"altitude_m", &SampleColumns::altitude_m},
            {"throttle_percent", &SampleColumns::throttle_percent},
            {"voltage_v", &SampleColumns::voltage_v},
            {"current_a", &SampleColumns::current_a},
            {"charge_ah", &SampleColumns::charge_ah},
            {"energy_wh", &SampleColumns::energy_wh},
            {"ground_speed_m_per_s", &SampleColumns::ground_speed_m_per_s},
            {"wind_speed_m_per_s", &SampleColumns::wind_speed_m_per_s},
            {"motor_speed_rpm", &SampleColumns::motor_speed_rpm}};
}

/// A series of these columns; without power it measures 0 W.
inline flight::FlightSeries series_of(SampleColumns columns, const std::string& name = "flight") {
    flight::FlightSeries series;
    series.file = series.flight = name;
    if (columns.power_w.empty()) columns.power_w.assign(columns.time_s.size(), 0.0);
    for (const auto& [column, values] : named_columns()) {
        if ((columns.*values).empty()) continue;
        series.tracks.push_back(
            {.name = column, .source = flight::plain_source, .time_s = columns.time_s, .value = columns.*values});
    }
    return series;
}

/// What the programs take from a series, on the clock of its power samples.
inline SampleColumns columns_of(const flight::FlightSeries& series) {
    SampleColumns columns;
    columns.time_s = power_track(series).time_s;
    for (const auto& [column, values] : named_columns()) {
        columns.*values = sample_selected_track(series, column, columns.time_s);
    }
    return columns;
}

}  // namespace flightwatt::test
