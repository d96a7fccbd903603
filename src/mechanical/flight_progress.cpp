#include "mechanical/flight_progress.h"

#include "base/error.h"
#include "flight/phase_statistics.h"
#include "flight/select.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr double max_log_gap_s = 60.0;

/// The sortie in the log so far; std::nullopt before its lift-off.
std::optional<flight::Sortie> sortie_of(const flight::FlightData& known, std::size_t index,
                                        const flight::SegmentationOptions& options) {
    if (known.power_w.time_s.size() < 2 || known.altitude_m.empty()) return std::nullopt;
    auto phases = segment(known, options);
    if (index >= phases.sorties.size()) return std::nullopt;
    return std::move(phases.sorties[index]);
}

/// Of any power sample of any source.
double first_sample_s(const flight::FlightSeries& series) {
    double first_s = std::numeric_limits<double>::infinity();
    for (const auto& track : series.tracks) {
        if (track.name == "power_w" && !track.empty()) first_s = std::min(first_s, track.time_s.front());
    }
    return first_s;
}

}  // namespace

double log_time_after_lift_off(const flight::FlightSeries& series, double since_s, std::size_t sortie,
                               const flight::SegmentationOptions& options) {
    constexpr double retry_s = 5.0;
    constexpr double same_s = 1e-3;
    double time_s = first_sample_s(series) + since_s;
    const double last_s = last_time_s(series) + max_log_gap_s;
    while (time_s <= last_s) {
        const auto cut = truncate_series(series, time_s);
        const auto found = sortie_of(select_tracks(cut), sortie, options);
        const double due_s =
            found && !found->phases.empty() ? found->phases.front().start.time_s + since_s : time_s + retry_s;
        if (due_s <= time_s + same_s) return time_s;
        time_s = due_s;
    }
    throw NoResultError(fmt::format("{}: the log ends at {:.0f} s, before {:.0f} s after a lift-off", series.flight,
                                    last_time_s(series), since_s));
}

FlightProgress progress_of(const flight::FlightData& known, const flight::Sortie* sortie, double until_s,
                           const flight::SegmentationOptions& options) {
    if (std::isfinite(known.last_s) && until_s > known.last_s + max_log_gap_s) {
        throw NoResultError(
            fmt::format("{}: the log ends at {:.1f} s, before {:.1f} s", known.flight, known.last_s, until_s));
    }
    const auto refuse = [&](std::string_view reason) {
        throw NoResultError(fmt::format("{}: at {:.1f} s of the log the aircraft {}", known.flight, until_s, reason));
    };
    if (sortie == nullptr || sortie->phases.empty()) refuse("has not taken off");
    const auto& first = sortie->phases.front();
    if (first.phase != flight::Phase::takeoff || !first.complete) {
        refuse("is in the air, but its take-off is not in the log");
    }
    const auto& last = sortie->phases.back();
    if (last.phase == flight::Phase::landing && last.complete) refuse("has landed");
    const double cruise_start_s = first.end.time_s;
    const bool is_climbing = last.phase == flight::Phase::takeoff;
    constexpr double least_hold_s = 10.0;
    const double climbed_s = cruise_start_s - first.start.time_s;
    const double hold_s = std::min(options.hold_s, std::max(least_hold_s, climbed_s));
    if (is_climbing || until_s - cruise_start_s < hold_s) {
        auto flown = measured_progress(known, {{flight::Phase::takeoff, first.start.time_s, until_s}}, until_s);
        if (!is_climbing)
            flown.phases[flight::Phase::takeoff] = {
                climbed_s, integrated_energy_wh(known.power_w, first.start.time_s, cruise_start_s)};
        return flown;
    }
    return measured_progress(known,
                             {{flight::Phase::takeoff, first.start.time_s, cruise_start_s},
                              {flight::Phase::cruise, cruise_start_s, until_s}},
                             until_s);
}

FlightProgress measured_progress(const flight::FlightData& known, const std::vector<flight::PhaseSegment>& spans,
                                 double until_s) {
    FlightProgress flown;
    flown.until_s = until_s;
    flown.lift_off_s = spans.front().start_s;
    flown.cruise_start_s = until_s;
    for (const auto& span : spans) {
        const double energy_wh = integrated_energy_wh(known.power_w, span.start_s, span.end_s);
        flown.phases[span.phase] = {span.duration_s(), energy_wh};
        flown.energy_wh += energy_wh;
        if (span.phase != flight::Phase::cruise) continue;
        flown.cruise_start_s = span.start_s;
        flown.cruise_energy_wh = energy_wh;
    }
    flown.motion = bin_flight(known, spans);
    return flown;
}

FlightProgress progress_after_lift_off(const flight::FlightSeries& series, const flight::Sortie& sortie,
                                       double since_s) {
    const auto& first = sortie.phases.front();
    const double until_s = first.start.time_s + since_s;
    const auto refuse = [&](std::string_view reason) {
        throw NoResultError(fmt::format("{:.0f} s after lift-off {}", since_s, reason));
    };
    if (first.phase != flight::Phase::takeoff || !first.complete) refuse("is unknown: its take-off is not in the log");
    if (until_s >= sortie.end_s()) refuse("the aircraft has landed, or its log has ended");
    std::vector<flight::PhaseSegment> spans;
    for (const auto& span : phase_spans(sortie))
        if (span.start_s < until_s) spans.push_back({span.phase, span.start_s, std::min(span.end_s, until_s)});
    return measured_progress(select_tracks(truncate_series(series, until_s)), spans, until_s);
}

}  // namespace flightwatt::mechanical
