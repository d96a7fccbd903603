#include "mission/planning/limit_search.h"

#include "base/units.h"
#include "mission/plan.h"
#include "mission/planning/planner.h"
#include "mission/sampling/landing_distribution.h"
#include "mission/simulation.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

LandingDistribution drawn(const Mission& mission, double probability) {
    require_known_spread(mission.setup);
    return draw_landings_until_known(mission, collect_uncertainty(mission.setup), probability);
}

}  // namespace

double surplus_percent(const Mission& mission) {
    const auto& setup = mission.setup;
    if (!setup.battery.thevenin && std::ranges::none_of(load_segments(setup, mission.schedule), charges_battery)) {
        const auto load = make_mission_load(setup);
        double soc_percent = setup.initial_soc_percent;
        for (const auto& segment : mission.schedule) soc_percent -= depletion_percent(load, segment);
        if (std::isfinite(soc_percent)) return soc_percent - setup.reserve_soc_percent;
    }
    const auto summary = simulate(mission).summary;
    if (summary.feasible) return *summary.final_soc_percent - mission.setup.reserve_soc_percent;
    return -mission.setup.reserve_soc_percent -
           units::percentage(summary.duration_s - powered_end_s(summary), summary.duration_s) - 1e-9;
}

Mission LimitSearch::mission(double value) const { return with_minimum_energy_schedule(variation_(value)); }

bool LimitSearch::fits(double value) {
    try {
        mission(value);
        return true;
    } catch (const InputError& error) {
        misfit_ = error;
        return false;
    }
}

std::optional<double> LimitSearch::surplus(double value) {
    const auto [known, is_new] = known_.try_emplace(value);
    if (is_new && fits(value)) {
        const auto at = mission(value);
        known->second = probability_ ? drawn(at, *probability_).spare_percent(*probability_) : surplus_percent(at);
    }
    return known->second;
}

std::string LimitSearch::share_text() const {
    return probability_ ? fmt::format(" in {:.4g} % of its flights", units::percentage(*probability_, 1.0)) : "";
}

FeasibilityLimit LimitSearch::limit(double value, double beyond) const {
    const auto at = mission(value);
    FeasibilityLimit most;
    most.value = value;
    if (probability_) {
        const auto landings = drawn(at, *probability_);
        most.margin_percent = std::max(0.0, landings.nominal_spare_percent() - landings.spare_percent(*probability_));
        most.sources = collect_uncertainty(at.setup).sources;
    }
    most.final_soc_percent = simulate(at).summary.final_soc_percent.value_or(0.0);
    most.residual_percent = most.final_soc_percent - most.margin_percent - at.setup.reserve_soc_percent;
    const auto further = simulate(mission(beyond)).summary;
    most.limited_by = further.undeliverable  ? LimitingFactor::power
                      : further.cut_off_at_s ? LimitingFactor::cut_off
                                             : LimitingFactor::charge;
    return most;
}

}  // namespace flightwatt::mission
