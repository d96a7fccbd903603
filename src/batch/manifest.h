#pragma once

#include "batch/log_files.h"

#include <array>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

/// What a batch wrote into its folder: it replaces and removes that alone.
namespace flightwatt::batch {

inline constexpr auto manifest_name = "batch.json";
/// The folder in OUT where files stand until they are whole.
inline constexpr auto temporary_folder = ".flightwatt-unfinished";

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

/// Removes what a batch wrote of a flight.
void remove_results(const std::filesystem::path& out, const std::string& flight);

/// A JSON file of a batch. Throws std::exception for what is none, or nests deeper than ours: it would take a hundred
/// times its size in memory.
nlohmann::ordered_json parse_json(const std::string& text);

struct Manifest {
    std::set<std::string> files;   ///< in OUT itself
    std::vector<LogFile> flights;  ///< whose files are the batch's, by name
};

/// OUT/batch.json; nothing where there is none. Throws InputError where it is damaged, another program's, or of a newer
/// format.
Manifest read_manifest(const std::filesystem::path& out);

void write_manifest(const Manifest& manifest, const std::filesystem::path& out);

/// A flight of an earlier run that is dropped from the folder.
struct DroppedFlight {
    std::string flight;
    std::string reason;  ///< "its log LOG is gone", "its log LOG is not in this batch"
};

/// What a run is to do.
struct BatchPlan {
    std::vector<LogFile> logs;  ///< this run's and those of earlier runs, by path
    std::vector<DroppedFlight> dropped;
    Manifest manifest;  ///< once it is done
    Manifest earlier;
};

/// Adds this run's logs to those of earlier runs. A log keeps the name that it had; other logs of one name are called
/// NAME, NAME_2, ... Earlier flights whose log is gone are kept as they are, except those that were never usable. With
/// `prune` all earlier flights that are not among `logs` are dropped.
BatchPlan plan_batch(std::vector<LogFile> logs, const std::filesystem::path& out, bool prune);

/// Throws UsageError, naming it, where a file that no batch wrote stands where this one is going to write.
void refuse_foreign_files(const BatchPlan& plan, const std::filesystem::path& out);

/// Makes the folders, lists in batch.json what is going to be written, and removes what is dropped and what killed runs
/// left unfinished. Killed at any moment, every file is listed.
void prepare_folder(const BatchPlan& plan, const std::filesystem::path& out);

}  // namespace flightwatt::batch
