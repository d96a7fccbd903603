#pragma once

#include "base/atomic_file.h"
#include "base/toml_reader.h"
#include "flight/flight_series.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// Reads a table's key current_origin. Throws InputError for another text.
CurrentOrigin read_current_origin(const TomlTable& table);

/// Returns a series file: metadata as TOML in comment lines, the first of them `format = 1`, then a CSV table with
/// `time_s`, a column for each track (further candidates are NAME.2, NAME.3, ...) and a row for each time of any track.
/// Lossless, but not for a series whose clock restarts.
std::string to_csv(const FlightSeries& series);
/// Writes a series file as to_csv(), in chunks.
void write_csv(const FlightSeries& series, const TextSink& sink);

/// The longest table that is read: the series of a log of 200 MB has 145 MB.
inline constexpr std::size_t max_series_bytes = 1'000'000'000;

/// Reads a series file, or a CSV without front matter (time_s and columns of track_names()). Throws InputError for a
/// newer format, an unknown column, a value that is not a finite number, neither power_w nor altitude_m, fewer than two
/// samples of power (without power: of altitude), times that do not rise, and several recordings.
FlightSeries read_series_csv(const std::filesystem::path& path);

/// Reads a series file from text as read_series_csv(). `file` is named in errors, and names the flight if the text does
/// not.
FlightSeries parse_series_csv(std::string_view text, const std::filesystem::path& file);

/// Reads the series of each recording in a text: files appended to each other, with their headers or not, or a clock
/// that restarts.
std::vector<FlightSeries> parse_series_recordings(std::string_view text, const std::filesystem::path& file);

}  // namespace flightwatt::flight
