#pragma once

#include "flight/flight_series.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// A track from columns of a CSV.
struct MappedTrack {
    enum class Combine { column, product, norm };

    std::string name;
    Combine combine = Combine::column;
    std::vector<std::string> columns;
    double factor = 1.0;  ///< from the columns' unit to that of the track
};

/// Which columns of a CSV are the tracks of a flight (docs/formats.md, "Column map").
struct ColumnMap {
    std::string text;                 ///< of its file
    std::vector<std::string> header;  ///< a CSV with all of these is recognised; empty: none is
    std::string aircraft_id;
    std::string aircraft_name;
    std::string firmware;
    CurrentOrigin current_origin = CurrentOrigin::unknown;
    std::string time_column;
    double ticks_per_s = 1.0;
    bool is_unix_time = false;
    std::vector<MappedTrack> tracks;
};

/// Throws InputError for an unknown key, track or unit, and for a map without power_w and altitude_m.
ColumnMap parse_column_map(const std::string& text, const std::filesystem::path& file);
ColumnMap read_column_map(const std::filesystem::path& file);

/// The map of a CSV: that of the file `columns`, else one that comes with FlightWatt and whose header it has.
/// std::nullopt for a series. Throws InputError, naming `file`, for a CSV that is neither.
std::optional<ColumnMap> column_map_of(std::string_view csv, const std::filesystem::path& file,
                                       const std::optional<std::filesystem::path>& columns);

/// Whether a CSV file is a flight, by its header: a series, or one with a map.
bool is_flight_csv(const std::filesystem::path& file, const std::optional<std::filesystem::path>& columns);

/// The series of a CSV by its map, one for each recording. A cell that is no number is counted and left out. Throws
/// InputError for a column that is missing, and for fewer than two rows.
std::vector<FlightSeries> parse_mapped_csv(std::string_view csv, const std::filesystem::path& file,
                                           const ColumnMap& map);

}  // namespace flightwatt::flight
