#include "mission/simulation/load_segments.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mission {
namespace {

constexpr double edge_tolerance_s = 1e-9;
constexpr double coarse_step_s = 1.0;

/// Times at which something changes, in order, between the segment's start and its end.
std::vector<double> cuts_of(const LoadSegment& segment, const Disturbances& disturbances) {
    std::vector<double> cuts;
    for (const auto& disturbance : disturbances) {
        for (const double time_s : {disturbance.start_s, disturbance.end_s})
            if (time_s > segment.start_s + edge_tolerance_s && time_s < segment.end_s - edge_tolerance_s)
                cuts.push_back(time_s);
    }
    std::ranges::sort(cuts);
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    cuts.push_back(segment.end_s);
    return cuts;
}

void disturb_power(const Disturbance& disturbance, LoadSegment& segment) {
    segment.compute_w = segment.compute_w * disturbance.compute_factor + disturbance.compute_w;
    if (!segment.mechanical) return;
    auto& curve = *segment.mechanical;
    curve.a0_w = curve.a0_w * disturbance.mechanical_factor + disturbance.mechanical_w;
    for (auto* terms_w : {&curve.cos_w, &curve.sin_w})
        for (auto& term_w : *terms_w) term_w *= disturbance.mechanical_factor;
}

/// A bound: no harmonic can be more negative than its amplitude.
bool never_charges(const LoadSegment& segment) {
    double least_w = segment.compute_w;
    if (segment.mechanical) {
        const auto& curve = *segment.mechanical;
        least_w += curve.a0_w;
        for (std::size_t n = 0; n < curve.cos_w.size(); ++n) least_w -= std::hypot(curve.cos_w[n], curve.sin_w[n]);
    }
    return least_w >= 0.0;
}

double depleted_percent(const battery::Battery& battery, const LoadSegment& segment, double until_s) {
    const double energy_j = mechanical_energy_j(segment, until_s) + compute_energy_j(segment, until_s);
    return units::percent_of(energy_j / battery.voltage_v, units::coulomb_from_ah(battery.capacity_ah));
}

}  // namespace

MissionLoad load_of(const MissionSetup& mission) {
    MissionLoad load{mission, timeline_of(mission.duration_s), {}};
    for (const auto phase : all_phases) {
        if (!mission.mechanical || mission.duration_s[phase] == 0.0) continue;
        load.mechanical[phase] =
            flown_model(mission.mechanical->phases[phase], mission.duration_s[phase], mission.phase_clock);
    }
    return load;
}

LoadSegment load_segment(const MissionLoad& load, const ScheduleSegment& scheduled) {
    LoadSegment segment;
    segment.phase = scheduled.phase;
    segment.phase_start_s = load.timeline.start_s[scheduled.phase];
    segment.start_s = segment.phase_start_s + scheduled.start_s;
    segment.end_s = segment.phase_start_s + scheduled.end_s;
    segment.mechanical = load.mechanical[scheduled.phase];
    segment.compute_w = power_w(load.mission.compute, scheduled.run);
    return segment;
}

std::vector<LoadSegment> load_segments(const MissionSetup& mission, const Schedule& schedule) {
    const auto load = load_of(mission);
    std::vector<LoadSegment> segments;
    segments.reserve(schedule.size());
    for (const auto& scheduled : schedule) segments.push_back(load_segment(load, scheduled));
    return segments;
}

std::vector<LoadSegment> disturbed(const std::vector<LoadSegment>& segments, const Disturbances& disturbances) {
    std::vector<LoadSegment> result;
    result.reserve(segments.size() + 2 * disturbances.size());
    for (const auto& segment : segments) {
        double start_s = segment.start_s;
        for (const double end_s : cuts_of(segment, disturbances)) {
            result.push_back(segment);
            auto& part = result.back();
            part.start_s = start_s;
            part.end_s = end_s;
            for (const auto& disturbance : disturbances) {
                if (disturbance.start_s >= end_s - edge_tolerance_s || disturbance.end_s <= start_s + edge_tolerance_s)
                    continue;
                disturb_power(disturbance, part);
                if (disturbance.start_s >= start_s - edge_tolerance_s)
                    part.soc_drop_percent += disturbance.soc_drop_percent;
            }
            start_s = end_s;
        }
    }
    return result;
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

battery::Discharge after_drop(battery::Discharge state, const LoadSegment& segment) {
    state.soc_percent -= segment.soc_drop_percent;
    if (state.soc_percent <= 0.0) {
        state.soc_percent = 0.0;
        state.empty_at_s = segment.start_s;
    }
    return state;
}

battery::Discharge after_segment(const battery::Battery& battery, double cutoff_voltage_v, const LoadSegment& segment,
                                 battery::Discharge state) {
    if (state.ended_at_s() || state.undeliverable) return state;
    if (segment.soc_drop_percent > 0.0) state = after_drop(state, segment);
    if (state.ended_at_s()) return state;
    if (!battery.thevenin && battery.resistance_ohm == 0.0 && battery.voltage_v >= cutoff_voltage_v &&
        never_charges(segment)) {
        const double left_percent = state.soc_percent - depleted_percent(battery, segment, segment.end_s);
        if (left_percent > 0.0) {
            state.soc_percent = left_percent;
            return state;
        }
    }
    const auto load = [&](double time_s) { return power_w(segment, time_s); };
    return discharge(battery, {load, segment.start_s, segment.end_s}, state, {coarse_step_s, cutoff_voltage_v});
}

}  // namespace flightwatt::mission
