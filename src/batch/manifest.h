#pragma once

#include "batch/log_files.h"
#include "record/json_type.h"

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// List of the flights of a batch, whose files it replaces and removes.
namespace flightwatt::batch {

inline constexpr auto manifest_name = "batch.json";
/// The folder in OUT of incomplete files.
inline constexpr auto temporary_folder = ".flightwatt-unfinished";

/// Files of a flight: OUT/flights/NAME.series.csv, ...
inline constexpr auto series_suffix = ".series.csv";
inline constexpr auto phases_suffix = ".phases.csv";
inline constexpr auto record_suffix = ".record.json";
inline constexpr std::array result_suffixes{record_suffix, series_suffix, phases_suffix};

/// Files in OUT itself: the catalogue, and those of the fit.
inline constexpr auto catalogue_name = "flights.csv";
inline constexpr auto model_name = "model.toml";
inline constexpr auto model_errors_name = "model_errors.toml";  ///< the same with its errors
inline constexpr auto fit_name = "fit.json";                    ///< see BatchFit
inline constexpr std::array table_names{"table1.txt", "table1.csv", "table1.md"};
inline constexpr std::array model_names{model_name,     model_errors_name, fit_name,
                                        table_names[0], table_names[1],    table_names[2]};

/// Path of one of these: OUT/flights/NAME.series.csv, ...
std::filesystem::path result_path(const std::filesystem::path& out, std::string_view flight, const char* ending);

/// Removes the files of a log, of all its recordings.
void remove_results(const std::filesystem::path& out, const std::string& flight);

/// Reads a JSON file of a batch. Throws InputError for a newer format, and with `problem` and `hint` for text that is
/// not JSON, is nested deeply, or that `read` throws a std::exception for.
void read_batch_json(const std::filesystem::path& file, const std::string& text, const char* problem,
                     const std::string& hint, const std::function<void(const Json&)>& read);

/// The flights of OUT/batch.json by name; none without the file. Throws InputError as read_batch_json.
std::vector<LogFile> read_manifest(const std::filesystem::path& out);

void write_manifest(const std::vector<LogFile>& flights, const std::filesystem::path& out, bool is_of_each = false);

/// Returns the folders of `--each` in OUT, by their batch.json, in order.
std::vector<std::filesystem::path> folders_of_each(const std::filesystem::path& out);

/// Removes the files that batch.json lists, and the folder if it is empty then. Throws UsageError, before it removes
/// any, if one is an input.
void remove_batch(const std::filesystem::path& out);

/// A flight of an earlier run that is dropped from the folder.
struct DroppedFlight {
    std::string flight;
    std::string reason;  ///< "its log LOG is missing", "its log LOG is not in this batch"
};

/// Logs and files of a run.
struct BatchPlan {
    std::vector<LogFile> logs;  ///< this run's and those of earlier runs, by path
    std::vector<DroppedFlight> dropped;
    std::vector<LogFile> flights;  ///< in the manifest after the run, by name
    std::vector<LogFile> earlier;  ///< in the manifest before it
    bool is_of_each = false;       ///< the folder of one aircraft, of `--each`
};

/// Adds this run's logs to those of earlier runs. A log keeps its name; others of one name are NAME, NAME_2, ...
/// Earlier flights that are not among the logs are kept, or dropped with `prune`.
BatchPlan plan_batch(std::vector<LogFile> logs, const std::filesystem::path& out, bool prune);

/// Throws UsageError if a file of the run would replace an input, or, in a folder without batch.json, any file.
void refuse_foreign_files(const BatchPlan& plan, const std::filesystem::path& out);

/// Makes the folders, lists the flights of the run in batch.json, and removes dropped and incomplete files.
void prepare_folder(const BatchPlan& plan, const std::filesystem::path& out);

}  // namespace flightwatt::batch
