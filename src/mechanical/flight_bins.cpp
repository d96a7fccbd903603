#include "mechanical/flight_bins.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/phase_statistics.h"
#include "flight/vtol_flight.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr double reach_s = 5.0;        // of a sample
constexpr double edge_window_s = 2.5;  // to both sides of a bin's edge, for the airspeed there
constexpr double max_bank_deg = 60.0;

/// The track's values in [start_s, end_s].
std::span<const double> values_between(const flight::Track& track, double start_s, double end_s) {
    const auto first = flight::first_at_or_after(track.time_s, start_s);
    return std::span(track.value).subspan(first, flight::first_after(track.time_s, end_s) - first);
}

/// Whether half of the time or more has a sample near it, and there is one inside.
bool is_measured(const flight::Track& track, double start_s, double end_s) {
    double covered_s = 0.0;
    double covered_until_s = start_s;
    for (auto i = std::ranges::lower_bound(track.time_s, start_s); i != track.time_s.end() && *i <= end_s; ++i) {
        const double until_s = std::min(*i + reach_s, end_s);
        covered_s += until_s - std::max(covered_until_s, std::max(*i - reach_s, start_s));
        covered_until_s = until_s;
    }
    return covered_s >= 0.5 * (end_s - start_s) && !values_between(track, start_s, end_s).empty();
}

template <typename Function>
double mean_of(std::span<const double> values, const Function& function) {
    double sum = 0.0;
    for (const double value : values) sum += function(value);
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// The tracks of a sortie's bins.
struct MotionTracks {
    const flight::Track& power;
    const flight::Track& airspeed;
    const flight::Track& altitude;
    const flight::Track& roll;
    const BinnedFlight& flight;
    double min_m_per_s = 0.0;  ///< at which the wing carries; 0 of a rotorcraft
};

/// Altitude and kinetic energy, in metres of height.
double energy_height_m(const MotionTracks& data, double time_s) {
    const auto near = values_between(data.airspeed, time_s - edge_window_s, time_s + edge_window_s);
    const double airspeed = near.empty() ? value_at(data.airspeed, time_s) : mean(near);
    return value_at(data.altitude, time_s) + airspeed * airspeed / (2.0 * units::standard_gravity_m_per_s2);
}

FlightBin motion_bin(const MotionTracks& data, const flight::PhaseSegment& span) {
    FlightBin bin;
    bin.phase = span.phase;
    bin.start_s = span.start_s;
    bin.duration_s = span.end_s - span.start_s;
    const auto speeds = values_between(data.airspeed, span.start_s, span.end_s);
    const double min_m_per_s = data.min_m_per_s;
    bin.power_w = flight::integrated(data.power.time_s, data.power.value, span.start_s, span.end_s) / bin.duration_s;
    bin.samples = values_between(data.power, span.start_s, span.end_s).size();
    bin.airspeed_m_per_s = mean(speeds);
    bin.values[PowerTerm::drag] = mean_of(speeds, [](double v) { return v * v * v; });
    bin.values[PowerTerm::blade] = mean_of(speeds, [](double v) { return v * v; });
    bin.values[PowerTerm::payload] = data.flight.load.payload_kg;
    bin.values[PowerTerm::hover] = mean_of(speeds, [&](double v) { return induced_power_w(data.flight.load, v); });
    if (!data.flight.is_rotorcraft)
        bin.values[PowerTerm::induced] = mean_of(speeds, [&](double v) { return 1.0 / std::max(v, min_m_per_s); });
    const double tan_squared = mean_of(values_between(data.roll, span.start_s, span.end_s), [](double roll_deg) {
        const double bank_deg = std::min(std::abs(roll_deg), max_bank_deg);
        return std::pow(std::tan(bank_deg / units::degree_per_rad), 2);
    });
    bin.values[PowerTerm::turn] = tan_squared * bin.values[PowerTerm::induced];
    const double climb = (energy_height_m(data, span.end_s) - energy_height_m(data, span.start_s)) / bin.duration_s;
    bin.values[PowerTerm::climb] = climb;
    bin.values[PowerTerm::descent] = std::min(climb, 0.0);
    bin.values[PowerTerm::constant] = 1.0;
    return bin;
}

/// Most rotorcraft have no airspeed sensor.
const flight::Track& speed_of(const flight::FlightData& data) {
    const bool by_ground = data.is_rotorcraft() && data.airspeed_m_per_s.empty();
    return by_ground ? data.ground_speed_m_per_s : data.airspeed_m_per_s;
}

/// Reason why a flight has no bins; empty without one.
std::string no_bins_reason(const flight::FlightData& data) {
    const auto& firmware = data.firmware;
    if (firmware == "rover") return "a rover: this model describes aircraft";
    if (data.power_w.empty()) return "its power was not measured";
    if (data.altitude_m.empty()) return "its altitude was not measured";
    if (!speed_of(data).empty()) return "";
    if (firmware == "rotorcraft") return "neither airspeed nor ground speed was measured";
    const auto& unknown = data.airspeed_m_per_s.not_chosen;
    return fmt::format("its airspeed was not measured{}; ground speed cannot replace it, as wind changes its cube",
                       unknown.empty() ? "" : " and cannot be estimated (" + unknown.front() + ")");
}

}  // namespace

