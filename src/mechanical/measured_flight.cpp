#include "mechanical/measured_flight.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "flight/flight_data.h"
#include "flight/vtol_flight.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr double max_edge_gap = 0.25;  // of the phase
constexpr double short_bin_s = 10.0;   // of wings that do not fly for min_bins of default_bin_s

/// Reason to exclude a phase, whatever its samples; empty without one.
std::string exclusion_reason(const flight::PhaseSpan& span) {
    if (!span.complete) return "the log begins or ends within it";
    const double gap_s = std::max(span.start.gap_s, span.end.gap_s);
    if (gap_s <= max_edge_gap * span.duration_s()) return "";
    return fmt::format("its {} is in a gap of {:.1f} s", span.start.gap_s == gap_s ? "start" : "end", gap_s);
}

/// Height above the ground that the cruise held after a take-off, or before a landing: the wings' phases end and begin
/// at a fraction of it.
std::optional<double> held_height_m(const flight::PhaseSpan& span, const flight::Sortie& sortie) {
    constexpr double min_height_m = 3.0;  // below, the altitude is unknown
    const double change_m = span.end.altitude_m - span.start.altitude_m;
    const double flown_m = span.phase == flight::Phase::landing ? -change_m : change_m;
    if (span.phase == flight::Phase::cruise || !(flown_m >= min_height_m)) return std::nullopt;
    return std::clamp(sortie.height_m, flown_m, flown_m / flight::SegmentationOptions{}.cruise_fraction);
}

PhaseSamples samples_of(const flight::Track& power, const flight::PhaseSpan& span, const std::string& flight) {
    PhaseSamples samples{flight, span.duration_s(), {}, {}, span.start.time_s};
    const auto first = flight::first_at_or_after(power.time_s, span.start.time_s);
    const auto last = flight::first_after(power.time_s, span.end.time_s);
    const auto edges = span.complete ? count_neighbour_samples(power, span) : EdgeSamples{};
    samples.edge_samples = edges.at_start + edges.at_end;
    for (auto i = first + edges.at_start; i + edges.at_end < last; ++i) {
        const double time_s = power.time_s[i];
        // The duration is rounded to the millisecond: a sample at the very end may be 1 + 2e-16 of it.
        samples.tau.push_back(std::min(1.0, (time_s - span.start.time_s) / samples.duration_s));
        samples.power_w.push_back(power.value[i]);
    }
    return samples;
}

std::string reason_of_too_few(const PhaseSamples& samples, flight::Phase phase) {
    constexpr std::size_t min_of_cruise = 3;
    const auto count = samples.tau.size();
    if (count == 0) return "it has no sample of the power";
    if (phase != flight::Phase::cruise || count >= min_of_cruise) return "";
    return fmt::format("it lasts {:.1f} s, with {} sample{} of the power", samples.duration_s, count,
                       count == 1 ? "" : "s");
}

PhasePower power_over(const flight::Track& power, const flight::PhaseSpan& span, flight::PhaseStatistics statistics) {
    PhasePower measured;
    measured.statistics = statistics;
    const double start_s = span.start.time_s;
    const auto add = [&](double time_s, double power_w) {
        measured.time_s.push_back(time_s);
        measured.power_w.push_back(power_w);
    };
    add(0.0, interpolate_clamped(power.time_s, power.value, start_s));
    for (auto i = flight::first_after(power.time_s, start_s);
         i < power.time_s.size() && power.time_s[i] < span.end.time_s; ++i)
        add(power.time_s[i] - start_s, power.value[i]);
    add(span.duration_s(), interpolate_clamped(power.time_s, power.value, span.end.time_s));
    return measured;
}

bool has_any_phase(const MeasuredFlight& flight) {
    return std::ranges::any_of(flight.samples.phases.values, [](const auto& samples) { return samples.has_value(); });
}

}  // namespace

std::string to_string(const Exclusion& exclusion) {
    const auto what = exclusion.phase ? phase_word(*exclusion.phase) : "it";
    return fmt::format("{}: {} is not used in the fit: {}", exclusion.flight, what, exclusion.reason);
}

std::string sortie_name(const std::string& flight, std::size_t sortie) {
    return sortie == 1 ? flight : fmt::format("{}#{}", flight, sortie);
}

bool is_sortie_of(const std::string& sortie, const std::string& flight) {
    return sortie == flight || sortie.starts_with(flight + "#");
}

std::optional<double> pack_voltage_v(const flight::FlightData& data) {
    constexpr double exceeded_by = 0.01;
    if (data.voltage_v.value.empty()) return std::nullopt;
    return quantile_of(data.voltage_v.value, 1.0 - exceeded_by);
}

MeasuredFlights extract_flights(const flight::FlightData& data, const flight::FlightPhases& phases) {
    MeasuredFlights measured;
    const auto voltage_v = pack_voltage_v(data);
    const flight::PowerStatistics statistics_of_power(data);
    for (const auto& sortie : phases.sorties) {
        MeasuredFlight flight;
        flight.samples.flight = sortie_name(data.flight, sortie.number);
        flight.samples.pack_voltage_v = voltage_v;
        for (const auto& span : sortie.phases) {
            const double start_s = span.start.time_s;
            auto samples = samples_of(data.power_w, span, flight.samples.flight);
            samples.height_m = held_height_m(span, sortie);
            auto reason = exclusion_reason(span);
            const auto statistics = statistics_of_power.between(start_s, span.end.time_s);
            if (reason.empty()) flight.power[span.phase] = power_over(data.power_w, span, statistics);
            if (reason.empty()) reason = reason_of_too_few(samples, span.phase);
            if (!reason.empty()) {
                measured.exclusions.push_back({flight.samples.flight, span.phase, std::move(reason)});
                continue;
            }
            flight.energy_wh[span.phase] = statistics.energy_wh;
            flight.counter_energy_wh[span.phase] = statistics.counter_energy_wh;
            flight.samples.phases[span.phase] = std::move(samples);
        }
        if (!has_any_phase(flight)) continue;
        flight.only_hovers = only_hovers(data, sortie);
        flight.motion = bin_flight(data, phase_spans(sortie));
        if (!flight.motion.is_rotorcraft && flight.motion.bins.size() < min_bins)
            flight.motion = bin_flight(data, phase_spans(sortie), short_bin_s);
        flight.motion.flight = flight.samples.flight;
        measured.flights.push_back(std::move(flight));
        measured.sorties.push_back(sortie.number - 1);
    }
    return measured;
}

MeasuredFlights extract_flights(const flight::LoadedFlight& loaded) {
    if (!loaded.exclusion.empty()) return {{}, {{loaded.data.flight, std::nullopt, loaded.exclusion}}, {}};
    return extract_flights(loaded.data, loaded.phases);
}

std::string hover_reason() { return "it only hovers, and other flights of this aircraft are on the wing"; }

std::vector<Exclusion> exclude_hover(std::vector<MeasuredFlight>& flights, const std::set<std::string>& keep) {
    std::vector<Exclusion> excluded;
    if (std::ranges::all_of(flights, &MeasuredFlight::only_hovers)) return excluded;
    std::erase_if(flights, [&](const auto& flight) {
        const auto& name = flight.samples.flight;
        const auto is_of = [&](const std::string& log) { return is_sortie_of(name, log); };
        if (!flight.only_hovers || std::ranges::any_of(keep, is_of)) return false;
        excluded.push_back({name, std::nullopt, hover_reason()});
        return true;
    });
    return excluded;
}

}  // namespace flightwatt::mechanical
