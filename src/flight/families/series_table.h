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
    std::vector<std::string> columns;  ///< of each track
    std::string chosen_column = {};    ///< that repeats what is chosen among the others; empty without one
};

/// The series of each recording in the table of a series file: with the tracks that have a column, those without front
/// matter from `plain_source`. Throws InputError as read_series_csv, and if the chosen column was changed.
std::vector<FlightSeries> read_series_table(FrontMatter matter, std::string_view text, const std::string& file,
                                            std::string_view plain_source);

}  // namespace flightwatt::flight
