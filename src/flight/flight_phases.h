#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// The phases of a sortie that are modelled; what lies between sorties is ground.
enum class Phase { takeoff, cruise, landing };

inline constexpr std::array all_phases{Phase::takeoff, Phase::cruise, Phase::landing};

constexpr std::string_view to_string(Phase phase) {
    constexpr std::array<std::string_view, 3> names{"takeoff", "cruise", "landing"};
    return names[static_cast<std::size_t>(phase)];
}

/// The phase of that name; std::nullopt if there is none.
constexpr std::optional<Phase> phase_from(std::string_view name) {
    for (const auto phase : all_phases)
        if (to_string(phase) == name) return phase;
    return std::nullopt;
}

/// From one time to another.
struct TimeInterval {
    double start_s = 0.0;
    double end_s = 0.0;
    double duration_s() const { return end_s - start_s; }
};

/// A time within one phase: in the log's own seconds, in missions in seconds since the phase began.
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

/// The few physical thresholds of the segmentation.
struct SegmentationOptions {
    double rest_s = 10.0;                   ///< an aircraft rests when, for this long, its motor idles and
    double rest_height_m = 3.0;             ///< its altitude stays within this range
    double rest_speed_m_per_s = 4.0;        ///< and (where known) it is no faster than someone who carries it
    double idle_throttle_percent = 5.0;     ///< idle is up to this (above the log's least, where speed is known)
    double flight_throttle_percent = 20.0;  ///< what rises without ever using as much is no flight
    double flight_height_m = 10.0;          ///< what stays below this is a run-up, a taxi or a hop
    double ground_fraction = 0.025;         ///< of the flight's height: below, it stands or rolls
    double cruise_fraction = 0.90;          ///< of the height held: there take-off ends and landing begins
    double hold_s = 30.0;                   ///< a height is held when it grows for this long by less than
    double hold_fraction = 0.10;            ///< this fraction of the flight's height
};

/// The segmentation looks at a flight so often [s], from its first sample of power on (without power: of altitude).
inline constexpr double segmentation_step_s = 0.5;

/// As the log writes its times.
inline double to_millisecond(double time_s) { return std::round(time_s * 1000.0) / 1000.0; }

/// Where a phase begins or ends, and what was seen there.
struct PhaseEdge {
    double time_s = 0.0;
    double altitude_m = 0.0;
    double gap_s = 0.0;  ///< between the altitude samples around it: the edge lies somewhere in there
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
    bool complete = true;  ///< false if the log begins or ends inside of it
    double duration_s() const { return to_millisecond(end.time_s - start.time_s); }
};

/// A height that was held, above the ground, after which the aircraft did not come back to a greater one.
struct HeldAltitude : TimeInterval {
    double height_m = 0.0;
    bool of_landing = false;  ///< held too shortly to be worked at: a step of the landing
};

/// From lift-off to touchdown.
struct Sortie {
    std::size_t number = 1;         ///< its place among those of the log
    std::vector<PhaseSpan> phases;  ///< in order; a log that begins or ends in the air lacks some
    double ground_altitude_m = 0.0;
    double height_m = 0.0;           ///< median height above the ground while in the upper half of it
    std::vector<HeldAltitude> held;  ///< in order; the landing begins where the last one that is not of it is left

    double start_s() const { return phases.front().start.time_s; }
    double end_s() const { return phases.back().end.time_s; }
};

/// Something that moved or ran on the ground and is no flight.
struct GroundEvent : TimeInterval {
    std::string what;  ///< "run-up: throttle to 65 %, height 0.4 m"
};

struct FlightPhases {
    std::vector<Sortie> sorties;
    std::vector<TimeInterval> rests;  ///< on the ground, in their order; without their ends
    std::vector<GroundEvent> ground_events;
    std::string motor_source;  ///< what told whether the motor runs: "ENERGY.throttle"
    std::vector<std::string> warnings;
};

}  // namespace flightwatt::flight
