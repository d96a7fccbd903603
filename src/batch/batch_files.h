#pragma once

#include "batch/flight_record.h"
#include "batch/log_files.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace flightwatt::batch {

/// What a batch writes of a flight, after its name: OUT/flights/NAME.series.csv, ...
inline constexpr auto series_ending = ".series.csv";
inline constexpr auto phases_ending = ".phases.csv";
inline constexpr auto record_ending = ".record.json";

/// What a batch writes into OUT itself; the first one is the catalogue, the others are the fit's.
inline constexpr auto catalogue_name = "flights.csv";
inline constexpr auto model_name = "model.toml";
inline constexpr auto model_errors_name = "model_errors.toml";  ///< the same with its errors
inline constexpr auto fit_name = "fit.json";                    ///< see BatchFit
inline constexpr std::array table_names{"table1.txt", "table1.csv", "table1.md"};
inline constexpr std::array model_names{model_name,     model_errors_name, fit_name,
                                        table_names[0], table_names[1],    table_names[2]};

/// A flight of an earlier run whose log is no longer among those of the batch, and what became of it.
struct DroppedFlight {
    std::string flight;
    std::string reason;  ///< "its log is gone", "its log LOG is not in this batch", "it is called NAME now"
};

/// The flights that have a record in OUT/flights and are not among `logs`, by name.
std::vector<DroppedFlight> find_dropped(const std::vector<LogFile>& logs, const std::filesystem::path& out);

/// Removes what earlier runs left in OUT of flights that are not among `logs`, and what killed ones left
/// unfinished. Files that no batch wrote stay.
void remove_left_overs(const std::vector<LogFile>& logs, const std::filesystem::path& out);

/// A log as a batch left it in its folder.
struct StoredFlight {
    FlightRecord record;
    flight::FlightSeries series;  ///< of an accepted log
    flight::FlightPhases phases;  ///< with the evidence at their edges, which the record does not hold
};

/// What a batch wrote into OUT, flight by flight, by name. Throws InputError where OUT is no batch's folder,
/// a record is damaged, or an accepted flight's files are missing or not as the batch writes them.
std::vector<StoredFlight> read_stored_flights(const std::filesystem::path& out);

}  // namespace flightwatt::batch
