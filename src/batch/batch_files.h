#pragma once

#include "batch/flight_record.h"
#include "batch/log_files.h"

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace flightwatt::batch {

/// What a batch writes of a flight, after its name: OUT/flights/NAME.series.csv, ...
inline constexpr auto series_suffix = ".series.csv";
inline constexpr auto phases_suffix = ".phases.csv";
inline constexpr auto record_suffix = ".record.json";
inline constexpr std::array result_suffixes{record_suffix, series_suffix, phases_suffix};

/// What a batch writes into OUT itself; the first one is the catalogue, the others are the fit's.
inline constexpr auto catalogue_name = "flights.csv";
inline constexpr auto model_name = "model.toml";
inline constexpr auto model_errors_name = "model_errors.toml";  ///< the same with its errors
inline constexpr auto fit_name = "fit.json";                    ///< see BatchFit
inline constexpr std::array table_names{"table1.txt", "table1.csv", "table1.md"};
inline constexpr std::array model_names{model_name,     model_errors_name, fit_name,
                                        table_names[0], table_names[1],    table_names[2]};

/// Where one of these stands: OUT/flights/NAME.series.csv, ...
std::filesystem::path result_path(const std::filesystem::path& out, std::string_view flight, const char* ending);

/// The flights that have a record in the folder OUT/flights, by name.
std::vector<std::string> recorded_flights(const std::filesystem::path& folder);

/// Removes what a batch wrote of a flight.
void remove_results(const std::filesystem::path& out, const std::string& flight);

/// Of the files that an accepted log leaves.
std::string results_fingerprint(std::string_view series_csv, std::string_view phases_csv);

/// The record of a flight whose files are all as the batch wrote them. Throws InputError for others.
FlightRecord read_verified_record(const std::filesystem::path& out, const std::string& flight);

/// A log as a batch left it in its folder.
struct StoredFlight {
    FlightRecord record;
    flight::FlightSeries series;     ///< of an accepted log
    flight::FlightPhases phases;     ///< with the evidence at their edges, which the record does not hold
    std::string damage_reason = {};  ///< why its files are not used: they are not as the batch wrote them
};

/// A JSON file of a batch. Throws std::exception for what is none, or nests deeper than ours: it would take a hundred
/// times its size in memory.
nlohmann::ordered_json parse_json(const std::string& text);

/// What a batch wrote into OUT, flight by flight, by name. Throws InputError where OUT is no batch's folder, or the
/// files of a flight are missing, damaged or changed; where its log is gone too, so that no batch could mend that, the
/// flight is given as damaged instead.
std::vector<StoredFlight> read_stored_flights(const std::filesystem::path& out);

/// The same without series and phases, which are compared with their fingerprints all the same.
std::vector<StoredFlight> read_stored_records(const std::filesystem::path& out);

}  // namespace flightwatt::batch
