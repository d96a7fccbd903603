#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::live {

/// Makes an empty file; false where there is one already. Throws OutputError.
bool make_new_file(const std::filesystem::path& path);

/// Keeps telemetry as logs that a batch takes: NAME.data in a folder, with the .log of its definitions beside it. Where
/// the clock begins anew a new log does, NAME_2 ...; no file that exists is written to. What is written can be read at
/// once. A disk that is full ends the recording, not the watch.
class Recorder {
  public:
    /// Makes the folder. `log_text`: of the .log; none: without one. Throws OutputError.
    Recorder(std::filesystem::path folder, std::string name, std::optional<std::string> log_text);

    /// Appends whole lines.
    void write(std::string_view lines, bool anew);

    /// The .data file that is written; empty before the first line.
    const std::filesystem::path& file() const { return file_; }
    /// Why no more is written; empty while it is.
    const std::string& failure() const { return failure_; }
    /// Why a .log could not be written; the .data goes on without it.
    const std::string& lacks_definitions() const { return lacks_definitions_; }

  private:
    void open_next();
    void write_definitions();

    std::filesystem::path folder_;
    std::string name_;
    std::optional<std::string> log_text_;
    std::size_t number_ = 0;
    std::filesystem::path file_;
    std::ofstream out_;
    std::string failure_;
    std::string lacks_definitions_;
};

/// "26_11_22__14_05_09": as Paparazzi names its logs, of a Unix time, in UTC.
std::string log_name(std::int64_t unix_s);

}  // namespace flightwatt::live
