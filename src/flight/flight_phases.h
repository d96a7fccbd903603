#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// The phases of a sortie.
enum class Phase { takeoff, cruise, landing };

/// All phases, in their order.
inline constexpr std::array all_phases{Phase::takeoff, Phase::cruise, Phase::landing};

/// Returns the name of a phase in files.
constexpr std::string_view to_string(Phase phase) {
    constexpr std::array<std::string_view, 3> names{"takeoff", "cruise", "landing"};
    return names[static_cast<std::size_t>(phase)];
}

/// Returns the name of a phase for readers: "take-off", "cruise", "landing".
constexpr std::string_view phase_word(Phase phase) {
    return phase == Phase::takeoff ? std::string_view("take-off") : to_string(phase);
}

/// Returns the phase of a name; std::nullopt for any other text.
constexpr std::optional<Phase> phase_from(std::string_view name) {
    for (const auto phase : all_phases)
        if (to_string(phase) == name) return phase;
    return std::nullopt;
}

/// An interval between two times.
struct TimeInterval {
    double start_s = 0.0;
    double end_s = 0.0;
    double duration_s() const { return end_s - start_s; }
};

/// An interval within one phase: in the log's own seconds; in missions in seconds from the start of the phase.
struct PhaseSegment {
    Phase phase = Phase::takeoff;
    double start_s = 0.0;
    double end_s = 0.0;
    bool operator==(const PhaseSegment&) const = default;
    double duration_s() const { return end_s - start_s; }
};

/// One value for each phase, indexed by Phase.
template <typename T>
struct PerPhase {
    std::array<T, 3> values{};
    T& operator[](Phase phase) { return values[static_cast<std::size_t>(phase)]; }
    const T& operator[](Phase phase) const { return values[static_cast<std::size_t>(phase)]; }
};

/// Thresholds of the segmentation.
struct SegmentationOptions {
    double rest_s = 10.0;                   ///< an aircraft rests if, for this time, its motor idles,
    double rest_height_m = 3.0;             ///< its altitude stays within this range,
    double rest_speed_m_per_s = 4.0;        ///< and its speed, if known, is at most that of a carrying person
    double idle_throttle_percent = 5.0;     ///< maximum of idle (if speed is known, above the log's minimum)
    double flight_throttle_percent = 20.0;  ///< minimum of the maximum throttle of a flight
    double flight_height_m = 10.0;          ///< minimum height of a flight; below it is a run-up, a taxi or a hop
    double ground_fraction = 0.025;         ///< fraction of the flight's height below which it is on the ground
    double cruise_fraction = 0.90;          ///< fraction of the height held at which take-off ends and landing begins
    double hold_s = 30.0;                   ///< a height is held if in this time it grows by less than
    double hold_fraction = 0.10;            ///< this fraction of the flight's height
};

/// Time step of the segmentation [s], from the first sample of power (without power: of altitude).
inline constexpr double segmentation_step_s = 0.5;

/// Rounds a time to 1 ms, the resolution of times in logs.
inline double to_millisecond(double time_s) { return std::round(time_s * 1000.0) / 1000.0; }

/// The beginning or end of a phase, with the evidence there.
struct PhaseEdge {
    double time_s = 0.0;
    double altitude_m = 0.0;
    double gap_s = 0.0;  ///< between the altitude samples around the edge: its uncertainty
    std::optional<double> throttle_percent;
    std::optional<int> mode;                ///< PPRZ_MODE.ap_mode
    std::optional<int> block;               ///< NAVIGATION.cur_block
    std::optional<double> takeoff_after_s;  ///< the nearest TAKEOFF message, in seconds after this edge
};

/// One phase of a sortie, in the log's own seconds.
struct PhaseSpan {
    Phase phase = Phase::cruise;
    PhaseEdge start;
    PhaseEdge end;
    bool complete = true;  ///< false if the log begins or ends within
    double duration_s() const { return to_millisecond(end.time_s - start.time_s); }
};

/// A flight from lift-off to touchdown, with its phases.
struct Sortie {
    std::size_t number = 1;         ///< its number in the log, from 1
    std::vector<PhaseSpan> phases;  ///< in order; incomplete if the log begins or ends in the air
    double ground_altitude_m = 0.0;
    double height_m = 0.0;  ///< median of the upper half of the height above the ground

    double start_s() const { return phases.front().start.time_s; }
    double end_s() const { return phases.back().end.time_s; }
};

/// Motion or motor run on the ground without a flight.
struct GroundEvent : TimeInterval {
    std::string what;  ///< "run-up: throttle to 65 %, height 0.4 m"
};

/// The result of the segmentation of a log.
struct FlightPhases {
    std::vector<Sortie> sorties;
    std::vector<TimeInterval> rests;  ///< intervals on the ground, in order; ends excluded
    std::vector<GroundEvent> ground_events;
    std::string motor_source;  ///< evidence of the running motor: "ENERGY.throttle"
    std::vector<std::string> warnings;
    /// The part of the log between the sorties that were left out (--sortie): by default the whole log.
    TimeInterval part{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
};

}  // namespace flightwatt::flight
