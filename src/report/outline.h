#pragma once

#include <filesystem>
#include <utility>
#include <vector>

namespace flightwatt::report {

/// A line as longitudes and latitudes [deg].
using Outline = std::vector<std::pair<double, double>>;

/// Reads every line and ring of a GeoJSON file, to be drawn below flown tracks. Throws InputError for a file without
/// any.
std::vector<Outline> read_outlines(const std::filesystem::path& file);

}  // namespace flightwatt::report
