#pragma once

#include "base/error.h"
#include "flight/flight_series.h"
#include "flight/power_check.h"
#include "flight/segmentation.h"
#include "flight/selected_track.h"
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

/// How a flight is read, segmented and judged: the same for every program.
struct LoadOptions {
    std::optional<std::string> aircraft_id;  ///< one of several in the log
    std::optional<std::size_t> sortie;       ///< from 1: the others are taken for ground
    SegmentationOptions segmentation;
    bool correct_idle_offset = false;     ///< see correct_idle_offset()
    std::set<std::string> excluded = {};  ///< flights that are not used
    std::set<std::string> keep = {};      ///< flights that are used in spite of power faults
    /// False: a log without altitude has no phases, and one in which nothing flew no sortie.
    bool flight_required = true;
    /// False: a log without measured power is segmented all the same, if it has an altitude.
    bool power_required = true;
    std::size_t max_log_bytes = telemetry::default_max_log_bytes;  ///< see read_data_file
    std::optional<std::filesystem::path> messages = {};            ///< see FlightFile
};

/// What a series that is segmented is worth: its power record, why none can be used, and what a user should know.
struct FlightAssessment {
    PowerReport power;                  ///< as measured, before any correction
    std::string lacks_power = {};       ///< why no power was measured; empty if it was
    std::vector<std::string> warnings;  ///< of the series, the segmentation and the power
};

struct LoadedFlight : FlightAssessment {
    FlightSeries series;  ///< its idle offset is corrected if that was asked for
    FlightPhases phases;
    std::string exclusion = {};                       ///< why the flight is not to be used; empty if it is
    std::map<std::string, std::string> sources = {};  ///< where each chosen track came from, by name
};

/// A text or binary log with its .log, or a series CSV, in memory. `messages` (a messages.xml or another .log) defines
/// the messages of a log whose .log is missing or damaged. Throws InputError for a file that cannot be read.
class FlightFile {
  public:
    explicit FlightFile(const std::filesystem::path& path, std::size_t max_bytes = telemetry::default_max_log_bytes,
                        const std::optional<std::filesystem::path>& messages = std::nullopt);
    FlightFile(const FlightFile&) = delete;
    FlightFile& operator=(const FlightFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    bool is_series() const { return is_series_; }
    std::string_view text() const { return text_; }
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
    std::string text_;
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

/// A log that is sound, of other aircraft than the one that is asked for.
class OtherAircraftError : public InputError {
    using InputError::InputError;
};

/// The series of each aircraft that may be meant: of the one that is named, else of all that sent telemetry.
/// Judges nothing yet. Throws InputError where the file holds no telemetry, OtherAircraftError where the
/// named one sent nothing.
std::vector<FlightSeries> read_candidates(const FlightFile& file, const std::optional<std::string>& aircraft_id);

/// The one that flew: the segmentation finds a sortie. Where none did, the only one. Throws InputError if that leaves
/// several (it says which, and where none flew what they did instead).
FlightSeries choose_aircraft(std::vector<FlightSeries> candidates);

FlightAssessment assess_flight(const SelectedTracks& tracks, const FlightPhases& phases,
                               const SegmentationOptions& options = {});

/// Why power of that judgement is not to be used; empty if it is.
std::string exclusion_reason(const FlightAssessment& judgement);

/// Segments and judges a series. Throws InputError where no power was measured (if it is required, or no altitude
/// either), for a sortie that the log has not, and, if a flight is required, where there is no altitude or nothing
/// flew.
LoadedFlight segment_and_check(FlightSeries series, const LoadOptions& options);

/// From file to judgement: Paparazzi .data or binary log (compressed or not, with its .log beside it) or series CSV.
LoadedFlight load_flight(const FlightFile& file, const LoadOptions& options);
LoadedFlight load_flight(const std::filesystem::path& path, const LoadOptions& options = {});

/// The series alone. Throws InputError where no power was measured.
FlightSeries read_flight(const std::filesystem::path& path,
                         const std::optional<std::string>& aircraft_id = std::nullopt);

}  // namespace flightwatt::flight
