#include "base/units.h"
#include "cli/output/mission_output.h"
#include "cli/output/replay_output.h"
#include "mechanical/table_one.h"
#include "mission/mission_summary.h"
#include "report/figures/mission_figures.h"
#include "report/sections/page_data.h"
#include "report/sections/sections.h"

#include <algorithm>
#include <iterator>
#include <set>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

using Missions = std::span<const SimulatedMission>;

/// The first mission of each key.
std::vector<const SimulatedMission*> first_of_each(Missions missions,
                                                   std::string (*key)(const mission::MissionSetup&)) {
    std::vector<const SimulatedMission*> firsts;
    std::set<std::string> keys;
    for (const auto& simulated : missions)
        if (keys.insert(key(simulated.mission.setup)).second) firsts.push_back(&simulated);
    return firsts;
}

std::vector<Section> model_sections(Missions missions, const PublishedFigures& published,
                                    std::span<const mechanical::MechanicalModel> shown) {
    std::vector<Section> sections;
    for (const auto* simulated : first_of_each(missions, model_key)) {
        const auto& mechanical = simulated->mission.setup.mechanical;
        const auto is_this = [&](const auto& other) {  // the batch has its errors, a mission may use its means alone
            return other.name == mechanical->name && std::ranges::all_of(flight::all_phases, [&](auto phase) {
                       return other.phases[phase].duration_s == mechanical->phases[phase].duration_s;
                   });
        };
        if (!mechanical || std::ranges::any_of(shown, is_this)) continue;
        ReportModel model{*mechanical, "The missions' model."};
        model.table_one = table_one(*mechanical);
        sections.push_back(model_section(model, published, fmt::format("mission-model-{}", sections.size() + 1)));
    }
    return sections;
}

Section profile_section(Missions missions) {
    Section section{"computing", "Computing profile"};
    for (const auto* simulated : first_of_each(missions, software_key)) {
        const auto& compute = simulated->mission.setup.compute;
        if (compute.components.empty()) continue;
        add_figure(section, profile_figure(compute, fmt::format("profile-{}", section.figures.size() + 1)));
    }
    return section;
}

/// Without columns that no mission has.
TextTable ranking_table(Missions missions) {
    std::vector<mission::MissionSummary> summaries;
    for (const auto& simulated : missions) {
        summaries.push_back(simulated.simulation.summary);
        summaries.back().mission = simulated.title;
    }
    return table_of(cli::ranked_missions(ranked(std::move(summaries))));
}

Section schedule_section(Missions missions, const PublishedFigures& published) {
    Section section{"schedules", "Schedules, and what differs between drawn flights"};
    add_figure(section, schedule_figure(missions, published, "schedules-soc"));
    std::vector<std::string> failures;
    std::vector<std::pair<std::string, std::string>> sources;  ///< what is drawn, and the missions of which
    for (const auto& simulated : missions) {
        auto summary = simulated.simulation.summary;
        summary.mission = simulated.title;
        if (summary.undeliverable) failures.push_back(describe(summary));
        if (!summary.samples) continue;
        const auto text = describe(summary.samples->sources);
        const auto same = std::ranges::find(sources, text, &std::pair<std::string, std::string>::first);
        if (same == sources.end())
            sources.emplace_back(text, simulated.title);
        else
            same->second += ", " + simulated.title;
    }
    add_table(section, {ranking_table(missions), "Missions by final state of charge", "tab:missions"},
              {.sortable = true});
    section.html += paragraph(
        "Energies are the demand of the whole mission, also where the battery is empty before its end. Probabilities "
        "are of 1000 flights drawn from the uncertainty of the models and of [uncertainty], 200 for a policy that "
        "plans in flight: 95 % intervals of at most 3 or 7 percent points; \"-\": no uncertainty is known.",
        "soft");
    std::vector<std::string> drawn;
    drawn.reserve(sources.size());
    for (const auto& [text, titles] : sources) drawn.push_back(fmt::format("{}: {}", titles, text));
    section.html += list_html(failures, "warning") + list_html(drawn, "soft");
    return section;
}

/// A grid of buttons for each flight, with the curve of the one that is selected.
Section quality_section(Missions missions) {
    Section section{"quality-of-service", "Quality of service"};
    std::size_t number = 0;
    for (const auto* simulated : first_of_each(missions, map_key)) {
        const auto& setup = simulated->mission.setup;
        const auto grid = qos_grid(setup);
        if (!grid) continue;
        std::vector<std::size_t> same;
        for (std::size_t i = 0; i < missions.size(); ++i)
            if (map_key(missions[i].mission.setup) == map_key(setup)) same.push_back(i);
        const auto id = fmt::format("quality-{}", ++number);
        section.html += heading(setup.mechanical ? "Flight and software" : "Software alone");
        section.html += fmt::format(
            "<div class=\"quality\"><div class=\"card drawn\" data-draw=\"grid\" data-from=\"{0}\"></div>\n<div "
            "class=\"card drawn\" data-draw=\"cell\" data-from=\"{0}\" aria-live=\"polite\"></div></div>\n{1}",
            id, data_block(id, quality_data(*grid, same, setup.reserve_soc_percent)));
    }
    if (section.html.empty()) return section;
    section.html =
        paragraph(
            "Charge at landing with one setting of the software throughout, and how probably it keeps the "
            "reserve (200 drawn flights a cell). Orange lands below the reserve, blue above. Select a cell to "
            "see its flight.",
            "soft") +
        section.html;
    return section;
}

