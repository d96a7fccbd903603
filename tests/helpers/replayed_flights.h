#pragma once

#include "base/units.h"
#include "mechanical/validation.h"
#include "mission/mission.h"

#include <functional>
#include <string>

namespace flightwatt::test {

/// [W] at a time of a phase.
using PowerOfPhase = std::function<double(flight::Phase phase, double time_s)>;

/// A flight whose power was measured every `step_s`, and that fits may use.
inline mechanical::MeasuredFlight flight_with_power(const std::string& name, const flight::PerPhase<double>& duration_s,
                                                    const PowerOfPhase& power_w, double step_s = 0.5) {
    mechanical::MeasuredFlight flight;
    flight.samples.flight = name;
    for (const auto phase : flight::all_phases) {
        if (duration_s[phase] == 0.0) continue;
        auto& power = flight.power[phase].emplace();
        auto& samples = flight.samples.phases[phase].emplace();
        samples.flight = name;
        samples.duration_s = duration_s[phase];
        double energy_j = 0.0;
        const auto steps = static_cast<std::size_t>(duration_s[phase] / step_s) + 1;
        for (std::size_t k = 0; k <= steps; ++k) {
            const double time_s = duration_s[phase] * static_cast<double>(k) / static_cast<double>(steps);
            power.time_s.push_back(time_s);
            power.power_w.push_back(power_w(phase, time_s));
            samples.tau.push_back(time_s / duration_s[phase]);
            samples.power_w.push_back(power.power_w.back());
            if (k > 0) energy_j += (power.power_w[k - 1] + power.power_w[k]) / 2.0 * (time_s - power.time_s[k - 1]);
        }
        power.statistics.energy_wh = units::wh_from_joule(energy_j);
        flight.energy_wh[phase] = power.statistics.energy_wh;
    }
    return flight;
}

/// A flight of which the model states all: its power times a factor, in phases that take so many parts of the mission's.
inline mechanical::MeasuredFlight flight_of_model(const std::string& name, const mission::MissionSetup& mission,
                                                  double factor = 1.0, double duration_part = 1.0,
                                                  double step_s = 0.5) {
    auto flown_s = mission.duration_s;
    for (auto& duration_s : flown_s.values) duration_s *= duration_part;
    return flight_with_power(
        name, flown_s,
        [&](flight::Phase phase, double time_s) {
            const auto curve =
                time_scaled_model(mission.mechanical->phases[phase], flown_s[phase], mission.phase_clock);
            return factor * power_w(curve, time_s);
        },
        step_s);
}

}  // namespace flightwatt::test
