#include "report/sections/missions_section.h"

#include "cli/output/mission_output.h"
#include "cli/output/replay_output.h"
#include "mechanical/table_one.h"
#include "mission/mission_summary.h"
#include "report/figures/mission_figures.h"
#include "report/sections/model_section.h"
#include "report/sections/page_data.h"
#include "report/sections/summary_section.h"

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

std::vector<Section> model_sections(Missions missions, std::span<const mechanical::MechanicalModel> shown) {
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
        sections.push_back(model_section(model, fmt::format("mission-model-{}", sections.size() + 1)));
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

Section schedule_section(Missions missions) {
    Section section{"schedules", "Schedules, and what differs between drawn flights"};
    add_figure(section, schedule_figure(missions, missions_data(missions), "schedules-soc"));
    std::vector<mission::MissionSummary> summaries;
    std::vector<std::pair<std::string, std::string>> sources;  ///< drawn quantities, and their missions
    for (const auto& simulated : missions) {
        const auto& summary = summaries.emplace_back(simulated.simulation.summary);
        if (!summary.samples) continue;
        const auto text = describe(summary.samples->sources);
        const auto same = std::ranges::find(sources, text, &std::pair<std::string, std::string>::first);
        if (same == sources.end())
            sources.emplace_back(text, simulated.title);
        else
            same->second += ", " + simulated.title;
    }
    const auto ranking = cli::ranked_missions(ranked(std::move(summaries)));
    add_table(section, {table_of(ranking), "Missions by final state of charge", "tab:missions"}, {.sortable = true});
    section.html += paragraph(
        "Energies are the demand of the whole mission, also where the battery is empty before its end. Probabilities "
        "are of 1000 flights drawn from the uncertainty of the models and of [uncertainty], 200 for a policy that "
        "plans in flight: 95 % intervals of at most 3 or 7 percent points; \"-\": no uncertainty is known.",
        "soft");
    std::vector<std::string> drawn;
    drawn.reserve(sources.size());
    for (const auto& [text, titles] : sources) drawn.push_back(fmt::format("{}: {}", titles, text));
    section.html += list_html(drawn, "soft");
    return section;
}

/// A grid of buttons for each flight, with the curve of the one that is selected; Fig. 4 as a file.
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
        section.figures.push_back(qos_map_figure(*qos_map(setup), id));
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

}  // namespace

std::vector<Section> mission_sections(Missions missions, std::span<const mechanical::MechanicalModel> shown) {
    auto sections = model_sections(missions, shown);
    for (auto& section : {profile_section(missions), schedule_section(missions)})
        if (!section.figures.empty()) sections.push_back(section);
    for (auto& section : sections) section.place = SectionPlace::folded;
    if (auto quality = quality_section(missions); !quality.html.empty())
        sections.insert(sections.begin(), std::move(quality));
    if (missions.size() > 1) sections.insert(sections.begin(), curves_section(missions));
    return sections;
}

Section packs_section(std::span<const mission::PackFlights> missions) {
    Section section{"packs", "Several packs"};
    for (const auto& all : missions) {
        section.html += paragraph(describe(all) + ".");
        add_table(section, {table_of(all.flights), "Flights of " + all.setup.name, "tab:packs"});
    }
    return section;
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
