#pragma once

#include "flight/flight_series.h"

#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// The comment lines at the beginning of a series file.
struct FrontMatter {
    bool present = false;
    FlightSeries series;               ///< without values; `tracks` in the order of the file's columns
    std::vector<std::string> columns;  ///< name of each track's column
    std::string chosen_column = {};    ///< column that repeats the chosen one of the others; empty without one
};

/// Reads the series of each recording in the table of a series file, with the tracks that have a column. Without front
/// matter the source of the tracks is `plain_source`, and without power_w it is voltage_v times current_a. Throws
/// InputError as read_series_csv, and if the chosen column was changed.
std::vector<FlightSeries> read_series_table(FrontMatter matter, std::string_view text, const std::string& file);

/// Returns the finding that times of a column, as seconds, are in a smaller unit: more than 15 s apart, or for more than
/// 4 days; empty if they are not, or fewer than 30.
std::string slow_clock_finding(const std::string& column, const std::vector<double>& time_s);

/// Returns whether a power [W] is negative throughout, as where a discharge has a negative current; NaN does not count.
bool is_negative_throughout(const std::vector<double>& power_w);

}  // namespace flightwatt::flight
