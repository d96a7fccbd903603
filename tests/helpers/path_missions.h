#pragma once

#include "helpers/made_up_paths.h"
#include "helpers/rejected.h"
#include "helpers/steady_mission.h"

#include <filesystem>
#include <utility>

namespace flightwatt::test {

/// The steady mission's battery on a path, with nothing that runs.
inline mission::Mission path_mission(path::FlightPath path, const path::Wind& wind = {}) {
    auto mission = steady_mission();
    mission.setup.mechanical->physical = made_up_wing();
    mission.setup.cruise_path = made_up_cruise(std::move(path), wind);
    mission.setup.cruise_level = mechanical::ConstantPower{mean_power_w(*mission.setup.cruise_path), std::nullopt, 0.0};
    const double cruise_s = duration_s(*mission.setup.cruise_path);
    mission.setup.duration_s[flight::Phase::cruise] = cruise_s;
    mission.setup.duration_is_stated[flight::Phase::cruise] = true;
    mission.schedule = {{flight::Phase::cruise, 0.0, cruise_s, {}}};
    return mission;
}

/// Writes a model with the made-up wing's power by motion.
inline void write_wing(mechanical::MechanicalModel model, const std::filesystem::path& file) {
    model.physical = made_up_wing();
    model.physical->mean_airspeed_m_per_s = 0.0;  // unknown: its power is that of the terms alone
    model.physical->bins = 100;
    model.physical->bin_s = 30.0;
    model.physical->correlation_s = 60.0;
    write_text(file, mechanical::to_toml(model));
}

/// Returns the mean power [W] of a mission's cruise by its curve.
inline double cruise_w(const mission::Mission& mission) {
    const auto& cruise = mission.setup.mechanical->phases[flight::Phase::cruise];
    return energy_j(cruise.fourier, cruise.duration_s) / cruise.duration_s;
}

}  // namespace flightwatt::test
