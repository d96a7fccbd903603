#include "base/units.h"
#include "cli/output/mission_output.h"
#include "cli/output/replay_output.h"
#include "mechanical/table_one.h"
#include "mission/mission_summary.h"
#include "report/figures/mission_figures.h"
#include "report/sections/sections.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

using Missions = std::span<const SimulatedMission>;

/// The missions without those that are the same as an earlier one.
template <typename Same>
std::vector<const SimulatedMission*> first_of_each(Missions missions, const Same& same) {
    std::vector<const SimulatedMission*> firsts;
    for (const auto& simulated : missions) {
        if (std::ranges::none_of(firsts, [&](const SimulatedMission* first) {
                return same(first->mission.setup, simulated.mission.setup);
            })) {
            firsts.push_back(&simulated);
        }
    }
    return firsts;
}

/// What is drawn of a model: files of it may leave out its errors. Of a validated one without its power over time,
/// instead of which missions use another.
std::string drawn_text(mechanical::MechanicalModel model) {
    for (auto& phase : model.phases.values) {
        phase.errors.reset();
        phase.spread.reset();
        if (!model.validation) continue;
        phase.fourier = {};
        phase.open_frequency = phase.not_negative = false;
    }
    if (model.validation) model.flights.clear();
    return to_toml(model);
}

std::vector<Section> model_sections(Missions missions, const PublishedFigures& published,
                                    std::span<const mechanical::MechanicalModel> shown) {
    std::vector<Section> sections;
    for (const auto* simulated : first_of_each(missions, have_same_model)) {
        const auto& mechanical = simulated->mission.setup.mechanical;
        const auto is_this = [&](const auto& other) { return drawn_text(*mechanical) == drawn_text(other); };
        if (!mechanical || std::ranges::any_of(shown, is_this)) continue;
        ReportModel model{*mechanical, mechanical->validation ? "The missions' model, as they use it."
                                                              : "The missions' model, as their files name it."};
        model.table_one = table_one(*mechanical);
        sections.push_back(model_section(model, published, fmt::format("mission-model-{}", sections.size() + 1)));
    }
    return sections;
}

Section profile_section(Missions missions) {
    Section section{"computing", "Computing profile"};
    for (const auto* simulated : first_of_each(missions, have_same_software)) {
        const auto& compute = simulated->mission.setup.compute;
        if (compute.components.empty()) continue;
        add_figure(section, profile_figure(compute, fmt::format("profile-{}", section.figures.size() + 1)));
    }
    return section;
}

Section schedule_section(Missions missions, const PublishedFigures& published) {
    Section section{"schedules", "Schedules"};
    add_figure(section, schedule_figure(missions, published, "schedules-soc"));
    std::vector<std::string> failures;
    std::vector<std::string> sources;
    for (const auto& simulated : missions) {
        auto summary = simulated.simulation.summary;
        summary.mission = simulated.title;
        if (summary.undeliverable) failures.push_back(describe(summary));
        if (summary.samples)
            sources.push_back(fmt::format("{}: {}", simulated.title, describe(summary.samples->sources)));
    }
    section.html += table_html(ranking_table(missions), {"Missions ranked by final state of charge",
                                                         true,
                                                         {},
                                                         {"mechanical [Wh]", "computing [Wh]", "duration [s]",
                                                          "cut off at [s]", "empty at [s]", "energy [Wh]", "utility"}});
    section.html += paragraph(
        "Energies are what the whole mission demands, also where the battery is empty before its end. The "
        "chance is that of 1000 flights drawn a mission, 200 where a policy plans in flight, from what its models and its "
        "[uncertainty] say of how flights differ: 95 % intervals reach 3 percent points at most, or 7; \"-\": nothing "
        "says it.",
        "soft");
    if (!sources.empty()) section.html += "<div class=\"soft\">" + list_html(sources) + "</div>\n";
    if (!failures.empty()) section.html += "<div class=\"warning\">" + list_html(failures) + "</div>\n";
    return section;
}

std::string titles_of(Missions missions) {
    std::string titles;
    for (const auto& simulated : missions) titles += (titles.empty() ? "" : ", ") + simulated.title;
    return titles;
}

