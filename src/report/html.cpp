#include "report/html.h"

#include "base/number.h"
#include "base/text.h"

#include <algorithm>
#include <cctype>
#include <map>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

bool is_number_or_dash(std::string_view cell) {
    if (cell.ends_with(" %")) cell.remove_suffix(2);
    if (cell.starts_with('+')) cell.remove_prefix(1);
    return cell == "-" || parse_number(cell).has_value();
}

/// Class attributes of the columns' cells.
std::vector<std::string> column_classes(const TextTable& table) {
    constexpr std::size_t short_text = 18;
    std::vector<std::string> classes(table.header.size());
    for (std::size_t c = 0; c < classes.size(); ++c) {
        if (std::ranges::all_of(table.rows, [c](const auto& row) { return is_number_or_dash(row[c]); })) continue;
        std::size_t max_length = 0;
        for (const auto& row : table.rows) max_length = std::max(max_length, row[c].size());
        classes[c] = max_length <= short_text ? " class=\"text short\"" : " class=\"text\"";
    }
    return classes;
}

}  // namespace

std::string html_escaped(std::string_view text) {
    static const std::map<char, std::string_view> entities{
        {'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
    std::string html;
    for (const char c : valid_utf8(text)) {
        if (const auto found = entities.find(c); found != entities.end()) {
            html += found->second;
        } else {
            html += static_cast<unsigned char>(c) < 0x20 && c != '\n' ? ' ' : c;
        }
    }
    return html;
}

std::string table_html(const TextTable& table, std::string_view caption, const HtmlTableOptions& options) {
    const auto classes = column_classes(table);
    auto html = fmt::format("<table{} aria-label=\"{}\">\n<thead><tr>", options.sortable ? " class=\"sortable\"" : "",
                            html_escaped(caption));
    for (std::size_t c = 0; c < table.header.size(); ++c) {
        html += fmt::format("<th scope=\"col\"{}>{}</th>", classes[c], html_escaped(table.header[c]));
    }
    html += "</tr></thead>\n<tbody>\n";
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        html += "<tr>";
        for (std::size_t c = 0; c < table.rows[r].size(); ++c) {
            auto cell = html_escaped(table.rows[r][c]);
            if (c == 0 && r < options.links.size() && !options.links[r].empty()) {
                cell = fmt::format("<a href=\"#{}\">{}</a>", html_escaped(options.links[r]), cell);
            }
            html += fmt::format("<td{} data-label=\"{}\">{}</td>", classes[c], html_escaped(table.header[c]), cell);
        }
        html += "</tr>\n";
    }
    return html + "</tbody></table>\n";
}

void add_figure(Section& section, Figure figure) {
    // A figure with parameters zooms, by the keyboard too.
    const auto* keys = figure.spec.contains("params") ? " data-zoom=\"zoom_time_s\" data-scale=\"x\"" : "";
    section.html += fmt::format(
        "<figure>\n<div class=\"figure\" tabindex=\"0\" role=\"group\" aria-label=\"{0}\" "
        "data-spec=\"spec-{1}\" "
        "data-name=\"{1}\"{2}></div>\n"
        "<script type=\"application/json\" id=\"spec-{1}\">{3}</script>\n"
        "<figcaption>{4}</figcaption>\n</figure>\n",
        html_escaped(figure.description), figure.id, keys, script_json(figure.spec), html_escaped(figure.caption));
    section.figures.push_back(std::move(figure));
}

void add_table(Section& section, const CaptionedTable& table, const HtmlTableOptions& options) {
    section.html += table_html(table.table, table.caption, options);
    if (table.label.empty() || table.table.rows.empty()) return;
    section.latex += (section.latex.empty() ? "" : "\n") + to_latex(table.table, table.caption, table.label);
}

std::string capitalized(std::string text) {
    if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
}

std::string heading(std::string_view text) { return fmt::format("<h3>{}</h3>\n", html_escaped(text)); }

std::string paragraph(std::string_view text, std::string_view css_class) {
    return fmt::format("<p{}>{}</p>\n", css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class),
                       html_escaped(text));
}

std::string list_html(const std::vector<std::string>& lines, std::string_view css_class) {
    if (lines.empty()) return "";
    std::string html = "<ul>\n";
    for (const auto& line : lines) html += fmt::format("<li>{}</li>\n", html_escaped(line));
    html += "</ul>\n";
    return css_class.empty() ? html : fmt::format("<div class=\"{}\">{}</div>\n", css_class, html);
}

}  // namespace flightwatt::report
