#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::live {

/// Records telemetry as logs for `batch`: NAME.data (or .tlog) in a folder, with the .log of its definitions. After a restart of
/// the clock a new log NAME_2 ... begins; existing files are never changed. Written lines can be read at once. A full
/// disk ends the recording, not the watch.
class Recorder {
  public:
    /// Creates the folder. `log_text` is the content of the .log; without it none is written. Throws OutputError.
    Recorder(std::filesystem::path folder, std::string name, std::optional<std::string> log_text,
             std::string ending = ".data");

    /// Appends complete lines; if the clock restarted before them, to a new log.
    void write(std::string_view lines, bool clock_restarted);

    /// Returns the current file; empty before the first line.
    const std::filesystem::path& file() const { return file_; }
    /// Returns the reason why the recording ended; empty while it continues.
    const std::string& failure() const { return failure_; }

  private:
    void open_next();

    std::filesystem::path folder_;
    std::string name_;
    std::optional<std::string> log_text_;
    std::string ending_;
    std::size_t number_ = 0;
    std::filesystem::path file_;
    std::ofstream out_;
    std::string failure_;
};

/// Returns the Unix time at which a recording begins: now, or 2001 where the clock of the computer is not set, as a .tlog
/// has no earlier times.
double recording_start_unix_s(double now_unix_s);

/// Returns Paparazzi's log name for a Unix time, in UTC: "26_11_22__14_05_09".
std::string log_name(std::int64_t unix_s);

}  // namespace flightwatt::live
