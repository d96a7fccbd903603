#include "mission/sampling/level_deviation.h"

#include "base/units.h"
#include "mechanical/prediction.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

bool is_of_flights(const MeanPowerDeviation& deviation) {
    return deviation.source != DeviationSource::none && deviation.source != DeviationSource::fit_error;
}

}  // namespace

double mean_level_w(const MissionSetup& mission, Phase phase) {
    if (phase == Phase::cruise && mission.cruise_path) return mean_power_w(*mission.cruise_path);
    const double duration_s = mission.duration_s[phase];
    const auto flown = time_scaled_model(mission.mechanical->phases[phase], duration_s, mission.phase_clock);
    return std::abs(energy_j(flown, duration_s) / duration_s);
}

bool has_flight_variability(const MissionSetup& mission) {
    return mission.mechanical && std::ranges::all_of(all_phases, [&](Phase phase) {
               return !(mission.duration_s[phase] > 0.0) || is_of_flights(level_deviation(mission, phase));
           });
}

MeanPowerDeviation level_deviation(const MissionSetup& mission, Phase phase) {
    const auto& model = mission.mechanical->phases[phase];
    if (const auto percent = mission.uncertainty.level_sd_percent[phase])
        return {units::amount_from_percent(mean_level_w(mission, phase), *percent), DeviationSource::stated};
    if (phase == Phase::cruise && mission.cruise_level && mission.cruise_level->sd_w)
        return {*mission.cruise_level->sd_w, mission.cruise_path ? DeviationSource::path : DeviationSource::conditions,
                0, mission.cruise_level->degrees_of_freedom};
    if (const auto& spread = model.level_spread) {
        const double weight_square_sum = forecast_of(*mission.mechanical, phase).weight_square_sum;
        return {spread->between_flight_sd_w * std::sqrt(1.0 + weight_square_sum), DeviationSource::flights,
                spread->flights, static_cast<double>(spread->flights - 1)};
    }
    if (model.errors) return {model.errors->a0_w, DeviationSource::fit_error, 0, model.errors->degrees_of_freedom};
    return {};
}

double level_sd_w(const MissionSetup& mission, Phase phase) {
    const auto deviation = level_deviation(mission, phase);
    if (is_of_flights(deviation)) return deviation.sd_w;
    throw InputError(
        {mission.file},
        fmt::format("the mechanical model does not say how flights differ: [{}] has no spread", to_string(phase)),
        "fit it to two flights or more (flightwatt fit FLIGHT... -o MODEL.toml), or state it: "
        "[uncertainty] with level_sd_percent");
}

void require_flight_variability(const MissionSetup& mission) {
    for (const auto phase : all_phases)
        if (mission.mechanical && mission.duration_s[phase] > 0.0) level_sd_w(mission, phase);
}

}  // namespace flightwatt::mission
