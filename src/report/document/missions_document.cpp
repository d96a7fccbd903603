#include "report/document/missions_document.h"

#include "base/statistics.h"
#include "cli/output/mission_output.h"
#include "cli/output/replay_output.h"
#include "mission/mission_summary.h"
#include "report/document/columns.h"
#include "report/document/mission_card.h"
#include "report/document/quality_of_service.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

using Missions = std::span<const SimulatedMission>;

/// Name and words of an outcome; its words in the headline follow a number of missions.
struct OutcomeWords {
    const char* name;
    const char* of_one;
    const char* of_several;
};

/// In the order of Outcome.
constexpr std::array<OutcomeWords, 5> known_outcomes{{{"keeps", "lands as planned", "land as planned"},
                                                      {"may-miss", "is uncertain", "are uncertain"},
                                                      {"may-miss", "may miss the reserve", "may miss the reserve"},
                                                      {"misses", "lands below the reserve", "land below the reserve"},
                                                      {"fails", "does not reach its end", "do not reach their end"}}};

const OutcomeWords& words_of(Outcome outcome) { return known_outcomes.at(static_cast<std::size_t>(outcome)); }

std::string number_word(std::size_t number) {
    constexpr std::array words{"no",    "one",   "two",  "three", "four",   "five",  "six",
                               "seven", "eight", "nine", "ten",   "eleven", "twelve"};
    return number < words.size() ? words.at(number) : fmt::format("{}", number);
}

std::vector<MissionCard> cards_of(const Findings& findings) {
    std::vector<MissionCard> cards;
    for (std::size_t i = 0; i < findings.missions.size(); ++i)
        cards.push_back(mission_card(findings.missions[i], findings.assessments[i]));
    return cards;
}

/// The best mission that keeps its reserve on the same flight and pack.
std::string better_schedule(Missions missions, const std::vector<MissionCard>& cards, std::size_t of) {
    if (cards[of].outcome == Outcome::keeps) return "";
    const auto& setup = missions[of].mission.setup;
    for (std::size_t i = 0; i < cards.size(); ++i) {
        const auto& other = missions[i];
        const bool is_same = other.mission.setup.reserve_soc_percent == setup.reserve_soc_percent &&
                             map_key(other.mission.setup) == map_key(setup);
        if (cards[i].outcome == Outcome::keeps && is_same && other.simulation.summary.samples)
            return fmt::format("With \u201c{}\u201d {} in {} of flights", other.title,
                               setup.reserve_soc_percent > 0.0 ? "it keeps the reserve" : "the battery lasts",
                               cards[i].texts.at("probability").get<std::string>());
    }
    return "";
}

Json phases_of(const mission::MissionSetup& mission) {
    auto phases = Json::array();
    const auto timeline = mission::timeline_of(mission.duration_s);
    for (const auto phase : flight::all_phases)
        if (mission.duration_s[phase] > 0.0)
            phases.push_back({{"phase", to_string(phase)},
                              {"start_s", rounded_json(timeline.start_s[phase], 1)},
                              {"end_s", rounded_json(timeline.end_s[phase], 1)}});
    return phases;
}

Json band_of(const mission::MissionSummary& summary) {
    if (!known_probability_below_reserve(summary) || summary.samples->bands.empty()) return nullptr;
    Json band{{"time_s", Json::array()}, {"low_percent", Json::array()}, {"high_percent", Json::array()}};
    for (const auto& row : summary.samples->bands) {
        band["time_s"].push_back(rounded_json(row.time_s, 1));
        band["low_percent"].push_back(rounded_json(row.p05_percent, 1));
        band["high_percent"].push_back(rounded_json(row.p95_percent, 1));
    }
    return band;
}

/// The state of charge over time, its value at landing and the end of the battery.
Json curve_json(const mission::Simulation& simulation) {
    const auto& summary = simulation.summary;
    Json::array_t time_s;
    Json::array_t soc_percent;
    for (const auto& row : simulation.curve.rows) {
        time_s.push_back(rounded_json(row.time_s, 1));
        soc_percent.push_back(rounded_json(row.soc_percent, 1));
    }
    return {{"curve", {{"time_s", time_s}, {"soc_percent", soc_percent}}},
            {"landing_soc_percent", summary.feasible ? rounded_json(*summary.final_soc_percent, 1) : Json()},
            {"end_s", rounded_json(mission::powered_end_s(summary), 1)}};
}