Section map_section(Missions missions, const PublishedFigures& published) {
    Section section{"quality-of-service", "Quality of service"};
    for (const auto* simulated : first_of_each(missions, have_same_map)) {
        const auto& mission = simulated->mission.setup;
        const auto map = qos_map(mission);
        if (!map) continue;
        std::vector<SimulatedMission> alike;
        std::ranges::copy_if(missions, std::back_inserter(alike),
                             [&](const auto& other) { return have_same_map(mission, other.mission.setup); });
        section.html +=
            fmt::format("<h3>{}: {}</h3>\n", mission.mechanical ? "Flight and computing" : "Computing alone",
                        html_escaped(titles_of(alike)));
        const bool is_published = !mission.mechanical;  // the paper's Fig. 4 is without the flight
        add_figure(section,
                   qos_map_figure(*map, alike, is_published ? published.soc_cells : std::vector<PublishedCell>{},
                                  fmt::format("quality-{}", section.figures.size() + 1)));
    }
    return section;
}

/// The missions with the planned one's flight, software and battery, by its utilities.
std::vector<UtilityPoint> utility_points(const SimulatedMission& planned, Missions missions) {
    std::vector<UtilityPoint> points;
    for (const auto& other : missions) {
        const auto& summary = other.simulation.summary;
        if (!have_same_map(planned.mission.setup, other.mission.setup) || !summary.final_soc_percent) continue;
        const auto utility = mean_utility(planned.mission.setup, other.mission.schedule, powered_end_s(summary));
        if (!utility) continue;
        points.push_back({other.title, *summary.final_soc_percent, *utility, other.planned.has_value()});
    }
    return points;
}

/// How much more utility than the plan some schedule could have at most [%].
std::optional<double> gap_percent(const SimulatedMission& simulated) {
    const auto& planned = *simulated.planned;
    const auto& utility = simulated.simulation.summary.utility;
    if (!planned.feasible || !utility || planned.bound <= 0.0) return std::nullopt;
    return std::max(0.0, units::percentage(planned.bound - *utility, planned.bound));
}

TextTable running_table(const mission::Mission& mission) {
    TextTable table{{"from [s]", "to [s]", "component", "runs", "power [W]"}, {}};
    for (const auto& running : run_intervals(mission)) {
        const auto& component = mission.setup.compute.components[running.component];
        table.rows.push_back({fixed(running.start_s, 0), fixed(running.end_s, 0), component.name,
                              describe_qos(component, running.qos), fixed(power_w(component.profile, running.qos), 2)});
    }
    return table;
}

TextTable utility_table(std::vector<UtilityPoint> points) {
    std::ranges::stable_sort(points,
                             [](const UtilityPoint& a, const UtilityPoint& b) { return a.utility > b.utility; });
    TextTable table{{"mission", "schedule", "utility", "final SoC [%]"}, {}};
    for (const auto& point : points) {
        table.rows.push_back(
            {point.mission, point.planned ? "planned" : "given", fixed(point.utility, 4), fixed(point.soc_percent, 4)});
    }
    return table;
}

void add_plan(Section& section, const SimulatedMission& planned, Missions missions, std::size_t number) {
    section.html += "<h3>" + html_escaped(planned.title) + "</h3>\n";
    if (!planned.planned->feasible) {
        section.html += paragraph(
            "No schedule that keeps the reserve was found: what is shown demands least energy. flightwatt plan "
            "tells what is short.",
            "warning");
    }
    if (planned.mission.setup.compute.components.empty()) return;
    add_figure(section, strip_figure(planned, fmt::format("plan-{}-strip", number)));
    section.html += table_html(running_table(planned.mission), {"What the plan runs when", true, {}});
    const auto points = utility_points(planned, missions);
    if (points.size() > 1) {
        add_figure(section, utility_figure(planned, points, fmt::format("plan-{}-utility", number)));
        section.html += table_html(utility_table(points), {"Utility of the schedules", true, {}});
    }
}

/// Utility over the charge left, a point a flight and schedule.
Figure replay_figure(const std::vector<const mission::Replay*>& replays, const std::string& id) {
    FigureData data({"soc", "utility"}, {"flight", "schedule"});
    auto description =
        fmt::format("{}: utility and final state of charge of each schedule on each flight.", replays.front()->mission);
    double reserve_percent = 0.0;
    for (const auto* replay : replays) {
        for (const auto& replayed : replay->schedules) {
            const auto& summary = replayed.summary;
            if (!summary.final_soc_percent || !summary.utility) continue;
            reserve_percent = summary.reserve_soc_percent;
            const auto way = to_string(replayed.way);
            data.add({*summary.final_soc_percent, *summary.utility}, {replay->flight, way});
            description += fmt::format(" {}, {}: {:.4g} at {:.2f} %.", replay->flight, way, *summary.utility,
                                       *summary.final_soc_percent);
        }
    }
    return new_figure("replay", id,
                      "Utility over final state of charge, by schedule and flight. To the left of the line the "
                      "reserve is not kept; what runs after the battery's end counts nothing.",
                      description, {{"points", data.json()}, {"reserve", reserve_percent}});
}

}  // namespace

