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
/// matter the source of the tracks is `plain_source`. Throws InputError as read_series_csv, and if the chosen column
/// was changed.
std::vector<FlightSeries> read_series_table(FrontMatter matter, std::string_view text, const std::string& file,
                                            std::string_view plain_source);

/// Returns the finding that times of a column, as seconds, are in a smaller unit: more than 15 s apart, or for more than
/// 4 days; empty if they are not, or fewer than 30.
std::string slow_clock_finding(const std::string& column, const std::vector<double>& time_s);

}  // namespace flightwatt::flight
