#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
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
    std::string place = {};           ///< the path from the root (place_of)
};

/// Logs in the room that their texts take: of a hundred thousand, all that a batch holds of them while it works.
class LogList {
  public:
    LogList() = default;
    explicit LogList(const std::vector<LogFile>& logs);

    void push_back(const LogFile& log);
    std::size_t size() const { return starts_.size(); }
    bool empty() const { return starts_.empty(); }
    LogFile operator[](std::size_t number) const;
    // Valid until another one is added.
    std::string_view path(std::size_t number) const { return text(number, 0); }
    std::string_view flight(std::size_t number) const { return text(number, 1); }
    std::string_view place(std::size_t number) const;

    /// The numbers of the logs in the order of their paths, folder by folder (path_less); equal ones as they stand.
    std::vector<std::size_t> by_path() const;
    /// In the order of their flights' names.
    std::vector<std::size_t> by_flight() const;

  private:
    std::string_view text(std::size_t number, std::size_t field) const;

    /// Of each log: its flags, the lengths of its texts, the texts. No string: one that is replaced keeps its room.
    std::vector<char> bytes_;
    std::vector<std::uint64_t> starts_;
};

/// Whether a path is the earlier one of two, part by part as std::filesystem::path orders them.
bool path_less(std::string_view one, std::string_view other);

}  // namespace flightwatt::batch
