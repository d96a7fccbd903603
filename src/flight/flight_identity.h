#pragma once

#include "flight/flight_series.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

/// Which flight of which aircraft a series is of, by what it holds rather than by its name.
namespace flightwatt::flight {

/// When a log was begun, by the clock of the ground station that named it so: "20_07_05__10_26_44", wherever in the
/// name that stands. None where it does not, or is no time.
std::optional<std::chrono::sys_seconds> start_in_name(const std::string& name);

/// What its samples are, in short.
struct FlightContent {
    std::uint64_t fingerprint = 0;  ///< of all values of altitude, voltage, current and power; 0: none varies
    bool has_definitions = true;    ///< its .log is beside it

    bool operator==(const FlightContent&) const = default;
};

/// Equal fingerprints: files with the same samples, under whatever name, compressed, as text or binary, as a log or as
/// the CSV of its series. Times play no part.
FlightContent content_of(const FlightSeries& series);

/// A flight and the aircraft that flew it, as far as its file tells.
struct FlightAircraft {
    std::string flight;
    std::string aircraft_id;    ///< empty: unknown, which goes with any
    std::string aircraft_name;  ///< may be empty
};

/// The name of a synthetic aircraft whose .log is not there.
inline constexpr auto unnamed_synthetic = "synthetic";

/// Whether no aircraft flew it: `flightwatt synthesize` names its aircraft so.
bool is_synthetic(const std::string& aircraft_name);

/// "20 Twinstar", "7 Opterra_synthetic (SYNTHETIC)", "unknown".
std::string describe_aircraft(const std::string& id, const std::string& name);

/// Why the flights are not of one aircraft, each with its own; empty if they may be. Synthetic ones and real ones never
/// are.
std::string describe_mixed_aircraft(std::span<const FlightAircraft> flights);

}  // namespace flightwatt::flight
