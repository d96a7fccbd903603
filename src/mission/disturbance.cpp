#include "mission/disturbance.h"

#include <algorithm>

namespace flightwatt::mission {
namespace {

constexpr double same_time_s = 1e-9;

/// Times at which something changes, in order, between the demand's begin and its end.
std::vector<double> cuts_of(const Demand& demand, const std::vector<Disturbance>& disturbances) {
    std::vector<double> cuts;
    for (const auto& disturbance : disturbances) {
        for (const double time_s : {disturbance.from_s, disturbance.to_s}) {
            if (time_s > demand.from_s + same_time_s && time_s < demand.to_s - same_time_s)
                cuts.push_back(time_s);
        }
    }
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    cuts.push_back(demand.to_s);
    return cuts;
}

void disturb_power(const Disturbance& disturbance, Demand& demand) {
    demand.compute_w = demand.compute_w * disturbance.compute_factor + disturbance.compute_w;
    if (!demand.mechanical) return;
    auto& curve = *demand.mechanical;
    curve.a0_w = curve.a0_w * disturbance.mechanical_factor + disturbance.mechanical_w;
    for (auto* terms_w : {&curve.cos_w, &curve.sin_w}) {
        for (auto& term_w : *terms_w) term_w *= disturbance.mechanical_factor;
    }
}

}  // namespace

std::vector<Demand> disturbed(const std::vector<Demand>& demands,
                              const std::vector<Disturbance>& disturbances) {
    std::vector<Demand> result;
    result.reserve(demands.size() + 2 * disturbances.size());
    for (const auto& demand : demands) {
        double from_s = demand.from_s;
        for (const double to_s : cuts_of(demand, disturbances)) {
            result.push_back(demand);
            auto& part = result.back();
            part.from_s = from_s;
            part.to_s = to_s;
            for (const auto& disturbance : disturbances) {
                if (disturbance.from_s >= to_s - same_time_s || disturbance.to_s <= from_s + same_time_s)
                    continue;
                disturb_power(disturbance, part);
                if (disturbance.from_s >= from_s - same_time_s)
                    part.soc_drop_percent += disturbance.soc_drop_percent;
            }
            from_s = to_s;
        }
    }
    return result;
}

battery::Battery disturbed(battery::Battery battery, const std::vector<Disturbance>& disturbances) {
    for (const auto& disturbance : disturbances) {
        battery.capacity_ah *= disturbance.capacity_factor;
        battery.resistance_ohm *= disturbance.resistance_factor;
        if (battery.thevenin) battery.thevenin->rc_resistance_ohm *= disturbance.resistance_factor;
    }
    return battery;
}

double at_same_part_s(double time_s, const flight::PerPhase<double>& planned_s,
                      const flight::PerPhase<double>& flown_s) {
    double planned_begin_s = 0.0;
    double flown_begin_s = 0.0;
    for (const auto phase : flight::all_phases) {
        const double in_phase_s = time_s - planned_begin_s;
        if (in_phase_s < planned_s[phase])
            return flown_begin_s + in_phase_s * (flown_s[phase] / planned_s[phase]);
        planned_begin_s += planned_s[phase];
        flown_begin_s += flown_s[phase];
    }
    return flown_begin_s + (time_s - planned_begin_s);
}

std::vector<Disturbance> at_same_part(std::vector<Disturbance> disturbances,
                                      const flight::PerPhase<double>& planned_s,
                                      const flight::PerPhase<double>& flown_s) {
    for (auto& disturbance : disturbances) {
        disturbance.from_s = at_same_part_s(disturbance.from_s, planned_s, flown_s);
        disturbance.to_s = at_same_part_s(disturbance.to_s, planned_s, flown_s);
    }
    return disturbances;
}

std::vector<Stretch> at_same_part(std::vector<Stretch> schedule, const flight::PerPhase<double>& planned_s,
                                  const flight::PerPhase<double>& flown_s) {
    for (auto& stretch : schedule) {
        const double planned = planned_s[stretch.phase];
        const double flown = flown_s[stretch.phase];
        stretch.from_s = stretch.from_s / planned * flown;
        stretch.to_s = stretch.to_s == planned ? flown : stretch.to_s / planned * flown;
    }
    return schedule;
}

}  // namespace flightwatt::mission
