#include "mechanical/prediction/flight_progress.h"

#include "base/error.h"
#include "flight/airspeed.h"
#include "flight/cut_series.h"
#include "flight/phase_statistics.h"
#include "flight/segmentation.h"
#include "mechanical/covariates.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr double longest_silence_s = 60.0;

/// The sortie as it looks at a time; std::nullopt before its lift-off.
std::optional<flight::Sortie> sortie_at(const flight::FlightSeries& series, double time_s,
                                        std::size_t index) {
    const auto known = cut_series(series, time_s);
    if (known.time_s.size() < 2) return std::nullopt;
    auto phases = segment(known);
    if (index >= phases.sorties.size()) return std::nullopt;
    return std::move(phases.sorties[index]);
}

double log_end_s(const flight::FlightSeries& series) {
    return std::max(series.time_s.back(),
                    series.altitude_track.empty() ? 0.0 : series.altitude_track.time_s.back());
}

/// The log's time so many seconds after a lift-off that is itself found in what lies before: waits, like a
/// ground station, until the lift-off that is seen is that long ago. Never looks beyond the answer.
double wait_since_lift_off(const flight::FlightSeries& series, double since_s, std::size_t index) {
    constexpr double look_again_s = 5.0;
    constexpr double same_s = 1e-3;
    double time_s = series.time_s.front() + since_s;
    const double last_s = log_end_s(series) + longest_silence_s;
    while (time_s <= last_s) {
        const auto sortie = sortie_at(series, time_s, index);
        const double due_s = sortie && !sortie->phases.empty() ? sortie->phases.front().start.time_s + since_s
                                                               : time_s + look_again_s;
        if (due_s <= time_s + same_s) return time_s;
        time_s = due_s;
    }
    throw NoAnswerError(fmt::format("{}: the log ends at {:.0f} s, before {:.0f} s after a lift-off",
                                    series.flight, log_end_s(series), since_s));
}

[[noreturn]] void refuse(const flight::FlightSeries& series, double until_s, std::string_view what) {
    throw NoAnswerError(
        fmt::format("{}: at {:.1f} s of the log the aircraft {}", series.flight, until_s, what));
}

}  // namespace

FlownSoFar flown_so_far(const flight::FlightSeries& series, const Moment& moment, std::size_t sortie_index) {
    FlownSoFar flown;
    flown.until_s = moment.since_lift_off_s
                        ? wait_since_lift_off(series, *moment.since_lift_off_s, sortie_index)
                        : moment.log_time_s;
    if (flown.until_s > log_end_s(series) + longest_silence_s) {
        throw NoAnswerError(fmt::format("{}: the log ends at {:.1f} s, before {:.1f} s", series.flight,
                                        log_end_s(series), flown.until_s));
    }
    const auto sortie = sortie_at(series, flown.until_s, sortie_index);
    if (!sortie || sortie->phases.empty()) refuse(series, flown.until_s, "has not taken off");
    const auto& first = sortie->phases.front();
    if (first.phase != flight::Phase::takeoff || !first.complete) {
        refuse(series, flown.until_s, "is in the air, but its take-off is not in the log");
    }
    const auto& last = sortie->phases.back();
    if (last.phase == flight::Phase::landing && last.complete) refuse(series, flown.until_s, "has landed");
    flown.lift_off_s = first.start.time_s;
    flown.cruise_start_s = first.end.time_s;
    // Whoever still climbs has just reached 90 % of the height so far: that is no cruise yet.
    const double hold_s = flight::SegmentationOptions{}.hold_s;
    if (last.phase == flight::Phase::takeoff || flown.cruise_s() < hold_s) {
        refuse(series, flown.until_s,
               fmt::format("has not held its height for {:.0f} s: expected a moment in cruise", hold_s));
    }
    const auto known = cut_series(series, flown.until_s);
    flown.cruise_energy_wh = integrated_energy_wh(known, flown.cruise_start_s, flown.until_s);
    flown.energy_wh =
        integrated_energy_wh(known, flown.lift_off_s, flown.cruise_start_s) + flown.cruise_energy_wh;
    flown.airspeed_cubed_m3_per_s3 =
        mean_cubed_airspeed_m3_per_s3(known.airspeed_track, flown.cruise_start_s, flown.until_s);
    flown.covariates = covariates_of(known, *sortie);
    return flown;
}

}  // namespace flightwatt::mechanical
