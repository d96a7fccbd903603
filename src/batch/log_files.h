#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace flightwatt::batch {

/// A log that a batch is to do or did, and the name that its results go by: flights/NAME.series.csv, .phases.csv and
/// .record.json.
struct LogFile {
    std::string path;                 ///< as it was given
    std::string flight = {};          ///< empty: not named yet
    std::string why_not_fitted = {};  ///< empty: it is fitted
    std::string problem = {};         ///< why it cannot be read at all: a folder that cannot be listed
    bool is_of_this_run = true;       ///< false: a log of an earlier run into the same folder
    bool is_missing = false;          ///< of an earlier run, and no longer there
    std::string place = {};           ///< the path from the root (canonical_path)
};

/// The path of a log from the root, its folder without links: one log, one place, however it is written.
std::string canonical_path(const std::string& log);

/// The logs among files and folders (searched to the bottom for .data, .LOG and .tlm files, compressed or not), in the
/// order of their paths, each once however it is written. Flights of the same name get the names NAME, NAME_2, ...
/// Logs in a folder below the one that was given, or deeper, are not fitted if that folder holds a file
/// not-fitted.txt, whose first line says why. A folder that cannot be listed stands among them with its problem.
/// Throws InputError for an input that does not exist, where there is no log at all, or for a not-fitted.txt that
/// does not say why.
/// What is `listed` stands among them as it is: a log that is not there is one that cannot be used.
std::vector<LogFile> find_logs(const std::vector<std::string>& inputs, const std::vector<std::string>& listed = {});

/// The paths of a text that names one a line: what stands in a line is the path. Empty lines are passed over.
/// Throws InputError for `file` where it holds a NUL, as lists of find -print0 do.
std::vector<std::string> parse_path_list(std::string_view text, const std::string& file);

/// Names for the results of logs, each given once.
class UniqueNames {
  public:
    void reserve(const std::string& name);

    /// The log's own name, shortened where no file could be called so, or, where that is taken, the next free one of
    /// NAME_2, NAME_3, ...
    std::string assign(const std::filesystem::path& log);

  private:
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, int> next_;  ///< the lowest number that may be free, by the log's own name
};

}  // namespace flightwatt::batch
