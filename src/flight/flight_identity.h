#pragma once

#include "flight/flight_series.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

/// Identification of flights and aircraft by content rather than by file name.
namespace flightwatt::flight {

/// Returns the start of a log by the ground station's clock, from its name: "20_07_05__10_26_44" anywhere in it.
/// std::nullopt without a valid time.
std::optional<std::chrono::sys_seconds> start_in_name(const std::string& name);

/// Returns when a log starts, in seconds since 1970: by its own clock (FlightData), or by its name. std::nullopt if
/// neither states it.
std::optional<double> start_clock_s(const std::optional<double>& logged_s, const std::string& name);

/// Summary of a flight's samples, which identifies it.
struct FlightContent {
    std::uint64_t fingerprint = 0;  ///< of altitude, voltage, current and power; 0: all are constant
    bool has_definitions = true;    ///< the log has a .log

    bool operator==(const FlightContent&) const = default;
};

/// Summarizes a series. Files with the same samples have equal fingerprints, but for rare exceptions also where they were
/// rounded: under any name, compressed, as text or binary, as a log or a series CSV. Times are not included.
FlightContent content_of(const FlightSeries& series);

/// The name of a synthetic aircraft without a .log.
inline constexpr auto unnamed_synthetic = "synthetic";

/// Returns whether `flightwatt synthesize` wrote the log, by the aircraft's name.
bool is_synthetic(const std::string& aircraft_name);

/// Returns whether a simulator of an autopilot recorded the log: the aircraft's name has SITL or HITL, or ends in the
/// word NPS.
bool is_simulated(const std::string& aircraft_name);

/// Returns a text for an aircraft: "20 Twinstar", "7 Opterra_synthetic (SYNTHETIC)", "PX4 SITL (SIMULATED)", "unknown".
std::string describe_aircraft(const std::string& id, const std::string& name);

}  // namespace flightwatt::flight
