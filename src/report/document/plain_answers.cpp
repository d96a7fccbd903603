#include "report/document/plain_answers.h"

#include "base/text.h"

#include <initializer_list>
#include <map>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

std::string text_of(const Json& value) { return html_escaped(value.get<std::string>()); }

std::string number_text(const Json& value, int decimals, std::string_view unit) {
    return value.is_null() ? "unknown" : fmt::format("{:.{}f} {}", value.get<double>(), decimals, unit);
}

/// A table with a head; the first cell of each row names it.
std::string table_html(std::string_view caption, std::initializer_list<const char*> head,
                       const std::vector<std::vector<std::string>>& rows) {
    if (rows.empty()) return "";
    auto html = fmt::format("<table>\n<caption>{}</caption>\n<thead><tr>", caption);
    for (const auto* name : head) html += fmt::format("<th scope=\"col\">{}</th>", name);
    html += "</tr></thead>\n<tbody>\n";
    for (const auto& row : rows) {
        html += fmt::format("<tr><th scope=\"row\">{}</th>", row.front());
        for (std::size_t c = 1; c < row.size(); ++c) html += fmt::format("<td>{}</td>", row[c]);
        html += "</tr>\n";
    }
    return html + "</tbody></table>\n";
}

/// Pairs of a name and a text.
std::string pairs_html(const Json& pairs, const char* name, const char* text) {
    std::string html = "<dl>\n";
    for (const auto& pair : pairs)
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", text_of(pair[name]), text_of(pair[text]));
    return html + "</dl>\n";
}

std::string answer_html(const Json& answer) {
    auto lines = answer["lines"];
    for (auto& line : lines) line["text"] = line["value"].get<std::string>() + line["basis"].get<std::string>();
    return fmt::format("<h1>{}</h1>\n", text_of(answer["headline"])) + pairs_html(lines, "label", "text");
}

std::string missions_html(const Json& missions) {
    std::vector<std::vector<std::string>> rows;
    for (const auto& mission : missions) {
        const auto& card = mission["card"];
        rows.push_back({text_of(mission["title"]), text_of(card["words"]), text_of(card["landing"]),
                        text_of(card["probability"]), text_of(card["reach_name"]) + ": " + text_of(card["reach"]),
                        text_of(card["help"])});
    }
    return table_html("Missions, worst first",
                      {"Mission", "Result", "Charge at landing", "Keeps the reserve", "Reach", "What would help"},
                      rows);
}

std::string flights_html(const Json& flights) {
    std::vector<std::vector<std::string>> rows;
    for (const auto& flight : flights) {
        const auto& rejected = flight["rejected"].get_ref<const std::string&>();
        if (!rejected.empty()) rows.push_back({text_of(flight["name"]), "", "not used: " + html_escaped(rejected), ""});
        for (const auto& sortie : flight["sorties"])
            rows.push_back({text_of(flight["name"]), text_of(flight["date"]),
                            html_escaped(duration_text(sortie["in_air_s"])),
                            number_text(sortie["energy_wh"], 2, "Wh")});
    }
    return table_html("Flights", {"Flight", "Date (UTC)", "In the air", "Energy"}, rows);
}

std::string list_html(const Json& texts) {
    std::string html;
    for (const auto& text : texts) html += fmt::format("<li>{}</li>\n", text_of(text));
    return html.empty() ? html : "<ul>\n" + html + "</ul>\n";
}

}  // namespace

std::string html_escaped(std::string_view text) {
    static const std::map<char, std::string_view> entities{
        {'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
    std::string html;
    for (const char c : valid_utf8(text)) {
        if (const auto found = entities.find(c); found != entities.end())
            html += found->second;
        else
            html += static_cast<unsigned char>(c) < 0x20 && c != '\n' ? ' ' : c;
    }
    return html;
}

std::string plain_answers(const Json& document) {
    const bool has_answer = !document["answer"].is_null();
    std::string html = has_answer ? answer_html(document["answer"]) : "";
    html += fmt::format("<{0}>{1}</{0}>\n", has_answer ? "h2" : "h1", text_of(document["headline"]));
    html += pairs_html(document["aircraft"], "name", "text") + missions_html(document["missions"]) +
            flights_html(document["flights"]) + list_html(document["warnings"]) + list_html(document["notes"]);
    return html + pairs_html(document["facts"], "name", "text");
}

}  // namespace flightwatt::report