Json schedule_json(const SimulatedMission& simulated) {
    const auto& mission = simulated.mission;
    const auto timeline = mission::timeline_of(mission.setup.duration_s);
    auto schedule = Json::array();
    for (const auto& segment : mission.schedule) {
        const double start_s = timeline.start_s[segment.phase];
        schedule.push_back({{"start_s", rounded_json(start_s + segment.start_s, 3)},
                            {"end_s", rounded_json(start_s + segment.end_s, 3)},
                            {"compute_w", power_w(mission.setup.compute, segment.run)},
                            {"phase", to_string(segment.phase)},
                            {"runs", describe(mission.setup.compute, segment.run)}});
    }
    return schedule;
}

Json elements_json(const path::PlannedPath& plan) {
    auto elements = Json::array();
    for (const auto& element : path_element_results(plan))
        elements.push_back({{"name", element.name},
                            {"kind", element.kind},
                            {"start_s", element.start_s},
                            {"duration_s", element.duration_s},
                            {"length_m", element.length_m ? Json(*element.length_m) : Json()},
                            {"course_deg", element.course_deg ? Json(*element.course_deg) : Json()},
                            {"airspeed_m_per_s", element.airspeed_m_per_s},
                            {"climb_m_per_s", element.climb_m_per_s},
                            {"mechanical_w", element.mechanical_w}});
    return elements;
}

/// The path of the cruise with the charge along it; null without one.
Json path_json(const SimulatedMission& simulated) {
    const auto track = flown_track(simulated.mission.setup, simulated.simulation);
    if (!track) return nullptr;
    auto path = record_json(*track);
    path["elements"] = elements_json(*simulated.mission.setup.cruise_path->plan);
    return path;
}

/// The first mission of each key.
std::vector<const SimulatedMission*> first_of_each(Missions missions,
                                                   std::string (*key)(const mission::MissionSetup&)) {
    std::vector<const SimulatedMission*> firsts;
    std::set<std::string> keys;
    for (const auto& simulated : missions)
        if (keys.insert(key(simulated.mission.setup)).second) firsts.push_back(&simulated);
    return firsts;
}

/// The parameters but the first.
std::string line_name(const compute::PowerProfile& profile, const std::vector<double>& qos) {
    std::vector<std::string> parts;
    for (std::size_t p = 1; p < qos.size(); ++p)
        parts.push_back(fmt::format("{} {:g}", in_words(profile.parameters[p]), qos[p]));
    return fmt::format("{}", fmt::join(parts, ", "));
}

Json component_json(const compute::Component& component) {
    const auto& profile = component.profile;
    auto lines = Json::array();
    for (std::size_t node = 0; node < profile.power_w.size(); ++node) {
        const auto qos = compute::grid_point(profile.axes, node);
        const auto name = line_name(profile, qos);
        auto line = std::ranges::find_if(lines, [&](const Json& one) { return one["name"] == name; });
        if (line == lines.end()) {
            lines.push_back({{"name", name},
                             {"value", Json::array()},
                             {"power_w", Json::array()},
                             {"low_w", Json::array()},
                             {"high_w", Json::array()}});
            line = lines.end() - 1;
        }
        const double error_w = profile.standard_error_w.empty() ? std::nan("") : profile.standard_error_w[node];
        const double reach_w = normal_half_width() * error_w;
        constexpr int decimals = 4;
        (*line)["value"].push_back(qos.empty() ? 0.0 : qos.front());
        (*line)["power_w"].push_back(rounded_json(profile.power_w[node], decimals));
        (*line)["low_w"].push_back(rounded_json(profile.power_w[node] - reach_w, decimals));
        (*line)["high_w"].push_back(rounded_json(profile.power_w[node] + reach_w, decimals));
    }
    return {{"name", component.name},
            {"parameter", profile.parameters.empty() ? "" : in_words(profile.parameters.front())},
            {"lines", std::move(lines)}};
}

}  // namespace

