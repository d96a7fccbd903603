#pragma once

#include "base/units.h"
#include "flight/flight_series.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// A track from columns of a CSV.
struct MappedTrack {
    /// How the values of several columns become one.
    enum class Combine { first, product, norm };

    std::string name;
    Combine combine = Combine::first;
    std::vector<std::string> columns;  ///< if empty, `factor` is the value
    double unit_factor = 1.0;          ///< of the unit, if the names of the columns state none
    double factor = 1.0;
    bool states_unit = false;  ///< or a factor, before a unit in the name of a column
};

/// Which columns of a CSV are the tracks of a flight (docs/formats.md, "Column map").
struct ColumnMap {
    std::string text;                 ///< content of its file
    bool is_shipped = false;          ///< part of FlightWatt: tracks whose columns a file lacks are left out
    std::vector<std::string> header;  ///< a CSV with all of these is recognised; empty: none is
    std::string aircraft_id;
    std::string aircraft_name;
    std::string firmware;
    CurrentOrigin current_origin = CurrentOrigin::unknown;
    std::optional<std::size_t> skip_lines;  ///< lines before the header; absent: the header is found by its names
    std::string time_column;
    std::string date_column;  ///< empty: none
    double tick_s = 1.0;      ///< unit of time, if the name of the column states none
    bool is_unix_time = false;
    std::vector<MappedTrack> tracks;
};

/// Reads a column map from text; `file` is named in errors. Throws InputError for an unknown key, track or unit, a
/// track named twice, and for a map with neither altitude_m nor power_w (which may be voltage_v and current_a).
ColumnMap parse_column_map(const std::string& text, const std::filesystem::path& file);
/// Reads a column map from a file. Throws as parse_column_map().
ColumnMap read_column_map(const std::filesystem::path& file);

/// Returns the names of columns by which the header of a map's files is found.
std::vector<std::string> header_names(const ColumnMap& map);

/// Returns the quantity of a track by the suffix of its name; std::nullopt for states.
std::optional<units::Quantity> quantity_of(std::string_view track);

/// Returns the map of a CSV: that of the file `columns`, else the one of FlightWatt whose header it has; std::nullopt
/// for a series. Throws InputError, naming `file`, for a CSV that is neither.
std::optional<ColumnMap> column_map_of(std::string_view csv, const std::filesystem::path& file,
                                       const std::optional<std::filesystem::path>& columns);

/// Returns whether a .csv, .tsv, .txt or .log is a table of a flight, by its header: a series, or one with a map.
bool is_flight_csv(const std::filesystem::path& file, const std::optional<std::filesystem::path>& columns);

}  // namespace flightwatt::flight
