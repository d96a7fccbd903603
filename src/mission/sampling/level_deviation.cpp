#include "mission/sampling/level_deviation.h"

#include "base/units.h"
#include "mechanical/prediction.h"
#include "mission/planning/depletion_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>

namespace flightwatt::mission {

std::optional<double> stated_level_sd_w(const Mission& mission, flight::Phase phase) {
    const auto percent = mission.uncertainty.level_sd_percent[phase];
    if (!percent || !mission.mechanical) return std::nullopt;
    const double duration_s = mission.duration_s[phase];
    const auto model = flown_model(mission.mechanical->phases[phase], duration_s, mission.phase_clock);
    return units::part_of(std::abs(energy_j(model, duration_s) / duration_s), *percent);
}

double level_sd_w(const Mission& mission, flight::Phase phase) {
    if (!mission.mechanical) {
        throw InputError({mission.file}, "mechanical = \"none\": there are no flights that differ",
                         "a chance needs a mechanical model of two flights or more");
    }
    if (const auto stated_w = stated_level_sd_w(mission, phase)) return *stated_w;
    if (phase == flight::Phase::cruise && mission.cruise_level) return mission.cruise_level->sd_w.value();
    const double duration_s = mission.duration_s[phase];
    const auto energy = predict_before_flight(forecast_of(*mission.mechanical, phase), duration_s);
    if (!energy.uncertainty_known) {
        throw InputError(
            {mission.file},
            fmt::format("the mechanical model does not say how flights differ: [{}] has no spread",
                        to_string(phase)),
            "fit it to two flights or more (flightwatt fit FLIGHT... -o MODEL.toml), or state it: "
            "[uncertainty] with level_sd_percent");
    }
    return units::joule_from_wh(std::sqrt(energy.variance_wh2)) / duration_s;
}

namespace {

double phase_drain_percent(const Mission& mission, const compute::Configuration& configuration,
                           flight::Phase phase) {
    const auto table = make_drain_table(mission, {configuration});
    return drain_percent(table, {0, phase, 0.0, mission.duration_s[phase]});
}

}  // namespace

double drain_sd_percent(const Mission& mission, const std::vector<compute::Configuration>& configurations) {
    const auto hungriest =
        std::max_element(configurations.begin(), configurations.end(), [&](const auto& a, const auto& b) {
            return power_w(mission.compute, a) < power_w(mission.compute, b);
        });
    if (hungriest == configurations.end()) throw std::invalid_argument("drain_sd_percent: no configuration");
    double variance = 0.0;
    for (const auto phase : flight::all_phases) {
        if (mission.duration_s[phase] == 0.0) continue;
        auto stronger = mission;
        stronger.mechanical->phases[phase].fourier.a0_w += level_sd_w(mission, phase);
        const double more = phase_drain_percent(stronger, *hungriest, phase) -
                            phase_drain_percent(mission, *hungriest, phase);
        if (!std::isfinite(more)) {
            throw NoAnswerError(
                fmt::format("the battery cannot deliver the most that this mission may draw in {}, with one "
                            "standard deviation "
                            "more of mechanical power",
                            to_string(phase)));
        }
        variance += more * more;
    }
    return std::sqrt(variance);
}

double margin_percent(const Mission& mission, const std::vector<compute::Configuration>& configurations,
                      double probability) {
    if (!(probability >= 0.5 && probability < 1.0)) {
        throw std::invalid_argument("margin_percent: the probability is not from 0.5 to below 1");
    }
    const double sd_percent = drain_sd_percent(mission, configurations);
    return boost::math::quantile(boost::math::normal_distribution<double>(), probability) * sd_percent;
}

}  // namespace flightwatt::mission
