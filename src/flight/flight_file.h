#pragma once

#include "base/error.h"
#include "flight/column_map.h"
#include "flight/flight_series.h"
#include "telemetry/autopilot_log.h"
#include "telemetry/binary_log.h"
#include "telemetry/data_file.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

struct LoadOptions;

/// A file of a flight in memory: a text or binary log with its .log, a log of another autopilot, or a CSV. `messages`
/// (a messages.xml or another .log) defines the messages of a log whose .log is missing or damaged, `columns` (a column
/// map) the tracks of a CSV. Throws InputError for a file that cannot be read.
class FlightFile {
  public:
    explicit FlightFile(const std::filesystem::path& path, std::size_t max_bytes = telemetry::default_max_log_bytes,
                        const std::optional<std::filesystem::path>& messages = std::nullopt,
                        const std::optional<std::filesystem::path>& columns = std::nullopt);
    FlightFile(const std::filesystem::path& path, const LoadOptions& options);
    FlightFile(const FlightFile&) = delete;
    FlightFile& operator=(const FlightFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    bool is_series() const { return is_series_; }
    /// Returns the column map of a CSV that is no series.
    const std::optional<ColumnMap>& column_map() const { return column_map_; }
    std::string_view text() const { return text_; }
    /// Returns the format of another autopilot's log; std::nullopt for other files.
    std::optional<telemetry::AutopilotFormat> autopilot() const { return autopilot_; }
    /// Returns the framing of a binary log; std::nullopt for text.
    std::optional<telemetry::Framing> framing() const { return framing_; }
    /// Returns the text of the log's .log or of `messages`; std::nullopt without one.
    const std::optional<std::string>& log_text() const { return log_text_; }
    std::filesystem::path log_file() const { return log_file_; }
    /// Returns the error of the .log that `messages` replace; empty without one.
    const std::string& log_error() const { return log_error_; }
    /// Returns the definitions of the messages of a binary log. Throws InputError if nothing defines them.
    telemetry::MessageDictionary definitions() const;

  private:
    std::filesystem::path path_;
    bool is_series_ = false;
    std::optional<ColumnMap> column_map_;
    std::string text_;
    std::optional<telemetry::AutopilotFormat> autopilot_;
    std::optional<telemetry::Framing> framing_;
    std::filesystem::path log_file_;
    std::optional<std::string> log_text_;
    std::string log_error_;
};

/// Calls use(BinaryLog) for a binary file and returns its result. Throws InputError if nothing defines its messages.
template <typename Use>
auto with_binary_log(const FlightFile& file, const Use& use) {
    const auto messages = file.definitions();
    return use(telemetry::BinaryLog{file.text(), file.framing().value(), file.path(), file.log_file(), &messages});
}

/// Minimum length of the beginning of an id that names an aircraft: longer than any whole id of Paparazzi.
inline constexpr std::size_t min_id_beginning = 4;

/// Returns the messages of a log and their numbers, the most frequent first: "GPS 310". Empty for a series.
std::vector<std::string> list_message_counts(const FlightFile& file);

/// Error of a valid log that has no data of the requested aircraft, or has several aircraft of which one must be
/// requested.
class OtherAircraftError : public InputError {
    using InputError::InputError;
};

/// The series of a recording that may be the flight: that of the named aircraft, else one of each that sent telemetry.
using Candidates = std::vector<FlightSeries>;

/// Returns the flight's name of a recording: FLIGHT of the first, FLIGHT@2, FLIGHT@3 ... of the others.
std::string recording_name(const std::string& flight, std::size_t recording);
/// Returns whether a name has the form of a recording that is not the first.
bool is_recording_name(const std::string& flight);

/// Reads the recordings of a file (telemetry/recordings.h), without checks: the series of that aircraft (see
/// LoadOptions::aircraft), else of all that sent telemetry. Throws InputError if the file has no telemetry,
/// OtherAircraftError without that aircraft, if it is required.
std::vector<Candidates> read_recordings(const FlightFile& file, const std::optional<std::string>& aircraft,
                                        bool required = true);

}  // namespace flightwatt::flight
