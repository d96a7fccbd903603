#include "mission/file/airspeed_toml.h"

// airspeed_m_per_s of a mission: the mean power of its cruise by the physical model.

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double noted_part = 0.2;  // of the power

/// Throws InputError at `where` if the model has no physical part.
const mechanical::PhysicalModel& physical_of(const mechanical::MechanicalModel& model, const Location& where) {
    if (model.physical) return *model.physical;
    throw InputError(
        where,
        fmt::format("the mechanical model '{}' has no [physical] part, which predicts power from motion", model.name),
        "fit one: flightwatt fit --model-kind physical FLIGHT... -o MODEL.toml, of flights that measured their airspeed");
}

/// Shifts the model's cruise so that its mean over the model's own duration is this power.
void set_cruise_level(const mechanical::ConstantPower& level, MissionSetup& mission) {
    auto& cruise = mission.mechanical->phases[Phase::cruise];
    cruise.fourier.a0_w += level.mean_w - mean_power_w(cruise);
    mission.cruise_level = level;
}

}  // namespace

std::string near_flown_hint(const mechanical::PhysicalModel& physical) {
    return fmt::format(
        "they flew {:.4g} to {:.4g} m/s; give an airspeed near these, or fit a model to flights that were flown so",
        physical.airspeed_m_per_s.low, physical.airspeed_m_per_s.high);
}

void apply_airspeed(const TomlTable& mission_table, MissionSetup& mission) {
    constexpr std::string_view key = "airspeed_m_per_s";
    if (!mission_table.has(key)) return;
    const double airspeed = number_in(more_than_up_to(0.0, 300.0), mission_table, "airspeed_m_per_s");
    const auto where = mission_table.where(key);
    if (!mission.mechanical)
        throw InputError(where, "airspeed_m_per_s has no meaning with mechanical = \"none\"", "leave it out");
    const auto& physical = physical_of(*mission.mechanical, where);
    const auto& [low, high] = physical.airspeed_m_per_s;
    const mechanical::FlightState motion{airspeed};
    const auto beyond = fmt::format("airspeed_m_per_s = {} is beyond what the model's flights flew", airspeed);
    if (!may_predict_power(physical, motion, mission.mechanical->is_rotorcraft))
        throw InputError(where, beyond, near_flown_hint(physical));
    if (!is_within_flown_range(physical, motion))
        mission.notes.push_back(fmt::format("{} ({:.4g} to {:.4g} m/s): its power is extrapolated", beyond, low, high));
    mission.airspeed_m_per_s = airspeed;
    const double duration_s = mission.mechanical->phases[Phase::cruise].duration_s;
    auto level = predicted_power(physical, term_values(motion, physical.load), duration_s);
    const double added_w = power_beyond_straight_flight_w(*mission.mechanical);
    level.mean_w += added_w;
    if (added_w > noted_part * level.mean_w)
        mission.notes.push_back(fmt::format(
            "airspeed_m_per_s = {}: {:.0f} W are added to level flight straight ahead, which the turns, climbs and gusts "
            "of the model's flights took",
            airspeed, added_w));
    set_cruise_level(level, mission);
}

}  // namespace flightwatt::mission
