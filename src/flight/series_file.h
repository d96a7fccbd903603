#pragma once

#include "base/atomic_file.h"
#include "flight/flight_series.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace flightwatt::flight {

/// What a track of a CSV without front matter is from.
inline constexpr auto plain_source = "series CSV";

/// The series file: what holds for the whole flight as TOML in comment lines, the first of them `format = 1`;
/// then a CSV table with `time_s` and a column a track, on one row for each time at which any track has a
/// value; a cell is empty where its track has none. Further candidates of a name are called NAME.2, NAME.3,
/// ... Nothing is lost: read_series_csv gives the same series. Not for a series whose clock restarts.
std::string to_csv(const FlightSeries& series);
/// The same in pieces, made on `max_threads` at most (0: on every core).
void write_csv(const FlightSeries& series, const TextSink& sink, std::size_t max_threads = 0);

/// Reads a series file, or a CSV without front matter (time_s, power_w and what else of track_names() there
/// is). Throws InputError with file, line and column for a format that is newer, an unknown column, a value
/// that is not a finite number, neither power_w nor altitude_m, fewer than two samples of power (or of altitude, where
/// no power was measured), or time that does not rise.
FlightSeries read_series_csv(const std::filesystem::path& path);

/// The same of a text; `file` is named in errors, and gives the flight's name where the text does not.
FlightSeries parse_series_csv(std::string_view text, const std::filesystem::path& file);

}  // namespace flightwatt::flight
