#include "mission/simulation/load_segments.h"

#include "base/error.h"
#include "base/piecewise_linear.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/minima.hpp>
#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double edge_tolerance_s = 1e-9;
constexpr double coarse_step_s = 1.0;
constexpr double longest_quick_step_s = 20.0;

/// The segments, cut at the times within them.
std::vector<LoadSegment> cut_at(std::vector<double> times_s, const std::vector<LoadSegment>& segments) {
    std::ranges::sort(times_s);
    std::vector<LoadSegment> parts;
    parts.reserve(segments.size() + times_s.size());
    auto time_s = times_s.begin();
    for (const auto& segment : segments) {
        parts.push_back(segment);
        for (; time_s != times_s.end() && *time_s < segment.end_s - edge_tolerance_s; ++time_s) {
            if (*time_s <= parts.back().start_s + edge_tolerance_s) continue;
            parts.back().end_s = *time_s;
            parts.push_back(segment);
            parts.back().start_s = *time_s;
        }
    }
    return parts;
}

/// The curve times a factor.
void scale(mechanical::FourierModel& curve, double factor) {
    curve.a0_w *= factor;
    for (auto* terms_w : {&curve.cos_w, &curve.sin_w})
        for (auto& term_w : *terms_w) term_w *= factor;
}

void disturb_power(const Disturbance& disturbance, LoadSegment& segment) {
    segment.compute_w = segment.compute_w * disturbance.compute_factor + disturbance.compute_w;
    if (!segment.mechanical && disturbance.mechanical_w == 0.0) return;
    if (!segment.mechanical) segment.mechanical = mechanical::FourierModel{};  // computing alone
    scale(*segment.mechanical, disturbance.mechanical_factor);
    segment.mechanical->a0_w += disturbance.mechanical_w;
}

/// Whether the source is constant, and nothing but an empty battery can end the segment.
bool depends_on_power_alone(const battery::Battery& battery, double cutoff_voltage_v, const LoadSegment& segment) {
    if (battery.thevenin) return false;
    const auto bounds = bounds_of(segment);
    return bounds.low >= 0.0 && bounds.high <= power_limit_w(battery) &&
           terminal_voltage_v(battery, {}, internal_current_a(battery, bounds.high)) >= cutoff_voltage_v;
}

/// Depletion of a constant source that delivers a segment.
double depleted_percent(const battery::Battery& battery, const LoadSegment& segment) {
    constexpr double pieces_a_turn = 4.0;  // of the highest harmonic: exact to rounding
    const double capacity_as = units::coulomb_from_ah(battery.capacity_ah);
    if (battery.resistance_ohm == 0.0) {
        const double energy_j = mechanical_energy_j(segment, segment.end_s) + compute_energy_j(segment, segment.end_s);
        return units::percentage(energy_j / battery.voltage_v, capacity_as);
    }
    const double length_s = segment.end_s - segment.start_s;
    double turns = 0.0;
    if (segment.mechanical)
        turns = static_cast<double>(segment.mechanical->cos_w.size()) * segment.mechanical->omega_rad_per_s * length_s /
                units::rad_per_turn;
    const auto pieces =
        static_cast<std::size_t>(std::min(1.0 + std::floor(turns * pieces_a_turn), std::max(16.0, length_s)));
    const double piece_s = length_s / static_cast<double>(pieces);
    const auto current_a = [&](double time_s) { return internal_current_a(battery, power_w(segment, time_s)); };
    double charge_as = 0.0;
    for (std::size_t k = 0; k < pieces; ++k) {
        const double start_s = segment.start_s + piece_s * static_cast<double>(k);
        charge_as += boost::math::quadrature::gauss<double, 7>::integrate(current_a, start_s, start_s + piece_s);
    }
    return units::percentage(charge_as, capacity_as);
}

constexpr double points_a_turn = 16.0;        // of the highest harmonic: one valley between two neighbours
constexpr double rounding_of_power_w = 1e-6;  // fits that touch 0 do not charge

/// No harmonics together are greater than their amplitudes.
double amplitude_w(const mechanical::FourierModel& curve) {
    double sum_w = 0.0;
    for (std::size_t n = 0; n < curve.cos_w.size(); ++n) sum_w += std::hypot(curve.cos_w[n], curve.sin_w[n]);
    return sum_w;
}

/// The least mechanical power of a segment, in the phase's own time; a bound where the whole is not negative.
PowerAt least_w(const LoadSegment& segment) {
    const TimeInterval within{segment.start_s - segment.phase_start_s, segment.end_s - segment.phase_start_s};
    if (!segment.mechanical) return {within.start_s, 0.0};
    return min_power_w(*segment.mechanical, within, -segment.compute_w);
}

