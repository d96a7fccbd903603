#pragma once

#include "base/diagnostic.h"
#include "flight/flight_data.h"
#include "flight/flight_file.h"
#include "flight/flight_series.h"
#include "flight/power_report.h"
#include "flight/segment.h"
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
    /// The aircraft, if the log has several: by its id, the beginning of its id, or its name.
    std::optional<std::string> aircraft = {};
    std::optional<std::size_t> sortie = {};  ///< counted from 1; the other sorties are ignored
    SegmentationOptions segmentation = {};
    bool correct_idle_offset = false;     ///< see correct_idle_offset()
    bool bridges_link_gaps = false;       ///< see bridge_link_gaps()
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
    std::optional<std::size_t> recording = {};                     ///< counted from 1; the others of a file are ignored
};

/// The quality of a segmented flight.
struct FlightAssessment {
    PowerReport power;             ///< as measured, before any correction
    std::string lacks_power = {};  ///< reason why there is no measured power; empty if there is
    Diagnostics diagnostics = {};  ///< of the series, the segmentation and the power
};

/// A flight that was read, segmented and checked.
struct LoadedFlight : FlightAssessment {
    FlightSeries series;  ///< with the idle offset corrected, if requested
    FlightData data;      ///< the tracks selected from the series
    FlightPhases phases;
    std::string exclusion = {};  ///< reason why the flight is excluded; empty if it is used
    std::size_t recording = 1;   ///< its number in the file
};

/// The flights of a file, one for each recording that has one.
struct LoadedFile {
    std::vector<LoadedFlight> flights = {};
    std::size_t recordings = 1;                      ///< number of recordings in the file
    std::map<std::size_t, std::string> unused = {};  ///< reason why a recording has no flight, by its number
};

/// Returns the number, from 1, of the requested recording, else of the first in which an aircraft flew, else of the
/// first with an aircraft. Throws InputError for a recording that is missing, OtherAircraftError for one without the
/// aircraft.
std::size_t choose_recording(const std::vector<Candidates>& recordings, const FlightFile& file,
                             const std::optional<std::size_t>& requested);

/// Reads the candidates of the first recording in which an aircraft flew, else of the first with an aircraft.
Candidates read_candidates(const FlightFile& file, const std::optional<std::string>& aircraft, bool required = true);

/// Returns the series of the only aircraft that flew (has a sortie), or of the only one. Throws InputError if none or
/// several flew; if the log may be `of_others`, OtherAircraftError for several.
FlightSeries choose_aircraft(Candidates candidates, bool of_others = false);

/// Checks the power record of a flight, and collects the findings about its selection and segmentation.
FlightAssessment assess_flight(const FlightData& data, const FlightPhases& phases,
                               const SegmentationOptions& options = {});

/// Returns the reason why a flight of this aircraft is not used, as a simulator flew it; empty if it is used.
std::string simulation_reason(const std::string& aircraft_name, const LoadOptions& options);

/// Returns the reason why the power of an assessed flight is not used; empty if it is.
std::string exclusion_reason(const FlightAssessment& assessment);

/// Segments and checks a series. Throws InputError without measured power (if required, or without altitude too), for a
/// missing sortie, and, if a flight is required, without altitude or flight.
LoadedFlight segment_and_check(FlightSeries series, const LoadOptions& options);

/// Reads, segments and checks the flights of a log (compressed or not) or CSV. Throws InputError if no recording has a
/// flight (without flight_required: if none can be read).
LoadedFile load_flights(const FlightFile& file, const LoadOptions& options);
/// Reads the file and loads its flights as above.
LoadedFile load_flights(const std::filesystem::path& path, const LoadOptions& options = {});

/// Returns the first flight with a sortie, else the first.
LoadedFlight first_flight(LoadedFile file);

/// Loads a file and returns first_flight().
LoadedFlight load_flight(const std::filesystem::path& path, const LoadOptions& options = {});

/// Reads a file and returns the series of its flight alone. Throws InputError without measured power.
FlightSeries read_flight(const std::filesystem::path& path, const std::optional<std::string>& aircraft = std::nullopt);

}  // namespace flightwatt::flight
