#include "report/page.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/number.h"
#include "base/overwrite_guard.h"
#include "report/figures/run_program.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <system_error>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// Escapes "</script": in strings and regular expressions, "<\/" is "</".
std::string inline_script(const std::string& text) {
    return "<script>" + boost::replace_all_copy(text, "</script", "<\\/script") + "</script>\n";
}

/// The page web/NAME.html, with each "{{FIELD}}" replaced by its value.
std::string filled_page(std::string_view name, const std::map<std::string_view, std::string_view>& values) {
    auto left = web_templates().at(name);
    std::string html;
    for (auto at = left.find("{{"); at != std::string_view::npos; at = left.find("{{")) {
        const auto end = left.find("}}", at);
        html.append(left.substr(0, at)).append(values.at(left.substr(at + 2, end - at - 2)));
        left.remove_prefix(end + 2);
    }
    html.append(left);
    return html;
}

/// Style, theme, scripts and, unless one is missing, libraries. Throws InputError for a missing one if
/// `needs_libraries`.
WebFiles read_files(const std::filesystem::path& folder, const char* style, std::initializer_list<const char*> scripts,
                    bool needs_libraries) {
    WebFiles files{folder, read_file(folder / style), read_file(folder / "theme.json"), "", ""};
    for (const std::string library : {"vega", "vega-lite", "vega-embed"}) {
        const auto path = folder / "node_modules" / library / "build" / (library + ".min.js");
        if (!open_error(path)) {
            files.libraries += read_file(path) + "\n";
            continue;
        }
        if (needs_libraries)
            throw InputError({path.string()}, "this library of the report's figures is missing",
                             "run scripts/install_dependencies with access to the npm registry");
        files.libraries.clear();
        break;
    }
    for (const auto* script : scripts) files.script += read_file(folder / script);
    return files;
}

/// Vega uses CSS pixels of 1/96 inch.
constexpr double px_per_pt = 96.0 / 72.0;
constexpr double default_width_px = 720.0;

/// The theme for papers: with a width all type has 8 points, as figures are not scaled.
VegaJson in_type_of_papers(const VegaJson& theme, const FigureLayout& layout) {
    constexpr double type_pt = 8.0;
    auto values = theme.flatten();
    for (auto& [path, value] : values.items())
        if (layout.width_pt && (path.ends_with("FontSize") || path.ends_with("/fontSize"))) value = type_pt * px_per_pt;
    if (layout.width_pt) values["/style/panel-name/fontWeight"] = "normal";
    if (layout.is_serif) values["/font"] = "'Times New Roman', 'Liberation Serif', 'DejaVu Serif', serif";
    return values.unflatten();
}

/// The specification with the light theme, for any Vega-Lite.
std::string standalone(const Figure& figure, const VegaJson& light_theme) {
    auto spec = figure.spec;
    spec["config"] = light_theme;
    return spec.dump(1, ' ', false, VegaJson::error_handler_t::replace) + "\n";
}

}  // namespace

std::filesystem::path web_folder() { return data_folder("web", "FLIGHTWATT_WEB", "the report's web files"); }

WebFiles read_web_files(const std::filesystem::path& folder) {
    return read_files(folder, "page.css", {"fit_width.js", "blocks.js", "drawings.js", "page.js"}, true);
}

WebFiles read_live_web_files(const std::filesystem::path& folder) {
    return read_files(folder, "watch.css", {"watch.js"}, false);
}

std::string page_html(const PageHead& head, const std::vector<Section>& sections, const WebFiles& web) {
    std::string contents;
    std::string html;
    std::string folded;
    const auto link = [&](std::string_view id, std::string_view title) {
        contents += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", id, title);
    };
    for (const auto& section : sections) {
        const auto title = html_escaped(section.title);
        if (section.place == SectionPlace::folded) {
            folded += fmt::format("<details class=\"more\" id=\"{}\"><summary><h3>{}</h3></summary>\n{}</details>\n",
                                  section.id, title, section.html);
            continue;
        }
        link(section.id, title);
        html += fmt::format("<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n", section.id);
        if (section.place == SectionPlace::page)
            html += fmt::format("<h2 id=\"{}-title\">{}</h2>\n", section.id, title);
        html += section.html + "</section>\n";
    }
    if (!folded.empty()) {
        link("certain", "How certain?");
        html +=
            "<section id=\"certain\" aria-labelledby=\"certain-title\">\n<h2 id=\"certain-title\">How certain is "
            "this?</h2>\n" +
            folded + "</section>\n";
    }
    std::string facts;
    for (const auto& [name, value] : head.facts)
        facts += fmt::format("<dt>{}</dt><dd>{}</dd>\n", html_escaped(name), html_escaped(value));
    return filled_page("page", {{"version", FLIGHTWATT_VERSION},
                                {"title", html_escaped(head.title)},
                                {"name", html_escaped(head.name)},
                                {"style", web.style},
                                {"contents", contents},
                                {"sections", html},
                                {"facts", facts},
                                {"theme", script_json(VegaJson::parse(web.theme))},
                                {"libraries", inline_script(web.libraries)},
                                {"script", inline_script(web.script)}});
}