std::vector<flight::PhaseSegment> phase_spans(const flight::Sortie& sortie) {
    std::vector<flight::PhaseSegment> spans;
    spans.reserve(sortie.phases.size());
    for (const auto& phase : sortie.phases) spans.push_back({phase.phase, phase.start.time_s, phase.end.time_s});
    return spans;
}

BinnedFlight bin_flight(const flight::FlightData& data, const std::vector<flight::PhaseSegment>& spans, double bin_s) {
    BinnedFlight motion{data.flight, {}, false, no_bins_reason(data)};
    motion.is_rotorcraft = data.is_rotorcraft();
    if (!motion.no_bins_reason.empty()) return motion;
    const auto payload_kg = first_value(data.payload_kg);
    motion.payload_known = payload_kg.has_value();
    motion.load.payload_kg = payload_kg.value_or(0.0);
    const auto mass_kg = first_value(data.mass_kg);
    const auto area_m2 = first_value(data.rotor_area_m2);
    if (const auto& estimate = data.airspeed_estimate) {
        motion.airspeed_sd_m_per_s = estimate->sd_m_per_s;
        motion.mean_airspeed_sd_m_per_s = estimate->mean_sd_m_per_s;
    }
    if (motion.is_rotorcraft && mass_kg && area_m2) motion.load.rotors = {*mass_kg, *area_m2};
    MotionTracks of{data.power_w, speed_of(data), data.altitude_m, data.roll_deg, motion};
    std::vector<double> speeds;
    for (const auto& span : spans) {
        const auto values = values_between(of.airspeed, span.start_s, span.end_s);
        speeds.insert(speeds.end(), values.begin(), values.end());
    }
    if (!speeds.empty() && !motion.is_rotorcraft) of.min_m_per_s = 0.5 * median(speeds);
    motion.bank_measured = !of.roll.empty();
    for (const auto& span : spans) {
        const double duration_s = span.duration_s();
        const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(std::round(duration_s / bin_s)));
        const double width_s = duration_s / static_cast<double>(count);
        for (std::size_t i = 0; i < count && duration_s > 0.0; ++i) {
            const double start_s = span.start_s + static_cast<double>(i) * width_s;
            const double end_s = start_s + width_s;
            if (!is_measured(of.power, start_s, end_s) || !is_measured(of.airspeed, start_s, end_s) ||
                !is_measured(of.altitude, start_s, end_s) || !is_on_wing(data, start_s, end_s) ||
                !(motion.is_rotorcraft || of.min_m_per_s > 0.0))
                continue;
            motion.bins.push_back(motion_bin(of, {span.phase, start_s, end_s}));
        }
    }
    if (motion.bins.empty())
        motion.no_bins_reason = fmt::format("power, airspeed and altitude were never measured at the same time{}",
                                            data.vtol_state.empty() ? "" : " on the wing");
    return motion;
}

TermValues airspeed_slopes(const FlightBin& bin) {
    const double by_speed = bin.values[PowerTerm::induced];
    TermValues slopes;
    slopes[PowerTerm::drag] = 3.0 * bin.values[PowerTerm::blade];
    slopes[PowerTerm::blade] = 2.0 * bin.airspeed_m_per_s;
    slopes[PowerTerm::induced] = -by_speed * by_speed;
    slopes[PowerTerm::turn] = -bin.values[PowerTerm::turn] * by_speed;
    return slopes;
}

TermValues mean_values(const std::vector<FlightBin>& bins) {
    TermValues sum;
    double duration_s = 0.0;
    for (const auto& bin : bins) {
        for (const auto term : all_power_terms) sum[term] += bin.values[term] * bin.duration_s;
        duration_s += bin.duration_s;
    }
    for (auto& value : sum.values) value = duration_s > 0.0 ? value / duration_s : 0.0;
    return sum;
}

}  // namespace flightwatt::mechanical