/// The parts of a segment with the constant power of each piece.
std::vector<LoadSegment> constant_power_parts(LoadSegment part, const path::PiecewisePower& pieces) {
    const auto& [time_s, energy_j] = pieces;
    const double end_s = part.end_s;
    const double start_s = part.start_s - part.phase_start_s + edge_tolerance_s;
    std::vector<LoadSegment> parts;
    for (auto k = find_knot_interval(time_s, start_s).lower;; ++k) {
        const double power_w = (energy_j[k + 1] - energy_j[k]) / (time_s[k + 1] - time_s[k]);
        part.mechanical = mechanical::FourierModel{0.0, power_w, {}, {}};
        part.end_s = part.phase_start_s + time_s[k + 1];
        if (k + 2 == time_s.size() || part.end_s >= end_s - edge_tolerance_s) part.end_s = end_s;
        parts.push_back(part);
        if (part.end_s == end_s) return parts;
        part.start_s = part.end_s;
    }
}

}  // namespace

Interval bounds_of(const LoadSegment& segment) {
    if (!segment.mechanical) return {segment.compute_w, segment.compute_w};
    const double mean_w = segment.mechanical->a0_w + segment.compute_w;
    const double reach_w = amplitude_w(*segment.mechanical);
    return {mean_w - reach_w, mean_w + reach_w};
}

double quick_step_s(const LoadSegment& segment) {
    constexpr double steps_a_turn = 12.0;  // of the highest harmonic
    if (!segment.mechanical || segment.mechanical->cos_w.empty()) return longest_quick_step_s;
    const double max_rad_per_s =
        static_cast<double>(segment.mechanical->cos_w.size()) * segment.mechanical->omega_rad_per_s;
    return std::min(longest_quick_step_s, units::rad_per_turn / (steps_a_turn * max_rad_per_s));
}

MissionLoad make_mission_load(const MissionSetup& mission) {
    require_single_flight(mission);
    MissionLoad load{mission, timeline_of(mission.duration_s), {}, {}};
    for (const auto phase : all_phases) {
        if (!mission.mechanical || mission.duration_s[phase] == 0.0) continue;
        load.pieces[phase] = mission.measured_power[phase];
        if (phase == Phase::cruise && mission.cruise_path && !load.pieces[phase])
            load.pieces[phase] = mission.cruise_path->pieces;
        if (load.pieces[phase]) continue;
        load.mechanical[phase] =
            time_scaled_model(mission.mechanical->phases[phase], mission.duration_s[phase], mission.phase_clock);
    }
    return load;
}

std::vector<LoadSegment> load_segments(const MissionLoad& load, const ScheduleSegment& scheduled) {
    LoadSegment segment;
    segment.phase = scheduled.phase;
    segment.phase_start_s = load.timeline.start_s[scheduled.phase];
    segment.start_s = segment.phase_start_s + scheduled.start_s;
    segment.end_s = segment.phase_start_s + scheduled.end_s;
    segment.mechanical = load.mechanical[scheduled.phase];
    segment.compute_w = power_w(load.mission.compute, scheduled.run);
    const auto& pieces = load.pieces[scheduled.phase];
    if (pieces) return constant_power_parts(std::move(segment), *pieces);
    return {std::move(segment)};
}

std::vector<LoadSegment> load_segments(const MissionSetup& mission, const Schedule& schedule) {
    const auto load = make_mission_load(mission);
    std::vector<LoadSegment> segments;
    segments.reserve(schedule.size());
    for (const auto& scheduled : schedule)
        std::ranges::move(load_segments(load, scheduled), std::back_inserter(segments));
    return segments;
}

std::vector<LoadSegment> disturbed(std::vector<LoadSegment> segments, const Disturbances& disturbances,
                                   const std::vector<double>& times_s) {
    if (disturbances.empty() && times_s.empty()) return segments;
    auto cuts_s = times_s;
    for (const auto& disturbance : disturbances) cuts_s.insert(cuts_s.end(), {disturbance.start_s, disturbance.end_s});
    auto parts = cut_at(std::move(cuts_s), segments);
    for (auto& part : parts) {
        Disturbance together;  // all factors, then all powers: in any order
        for (const auto& disturbance : disturbances) {
            if (disturbance.start_s >= part.end_s - edge_tolerance_s ||
                disturbance.end_s <= part.start_s + edge_tolerance_s)
                continue;
            together.mechanical_factor *= disturbance.mechanical_factor;
            together.mechanical_w += disturbance.mechanical_w;
            together.compute_factor *= disturbance.compute_factor;
            together.compute_w += disturbance.compute_w;
            if (disturbance.start_s >= part.start_s - edge_tolerance_s)
                part.soc_drop_percent += disturbance.soc_drop_percent;
        }
        disturb_power(together, part);
    }
    return parts;
}

