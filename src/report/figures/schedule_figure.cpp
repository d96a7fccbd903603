#include "report/figures/mission_figures.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

using Missions = std::span<const SimulatedMission>;

VegaJson curve_rows(Missions missions) {
    FigureData data({"time_s", "soc_percent", "power_w", "mission_number"}, {"phase"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        for (const auto& row : missions[m].simulation.curve.rows) {
            data.add({row.time_s, row.soc_percent, row.power_w, static_cast<double>(m)}, {phase_word(row.phase)});
        }
    }
    return data.json();
}

/// The missions' titles, once: rows of curves have only their numbers.
FigureData title_rows(Missions missions) {
    FigureData data({"mission_number"}, {"mission"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        data.add({static_cast<double>(m)}, {missions[m].title});
    }
    return data;
}

VegaJson title_list(Missions missions) {
    auto titles = VegaJson::array();
    for (const auto& mission : missions) titles.push_back(mission.title);
    return titles;
}

/// Dashes tell apart what colours may not: of missions that share a colour, and in print.
VegaJson dashes_of(Missions missions) {
    const VegaJson patterns{{1, 0}, {7, 3}, {2, 2}, {9, 2, 2, 2}, {4, 1}};
    auto range = VegaJson::array();
    for (std::size_t m = 0; m < missions.size(); ++m) range.push_back(patterns[m % patterns.size()]);
    return range;
}

VegaJson published_rows(Missions missions, const PublishedFigures& published) {
    FigureData data({"time_s", "soc_percent", "mission_number"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        const auto found = published.soc.find(missions[m].mission.setup.name);
        if (found == published.soc.end()) continue;
        const auto& [time_s, soc_percent] = found->second;
        for (std::size_t i = 0; i < time_s.size(); ++i) data.add({time_s[i], soc_percent[i], static_cast<double>(m)});
    }
    return data.empty() ? VegaJson() : data.json();
}

/// Where 5 to 95 % of the flights that were drawn are.
VegaJson band_rows(Missions missions) {
    FigureData data({"time_s", "p05_percent", "p95_percent", "mission_number"});
    for (std::size_t m = 0; m < missions.size(); ++m) {
        const auto& samples = missions[m].simulation.summary.samples;
        if (!samples) continue;
        for (const auto& band : samples->bands)
            data.add({band.time_s, band.p05_percent, band.p95_percent, static_cast<double>(m)});
    }
    return data.empty() ? VegaJson() : data.json();
}

/// The reserves that the missions ask for, each once.
VegaJson reserve_rows(Missions missions) {
    FigureData data({"reserve_percent"});
    std::vector<double> drawn;
    for (const auto& simulated : missions) {
        const double reserve_percent = simulated.simulation.summary.reserve_soc_percent;
        if (reserve_percent <= 0.0 || std::ranges::count(drawn, reserve_percent) > 0) continue;
        drawn.push_back(reserve_percent);
        data.add({reserve_percent});
    }
    return data.empty() ? VegaJson() : data.json();
}

/// The phases, where all missions have the same.
VegaJson phase_rows(Missions missions) {
    const auto& durations_s = missions.front().mission.setup.duration_s;
    const bool all_alike = std::ranges::all_of(
        missions, [&](const auto& other) { return other.mission.setup.duration_s.values == durations_s.values; });
    if (!all_alike) return nullptr;
    FigureData data({"start_s", "end_s", "middle_s"}, {"word"});
    const auto timeline = mission::timeline_of(durations_s);
    for (const auto phase : flight::all_phases) {
        const double start_s = timeline.start_s[phase];
        const double end_s = timeline.end_s[phase];
        data.add({start_s, end_s, std::midpoint(start_s, end_s)}, {phase_word(phase)});
    }
    return data.json();
}

/// A bar a segment: when a mission runs which configuration.
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

std::string schedules_described(Missions missions) {
    std::string text = "State of charge over the mission.";
    for (const auto& mission : missions) {
        text += fmt::format(" {}.", describe(mission.simulation.summary));
    }
    return text;
}

}  // namespace

Figure schedule_figure(Missions missions, const PublishedFigures& published, const std::string& id) {
    double end_s = 0.0;
    auto shown = VegaJson::array();
    for (const auto& mission : missions) {
        end_s = std::max(end_s, mission.simulation.summary.duration_s);
        shown.push_back({{"mission", mission.title}});
    }
    const auto bands = band_rows(missions);
    const auto reserves = reserve_rows(missions);
    const auto points = published_rows(missions, published);
    std::string caption =
        "A click on the legend hides a mission. Below: what each schedule runs when, coloured by its power.";
    if (!bands.is_null()) caption += " Shaded: 5 to 95 % of the flights drawn.";
    if (!reserves.is_null()) caption += " Level dashes: the reserve.";
    if (!points.is_null()) caption += " Points: the paper's Fig. 3, digitised.";
    return new_figure("schedule", id, caption, schedules_described(missions),
                      {{"end_s", end_s},
                       {"missions", title_list(missions)},
                       {"shown", shown},
                       {"titles", title_rows(missions).csv()},
                       {"dashes", dashes_of(missions)},
                       {"phases", phase_rows(missions)},
                       {"bands", bands},
                       {"reserves", reserves},
                       {"curves", curve_rows(missions)},
                       {"published", points},
                       {"strip", strip_rows(missions)}});
}

}  // namespace flightwatt::report