Section map_section(Missions missions, const PublishedFigures& published) {
    Section section{"quality-figures", "Quality of service, as the paper's Fig. 4"};
    for (const auto* simulated : first_of_each(missions, map_key)) {
        const auto& mission = simulated->mission.setup;
        const auto map = qos_map(mission);
        if (!map) continue;
        std::vector<SimulatedMission> same;
        std::vector<std::string> titles;
        for (const auto& other : missions) {
            if (map_key(mission) != map_key(other.mission.setup)) continue;
            same.push_back(other);
            titles.push_back(other.title);
        }
        section.html += heading(fmt::format("{}: {}", mission.mechanical ? "Flight and computing" : "Computing alone",
                                            fmt::join(titles, ", ")));
        const bool is_published = !mission.mechanical;  // the paper's Fig. 4 is without the flight
        add_figure(section,
                   qos_map_figure(*map, same, is_published ? published.soc_cells : std::vector<PublishedCell>{},
                                  fmt::format("quality-{}", section.figures.size() + 1)));
    }
    return section;
}

/// Upper bound of the utility that the plan misses [%].
std::optional<double> gap_percent(const SimulatedMission& simulated) {
    const auto& planned = *simulated.planned;
    const auto& utility = simulated.simulation.summary.utility;
    if (!planned.feasible || !utility || planned.bound <= 0.0) return std::nullopt;
    return std::max(0.0, units::percentage(planned.bound - *utility, planned.bound));
}

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

void add_plan(Section& section, const SimulatedMission& planned, std::size_t number) {
    section.html += heading(planned.title);
    if (!planned.planned->feasible)
        section.html += paragraph(
            "No schedule that keeps the reserve was found: this one needs the least energy. flightwatt plan has the "
            "limiting factor.",
            "warning");
    if (!planned.mission.setup.compute.components.empty())
        add_figure(section, strip_figure(planned, fmt::format("plan-{}-strip", number)));
}

}  // namespace

Section plan_section(Missions missions) {
    Section section{"plan", "Plan"};
    const auto plans = plans_table(missions);
    if (plans.rows.empty()) return section;
    section.html += paragraph(
        "Missions without a schedule are planned for maximum utility within the reserve. No schedule in slots that "
        "keeps the reserve exceeds the proven bound.");
    add_table(section, {plans, "Planned missions", "tab:plans"});
    std::size_t number = 0;
    for (const auto& simulated : missions)
        if (simulated.planned) add_plan(section, simulated, ++number);
    return section;
}

std::vector<Section> mission_sections(Missions missions, const PublishedFigures& published,
                                      std::span<const mechanical::MechanicalModel> shown) {
    auto sections = model_sections(missions, published, shown);
    for (auto& section : {profile_section(missions), schedule_section(missions, published),
                          map_section(missions, published), plan_section(missions)}) {
        if (!section.figures.empty()) sections.push_back(section);
    }
    for (auto& section : sections) section.place = SectionPlace::folded;
    if (auto quality = quality_section(missions); !quality.html.empty())
        sections.insert(sections.begin(), std::move(quality));
    if (missions.size() > 1) sections.insert(sections.begin(), curves_section(missions));
    return sections;
}

Section replay_section(std::span<const mission::Replay> replays) {
    Section section{"replay", "Replay"};
    section.html += paragraph(
        "The missions' schedules on the measured power of the flights. Plans use a model of the other flights; "
        "hindsight plans with the measured power, and regret is its surplus of utility.");
    section.html += list_html(cli::replay_sentences(replays));
    add_table(section, {cli::replay_table(replays), "Results of each schedule on each flight", "tab:replay"},
              {.sortable = true});
    add_table(section, {cli::replay_basis_table(replays), "Models of the replays", "tab:replay-basis"},
              {.sortable = true});
    std::vector<std::string> notes;
    for (const auto& replay : replays)
        for (const auto& note : replay.notes)
            notes.push_back(fmt::format("{}, {}: {}", replay.flight, replay.mission, note));
    notes.push_back(cli::replay_remark());
    section.html += list_html(notes, "soft");
    return section;
}

}  // namespace flightwatt::report