TextTable plans_table(Missions missions) {
    TextTable table{
        {"mission", "schedule", "utility", "proven bound", "gap [%]", "final SoC [%]", "reserve [%]", "reserve kept"},
        {}};
    for (const auto& simulated : missions) {
        if (!simulated.planned) continue;
        const auto& summary = simulated.simulation.summary;
        const auto& planned = *simulated.planned;
        table.rows.push_back({simulated.title, to_string(summary.schedule), fixed(summary.utility, 4),
                              planned.feasible ? fixed(planned.bound, 4) : "-", fixed(gap_percent(simulated), 4),
                              fixed(summary.final_soc_percent, 4), fixed(summary.reserve_soc_percent, 4),
                              summary.keeps_reserve ? "yes" : "no"});
    }
    return table;
}

/// What people look for first stands to the left; columns that no mission has are left out.
TextTable ranking_table(Missions missions) {
    std::vector<mission::MissionSummary> summaries;
    for (const auto& simulated : missions) {
        summaries.push_back(simulated.simulation.summary);
        summaries.back().mission = simulated.title;
    }
    return table_of(cli::ranked_missions(ranked(std::move(summaries))));
}

Section plan_section(Missions missions) {
    Section section{"plan", "Plan"};
    const bool any =
        std::ranges::any_of(missions, [](const SimulatedMission& mission) { return mission.planned.has_value(); });
    if (!any) return section;
    section.html += paragraph(
        "Missions without a schedule of their own are planned: most utility of what keeps the reserve. The "
        "bound is proven: no schedule in slots that keeps the reserve has more.");
    section.html += table_html(plans_table(missions), {"Planned missions", false, {}});
    std::size_t number = 0;
    for (const auto& simulated : missions)
        if (simulated.planned) add_plan(section, simulated, missions, ++number);
    return section;
}

std::vector<Section> mission_sections(Missions missions, const PublishedFigures& published,
                                      std::span<const mechanical::MechanicalModel> shown) {
    auto sections = model_sections(missions, published, shown);
    for (auto& section : {profile_section(missions), schedule_section(missions, published),
                          map_section(missions, published), plan_section(missions)}) {
        if (!section.figures.empty()) sections.push_back(section);
    }
    return sections;
}

Section replay_section(std::span<const mission::Replay> replays) {
    Section section{"replay", "Replay"};
    section.html += paragraph(
        "The missions' schedules on the power that the flights measured. What is known before each flight is a model "
        "of the other flights alone; hindsight plans by what was measured, and regret is the utility that it has more.");
    std::vector<std::string> drawn;
    for (const auto& replay : replays) {
        if (replay.schedules.size() <= 2 || std::ranges::count(drawn, replay.mission) > 0) continue;
        drawn.push_back(replay.mission);
        std::vector<const mission::Replay*> of_mission;
        for (const auto& other : replays)
            if (other.mission == replay.mission) of_mission.push_back(&other);
        section.html += "<h3>" + html_escaped(replay.mission) + "</h3>\n";
        add_figure(section, replay_figure(of_mission, fmt::format("replay-{}", drawn.size())));
    }
    section.html += list_html(cli::replay_sentences(replays));
    add_table(section, {cli::replay_table(replays), "What each schedule came to on each flight", "tab:replay"}, true);
    add_table(section, {cli::replay_basis_table(replays), "What the replays rest on", "tab:replay-basis"}, true);
    std::vector<std::string> notes;
    for (const auto& replay : replays)
        for (const auto& note : replay.notes)
            notes.push_back(fmt::format("{}, {}: {}", replay.flight, replay.mission, note));
    notes.push_back(cli::replay_remark());
    section.html += "<div class=\"soft\">" + list_html(notes) + "</div>\n";
    return section;
}

}  // namespace flightwatt::report
