#pragma once

#include "base/error.h"
#include "flight/column_map.h"
#include "flight/flight_series.h"
#include "flight/power_check.h"
#include "flight/segmentation.h"
#include "flight/selected_track.h"
#include "telemetry/autopilot_log.h"
#include "telemetry/binary_log.h"
#include "telemetry/data_file.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// Options of reading, segmenting and checking a flight, common to all programs.
struct LoadOptions {
    /// One of several in the log: by its id, the beginning of its id, its name; or any of the log with this name.
    std::optional<std::string> aircraft = {};
    std::optional<std::size_t> sortie = {};  ///< from 1: the other sorties are ignored
    SegmentationOptions segmentation = {};
    bool correct_idle_offset = false;     ///< see correct_idle_offset()
    std::set<std::string> excluded = {};  ///< flights that are not used
    std::set<std::string> keep = {};      ///< flights that are used despite power faults
    bool simulated = false;               ///< flights of a simulator (SITL, HITL) are used too
    /// False: a log without that aircraft is read as if none were named.
    bool aircraft_required = true;
    /// False: a log without altitude or flight is accepted, and has no phases.
    bool flight_required = true;
    /// False: a log without measured power is accepted if it has an altitude.
    bool power_required = true;
    std::size_t max_log_bytes = telemetry::default_max_log_bytes;  ///< see read_data_file
    std::optional<std::filesystem::path> messages = {};            ///< see FlightFile
    std::optional<std::filesystem::path> columns = {};             ///< see FlightFile
};

/// Quality of a segmented series.
struct FlightAssessment {
    PowerReport power;                  ///< as measured, before any correction
    std::string lacks_power = {};       ///< why there is no measured power; empty if there is
    std::vector<std::string> warnings;  ///< of the series, the segmentation and the power
};

struct LoadedFlight : FlightAssessment {
    FlightSeries series;  ///< with the idle offset corrected, if requested
    FlightPhases phases;
    std::string exclusion = {};                       ///< why the flight is excluded; empty if it is used
    std::map<std::string, std::string> sources = {};  ///< source of each selected track, by name
};

/// A text or binary log with its .log, a log of another autopilot, or a CSV, in memory. `messages` (a messages.xml or
/// another .log) defines the messages of a log whose .log is missing or damaged, `columns` (a column map) the tracks of
/// a CSV. Throws InputError for a file that cannot be read.
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
    /// Of a CSV that is no series.
    const std::optional<ColumnMap>& column_map() const { return column_map_; }
    std::string_view text() const { return text_; }
    /// Format of another autopilot's log, which defines its own messages.
    std::optional<telemetry::AutopilotFormat> autopilot() const { return autopilot_; }
    /// Framing of a binary log; std::nullopt for text.
    std::optional<telemetry::Framing> framing() const { return framing_; }
    /// Text of the log's .log or of `messages`; std::nullopt without one.
    const std::optional<std::string>& log_text() const { return log_text_; }
    std::filesystem::path log_file() const { return log_file_; }
    /// Error of the .log that `messages` replace; empty without one.
    const std::string& log_error() const { return log_error_; }
    /// The messages of a binary log. Throws InputError if nothing defines them.
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

/// Calls use(BinaryLog) for a binary file. Throws InputError if nothing defines its messages.
template <typename Use>
auto with_binary_log(const FlightFile& file, const Use& use) {
    const auto messages = file.definitions();
    return use(telemetry::BinaryLog{file.text(), file.framing().value(), file.path(), file.log_file(), &messages});
}

/// The messages of a log and their numbers, the most frequent first: "GPS 310". Empty for a series.
std::vector<std::string> census_of(const FlightFile& file);

/// The log is valid, but has no data of the requested aircraft, or of several of which one is requested.
class OtherAircraftError : public InputError {
    using InputError::InputError;
};

/// The series of that aircraft (LoadOptions::aircraft), else of all that sent telemetry, without checks. Throws
/// InputError if the file has no telemetry, OtherAircraftError without that aircraft, if it is required.
std::vector<FlightSeries> read_candidates(const FlightFile& file, const std::optional<std::string>& aircraft,
                                          bool required = true);

/// The aircraft that flew (has a sortie), or the only one. Throws InputError if there are several, of logs that may be
/// `of_others` OtherAircraftError.
FlightSeries choose_aircraft(std::vector<FlightSeries> candidates, bool of_others = false);

FlightAssessment assess_flight(const SelectedTracks& tracks, const FlightPhases& phases,
                               const SegmentationOptions& options = {});

/// Why a flight of this aircraft is not used, as a simulator flew it; empty if it is used.
std::string simulation_reason(const std::string& aircraft_name, const LoadOptions& options);

/// Why the power of an assessment is not used; empty if it is.
std::string exclusion_reason(const FlightAssessment& assessment);

/// Segments and checks a series. Throws InputError without measured power (if required, or without altitude too), for a
/// missing sortie, and, if a flight is required, without altitude or flight.
LoadedFlight segment_and_check(FlightSeries series, const LoadOptions& options);

/// Reads, segments and checks a log (compressed or not) or series CSV.
LoadedFlight load_flight(const FlightFile& file, const LoadOptions& options);
LoadedFlight load_flight(const std::filesystem::path& path, const LoadOptions& options = {});

/// Only the series. Throws InputError without measured power.
FlightSeries read_flight(const std::filesystem::path& path,
                         const std::optional<std::string>& aircraft = std::nullopt);

}  // namespace flightwatt::flight