double mechanical_w(const LoadSegment& segment, double time_s) {
    return segment.mechanical ? power_w(*segment.mechanical, time_s - segment.phase_start_s) : 0.0;
}

double power_w(const LoadSegment& segment, double time_s) { return mechanical_w(segment, time_s) + segment.compute_w; }

double mechanical_energy_j(const LoadSegment& segment, double time_s) {
    if (!segment.mechanical) return 0.0;
    return energy_j(*segment.mechanical, time_s - segment.phase_start_s) -
           energy_j(*segment.mechanical, segment.start_s - segment.phase_start_s);
}

double compute_energy_j(const LoadSegment& segment, double time_s) {
    return segment.compute_w * (time_s - segment.start_s);
}

battery::Discharge apply_charge_drop(battery::Discharge state, const LoadSegment& segment) {
    state.soc_percent -= segment.soc_drop_percent;
    if (state.soc_percent <= 0.0) {
        state.soc_percent = 0.0;
        state.empty_at_s = segment.start_s;
    }
    return state;
}

battery::Discharge advance_segment(const battery::Battery& battery, double cutoff_voltage_v, const LoadSegment& segment,
                                   battery::Discharge state) {
    if (state.ended_at_s() || state.undeliverable) return state;
    if (segment.soc_drop_percent > 0.0) state = apply_charge_drop(state, segment);
    if (state.ended_at_s()) return state;
    if (depends_on_power_alone(battery, cutoff_voltage_v, segment)) {
        const double left_percent = state.soc_percent - depleted_percent(battery, segment);
        if (left_percent > 0.0) {
            state.soc_percent = left_percent;
            return state;
        }
    }
    const battery::Load load{[&](double time_s) { return power_w(segment, time_s); }, segment.start_s, segment.end_s};
    if (battery.thevenin && bounds_of(segment).low >= 0.0)
        return fast_discharge(battery, load, state, {quick_step_s(segment), cutoff_voltage_v});
    return discharge(battery, load, state, {coarse_step_s, cutoff_voltage_v});
}

PowerAt min_power_w(const mechanical::FourierModel& curve, const TimeInterval& within, double enough_w) {
    const double bound_w = curve.a0_w - amplitude_w(curve);
    if (bound_w >= enough_w || curve.cos_w.empty()) return {within.start_s, bound_w};
    const double length_s = within.end_s - within.start_s;
    const double turns =
        static_cast<double>(curve.cos_w.size()) * curve.omega_rad_per_s * length_s / units::rad_per_turn;
    const auto points = static_cast<std::size_t>(std::clamp(std::ceil(turns * points_a_turn), 16.0, 1e6));
    const double step_s = length_s / static_cast<double>(points);
    const auto power = [&](double time_s) { return power_w(curve, time_s); };
    PowerAt least{within.start_s, power(within.start_s)};
    for (std::size_t k = 1; k <= points; ++k) {
        const double time_s = within.start_s + static_cast<double>(k) * step_s;
        if (const double now_w = power(time_s); now_w < least.power_w) least = {time_s, now_w};
    }
    constexpr int bits = 24;
    const auto [time_s, valley_w] = boost::math::tools::brent_find_minima(
        power, std::max(within.start_s, least.time_s - step_s), std::min(within.end_s, least.time_s + step_s), bits);
    return valley_w < least.power_w ? PowerAt{time_s, valley_w} : least;
}

void refuse_charging(const MissionSetup& mission, const std::vector<LoadSegment>& segments) {
    if (mission.may_charge) return;
    for (const auto& segment : segments) {
        const auto least = least_w(segment);
        if (least.power_w + segment.compute_w >= -rounding_of_power_w) continue;
        throw InputError(
            {mission.file},
            fmt::format("{}: {:.1f} s into the {} it draws {:.4g} W ({:.4g} W mechanical, {:.4g} W computing), which "
                        "charges the battery in flight",
                        mission.name, least.time_s, phase_word(segment.phase), least.power_w + segment.compute_w,
                        least.power_w, segment.compute_w),
            "check the model or profile and fit it again (another order, flights with correct power), or "
            "state may_charge = true if a source aboard charges the battery");
    }
}

}  // namespace flightwatt::mission
