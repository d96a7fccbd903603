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

std::optional<Mission> LimitSearch::mission_if_it_fits(double value) {
    try {
        return mission(value);
    } catch (const InputError& error) {
        misfit_ = error;
        return std::nullopt;
    }
}

double LimitSearch::surplus(Mission changed) const {
    changed.setup.reserve_soc_percent += margin_percent_;
    return surplus_percent(changed);
}

std::optional<double> LimitSearch::drawn_surplus(double value, Accuracy accuracy) {
    constexpr std::size_t rough_flights = 1250;
    try {
        const auto changed = mission(value);
        if (!probability_) return surplus_percent(changed);
        require_known_spread(changed.setup);
        const auto spreads = collect_uncertainty(changed.setup);
        if (accuracy == Accuracy::rough)
            return draw_landings(changed, spreads, rough_flights).spare_percent(*probability_);
        const auto landings = draw_landings_until_known(changed, spreads, *probability_);
        const double surplus = landings.spare_percent(*probability_);
        margins_percent_[value] = std::max(0.0, landings.nominal_spare_percent() - surplus);
        return surplus;
    } catch (const InputError& error) {
        misfit_ = error;
        return std::nullopt;
    }
}

double LimitSearch::find_with_margin(const std::function<double()>& find) {
    constexpr int rounds = 40;
    constexpr double close_fraction = 2e-4;  // of the flights' deviation
    if (!probability_) return find();
    MarginSearch search(0.0);
    std::optional<double> last;
    std::optional<NoResultError> none;
    std::optional<LandingDistribution> nearest;
    for (int round = 0; round < rounds && !search.has_converged(); ++round) {
        margin_percent_ = search.margin_percent();
        try {
            const double value = find();
            const auto found = mission(value);
            require_known_spread(found.setup);
            const auto landings = draw_landings_until_known(found, collect_uncertainty(found.setup), *probability_);
            if (!nearest || landings.below() < nearest->below()) nearest = landings;
            const double slack_percent = landings.spare_percent(*probability_);
            if (slack_percent < 0.0) search.raise_lower_bound(landings.nominal_spare_percent());
            search.add_result(slack_percent, 0.0);
            const bool is_close = std::abs(slack_percent) <= close_fraction * landings.sd_percent ||
                                  std::abs(landings.below() - (1.0 - *probability_)) <= landings.resolution();
            if (slack_percent >= 0.0 || is_close) {
                last = value;
                margins_percent_[value] = std::max(0.0, landings.nominal_spare_percent() - slack_percent);
            }
            if (is_close) break;
        } catch (const NoResultError& error) {
            none = error;
            search.mark_infeasible();
        }
    }
    if (last) return *last;
    if (!nearest) throw none.value_or(NoResultError("no answer lands with the reserve often enough"));
    throw NoResultError(fmt::format(
        "no answer lands with the reserve in {:.4g} % of flights: with the one that came nearest {:.3g} % do "
        "not (standard error {:.2g} %)",
        units::percentage(*probability_, 1.0), units::percentage(nearest->below(), 1.0),
        units::percentage(nearest->standard_error(), 1.0)));
}

FeasibilityLimit LimitSearch::limit(double value, double beyond) const {
    const auto at = mission(value);
    FeasibilityLimit most;
    most.value = value;
    most.margin_percent = probability_ ? margins_percent_.at(value) : 0.0;
    most.final_soc_percent = simulate(at).summary.final_soc_percent.value_or(0.0);
    most.residual_percent = most.final_soc_percent - most.margin_percent - at.setup.reserve_soc_percent;
    const auto further = simulate(mission(beyond)).summary;
    most.limited_by = further.undeliverable  ? LimitingFactor::power
                      : further.cut_off_at_s ? LimitingFactor::cut_off
                                             : LimitingFactor::charge;
    if (probability_) most.sources = collect_uncertainty(at.setup).sources;
    return most;
}

}  // namespace flightwatt::mission
