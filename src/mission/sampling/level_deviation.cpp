#include "mission/sampling/level_deviation.h"

#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/prediction.h"
#include "mission/planning/depletion_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

double phase_depletion_percent(const MissionSetup& mission, const compute::Configuration& configuration, Phase phase) {
    const auto table = make_depletion_table(mission, {configuration});
    return soc_depletion_percent(table, {{phase, 0.0, mission.duration_s[phase]}, 0});
}

void require_probability(double probability) {
    if (probability >= 0.5 && probability < 1.0) return;
    throw std::invalid_argument("the probability of a margin is not from 0.5 to below 1");
}

}  // namespace

LevelDeviation level_deviation(const MissionSetup& mission, Phase phase) {
    const auto& model = mission.mechanical->phases[phase];
    if (const auto percent = mission.uncertainty.level_sd_percent[phase]) {
        const double duration_s = mission.duration_s[phase];
        const auto flown = flown_model(model, duration_s, mission.phase_clock);
        const double mean_w = std::abs(energy_j(flown, duration_s) / duration_s);
        return {units::part_of(mean_w, *percent), DeviationSource::stated};
    }
    if (phase == Phase::cruise && mission.cruise_level)
        return {mission.cruise_level->sd_w.value(), DeviationSource::conditions};
    if (const auto& spread = model.level_spread) {
        const double weight_square_sum = forecast_of(*mission.mechanical, phase).weight_square_sum;
        return {spread->level_sd_w * std::sqrt(1.0 + weight_square_sum), DeviationSource::flights,
                static_cast<std::size_t>(spread->flights)};
    }
    if (model.errors) return {model.errors->a0_w, DeviationSource::fit_error};
    return {};
}

double level_sd_w(const MissionSetup& mission, Phase phase) {
    if (!mission.mechanical) {
        throw InputError({mission.file}, "mechanical = \"none\": there are no flights that differ",
                         "a chance needs a mechanical model of two flights or more");
    }
    const auto deviation = level_deviation(mission, phase);
    if (deviation.source != DeviationSource::none && deviation.source != DeviationSource::fit_error)
        return deviation.sd_w;
    throw InputError(
        {mission.file},
        fmt::format("the mechanical model does not say how flights differ: [{}] has no spread", to_string(phase)),
        "fit it to two flights or more (flightwatt fit FLIGHT... -o MODEL.toml), or state it: "
        "[uncertainty] with level_sd_percent");
}

double soc_depletion_sd_percent(const MissionSetup& mission,
                                const std::vector<compute::Configuration>& configurations) {
    const auto most_power = std::ranges::max_element(configurations, [&](const auto& a, const auto& b) {
        return power_w(mission.compute, a) < power_w(mission.compute, b);
    });
    if (most_power == configurations.end()) throw std::invalid_argument("soc_depletion_sd_percent: no configuration");
    double variance = 0.0;
    for (const auto phase : all_phases) {
        if (mission.duration_s[phase] == 0.0) continue;
        auto stronger = mission;
        stronger.mechanical->phases[phase].fourier.a0_w += level_sd_w(mission, phase);
        const double more = phase_depletion_percent(stronger, *most_power, phase) -
                            phase_depletion_percent(mission, *most_power, phase);
        if (!std::isfinite(more)) {
            throw NoAnswerError(
                fmt::format("the battery cannot deliver the most that this mission may draw in {}, with one "
                            "standard deviation more of mechanical power",
                            to_string(phase)));
        }
        variance += more * more;
    }
    return std::sqrt(variance);
}

double margin_percent(const MissionSetup& mission, const std::vector<compute::Configuration>& configurations,
                      double probability) {
    require_probability(probability);
    return normal_quantile(probability) * soc_depletion_sd_percent(mission, configurations);
}

PlanningProblem mission_at_quantile(const PlanningProblem& problem, double probability) {
    require_probability(probability);
    PerPhase<double> sd_w;
    double energy_variance_j2 = 0.0;
    for (const auto phase : all_phases) {
        if (problem.duration_s[phase] == 0.0) continue;
        sd_w[phase] = level_sd_w(problem, phase);
        energy_variance_j2 += std::pow(sd_w[phase] * problem.duration_s[phase], 2);
    }
    auto stronger = problem;
    if (energy_variance_j2 == 0.0) return stronger;
    for (const auto phase : all_phases) {
        const double part = sd_w[phase] * problem.duration_s[phase] / std::sqrt(energy_variance_j2);
        if (part > 0.0) {
            stronger.mechanical->phases[phase].fourier.a0_w += normal_quantile(probability) * part * sd_w[phase];
        }
    }
    return stronger;
}

}  // namespace flightwatt::mission
