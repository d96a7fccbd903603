#include "report/sections/summary_section.h"

#include "report/figures/mission_figures.h"
#include "report/sections/aircraft_panel.h"
#include "report/sections/mission_card.h"
#include "report/sections/page_data.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

/// Style and words of an outcome; its words in the headline follow a number of missions.
struct OutcomeLook {
    const char* css_class;  ///< also the name of its mark in web/page.html
    const char* of_one;
    const char* of_several;
};

/// In the order of Outcome.
constexpr std::array<OutcomeLook, 5> looks{
    {{"keeps", "lands as planned", "land as planned"},
     {"may-miss", "flies turns that it may not be able to", "fly turns that they may not be able to"},
     {"may-miss", "may miss the reserve", "may miss the reserve"},
     {"misses", "lands below the reserve", "land below the reserve"},
     {"fails", "does not reach its end", "do not reach their end"}}};

const OutcomeLook& look_of(Outcome outcome) { return looks.at(static_cast<std::size_t>(outcome)); }

std::string mark_html(Outcome outcome) {
    return fmt::format(
        "<svg class=\"mark\" width=\"16\" height=\"16\" aria-hidden=\"true\"><use href=\"#mark-{}\"/></svg>",
        look_of(outcome).css_class);
}

std::string number_word(std::size_t number) {
    constexpr std::array words{"no",    "one",   "two",  "three", "four",   "five",  "six",
                               "seven", "eight", "nine", "ten",   "eleven", "twelve"};
    return number < words.size() ? words.at(number) : fmt::format("{}", number);
}

/// The missions, the worst first, with their cards.
struct RankedCards {
    std::span<const SimulatedMission> missions;
    std::vector<MissionCard> cards;
};

RankedCards ranked_cards(const PageSummary& answers) {
    RankedCards ranked{answers.missions, {}};
    for (std::size_t i = 0; i < answers.missions.size(); ++i)
        ranked.cards.push_back(mission_card(answers.missions[i], answers.answers[i]));
    return ranked;
}

/// "One of nine missions runs empty, two land below the reserve".
std::string headline_of(const RankedCards& ranked, std::span<const ReportFlight> flights) {
    const auto& cards = ranked.cards;
    if (cards.empty()) {
        const auto lines = aircraft_lines(flights);
        return lines.empty() ? "No flights"
                             : fmt::format("{} and no mission", lines.front().substr(0, lines.front().find(" \u00b7")));
    }
    if (cards.size() == 1) return fmt::format("{}: {}", ranked.missions.front().title, cards.front().lead);
    if (cards.front().outcome == Outcome::keeps)
        return fmt::format("{} missions land as planned",
                           cards.size() == 2 ? "Both" : "All " + number_word(cards.size()));
    std::vector<std::string> parts;
    for (const auto outcome : {Outcome::fails, Outcome::misses, Outcome::may_miss, Outcome::is_steep}) {
        const auto is_this = [&](const MissionCard& card) { return card.outcome == outcome; };
        const auto count = static_cast<std::size_t>(std::ranges::count_if(cards, is_this));
        if (count == 0 || (outcome == Outcome::may_miss && !parts.empty())) continue;
        const bool run_empty = std::ranges::all_of(
            cards, [&](const MissionCard& card) { return !is_this(card) || card.words == "runs empty"; });
        const auto& look = look_of(outcome);
        const std::string words =
            run_empty ? (count == 1 ? "runs empty" : "run empty") : (count == 1 ? look.of_one : look.of_several);
        const auto of_all = parts.empty() ? fmt::format(" of {} missions", number_word(cards.size())) : "";
        parts.push_back(fmt::format("{}{} {}", number_word(count), of_all, words));
    }
    return capitalized(fmt::format("{}", fmt::join(parts, ", ")));
}

