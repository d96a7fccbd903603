#include "report/sections/plan_section.h"

#include "base/units.h"
#include "report/figures/plan_figures.h"
#include "report/figures/qos_map.h"
#include "report/html.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

using Missions = std::span<const SimulatedMission>;

/// Until when what runs counts.
double powered_until_s(const mission::MissionSummary& summary) {
    double until_s = summary.duration_s;
    if (summary.depleted_at_s) until_s = std::min(until_s, *summary.depleted_at_s);
    if (summary.cut_off_at_s) until_s = std::min(until_s, *summary.cut_off_at_s);
    if (summary.undeliverable) until_s = std::min(until_s, summary.undeliverable->time_s);
    return until_s;
}

/// The missions with the planned one's flight, software and battery, by its utilities.
std::vector<UtilityPoint> utility_points(const SimulatedMission& planned, Missions missions) {
    std::vector<UtilityPoint> points;
    for (const auto& other : missions) {
        const auto& summary = other.simulation.summary;
        if (!have_same_map(planned.mission, other.mission) || !summary.final_soc_percent) continue;
        const auto utility = mean_utility(planned.mission, other.mission.schedule, powered_until_s(summary));
        if (!utility) continue;
        points.push_back({other.title, *summary.final_soc_percent, *utility, other.planned.has_value()});
    }
    return points;
}

std::string number_or_dash(const std::optional<double>& value, int decimals) {
    return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

/// How much more utility than the plan some schedule could have at most [%].
std::optional<double> gap_percent(const SimulatedMission& simulated) {
    const auto& planned = *simulated.planned;
    const auto& utility = simulated.simulation.summary.utility;
    if (!planned.feasible || !utility || planned.bound <= 0.0) return std::nullopt;
    return std::max(0.0, units::percent_of(planned.bound - *utility, planned.bound));
}

TextTable plans_table(Missions missions) {
    TextTable table{{"mission", "schedule", "utility", "proven bound", "gap [%]", "final SoC [%]",
                     "reserve [%]", "reserve kept"},
                    {}};
    for (const auto& simulated : missions) {
        if (!simulated.planned) continue;
        const auto& summary = simulated.simulation.summary;
        const auto& planned = *simulated.planned;
        table.rows.push_back(
            {simulated.title, to_string(summary.schedule), number_or_dash(summary.utility, 4),
             planned.feasible ? fmt::format("{:.4f}", planned.bound) : "-",
             number_or_dash(gap_percent(simulated), 4), number_or_dash(summary.final_soc_percent, 4),
             fmt::format("{:.4f}", summary.reserve_soc_percent), summary.keeps_reserve ? "yes" : "no"});
    }
    return table;
}

TextTable running_table(const mission::Mission& mission) {
    TextTable table{{"from [s]", "to [s]", "component", "runs", "power [W]"}, {}};
    for (const auto& running : running_times(mission)) {
        const auto& component = mission.compute.components[running.component];
        table.rows.push_back({fmt::format("{:.0f}", running.start_s), fmt::format("{:.0f}", running.end_s),
                              component.name, describe_qos(component, running.qos),
                              fmt::format("{:.2f}", power_w(component.profile, running.qos))});
    }
    return table;
}

TextTable utility_table(std::vector<UtilityPoint> points) {
    std::stable_sort(points.begin(), points.end(),
                     [](const UtilityPoint& a, const UtilityPoint& b) { return a.utility > b.utility; });
    TextTable table{{"mission", "schedule", "utility", "final SoC [%]"}, {}};
    for (const auto& point : points) {
        table.rows.push_back({point.mission, point.planned ? "planned" : "given",
                              fmt::format("{:.4f}", point.utility),
                              fmt::format("{:.4f}", point.soc_percent)});
    }
    return table;
}

void add_plan(Section& section, const SimulatedMission& planned, Missions missions, std::size_t number) {
    section.html += "<h3>" + escaped(planned.title) + "</h3>\n";
    if (!planned.planned->feasible) {
        section.html += paragraph(
            "No schedule that keeps the reserve was found: what is shown demands least energy. flightwatt plan "
            "tells what is short.",
            "warning");
    }
    if (planned.mission.compute.components.empty()) return;
    add_figure(section, strip_figure(planned, fmt::format("plan-{}-strip", number)));
    section.html += table_html(running_table(planned.mission), {"What the plan runs when", true, {}});
    const auto points = utility_points(planned, missions);
    if (points.size() > 1) {
        add_figure(section, utility_figure(planned, points, fmt::format("plan-{}-worth", number)));
        section.html += table_html(utility_table(points), {"Utility of the schedules", true, {}});
    }
}

}  // namespace

Section plan_section(Missions missions) {
    Section section{"plan", "Plan", "", {}};
    const bool any = std::any_of(missions.begin(), missions.end(),
                                 [](const SimulatedMission& mission) { return mission.planned.has_value(); });
    if (!any) return section;
    section.html += paragraph(
        "Missions without a schedule of their own are planned: most utility of what keeps the reserve. The "
        "bound is proven: no schedule in slots that keeps the reserve has more.");
    section.html += table_html(plans_table(missions), {"Planned missions", false, {}});
    std::size_t number = 0;
    for (const auto& simulated : missions) {
        if (simulated.planned) add_plan(section, simulated, missions, ++number);
    }
    return section;
}

}  // namespace flightwatt::report
