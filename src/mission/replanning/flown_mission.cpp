#include "mission/replanning/flown_mission.h"

#include <algorithm>

namespace flightwatt::mission {
namespace {

constexpr double shortest_piece_s = 1.0;  // as the coarse steps of drawn flights

}  // namespace

path::PiecewisePower measured_power_profile(const mechanical::PhasePower& measured) {
    const auto& time_s = measured.time_s;
    const auto& power_w = measured.power_w;
    path::PiecewisePower pieces;
    double energy_j = 0.0;  // of the current piece
    for (std::size_t i = 1; i < time_s.size(); ++i) {
        energy_j += (power_w[i - 1] + power_w[i]) / 2.0 * (time_s[i] - time_s[i - 1]);
        const double length_s = time_s[i] - pieces.time_s.back();
        if (length_s <= 0.0 || (length_s < shortest_piece_s && i + 1 < time_s.size())) continue;
        pieces.time_s.push_back(time_s[i]);
        pieces.energy_j.push_back(pieces.energy_j.back() + std::max(0.0, energy_j));
        energy_j = 0.0;
    }
    return pieces;
}

MissionSetup nominal_mission(const MissionSetup& stated, const mechanical::MechanicalModel& model) {
    auto known = stated;
    known.mechanical = model;
    known.cruise_level.reset();
    known.cruise_path.reset();
    known.power_model.reset();
    for (const auto phase : all_phases) {
        if (stated.duration_s[phase] == 0.0 || stated.duration_is_stated[phase]) continue;
        known.duration_s[phase] = model.phases[phase].duration_s;
    }
    return known;
}

MissionSetup measured_mission(const MissionSetup& known, const mechanical::MeasuredFlight& flight) {
    auto flown = known;
    for (const auto phase : all_phases) {
        if (known.duration_s[phase] == 0.0) continue;
        const auto& power = flight.power[phase].value();
        flown.measured_power[phase] = std::make_shared<const path::PiecewisePower>(measured_power_profile(power));
        flown.duration_s[phase] = power.time_s.back();
    }
    return flown;
}

}  // namespace flightwatt::mission