std::string missions_headline(const Findings& findings) {
    const auto cards = cards_of(findings);
    if (cards.empty()) return "";
    if (cards.size() == 1)
        return fmt::format("{}: {}", findings.missions.front().title,
                           cards.front().texts.at("lead").get<std::string>());
    if (cards.front().outcome == Outcome::keeps)
        return fmt::format("{} missions land as planned",
                           cards.size() == 2 ? "Both" : "All " + number_word(cards.size()));
    std::vector<std::string> parts;
    for (const auto outcome : {Outcome::fails, Outcome::misses, Outcome::may_miss, Outcome::is_uncertain}) {
        const auto is_this = [&](const MissionCard& card) { return card.outcome == outcome; };
        const auto count = static_cast<std::size_t>(std::ranges::count_if(cards, is_this));
        if (count == 0 || (outcome == Outcome::may_miss && !parts.empty())) continue;
        const bool run_empty = std::ranges::all_of(
            cards, [&](const MissionCard& card) { return !is_this(card) || card.texts.at("words") == "runs empty"; });
        const auto& known = words_of(outcome);
        const std::string words =
            run_empty ? (count == 1 ? "runs empty" : "run empty") : (count == 1 ? known.of_one : known.of_several);
        const auto of_all = parts.empty() ? fmt::format(" of {} missions", number_word(cards.size())) : "";
        parts.push_back(fmt::format("{}{} {}", number_word(count), of_all, words));
    }
    return capitalized(fmt::format("{}", fmt::join(parts, ", ")));
}

Json missions_json(const Findings& findings, LatexTables& tables) {
    const auto& missions = findings.missions;
    std::vector<mission::MissionSummary> summaries;
    summaries.reserve(missions.size());
    for (const auto& simulated : missions) summaries.push_back(simulated.simulation.summary);
    const auto ranking = cli::ranked_missions(ranked(summaries));
    tables.add({table_of(ranking), "Missions by final state of charge", "tab:missions"});
    const auto cards = cards_of(findings);
    auto all = Json::array();
    for (std::size_t i = 0; i < missions.size(); ++i) {
        const auto& simulated = missions[i];
        const auto& summary = simulated.simulation.summary;
        auto card = cards[i].texts;
        card["better"] = better_schedule(missions, cards, i);
        const auto place = std::ranges::find(ranking, simulated.title,
                                             [](const cli::RankedMission& one) { return one.summary.mission; });
        Json json{{"title", simulated.title},
                  {"rank", place == ranking.end() ? i + 1 : place->rank},
                  {"outcome", words_of(cards[i].outcome).name},
                  {"summary", record_json(summary)},
                  {"card", std::move(card)}};
        json.update(curve_json(simulated.simulation));
        json["band"] = band_of(summary);
        json["phases"] = phases_of(simulated.mission.setup);
        json["schedule"] = schedule_json(simulated);
        json["path"] = path_json(simulated);
        json["again"] = nullptr;
        all.push_back(std::move(json));
    }
    return all;
}

Json schedule_notes(Missions missions) {
    auto sources = Json::array();  // drawn quantities, and their missions
    for (const auto& simulated : missions) {
        const auto& samples = simulated.simulation.summary.samples;
        if (!samples) continue;
        const auto text = describe(samples->sources);
        const auto same = std::ranges::find_if(sources, [&](const Json& one) { return one["text"] == text; });
        if (same == sources.end())
            sources.push_back({{"missions", {simulated.title}}, {"text", text}});
        else
            (*same)["missions"].push_back(simulated.title);
    }
    return {{"text",
             "Energies are the demand of the whole mission, also where the battery is empty before its end. "
             "Probabilities are of 1000 flights drawn from the uncertainty of the models and of [uncertainty], 200 for "
             "a policy that plans in flight: 95 % intervals of at most 3 or 7 percent points; unknown "
             "where no uncertainty is."},
            {"sources", std::move(sources)}};
}

