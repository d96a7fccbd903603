#include "mission/file/conditions_toml.h"

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

const mechanical::LevelLaw& law_of(const TomlTable& conditions,
                                   const std::optional<mechanical::MechanicalModel>& mechanical) {
    if (!mechanical) {
        throw InputError(conditions.where(), "conditions have no meaning with mechanical = \"none\"",
                         "leave them out");
    }
    const auto& law = mechanical->phases[flight::Phase::cruise].level_law;
    if (law) return *law;
    throw InputError(
        conditions.where(),
        fmt::format("the cruise level of the mechanical model '{}' follows no condition", mechanical->name),
        "fit it with one: flightwatt fit --level-covariate NAME FLIGHT...; or leave the conditions out");
}

}  // namespace

mechanical::ConstantPower apply_conditions(const TomlTable& conditions,
                                           std::optional<mechanical::MechanicalModel>& mechanical) {
    const auto& law = law_of(conditions, mechanical);
    const auto name = to_string(law.covariate);
    for (const auto& key : conditions.keys()) {
        if (key == name) continue;
        throw InputError(conditions.where(key),
                         fmt::format("the cruise level of this mechanical model does not follow '{}'", key),
                         fmt::format("it follows {}, from {:.4g} to {:.4g}", name, law.least, law.most));
    }
    const double value = conditions.number(name);
    const auto level = level_at(law, value);
    if (!level.within_flights) {
        throw InputError(
            conditions.where(name),
            fmt::format("{} = {} is beyond what the model's flights showed", name, value),
            fmt::format("the {} flights of its level law were from {:.4g} to {:.4g}; give one of these, or "
                        "fit a model to flights that were flown so",
                        law.flights, law.least, law.most));
    }
    auto& cruise = mechanical->phases[flight::Phase::cruise];
    const double model_mean_w = energy_j(cruise.fourier, cruise.duration_s) / cruise.duration_s;
    cruise.fourier.a0_w += level.power_w - model_mean_w;
    return constant_power(level);
}

}  // namespace flightwatt::mission
