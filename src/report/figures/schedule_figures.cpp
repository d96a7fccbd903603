#include "compute/qos_range.h"
#include "report/figures/mission_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
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

namespace {

VegaJson point_rows(const std::vector<UtilityPoint>& points) {
    FigureData data({"soc_percent", "utility"}, {"mission", "kind"});
    for (const bool planned : {true, false}) {  // a planned one stands behind a given one that is as good
        for (const auto& point : points) {
            if (point.planned != planned) continue;
            data.add({point.soc_percent, point.utility}, {point.mission, planned ? "planned" : "given"});
        }
    }
    return data.json();
}

/// Points that a reader cannot tell apart share a name.
std::vector<UtilityPoint> named_together(const std::vector<UtilityPoint>& points) {
    constexpr double near_fraction = 0.02;  // of what the points span
    const auto span_of = [&](double UtilityPoint::*value) {
        const auto [low, high] = std::ranges::minmax_element(
            points, [&](const UtilityPoint& a, const UtilityPoint& b) { return a.*value < b.*value; });
        return (*high).*value - (*low).*value;
    };
    const double soc_span = span_of(&UtilityPoint::soc_percent);
    const double utility_span = span_of(&UtilityPoint::utility);
    std::vector<UtilityPoint> together;
    for (const auto& point : points) {
        const auto twin = std::ranges::find_if(together, [&](const UtilityPoint& other) {
            return std::abs(other.soc_percent - point.soc_percent) <= near_fraction * soc_span &&
                   std::abs(other.utility - point.utility) <= near_fraction * utility_span;
        });
        if (twin == together.end()) {
            together.push_back(point);
        } else {
            twin->mission += ", " + point.mission;
        }
    }
    return together;
}

/// Names to the right of their points, at the figure's right end to the left.
VegaJson name_rows(const std::vector<UtilityPoint>& points) {
    FigureData data({"soc_percent", "utility"}, {"mission", "side"});
    constexpr double right_end = 0.65;
    double max_percent = 0.0;
    for (const auto& point : points) max_percent = std::max(max_percent, point.soc_percent);
    for (const auto& point : named_together(points)) {
        data.add({point.soc_percent, point.utility},
                 {point.mission, point.soc_percent > right_end * max_percent ? "left" : "right"});
    }
    return data.json();
}

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

VegaJson phase_rows(const mission::Mission& mission) {
    FigureData data({"begin_s", "middle_s"}, {"phase"});
    const auto timeline = mission::timeline_of(mission.setup.duration_s);
    for (const auto phase : flight::all_phases) {
        if (mission.setup.duration_s[phase] <= 0.0) continue;
        data.add({timeline.start_s[phase], timeline.start_s[phase] + mission.setup.duration_s[phase] / 2.0},
                 {phase_word(phase)});
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

Figure utility_figure(const SimulatedMission& planned, const std::vector<UtilityPoint>& points, const std::string& id) {
    std::string description = "Utility over final state of charge.";
    for (const auto& point : points) {
        description += fmt::format(" {}: {:.4g} at {:.2f} %.", point.mission, point.utility, point.soc_percent);
    }
    auto figure =
        new_figure("utility", id,
                   "The utility of the schedules, by that of the planned mission, over what they leave. To the left "
                   "of the reserve a schedule spends what was to be kept; above the bound there is none that keeps it. "
                   "What runs after the battery's end counts nothing.",
                   description,
                   {{"reserve", planned.simulation.summary.reserve_soc_percent},
                    {"bound", planned.planned->bound},
                    {"points", point_rows(points)},
                    {"names", name_rows(points)}});
    if (!planned.planned->feasible) figure.spec["layer"].erase(1);  // the bound
    return figure;
}

Figure strip_figure(const SimulatedMission& planned, const std::string& id) {
    const auto& mission = planned.mission;
    auto description = fmt::format("What {} runs when.", planned.title);
    for (const auto& running : run_intervals(mission)) {
        const auto& component = mission.setup.compute.components[running.component];
        description += fmt::format(" {} {} from {:.0f} to {:.0f} s.", component.name,
                                   describe_qos(component, running.qos), running.start_s, running.end_s);
    }
    constexpr double min_part = 0.13;  // of the time: a shorter bar has no room for its words
    const double duration_s = mission::timeline_of(mission.setup.duration_s).duration_s;
    return new_figure("strip", id, "What runs when, coloured by its power; a component without a bar is off.",
                      description,
                      {{"bars", bar_rows(mission)},
                       {"phases", phase_rows(mission)},
                       {"duration_s", duration_s},
                       {"has_room", fmt::format("datum.long_s > {}", min_part * duration_s)}});
}

}  // namespace flightwatt::report
