#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace flightwatt::batch {

/// A log of a batch and the name of its results: flights/NAME.series.csv, .phases.csv and .record.json.
struct LogFile {
    std::string path;                 ///< as it was given
    std::string flight = {};          ///< empty: not named yet
    std::string why_not_fitted = {};  ///< empty: it is fitted
    std::string problem = {};         ///< why it cannot be read: a folder that cannot be listed
    bool is_of_this_run = true;       ///< false: a log of an earlier run into the same folder
    bool is_missing = false;          ///< of an earlier run, and deleted since
    std::string place = {};           ///< canonical_path
};

/// The absolute path of a log, its folder without links.
std::string canonical_path(const std::string& log);

/// The logs among files and folders (recursively), each once, by path; flights of one name are NAME, NAME_2, ...
/// A not-fitted.txt below a given folder excludes its logs from the fit, with the reason in its first line.
/// Logs that are `listed` need not exist: those are unusable, as a folder that cannot be listed.
/// Throws InputError for a missing input, for no log at all, and for an empty not-fitted.txt.
/// A CSV below a folder counts if it is a flight, with the column map `columns` or by its header.
std::vector<LogFile> find_logs(const std::vector<std::string>& inputs, const std::vector<std::string>& listed = {},
                               const std::optional<std::filesystem::path>& columns = std::nullopt);

/// The paths of a text, one a line; empty lines are ignored. Throws InputError for a NUL, as of find -print0.
std::vector<std::string> parse_path_list(std::string_view text, const std::string& file);

/// Unique names for the results of logs.
class UniqueNames {
  public:
    void reserve(const std::string& name);

    /// The log's own name, shortened if necessary, or the next free one of NAME_2, NAME_3, ...
    std::string assign(const std::filesystem::path& log);

  private:
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, int> next_;  ///< lowest number that may be free, by name
};

}  // namespace flightwatt::batch
