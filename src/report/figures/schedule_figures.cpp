#include "compute/qos_range.h"
#include "report/figures/mission_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

using Missions = std::span<const SimulatedMission>;

VegaJson curve_rows(Missions missions) {
    FigureData data({"time_s", "soc_percent", "power_w"}, {"mission", "phase"});
    for (const auto& mission : missions)
        for (const auto& row : mission.simulation.curve.rows)
            data.add({row.time_s, row.soc_percent, row.power_w}, {mission.title, phase_word(row.phase)});
    return data.json();
}

VegaJson published_rows(Missions missions, const PublishedFigures& published) {
    FigureData data({"time_s", "soc_percent"}, {"mission"});
    for (const auto& mission : missions) {
        const auto found = published.soc.find(mission.mission.setup.name);
        if (found == published.soc.end()) continue;
        const auto& [time_s, soc_percent] = found->second;
        for (std::size_t i = 0; i < time_s.size(); ++i) data.add({time_s[i], soc_percent[i]}, {mission.title});
    }
    return data.empty() ? VegaJson() : data.json();
}

/// Range of 5 to 95 % of the drawn flights.
VegaJson band_rows(Missions missions) {
    FigureData data({"time_s", "p05_percent", "p95_percent"}, {"mission"});
    for (const auto& mission : missions) {
        const auto& samples = mission.simulation.summary.samples;
        if (!samples) continue;
        for (const auto& band : samples->bands)
            data.add({band.time_s, band.p05_percent, band.p95_percent}, {mission.title});
    }
    return data.empty() ? VegaJson() : data.json();
}

/// The missions' reserves, each once.
VegaJson reserve_rows(Missions missions) {
    std::set<double> reserves;
    for (const auto& mission : missions) reserves.insert(mission.simulation.summary.reserve_soc_percent);
    reserves.erase(0.0);
    FigureData data({"reserve_percent"});
    for (const double reserve_percent : reserves) data.add({reserve_percent});
    return data.empty() ? VegaJson() : data.json();
}

VegaJson phase_rows(const mission::Mission& mission) {
    FigureData data({"start_s", "end_s", "middle_s"}, {"word"});
    const auto timeline = mission::timeline_of(mission.setup.duration_s);
    for (const auto phase : flight::all_phases) {
        if (mission.setup.duration_s[phase] <= 0.0) continue;
        data.add({timeline.start_s[phase], timeline.end_s[phase],
                  std::midpoint(timeline.start_s[phase], timeline.end_s[phase])},
                 {phase_word(phase)});
    }
    return data.json();
}

/// The phases, if all missions have the same.
VegaJson common_phase_rows(Missions missions) {
    const auto& first = missions.front().mission;
    const bool are_equal = std::ranges::all_of(missions, [&](const auto& other) {
        return other.mission.setup.duration_s.values == first.setup.duration_s.values;
    });
    return are_equal ? phase_rows(first) : VegaJson();
}

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

Figure schedule_figure(Missions missions, const PublishedFigures& published, const std::string& id) {
    double end_s = 0.0;
    auto titles = VegaJson::array();
    auto shown = VegaJson::array();
    std::string description = "State of charge over the mission.";
    for (const auto& mission : missions) {
        end_s = std::max(end_s, mission.simulation.summary.duration_s);
        titles.push_back(mission.title);
        shown.push_back({{"mission", mission.title}});
        description += fmt::format(" {}.", describe(mission.simulation.summary));
    }
    const auto bands = band_rows(missions);
    const auto reserves = reserve_rows(missions);
    const auto points = published_rows(missions, published);
    const bool has_software = std::ranges::any_of(
        missions, [](const auto& mission) { return !mission.mission.setup.compute.components.empty(); });
    std::string caption = "A click on the legend hides a mission.";
    if (has_software) caption += " Below: the schedules, coloured by their power.";
    if (!bands.is_null()) caption += " Shaded: 5 to 95 % of the drawn flights.";
    if (!reserves.is_null()) caption += " Dashed horizontal lines: the reserve.";
    if (!points.is_null()) caption += " Points: the paper's Fig. 3, digitised.";
    auto figure = new_figure("schedule", id, caption, description,
                             {{"end_s", end_s},
                              {"missions", titles},
                              {"shown", shown},
                              {"phases", common_phase_rows(missions)},
                              {"bands", bands},
                              {"reserves", reserves},
                              {"curves", curve_rows(missions)},
                              {"published", points},
                              {"strip", strip_rows(missions)}});
    if (!has_software) figure.spec["vconcat"].erase(1);
    return figure;
}

namespace {

VegaJson bar_rows(const mission::Mission& mission) {
    FigureData data({"from_s", "to_s", "middle_s", "power_w", "long_s"}, {"component", "runs"});
    for (const auto& running : run_intervals(mission)) {
        const auto& component = mission.setup.compute.components[running.component];
        data.add({running.start_s, running.end_s, std::midpoint(running.start_s, running.end_s),
                  power_w(component.profile, running.qos), running.end_s - running.start_s},
                 {component.name, describe_qos(component, running.qos)});
    }
    return data.json();
}

}  // namespace

std::vector<RunInterval> run_intervals(const mission::Mission& mission) {
    const auto timeline = mission::timeline_of(mission.setup.duration_s);
    std::vector<RunInterval> times;
    std::map<std::size_t, std::size_t> last;  // of each component, its index in `times`
    for (const auto& segment : mission.schedule) {
        const double start_s = timeline.start_s[segment.phase] + segment.start_s;
        const double end_s = timeline.start_s[segment.phase] + segment.end_s;
        for (const auto& run : segment.run) {
            const auto before = last.find(run.component);
            if (before != last.end() && times[before->second].qos == run.qos &&
                start_s - times[before->second].end_s < mission::same_time_tolerance_s(end_s)) {
                times[before->second].end_s = end_s;
                continue;
            }
            last[run.component] = times.size();
            times.push_back({{start_s, end_s}, run.component, run.qos});
        }
    }
    return times;
}

std::string describe_qos(const compute::Component& component, const std::vector<double>& qos) {
    return qos.empty() ? "on" : compute::format_qos(component.profile.parameters, qos, " ", ", ");
}

Figure strip_figure(const SimulatedMission& planned, const std::string& id) {
    const auto& mission = planned.mission;
    auto description = fmt::format("Schedule of {}.", planned.title);
    for (const auto& running : run_intervals(mission)) {
        const auto& component = mission.setup.compute.components[running.component];
        description += fmt::format(" {} {} from {:.0f} to {:.0f} s.", component.name,
                                   describe_qos(component, running.qos), running.start_s, running.end_s);
    }
    constexpr double min_fraction = 0.13;  // of the time: a shorter bar has no room for text
    const double duration_s = mission::timeline_of(mission.setup.duration_s).duration_s;
    return new_figure("strip", id, "The schedule, coloured by power; a component without a bar is off.", description,
                      {{"bars", bar_rows(mission)},
                       {"phases", phase_rows(mission)},
                       {"duration_s", duration_s},
                       {"has_room", fmt::format("datum.long_s > {}", min_fraction * duration_s)}});
}

}  // namespace flightwatt::report
