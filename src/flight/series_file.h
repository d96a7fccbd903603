#pragma once

#include "flight/flight_series.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace flightwatt::flight {

/// A channel of FlightSeries and its column in the series CSV.
struct SeriesChannel {
    std::string_view name;
    std::vector<double> FlightSeries::*values;
};

/// The channels in the order of the CSV's columns, behind `time_s`.
const std::vector<SeriesChannel>& series_channels();

/// The series CSV: one row a power sample, the columns that the log has. Numbers read back exactly.
std::string to_csv(const FlightSeries& series);

/// Reads a series CSV. Throws InputError with file, line and column for an unknown column, a value that is
/// not a finite number, no power_w, fewer than two rows, or time that does not rise.
FlightSeries read_series_csv(const std::filesystem::path& path);

}  // namespace flightwatt::flight