std::string live_page_html(const WebFiles& web) {
    std::string charts;
    for (const auto* id : {"charge", "power", "altitude"})
        charts += fmt::format("<div class=\"chart\" id=\"{0}\" role=\"img\" aria-label=\"{0} over time\"></div>\n", id);
    if (web.libraries.empty())
        charts = "<p>No charts: their libraries are not installed (scripts/install_dependencies).</p>\n";
    return filled_page("watch", {{"version", FLIGHTWATT_VERSION},
                                 {"style", web.style},
                                 {"charts", charts},
                                 {"theme", script_json(VegaJson::parse(web.theme))},
                                 {"libraries", web.libraries.empty() ? "" : inline_script(web.libraries)},
                                 {"script", inline_script(web.script)}});
}

FigureFiles write_figures(const std::vector<Section>& sections, const WebFiles& web,
                          const std::filesystem::path& folder, const FigureLayout& layout) {
    std::vector<const Figure*> figures;
    for (const auto& section : sections)
        for (const auto& figure : section.figures) figures.push_back(&figure);
    for (const auto* figure : figures)
        for (const auto* ending : {".vl.json", ".svg", ".pdf"}) register_output(folder / (figure->id + ending));
    make_directories(folder);
    constexpr double landscape = 0.75;  // of the width
    const auto theme = in_type_of_papers(VegaJson::parse(web.theme).at("light"), layout);
    FigureFiles files{figures.size()};
    const double width_px = layout.width_pt ? *layout.width_pt * px_per_pt : default_width_px;
    const double height_px = layout.height_pt.value_or(landscape * layout.width_pt.value_or(0.0)) * px_per_pt;
    std::vector<std::string> render{"node", (web.folder / "render.mjs").string(), folder.string(),
                                    fmt::format("{}", width_px), fmt::format("{}", height_px)};
    for (const auto* figure : figures) {
        write_file_atomically(folder / (figure->id + ".vl.json"), standalone(*figure, theme));
        render.push_back(figure->id);  // only these: the folder may contain others
    }
    files.has_svg = run_program(render);
    files.has_pdf = files.has_svg;
    for (const auto* figure : figures) {
        if (!files.has_pdf) break;
        const auto file = (folder / figure->id).string();
        files.has_pdf = run_program({"rsvg-convert", "--format", "pdf", "--output", file + ".pdf", file + ".svg"});
    }
    return files;
}

double parse_figure_length_pt(const std::string& option, const std::string& text) {
    static const std::map<std::string, double> points_of{
        {"in", 72.0}, {"cm", 72.0 / 2.54}, {"mm", 7.2 / 2.54}, {"pt", 1.0}};
    constexpr double min_pt = 1.5 * 72.0;
    constexpr double max_pt = 20.0 * 72.0;
    const auto unit_at = std::min(text.find_first_not_of("0123456789."), text.size());
    const auto unit = points_of.find(text.substr(unit_at));
    const auto number = parse_number(std::string_view(text).substr(0, unit_at));
    if (!number || unit == points_of.end())
        throw UsageError(
            fmt::format("--{} {}: expected a length with its unit: 3.5in, 89mm, 9cm or 252pt", option, text));
    const double length_pt = *number * unit->second;
    if (!(length_pt >= min_pt && length_pt <= max_pt))
        throw UsageError(fmt::format("--{} {}: expected 1.5in to 20in", option, text));
    return length_pt;
}

}  // namespace flightwatt::report
