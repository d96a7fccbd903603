#include "compute/qos_range.h"
#include "report/figures/mission_figures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace flightwatt::report {
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