/// The best mission that keeps its reserve on the same flight and pack.
std::string better_schedule(const RankedCards& ranked, std::size_t of) {
    if (ranked.cards[of].outcome == Outcome::keeps) return "";
    const auto& setup = ranked.missions[of].mission.setup;
    for (std::size_t i = 0; i < ranked.cards.size(); ++i) {
        const auto& other = ranked.missions[i];
        const bool is_same = other.mission.setup.reserve_soc_percent == setup.reserve_soc_percent &&
                             map_key(other.mission.setup) == map_key(setup);
        if (ranked.cards[i].outcome == Outcome::keeps && is_same && other.simulation.summary.samples)
            return fmt::format("With \u201c{}\u201d {} in {} of flights", other.title,
                               setup.reserve_soc_percent > 0.0 ? "it keeps the reserve" : "the battery lasts",
                               ranked.cards[i].probability);
    }
    return "";
}

std::string number_row(std::string_view name, std::string_view note, std::string_view value) {
    return fmt::format("<div><dt>{}{}</dt><dd>{}</dd></div>\n", html_escaped(name),
                       note.empty() ? "" : fmt::format(" <small>{}</small>", html_escaped(note)), html_escaped(value));
}

std::string help_html(const RankedCards& ranked, std::size_t i) {
    const auto& card = ranked.cards[i];
    std::vector<std::string> ways;
    if (!card.help.empty()) ways.push_back(card.help);
    if (auto better = better_schedule(ranked, i); !better.empty()) ways.push_back(std::move(better));
    std::string html;
    if (!ways.empty())
        html = fmt::format("<p class=\"help\">{}{}.</p>\n",
                           card.outcome == Outcome::keeps ? "" : "<b>What would help:</b> ",
                           html_escaped(fmt::format("{}", fmt::join(ways, ". "))));
    if (!card.notes.empty())
        html +=
            fmt::format("<p class=\"soft\">{}.</p>\n", html_escaped(fmt::format("{}", fmt::join(card.notes, ". "))));
    return html;
}

std::string card_html(const RankedCards& ranked, std::size_t i) {
    const auto& card = ranked.cards[i];
    const auto& mission = ranked.missions[i];
    const double reserve_percent = mission.simulation.summary.reserve_soc_percent;
    const auto count = number_word(ranked.cards.size());
    const auto rank = ranked.cards.size() == 1 ? capitalized(card.words)
                      : i == 0                 ? fmt::format("Worst of {}", count)
                                               : fmt::format("{} of {}, worst first", i + 1, count);
    auto html = fmt::format(
        "<article class=\"card mission {}\" id=\"mission-{}\"{}>\n<div>\n<p class=\"outcome\">{}{}</p>\n<h2>{}</h2>\n"
        "<p><b>{}</b><br><span class=\"soft\">{}</span></p>\n<dl class=\"numbers\">\n",
        look_of(card.outcome).css_class, i, i == 0 ? "" : " hidden", mark_html(card.outcome), rank,
        html_escaped(card.lead), html_escaped(mission.title), html_escaped(card.runs));
    html += number_row("Charge at landing", "", card.landing);
    html += number_row(capitalized(describe_aim(reserve_percent)), "", card.probability);
    if (!card.reach.empty())
        html += number_row(card.reach_name, card.planned.empty() ? "" : fmt::format("(planned: {})", card.planned),
                           card.reach);
    return html + fmt::format(
                      "</dl>\n</div>\n<div class=\"drawn\" data-draw=\"mission\" data-mission=\"{}\"></div>\n"
                      "<div class=\"below\">{}</div>\n</article>\n",
                      i, help_html(ranked, i));
}

