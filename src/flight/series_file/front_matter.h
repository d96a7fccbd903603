#pragma once

#include "flight/flight_series.h"

#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// What each track's column is called: its name, and NAME.2, NAME.3 ... for further candidates.
std::vector<std::string> column_names(const std::vector<Track>& tracks);

/// What holds for the whole flight, as comment lines of TOML: `# format = 1` ...
std::string format_front_matter(const FlightSeries& series);

/// What the comment lines at the beginning of a series file say.
struct FrontMatter {
    bool present = false;
    FlightSeries series;               ///< without values; `tracks` as the file has columns
    std::vector<std::string> columns;  ///< of each track
};

/// Throws InputError for a format that is newer, and for what is not as format_front_matter writes it.
FrontMatter read_front_matter(std::string_view text, const std::string& file);

}  // namespace flightwatt::flight
