#include "mission/sampling/flight_outcomes.h"

#include "base/parallel.h"
#include "base/units.h"

#include <algorithm>
#include <utility>

namespace flightwatt::mission {
namespace {

/// Energy demanded after the battery failed, as a fraction of its full energy [points].
double unserved_demand_percent(const DrawnFlight& flight, double failed_at_s) {
    double missed_j = 0.0;
    for (const auto& segment : flight.segments) {
        const double from_s = std::max(segment.start_s, failed_at_s);
        if (from_s >= segment.end_s) continue;
        missed_j += mechanical_energy_j(segment, segment.end_s) + compute_energy_j(segment, segment.end_s) -
                    mechanical_energy_j(segment, from_s) - compute_energy_j(segment, from_s);
    }
    return units::percentage(units::wh_from_joule(missed_j), full_energy_wh(flight.setup.battery));
}

FlightOutcome land(const DrawnFlight& flight, const battery::Discharge& charge, std::vector<double> noted_percent) {
    FlightOutcome landing;
    landing.soc_percent = std::move(noted_percent);
    landing.soc_percent.resize(flight.times_s.size(), charge.soc_percent);
    landing.final_soc_percent = landing.remaining_percent = charge.soc_percent;
    const double lasted_s = flight.segments.back().end_s - end_tolerance_s;
    landing.depleted = charge.empty_at_s && *charge.empty_at_s < lasted_s;
    landing.battery_failure = charge.undeliverable || (charge.ended_at_s() && *charge.ended_at_s() < lasted_s);
    if (const auto& path = flight.setup.cruise_path; path && path->is_infeasible) {
        landing.battery_failure = true;
        landing.remaining_percent = std::min(-1e-9, landing.remaining_percent - units::percent_per_whole);
    } else if (landing.battery_failure) {
        const double failed_at_s = charge.undeliverable ? charge.undeliverable->time_s : *charge.ended_at_s();
        landing.remaining_percent = std::min(-1e-9, -unserved_demand_percent(flight, failed_at_s));
    }
    return landing;
}

}  // namespace

FlightOutcome simulate_flight(const DrawnFlight& flight) {
    const auto& [setup, segments, times_s] = flight;
    battery::Discharge charge{{setup.initial_soc_percent}};
    std::vector<double> noted_percent;
    for (const auto& segment : segments) {
        if (charge.failed_at_s()) break;
        const auto start = segment.soc_drop_percent > 0.0 ? apply_charge_drop(charge, segment) : charge;
        while (noted_percent.size() < times_s.size() &&
               times_s[noted_percent.size()] <= segment.start_s + end_tolerance_s)
            noted_percent.push_back(start.soc_percent);
        charge = advance_segment(setup.battery, setup.cutoff_voltage_v, segment, charge);
    }
    return land(flight, charge, std::move(noted_percent));
}

std::vector<FlightOutcome> fly_drawn(const MissionSetup& mission, const FlightDraw& draw, std::size_t first,
                                     std::size_t count) {
    constexpr std::size_t at_once = 64;
    std::vector<FlightOutcome> outcomes(count);
    for_each_in_parallel((count + at_once - 1) / at_once, [&](std::size_t block) {
        DrawnFlight flight{mission, {}};
        for (std::size_t i = block * at_once; i < std::min(count, (block + 1) * at_once); ++i) {
            draw(first + i, flight);
            outcomes[i] = simulate_flight(flight);
        }
    });
    return outcomes;
}

}  // namespace flightwatt::mission
