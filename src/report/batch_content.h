#pragma once

#include "batch/batch_fit.h"
#include "batch/flight_record.h"
#include "mechanical/measured_flight.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::report {

/// Date, times, distances and energy of a flight.
struct FlightSummary {
    std::optional<double> start_clock_s;   ///< Unix time: UTC of the .log, or the time in its name
    std::string date;                      ///< the same as "2020-07-03 12:17"; empty if unknown
    double in_air_s = 0.0;                 ///< time in the air
    std::optional<double> distance_m;      ///< distance over ground, while in the air
    std::optional<double> air_distance_m;  ///< distance through the air, if airspeed was logged
    std::optional<double> height_m;        ///< maximum above the ground at lift-off
    std::optional<double> energy_wh;       ///< while in the air
    std::optional<double> counter_wh;      ///< the same by the autopilot's counter
    flight::PerPhase<double> duration_s;
    flight::PerPhase<std::optional<double>> mean_power_w;
    std::optional<double> cruise_airspeed_m_per_s;  ///< mean
};

/// One log of a batch with its results.
struct ReportFlight {
    std::string name;
    std::string log;                           ///< path of the log
    std::string rejected;                      ///< reason why the log was rejected; empty if accepted
    flight::FlightData data = {};              ///< tracks of an accepted log
    flight::FlightPhases phases = {};          ///< phases with their edges
    std::vector<std::string> warnings = {};    ///< warnings and errors
    std::vector<std::string> notes = {};       ///< harmless diagnostics
    std::vector<std::string> exclusions = {};  ///< parts that the fit does not use, with reasons
    std::string unusable_power = {};           ///< reason why its power record is not used; empty if it is
    bool is_fitted = true;                     ///< false: the fit leaves it out for another reason
    batch::FlightAircraft aircraft = {};       ///< aircraft of an accepted flight
    FlightSummary facts = {};                  ///< of an accepted flight in a batch's folder
};

/// Returns the use of a flight in the fit: "all", "in part" or "no".
std::string_view fitted_part(const ReportFlight& flight);

/// The flights and the model in the folder of a batch.
struct BatchContent {
    std::vector<ReportFlight> flights;
    std::vector<mechanical::MeasuredFlight> measured;  ///< the input of the fit
    std::optional<batch::BatchFit> fit;                ///< absent if the batch could not fit a model
    std::vector<std::string> damaged;                  ///< flights whose files were changed or damaged, with reasons
};

/// Reads the flights of a batch's folder, those with a usable power record first, without those of other aircraft than
/// its model's. Throws InputError as read_stored_flights and read_batch_fit.
BatchContent read_batch_content(const std::filesystem::path& out);

/// Returns a text about the flights of each aircraft, if there are several and the batch was not run with
/// --mix-aircraft; else empty.
std::string aircraft_mix(const BatchContent& content);

/// Returns the content's `measured` with the power of the flights' series, for a replay.
std::vector<mechanical::MeasuredFlight> flights_with_power(const BatchContent& content);

/// Summarizes an accepted flight, or one of its sorties, counted from 0.
FlightSummary summarize_flight(const ReportFlight& flight, std::optional<std::size_t> sortie = std::nullopt);

}  // namespace flightwatt::report
