#include "mechanical/flight_samples.h"

#include "flight/airspeed.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr double longest_edge_gap = 0.25;  // of the phase

/// Why a phase cannot be fitted, before its samples are counted; empty if it can.
std::string why_left_out(const flight::PhaseSpan& span) {
    if (!span.complete) return "the log begins or ends inside of it";
    const double gap_s = std::max(span.start.gap_s, span.end.gap_s);
    if (gap_s > longest_edge_gap * span.duration_s()) {
        return fmt::format("its {} lies in a gap of {:.1f} s", span.start.gap_s == gap_s ? "start" : "end",
                           gap_s);
    }
    return "";
}

PhaseSamples samples_of(const flight::FlightSeries& series, const flight::PhaseSpan& span,
                        const std::string& flight) {
    PhaseSamples samples;
    samples.flight = flight;
    samples.duration_s = span.duration_s();
    samples.start_s = span.start.time_s;
    for (std::size_t i = 0; i < series.time_s.size(); ++i) {
        const double time_s = series.time_s[i];
        if (time_s < span.start.time_s || time_s > span.end.time_s) continue;
        samples.tau.push_back((time_s - span.start.time_s) / samples.duration_s);
        samples.power_w.push_back(series.power_w[i]);
    }
    samples.airspeed_cubed_m3_per_s3 =
        mean_cubed_airspeed_m3_per_s3(series.airspeed_track, span.start.time_s, span.end.time_s);
    return samples;
}

}  // namespace

std::string to_string(const LeftOut& left_out) {
    const auto what =
        left_out.phase ? fmt::format("{} is", to_string(*left_out.phase)) : std::string("it is");
    return fmt::format("{}: {} left out of the fit: {}", left_out.flight, what, left_out.reason);
}

std::string flight_name_of_sortie(const std::string& flight, std::size_t sortie) {
    return sortie == 1 ? flight : fmt::format("{}#{}", flight, sortie);
}

FlightSelection select_samples(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                               std::size_t needed_samples) {
    FlightSelection selection;
    for (std::size_t s = 0; s < phases.sorties.size(); ++s) {
        FlightSamples flight;
        flight.flight = flight_name_of_sortie(series.flight, s + 1);
        bool any = false;
        for (const auto& span : phases.sorties[s].phases) {
            if (auto why = why_left_out(span); !why.empty()) {
                selection.left_out.push_back({flight.flight, span.phase, std::move(why)});
                continue;
            }
            auto samples = samples_of(series, span, flight.flight);
            if (samples.tau.size() < needed_samples) {
                selection.left_out.push_back(
                    {flight.flight, span.phase,
                     fmt::format("{} samples, {} are needed", samples.tau.size(), needed_samples)});
                continue;
            }
            flight.phases[span.phase] = std::move(samples);
            any = true;
        }
        if (any) selection.flights.push_back(std::move(flight));
    }
    return selection;
}

void leave_out_all(FlightSelection& selection, const std::string& flight, const std::string& reason) {
    selection.flights.clear();
    selection.left_out.push_back({flight, std::nullopt, reason});
}

}  // namespace flightwatt::mechanical
