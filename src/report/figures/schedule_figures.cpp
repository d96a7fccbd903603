#include "report/figures/mission_figures.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

using Missions = std::span<const SimulatedMission>;

/// A bar for each segment of a schedule.
VegaJson strip_rows(Missions missions) {
    FigureData data({"start_s", "end_s", "compute_w"}, {"mission", "phase", "runs"});
    for (const auto& simulated : missions) {
        const auto& mission = simulated.mission;
        const auto timeline = mission::timeline_of(mission.setup.duration_s);
        for (const auto& segment : mission.schedule) {
            const double start_s = timeline.start_s[segment.phase];
            data.add({start_s + segment.start_s, start_s + segment.end_s, power_w(mission.setup.compute, segment.run)},
                     {simulated.title, phase_word(segment.phase), describe(mission.setup.compute, segment.run)});
        }
    }
    return data.json();
}

}  // namespace

Figure schedule_figure(Missions missions, const VegaJson& data, const std::string& id) {
    const auto& phases = data.front()["phases"];
    const bool are_common =
        std::ranges::all_of(data, [&](const VegaJson& mission) { return mission["phases"] == phases; });
    double end_s = 0.0;
    auto titles = VegaJson::array();
    auto shown = VegaJson::array();
    std::string description = "State of charge over the mission.";
    bool has_software = false;
    for (const auto& mission : missions) {
        end_s = std::max(end_s, mission.simulation.summary.duration_s);
        titles.push_back(mission.title);
        shown.push_back({{"title", mission.title}});
        description += fmt::format(" {}.", describe(mission.simulation.summary));
        has_software = has_software || !mission.mission.setup.compute.components.empty();
    }
    std::string caption =
        "A click on the legend hides a mission. Shaded, where uncertainty is known: 5 to 95 % of the drawn flights. "
        "Dashed horizontal lines: the reserve.";
    if (has_software) caption += " Below: the schedules, coloured by their power.";
    auto figure = new_figure("schedule", id, caption, description,
                             {{"end_s", end_s},
                              {"titles", titles},
                              {"shown", shown},
                              {"missions", data},
                              {"phases", are_common ? VegaJson{{"values", phases}} : VegaJson()},
                              {"strip", strip_rows(missions)}});
    if (!has_software) figure.spec["vconcat"].erase(1);
    return figure;
}

}  // namespace flightwatt::report
