#include "mission/sampling/flight_outcome.h"

#include "base/units.h"

#include <algorithm>

namespace flightwatt::mission {
namespace {

/// Energy demanded after the battery failed, as a part of what a full one holds [points].
double unserved_demand_percent(const SampledFlight& flight, double failed_at_s) {
    double missed_j = 0.0;
    for (const auto& segment : flight.segments) {
        const double from_s = std::max(segment.start_s, failed_at_s);
        if (from_s >= segment.end_s) continue;
        missed_j += mechanical_energy_j(segment, segment.end_s) + compute_energy_j(segment, segment.end_s) -
                    mechanical_energy_j(segment, from_s) - compute_energy_j(segment, from_s);
    }
    return units::percentage(units::wh_from_joule(missed_j), full_energy_wh(flight.battery));
}

}  // namespace

FlightOutcome simulate_flight(const SampledFlight& flight, const std::vector<double>& times_s) {
    FlightOutcome landing;
    battery::Discharge charge{{flight.setup.initial_soc_percent}};
    auto& noted_percent = landing.soc_percent;
    for (auto part : flight.segments) {
        const double segment_end_s = part.end_s;
        const auto follow_until = [&](double time_s) {
            part.end_s = time_s;
            charge = advance_segment(flight.battery, flight.setup.cutoff_voltage_v, part, charge);
            part.start_s = time_s;
            part.soc_drop_percent = 0.0;
        };
        while (noted_percent.size() < times_s.size() && times_s[noted_percent.size()] < segment_end_s) {
            follow_until(std::max(part.start_s, times_s[noted_percent.size()]));
            noted_percent.push_back(charge.soc_percent);
        }
        follow_until(segment_end_s);
    }
    noted_percent.resize(times_s.size(), charge.soc_percent);
    landing.final_soc_percent = charge.soc_percent;
    const double lasted_s = flight.segments.back().end_s - end_tolerance_s;
    landing.depleted = charge.empty_at_s && *charge.empty_at_s < lasted_s;
    landing.battery_failure = charge.undeliverable || (charge.ended_at_s() && *charge.ended_at_s() < lasted_s);
    landing.remaining_percent = charge.soc_percent;
    if (const auto& path = flight.setup.cruise_path; path && path->is_infeasible) {
        landing.battery_failure = true;  // it never gets there
        landing.remaining_percent = std::min(-1e-9, landing.remaining_percent - units::percent_per_whole);
    } else if (landing.battery_failure) {
        const double failed_at_s = charge.undeliverable ? charge.undeliverable->time_s : *charge.ended_at_s();
        landing.remaining_percent = std::min(-1e-9, -unserved_demand_percent(flight, failed_at_s));
    }
    return landing;
}

}  // namespace flightwatt::mission
