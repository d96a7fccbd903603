#include "mission/file/conditions_toml.h"

#include <cmath>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

/// A law through the origin reaches beyond what its flights showed, up to so many times their power and down to its
/// inverse.
constexpr double max_power_ratio = 2.0;

const mechanical::CovariateRegression& law_of(const TomlTable& conditions,
                                              const std::optional<mechanical::MechanicalModel>& mechanical) {
    if (!mechanical) {
        throw InputError(conditions.where(), "conditions have no meaning with mechanical = \"none\"", "leave them out");
    }
    const auto& law = mechanical->phases[Phase::cruise].level_law;
    if (law) return *law;
    throw InputError(
        conditions.where(),
        fmt::format("the cruise level of the mechanical model '{}' follows no condition", mechanical->name),
        "fit it with one: flightwatt fit --level-covariate NAME FLIGHT...; or leave the conditions out");
}

/// Shifts the model's cruise so that its mean over the model's own duration is this power.
void set_cruise_level(const mechanical::ConstantPower& level, MissionSetup& mission) {
    auto& cruise = mission.mechanical->phases[Phase::cruise];
    const double model_mean_w = energy_j(cruise.fourier, cruise.duration_s) / cruise.duration_s;
    cruise.fourier.a0_w += level.mean_w - model_mean_w;
    mission.cruise_level = level;
}

/// What the flights of the law did not show is refused: a plan can be changed, and a power that nothing supports should
/// not look like a result.
void apply_stated_conditions(const TomlTable& conditions, MissionSetup& mission) {
    const auto& law = law_of(conditions, mission.mechanical);
    const auto name = to_string(law.covariate);
    for (const auto& key : conditions.keys()) {
        if (key == name) continue;
        throw InputError(conditions.where(key),
                         fmt::format("the cruise level of this mechanical model does not follow '{}'", key),
                         fmt::format("it follows {}, from {:.4g} to {:.4g}", name, law.least, law.most));
    }
    const double value = conditions.number(name);
    const auto level = predict_mean_power(law, value);
    if (!level.within_flights) {
        throw InputError(
            conditions.where(name), fmt::format("{} = {} is beyond what the model's flights showed", name, value),
            fmt::format("the {} flights of its level law were from {:.4g} to {:.4g}; give one of these, or "
                        "fit a model to flights that were flown so",
                        law.flights, law.least, law.most));
    }
    set_cruise_level(constant_power(level), mission);
}

/// Level flight at an airspeed by the physical model.
void apply_physical(double airspeed_m_per_s, const mechanical::PhysicalModel& physical, MissionSetup& mission) {
    const mechanical::FlightState motion{airspeed_m_per_s};
    if (!is_within_flown_range(physical, motion)) {
        mission.notes.push_back(fmt::format(
            "airspeed_m_per_s = {} is beyond what the model's flights flew ({:.4g} to {:.4g} m/s): its power is extrapolated",
            airspeed_m_per_s, physical.airspeed_m_per_s.low, physical.airspeed_m_per_s.high));
    }
    mechanical::ConstantPower level{power_w(physical, motion), std::nullopt, 0.0};
    const double duration_s = mission.mechanical->phases[Phase::cruise].duration_s;
    if (const auto uncertainty = prediction_uncertainty(physical, term_values(motion), duration_s)) {
        level.sd_w = uncertainty->sd_w;
        level.degrees_of_freedom = uncertainty->degrees_of_freedom;
    }
    set_cruise_level(level, mission);
}

/// By drag's law of the flights that measured their airspeed, else by the covariate that the model was fitted with.
const mechanical::CovariateRegression* airspeed_law_of(const mechanical::PhaseModel& cruise) {
    if (cruise.airspeed_law) return &*cruise.airspeed_law;
    if (!cruise.level_law) return nullptr;
    const bool follows_airspeed = cruise.level_law->covariate == mechanical::Covariate::airspeed ||
                                  cruise.level_law->covariate == mechanical::Covariate::airspeed_cubed;
    return follows_airspeed ? &*cruise.level_law : nullptr;
}

void apply_airspeed(const TomlTable& root, MissionSetup& mission) {
    constexpr std::string_view key = "airspeed_m_per_s";
    const double airspeed = number_in(more_than_up_to(0.0, 300.0), root, "airspeed_m_per_s");
    const auto refuse = [&](const std::string& message, const std::string& hint) {
        throw InputError(root.where(key), message, hint);
    };
    if (!mission.mechanical) refuse("airspeed_m_per_s has no meaning with mechanical = \"none\"", "leave it out");
    if (root.has("conditions"))
        refuse("airspeed_m_per_s and conditions both state the level of the cruise", "give one");
    if (mission.mechanical->physical) {
        const auto physical = *mission.mechanical->physical;
        const double power = power_w(physical, {airspeed});
        if (power > max_power_ratio * power_w(physical, {physical.airspeed_m_per_s.high}) ||
            power * max_power_ratio < power_w(physical, {physical.airspeed_m_per_s.low})) {
            refuse(fmt::format("airspeed_m_per_s = {} is beyond what the model's flights flew", airspeed),
                   fmt::format("they flew {:.4g} to {:.4g} m/s; give an airspeed near these, or fit a model to flights "
                               "that were flown so",
                               physical.airspeed_m_per_s.low, physical.airspeed_m_per_s.high));
        }
        apply_physical(airspeed, physical, mission);
        return;
    }
    const auto* law = airspeed_law_of(mission.mechanical->phases[Phase::cruise]);
    if (law == nullptr) {
        refuse(fmt::format("the cruise of the mechanical model '{}' does not know airspeed", mission.mechanical->name),
               "fit it to two flights or more that measured their airspeed (AIRSPEED or AIR_DATA in their logs)");
    }
    const bool is_drag = is_through_origin(law->covariate);
    const double value = is_drag ? airspeed * airspeed * airspeed : airspeed;
    const double low = is_drag ? std::cbrt(law->least) : law->least;
    const double high = is_drag ? std::cbrt(law->most) : law->most;
    const auto level = predict_mean_power(*law, value);
    const bool is_near = is_drag && value <= max_power_ratio * law->most && value >= law->least / max_power_ratio;
    const auto beyond = fmt::format("airspeed_m_per_s = {} is beyond what the model's flights flew", airspeed);
    const auto flown = fmt::format("the {} flights of its law flew {:.4g} to {:.4g} m/s", law->flights, low, high);
    if (!level.within_flights && !is_near) {
        refuse(beyond, flown + "; give an airspeed near these, or fit a model to flights that were flown so");
    }
    if (!level.within_flights) mission.notes.push_back(beyond + ": " + flown + ", and drag's law reaches further");
    set_cruise_level(constant_power(level), mission);
}

}  // namespace

void apply_conditions(const TomlTable& mission_table, MissionSetup& mission) {
    const auto conditions = mission_table.optional_table("conditions");
    if (mission_table.has("airspeed_m_per_s")) apply_airspeed(mission_table, mission);
    if (conditions) apply_stated_conditions(*conditions, mission);
}

}  // namespace flightwatt::mission
