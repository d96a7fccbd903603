#pragma once

#include "flight/flight_series.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

/// Which flight of which aircraft a series is of, by what it holds rather than by its name.
namespace flightwatt::flight {

/// When a log was begun, by the clock of the ground station that named it so: "20_07_05__10_26_44", wherever in the
/// name that stands. None where it does not, or is no time.
std::optional<std::chrono::sys_seconds> start_in_name(const std::string& name);

/// Two values of one field, some samples apart, and when: one of many by which a flight is known again.
struct SketchHash {
    std::uint64_t fingerprint = 0;  ///< of the two values and the time between them; odd: of an altitude
    double time_s = 0.0;            ///< the log's own seconds
    bool operator==(const SketchHash&) const = default;
};

/// What its samples are, in short: marks of its altitude, voltage, current and power.
struct FlightSketch {
    std::vector<SketchHash> hashes = {};  ///< those with the least fingerprints, rising
    bool has_definitions = true;          ///< its .log is beside it
    std::size_t samples = 0;              ///< of power, or else of altitude

    bool operator==(const FlightSketch&) const = default;
};

FlightSketch make_sketch(const FlightSeries& series);

/// What two recordings have in common.
struct SketchMatch {
    bool is_same = false;   ///< at least half of the time that the shorter one tells of is in the other too
    double shared_s = 0.0;  ///< how long, about; 0 if they have nothing in common
};

/// Whether two are recordings of one flight: marks of both at one offset of their clocks (docs/guide.md). So are copies
/// that lost other lines, have another clock, begin or end elsewhere, or hold several flights. Two of which nothing
/// varies are not, nor two whose values were rounded differently or that sampled the flight at other moments.
SketchMatch compare_sketches(const FlightSketch& one, const FlightSketch& other);

/// Which of two recordings of one flight is used: one with definitions, then one with more samples.
bool is_preferred_duplicate(const FlightSketch& one, const FlightSketch& other);

/// A warning that two flights, which both are used, share a part.
std::string describe_overlap(const std::string& one, const std::string& other, const SketchMatch& likeness);

/// Flights, to be asked for those that another is like, without comparing it with all.
class SketchIndex {
  public:
    struct Hit {
        std::size_t number = 0;  ///< in the order in which they were added
        SketchMatch likeness = {};
    };

    std::vector<Hit> find(const FlightSketch& content) const;
    void add(FlightSketch content);
    const FlightSketch& operator[](std::size_t number) const { return contents_[number]; }

  private:
    std::vector<FlightSketch> contents_;
    std::unordered_multimap<std::uint64_t, std::size_t> with_mark_;
};

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
