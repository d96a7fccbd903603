#pragma once

#include "flight/flight_series.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

/// Which flight of which aircraft a series is of, by what it holds rather than by its name.
namespace flightwatt::flight {

/// What its samples are, in short: a sketch of the stretches of values in its altitude, voltage, current and power. Times
/// are no part of it, as a replayed or resumed recording has others.
struct FlightContent {
    std::size_t stretches = 0;          ///< that differ
    std::vector<std::uint64_t> sketch;  ///< the least of their fingerprints, rising

    bool operator==(const FlightContent&) const = default;
};

FlightContent content_of(const FlightSeries& series);

/// Whether two are recordings of one flight: at least half of what the shorter one holds is in the other too. True for
/// copies, for logs that begin or end elsewhere, and for several flights in one log. Two of which nothing varies are not.
bool is_same_flight(const FlightContent& one, const FlightContent& other);

/// Flights, to be asked for the one that another is the same as, without comparing it with all.
class KnownFlights {
  public:
    /// The number of the first that is the same, in the order in which they were added.
    std::optional<std::size_t> find(const FlightContent& content) const;
    void add(FlightContent content);

  private:
    std::vector<FlightContent> contents_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> with_stretch_;
};

/// A flight and the aircraft that flew it, as far as its file tells.
struct FlownBy {
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
std::string describe_mix(std::span<const FlownBy> flights);

}  // namespace flightwatt::flight
