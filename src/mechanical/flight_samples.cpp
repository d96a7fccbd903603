#include "mechanical/flight_samples.h"

#include "flight/chosen_track.h"
#include "flight/phase_statistics.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr double longest_edge_gap = 0.25;  // of the phase

/// Why a phase cannot be fitted, before its samples are counted; empty if it can.
std::string why_excluded(const flight::PhaseSpan& span) {
    if (!span.complete) return "the log begins or ends inside of it";
    const double gap_s = std::max(span.start.gap_s, span.end.gap_s);
    if (gap_s > longest_edge_gap * span.duration_s()) {
        return fmt::format("its {} lies in a gap of {:.1f} s", span.start.gap_s == gap_s ? "start" : "end",
                           gap_s);
    }
    return "";
}

PhaseSamples samples_of(const flight::Track& power, const flight::Track& airspeed,
                        const flight::PhaseSpan& span, const std::string& flight) {
    PhaseSamples samples;
    samples.flight = flight;
    samples.duration_s = span.duration_s();
    samples.start_s = span.start.time_s;
    for (std::size_t i = 0; i < power.time_s.size(); ++i) {
        const double time_s = power.time_s[i];
        if (time_s < span.start.time_s || time_s > span.end.time_s) continue;
        samples.tau.push_back((time_s - span.start.time_s) / samples.duration_s);
        samples.power_w.push_back(power.value[i]);
    }
    samples.airspeed_cubed_m3_per_s3 =
        mean_cubed_airspeed_m3_per_s3(airspeed, span.start.time_s, span.end.time_s);
    return samples;
}

}  // namespace

std::string to_string(const Exclusion& exclusion) {
    const auto what =
        exclusion.phase ? fmt::format("{} is", to_string(*exclusion.phase)) : std::string("it is");
    return fmt::format("{}: {} excluded from the fit: {}", exclusion.flight, what, exclusion.reason);
}

std::string flight_name_of_sortie(const std::string& flight, std::size_t sortie) {
    return sortie == 1 ? flight : fmt::format("{}#{}", flight, sortie);
}

FlightSelection select_samples(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                               std::size_t needed_samples) {
    FlightSelection selection;
    const auto power = power_track(series);
    const auto airspeed = chosen_track(series, "airspeed_m_per_s");
    for (const auto& sortie : phases.sorties) {
        FlightSamples flight;
        flight.flight = flight_name_of_sortie(series.flight, sortie.number);
        bool any = false;
        for (const auto& span : sortie.phases) {
            if (auto why = why_excluded(span); !why.empty()) {
                selection.exclusions.push_back({flight.flight, span.phase, std::move(why)});
                continue;
            }
            auto samples = samples_of(power, airspeed, span, flight.flight);
            if (samples.tau.size() < needed_samples) {
                selection.exclusions.push_back(
                    {flight.flight, span.phase, too_few_samples(samples.tau.size(), needed_samples)});
                continue;
            }
            flight.phases[span.phase] = std::move(samples);
            any = true;
        }
        if (any) selection.flights.push_back(std::move(flight));
    }
    return selection;
}

std::string too_few_samples(std::size_t samples, std::size_t needed) {
    return fmt::format("{} samples, {} are needed", samples, needed);
}

}  // namespace flightwatt::mechanical
