#pragma once

#include "flight/column_map.h"

#include <filesystem>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// Reads the series of a CSV by its map, one for each recording. Cells that are no numbers, and rows of another length
/// than the header, are counted and left out. Throws InputError for a column that is missing, for fewer than two rows,
/// and for negative power.
std::vector<FlightSeries> parse_mapped_csv(std::string_view csv, const std::filesystem::path& file,
                                           const ColumnMap& map);

}  // namespace flightwatt::flight