std::string table_row(const RankedCards& ranked, std::size_t i) {
    const auto& card = ranked.cards[i];
    const auto cell = [](std::string_view head, const std::string& html, std::string_view css_class = "") {
        return fmt::format("<td data-label=\"{}\"{}>{}</td>", head,
                           css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class), html);
    };
    auto html = fmt::format(
        "<tr class=\"{}\"><th scope=\"row\">{}<button type=\"button\" data-select=\"{}\" aria-pressed=\"{}\">"
        "{}</button><small>{}</small></th>",
        look_of(card.outcome).css_class, mark_html(card.outcome), i, i == 0, html_escaped(ranked.missions[i].title),
        html_escaped(card.runs));
    html +=
        cell("State of charge", fmt::format("<div class=\"drawn\" data-draw=\"spark\" data-mission=\"{}\"></div>", i));
    html += cell("Charge at landing", fmt::format("<b>{}</b><small>{}</small>", card.landing, card.words), "state");
    html += cell("Keeps the reserve", fmt::format("<b>{}</b>", card.probability), "state");
    html += cell(card.reach_name, fmt::format("<b>{}</b>", html_escaped(card.reach)));
    return html + cell("To keep the reserve", html_escaped(card.help), "help") + "</tr>\n";
}

std::string missions_table(const RankedCards& ranked) {
    std::string html = "<table class=\"card missions\" aria-label=\"Missions, worst first\">\n<thead><tr>";
    for (const auto* head : {"Mission, worst first", "State of charge", "Charge at landing", "Keeps the reserve",
                             "Reach with 95&nbsp;%", "To keep the reserve in 95 of 100 flights"})
        html += fmt::format("<th scope=\"col\">{}</th>", head);
    html += "</tr></thead>\n<tbody>\n";
    for (std::size_t i = 0; i < ranked.cards.size(); ++i) html += table_row(ranked, i);
    return html + "</tbody></table>\n";
}

}  // namespace

Section summary_section(const PageSummary& answers, std::span<const ReportFlight> flights, std::string_view heading) {
    const auto ranked = ranked_cards(answers);
    Section section{"missions", ranked.cards.empty() ? "Aircraft" : "Missions"};
    section.place = SectionPlace::front;
    for (const auto& line : aircraft_lines(flights)) {
        const auto name = line.find(": ");
        section.html += fmt::format("<p class=\"aircraft\"><b>{}</b> {}</p>\n", html_escaped(line.substr(0, name)),
                                    html_escaped(line.substr(name + 2)));
    }
    section.html += fmt::format("<{0} id=\"missions-title\">{1}</{0}>\n<div class=\"front\">\n", heading,
                                html_escaped(headline_of(ranked, flights)));
    if (!ranked.cards.empty()) {
        section.html += "<div>\n";
        for (std::size_t i = 0; i < ranked.cards.size(); ++i) section.html += card_html(ranked, i);
        if (ranked.cards.size() > 1) section.html += missions_table(ranked);
        section.html += "</div>\n" + data_block("missions", missions_data(ranked.missions));
    }
    if (const auto panel = aircraft_panel(answers, flights); !panel.empty())
        section.html += "<section class=\"card panel\" aria-label=\"The aircraft\">\n<h2>The aircraft</h2>\n" + panel +
                        "</section>\n";
    section.html += "</div>\n";
    return section;
}

std::optional<Section> notes_section(const PageSummary& answers) {
    auto lines = answers.warnings;
    lines.insert(lines.end(), answers.notes.begin(), answers.notes.end());
    if (lines.empty()) return std::nullopt;
    Section section{"notes", "Notes on models and contents", list_html(lines)};
    section.place = SectionPlace::folded;
    return section;
}

Section curves_section(std::span<const SimulatedMission> missions) {
    return {
        "curves", missions.size() == 2 ? "Both missions" : fmt::format("All {} missions", number_word(missions.size())),
        "<p class=\"soft\">The colour of a line is its outcome: <b class=\"fails\">does not reach its end</b>, <b "
        "class=\"misses\">lands below or may miss the reserve</b>, <b class=\"keeps\">keeps the reserve in 95 of 100 "
        "flights</b>.</p>\n<div class=\"card\"><div class=\"drawn\" data-draw=\"curves\"></div></div>\n"};
}

}  // namespace flightwatt::report
