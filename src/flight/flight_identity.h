#pragma once

#include "flight/flight_series.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

/// Identification of flights and aircraft by content rather than by file name.
namespace flightwatt::flight {

/// Start of a log by the ground station's clock, from its name: "20_07_05__10_26_44" anywhere in it. std::nullopt
/// without a valid time.
std::optional<std::chrono::sys_seconds> start_in_name(const std::string& name);

/// Summary of a flight's samples.
struct FlightContent {
    std::uint64_t fingerprint = 0;  ///< of all values of altitude, voltage, current and power; 0: all are constant
    bool has_definitions = true;    ///< there is a .log

    bool operator==(const FlightContent&) const = default;
};

/// Files with the same samples have equal fingerprints: under any name, compressed, as text or binary, as a log or a
/// series CSV. Times do not count.
FlightContent content_of(const FlightSeries& series);

/// Name of a synthetic aircraft without a .log.
inline constexpr auto unnamed_synthetic = "synthetic";

/// Whether `flightwatt synthesize` wrote the log: its aircraft have such names.
bool is_synthetic(const std::string& aircraft_name);

/// Whether a simulator of an autopilot recorded the log: its aircraft's name has SITL or HITL, or ends in the word NPS.
bool is_simulated(const std::string& aircraft_name);

/// "20 Twinstar", "7 Opterra_synthetic (SYNTHETIC)", "PX4 SITL (SIMULATED)", "unknown".
std::string describe_aircraft(const std::string& id, const std::string& name);

}  // namespace flightwatt::flight
