#include "report/missions_section.h"

#include "mechanical/table_one.h"
#include "mission/mission_summary.h"
#include "report/figures/profile_figure.h"
#include "report/figures/qos_map_figure.h"
#include "report/figures/schedule_figure.h"
#include "report/html.h"
#include "report/model_section.h"
#include "report/sections/plan_section.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

using Missions = std::span<const SimulatedMission>;

std::vector<Section> model_sections(Missions missions, const PublishedFigures& published) {
    std::vector<Section> sections;
    std::vector<std::string> seen;
    for (const auto& simulated : missions) {
        const auto& mission = simulated.mission;
        if (!mission.mechanical) continue;
        const auto text = to_toml(*mission.mechanical);
        if (std::find(seen.begin(), seen.end(), text) != seen.end()) continue;
        seen.push_back(text);
        ReportModel model{*mission.mechanical, "The missions' model, as their files name it."};
        model.table_one = table_one(*mission.mechanical);
        sections.push_back(model_section(model, published, fmt::format("mission-model-{}", seen.size())));
    }
    return sections;
}

bool same_software(const compute::ComputeModel& a, const compute::ComputeModel& b) {
    return std::equal(a.components.begin(), a.components.end(), b.components.begin(), b.components.end(),
                      [](const compute::Component& one, const compute::Component& other) {
                          return one.name == other.name && one.profile.axes == other.profile.axes &&
                                 one.profile.power_w == other.profile.power_w;
                      });
}

Section profile_section(Missions missions) {
    Section section{"computing", "Computing profile", "", {}};
    std::vector<const compute::ComputeModel*> seen;
    for (const auto& simulated : missions) {
        const auto& compute = simulated.mission.compute;
        const bool known = std::any_of(seen.begin(), seen.end(), [&](const compute::ComputeModel* other) {
            return same_software(*other, compute);
        });
        if (compute.components.empty() || known) continue;
        seen.push_back(&compute);
        add_figure(section, profile_figure(compute, fmt::format("profile-{}", seen.size())));
    }
    return section;
}

/// The ranking with its columns named for people.
TextTable ranking_of(std::vector<mission::MissionSummary> summaries) {
    static const std::map<std::string, std::string> words{
        {"final_soc_percent", "final state of charge [%]"},
        {"energy_wh", "energy [Wh]"},
        {"mechanical_energy_wh", "mechanical [Wh]"},
        {"compute_energy_wh", "computing [Wh]"},
        {"duration_s", "duration [s]"},
        {"depleted_at_s", "empty at [s]"},
        {"cut_off_at_s", "cut off at [s]"},
        {"utility", "utility"},
        {"probability_below_reserve", "chance of landing below the reserve"}};
    auto table = comparison_table(ranked(std::move(summaries)));
    for (auto& name : table.header) {
        if (const auto word = words.find(name); word != words.end()) name = word->second;
    }
    return table;
}

Section schedule_section(Missions missions, const PublishedFigures& published) {
    Section section{"schedules", "Schedules", "", {}};
    add_figure(section, schedule_figure(missions, published, "schedules-soc"));
    std::vector<mission::MissionSummary> summaries;
    std::vector<std::string> failures;
    for (const auto& simulated : missions) {
        auto summary = simulated.simulation.summary;
        summary.mission = simulated.title;
        if (summary.undeliverable) failures.push_back(describe(summary));
        summaries.push_back(std::move(summary));
    }
    section.html +=
        table_html(ranking_of(std::move(summaries)), {"Missions ranked by final state of charge", true, {}});
    section.html += paragraph(
        "Energies are what the whole mission demands, also where the battery is empty before its end. The "
        "chance is that of 1000 flights drawn a mission, from what its models and its [uncertainty] say of "
        "how flights differ: 95 % intervals reach 3 percent points at most; \"-\": nothing says it.",
        "soft");
    if (!failures.empty()) section.html += "<div class=\"warning\">" + list_html(failures) + "</div>\n";
    return section;
}

Section map_section(Missions missions, const PublishedFigures& published) {
    Section section{"quality-of-service", "Quality of service", "", {}};
    std::vector<const mission::Mission*> seen;
    for (const auto& simulated : missions) {
        const auto& mission = simulated.mission;
        const bool known = std::any_of(seen.begin(), seen.end(), [&](const mission::Mission* other) {
            return have_same_map(*other, mission);
        });
        if (known) continue;
        const auto map = qos_map(mission);
        if (!map) continue;
        seen.push_back(&mission);
        std::vector<SimulatedMission> alike;
        for (const auto& other : missions) {
            if (have_same_map(mission, other.mission)) alike.push_back(other);
        }
        section.html +=
            fmt::format("<h3>{}</h3>\n", mission.mechanical ? "Flight and computing" : "Computing alone");
        const bool is_published = !mission.mechanical;  // the paper's Fig. 4 leaves the flight out
        add_figure(section, qos_map_figure(*map, alike,
                                           is_published ? published.soc_cells : std::vector<PublishedCell>{},
                                           fmt::format("quality-{}", seen.size())));
    }
    return section;
}

}  // namespace

std::vector<Section> mission_sections(Missions missions, const PublishedFigures& published) {
    auto sections = model_sections(missions, published);
    for (auto& section : {profile_section(missions), schedule_section(missions, published),
                          map_section(missions, published), plan_section(missions)}) {
        if (!section.figures.empty()) sections.push_back(section);
    }
    return sections;
}

}  // namespace flightwatt::report