Json software_json(Missions missions) {
    auto all = Json::array();
    for (const auto* simulated : first_of_each(missions, software_key)) {
        const auto& setup = simulated->mission.setup;
        if (setup.compute.components.empty()) continue;
        auto titles = Json::array();
        for (const auto& other : missions)
            if (software_key(other.mission.setup) == software_key(setup)) titles.push_back(other.title);
        auto components = Json::array();
        for (const auto& component : setup.compute.components) components.push_back(component_json(component));
        all.push_back({{"missions", std::move(titles)}, {"components", std::move(components)}});
    }
    return all;
}

Json quality_json(Missions missions, bool with_figures) {
    auto grids = Json::array();
    for (const auto* simulated : first_of_each(missions, map_key)) {
        const auto& setup = simulated->mission.setup;
        const auto grid = qos_grid(setup);
        if (!grid) continue;
        std::vector<std::size_t> same;
        for (std::size_t i = 0; i < missions.size(); ++i)
            if (map_key(missions[i].mission.setup) == map_key(setup)) same.push_back(i);
        auto cells = Json::array();
        for (const auto& cell : grid->cells) {
            const auto& summary = cell.simulation.summary;
            auto json = curve_json(cell.simulation);
            json["keeps"] = cell.probability ? probability_text(*cell.probability) : "";
            json["utility"] = summary.utility ? rounded_json(*summary.utility, 2) : Json();
            json["duration_s"] = rounded_json(summary.duration_s, 1);
            cells.push_back(std::move(json));
        }
        grids.push_back({{"x_name", grid->x.name},
                         {"y_name", grid->y.name},
                         {"x", grid->x.nodes},
                         {"y", grid->y.nodes},
                         {"others", grid->others},
                         {"reserve_soc_percent", setup.reserve_soc_percent},
                         {"missions", same},
                         {"flights_drawn", grid_flights_drawn},
                         {"cells", std::move(cells)}});
        if (!with_figures) continue;
        const auto map = *qos_map(setup);
        grids.back()["map"] = {{"x", map.x.nodes}, {"y", map.y.nodes}, {"soc_percent", column_of(map.soc_percent)}};
    }
    return grids;
}

std::vector<mechanical::MechanicalModel> other_models(Missions missions,
                                                      std::span<const mechanical::MechanicalModel> shown) {
    std::vector<mechanical::MechanicalModel> models;
    for (const auto* simulated : first_of_each(missions, model_key)) {
        const auto& mechanical = simulated->mission.setup.mechanical;
        const auto is_this = [&](const auto& other) {  // the batch has its errors, a mission may use its means alone
            return other.name == mechanical->name && std::ranges::all_of(flight::all_phases, [&](auto phase) {
                       return other.phases[phase].duration_s == mechanical->phases[phase].duration_s;
                   });
        };
        if (mechanical && std::ranges::none_of(shown, is_this)) models.push_back(*mechanical);
    }
    return models;
}

Json packs_json(std::span<const mission::PackFlights> missions, LatexTables& tables) {
    auto packs = Json::array();
    for (const auto& all : missions) {
        auto json = record_json(all);
        json["text"] = describe(all) + ".";
        packs.push_back(std::move(json));
        tables.add({table_of(all.flights), "Flights of " + all.setup.name, "tab:packs"});
    }
    return packs;
}

Json replay_json(std::span<const mission::Replay> replays, LatexTables& tables) {
    const CaptionedTable results{cli::replay_table(replays), "Results of each schedule on each flight", "tab:replay"};
    const CaptionedTable bases{cli::replay_basis_table(replays), "Models of the replays", "tab:replay-basis"};
    std::vector<std::string> notes;
    for (const auto& replay : replays)
        for (const auto& note : replay.notes)
            notes.push_back(fmt::format("{}, {}: {}", replay.flight, replay.mission, note));
    notes.push_back(cli::replay_remark());
    auto printed = Json::array();
    for (const auto& table : {results, bases}) {
        tables.add(table);
        printed.push_back(printed_json(table.table, table.caption));
    }
    return {{"text",
             "The missions' schedules on the measured power of the flights. Plans use a model of the other flights; "
             "hindsight plans with the measured power, and regret is its surplus of utility."},
            {"sentences", cli::replay_sentences(replays)},
            {"notes", notes},
            {"tables", std::move(printed)}};
}

}  // namespace flightwatt::report
