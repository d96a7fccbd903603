#pragma once

#include <filesystem>
#include <utility>
#include <vector>

namespace flightwatt::report {

/// Longitudes and latitudes [deg] of a line.
using Outline = std::vector<std::pair<double, double>>;

/// Every line and ring of a GeoJSON file, drawn below flown tracks. Throws InputError for a file without any.
std::vector<Outline> read_outlines(const std::filesystem::path& file);

}  // namespace flightwatt::report
