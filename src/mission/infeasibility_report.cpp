#include "mission/infeasibility_report.h"

#include "base/units.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

std::optional<double> cruise_that_lands(const MissionOfCruise& mission_of, double margin_percent) {
    const auto with_margin = [&](double cruise_s) {
        auto mission = mission_of(cruise_s);
        mission.reserve_soc_percent += margin_percent;
        return mission;
    };
    try {
        return longest_cruise(with_margin).value;
    } catch (const NoAnswerError&) {
        return std::nullopt;
    }
}

std::optional<double> spare_without_fixed(Mission mission, double margin_percent) {
    if (mission.schedule.empty()) return std::nullopt;
    mission.schedule.clear();
    const double spare = spare_percent(with_least_schedule(mission)) - margin_percent;
    if (spare < 0.0) return std::nullopt;
    return spare;
}

}  // namespace

Shortfall shortfall_of(const Mission& mission, const MissionPlan& plan, const MissionOfCruise& mission_of) {
    Shortfall shortfall;
    const double wanted = mission.reserve_soc_percent + plan.margin_percent;
    const double least_drain = mission.initial_soc_percent - plan.plan.final_soc_percent;
    shortfall.short_percent = wanted - plan.plan.final_soc_percent;
    shortfall.short_wh = units::part_of(full_energy_wh(mission.battery), shortfall.short_percent);
    shortfall.cut_off_at_s = plan.summary.cut_off_at_s;
    shortfall.cruise_s = cruise_that_lands(mission_of, plan.margin_percent);
    shortfall.fixed_spare_percent = spare_without_fixed(mission, plan.margin_percent);
    const double possible = plan.plan.final_soc_percent - plan.margin_percent;
    if (possible >= 0.0 && plan.summary.feasible) shortfall.reserve_soc_percent = possible;
    if (mission.battery.thevenin || mission.cutoff_voltage_v > 0.0) {
        auto with_margin = mission;
        with_margin.reserve_soc_percent = wanted;
        shortfall.capacity_ah = least_capacity_ah(with_margin);
        return shortfall;
    }
    // Drain and margin are parts of the capacity; the reserve stays what it is.
    const double usable = mission.initial_soc_percent - mission.reserve_soc_percent;
    if (usable > 0.0) {
        shortfall.capacity_ah = mission.battery.capacity_ah * (least_drain + plan.margin_percent) / usable;
    }
    return shortfall;
}

std::string describe(const Mission& mission, const Shortfall& shortfall) {
    std::vector<std::string> remedies;
    if (shortfall.cruise_s) {
        remedies.push_back(fmt::format("a cruise {:.1f} s shorter ({:.1f} s)",
                                       mission.duration_s[flight::Phase::cruise] - *shortfall.cruise_s,
                                       *shortfall.cruise_s));
    }
    if (shortfall.fixed_spare_percent) {
        remedies.push_back(
            fmt::format("lower quality where it is fixed (the least leaves {:.2f} points to spare)",
                        *shortfall.fixed_spare_percent));
    }
    if (shortfall.reserve_soc_percent) {
        remedies.push_back(fmt::format("a reserve of at most {:.2f} %", *shortfall.reserve_soc_percent));
    }
    if (shortfall.capacity_ah) {
        remedies.push_back(fmt::format("a battery of {:.3f} Ah instead of {:.3f} Ah", *shortfall.capacity_ah,
                                       mission.battery.capacity_ah));
    }
    auto text = fmt::format(
        "no schedule lands with the reserve: the one that drains least is {}short by {:.2f} points "
        "({:.3f} Wh)",
        shortfall.cut_off_at_s ? fmt::format("cut off at {:.1f} s, ", *shortfall.cut_off_at_s) : "",
        shortfall.short_percent, shortfall.short_wh);
    if (!remedies.empty()) text += fmt::format("; any one of these would do: {}", fmt::join(remedies, ", "));
    return text;
}

}  // namespace flightwatt::mission
