#include "report/page.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/input_file.h"

#include <optional>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// A script's text cannot end its element: inside of strings and regular expressions "<\/" is "</".
std::string inline_script(const std::string& text) {
    return "<script>" + boost::replace_all_copy(text, "</script", "<\\/script") + "</script>\n";
}

std::string head_html(const PageHead& head, const WebFiles& web) {
    // The policy lets the page draw (Vega compiles its expressions) and ask the network for nothing.
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
        "script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; img-src data: blob:\">\n"
        "<meta name=\"generator\" content=\"flightwatt " FLIGHTWATT_VERSION
        "\">\n<link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>\n{}</style>\n</head>\n",
        html_escaped(head.title), web.style);
}

std::vector<std::filesystem::path> library_paths(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> paths;
    for (const auto* library : {"vega", "vega-lite", "vega-embed"})
        paths.push_back(folder / "node_modules" / library / "build" / (std::string(library) + ".min.js"));
    return paths;
}

/// The first that is not there.
std::optional<std::filesystem::path> missing_library(const std::filesystem::path& folder) {
    for (const auto& path : library_paths(folder)) {
        if (open_error(path)) return path;
    }
    return std::nullopt;
}

/// Style, theme and, where they are all there, libraries.
WebFiles read_drawing_files(const std::filesystem::path& folder) {
    WebFiles files;
    files.folder = folder;
    files.style = read_file(folder / "page.css");
    files.theme = read_file(folder / "theme.json");
    if (missing_library(folder)) return files;
    for (const auto& path : library_paths(folder)) files.libraries += read_file(path) + "\n";
    return files;
}

std::string contents_html(const std::vector<Section>& sections) {
    std::string html = "<nav aria-label=\"Contents\"><ul>\n";
    for (const auto& section : sections) {
        html += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id, html_escaped(section.title));
    }
    return html + "</ul></nav>\n";
}

std::string opening_html(const PageHead& head, const std::vector<Section>& sections) {
    return fmt::format("<header>\n<h1>{}</h1>\n", html_escaped(head.title)) + contents_html(sections) +
           "<noscript><p class=\"warning\">The figures need JavaScript; the tables do not.</p></noscript>\n"
           "</header>\n";
}

std::string closing_html(const PageHead& head) {
    std::string html = "<footer>\n<h2>About this page</h2>\n<dl>\n";
    for (const auto& [name, value] : head.facts)
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", html_escaped(name), html_escaped(value));
    html += "</dl>\n";
    return html +
           "<p class=\"soft keys\">In figures over time: drag to move, Ctrl and wheel to zoom, double-click for "
           "all; with the keyboard + and \u2212, arrows, 0, and the tab key for the series. The menu in a "
           "figure's corner saves it.</p>\n</footer>\n";
}

}  // namespace

std::filesystem::path web_folder() { return data_folder("web", "FLIGHTWATT_WEB", "the report's web files"); }

WebFiles read_web_files(const std::filesystem::path& folder) {
    if (const auto missing = missing_library(folder)) {
        throw InputError({missing->string()}, "the report's figures need this library, and it is not there",
                         "run scripts/install_dependencies with the npm registry at hand");
    }
    auto files = read_drawing_files(folder);
    for (const auto* script : {"fit_width.js", "blocks.js", "page.js"}) files.script += read_file(folder / script);
    return files;
}

WebFiles read_live_web_files(const std::filesystem::path& folder) {
    auto files = read_drawing_files(folder);
    files.script = read_file(folder / "watch.js");
    return files;
}

std::string page_html(const PageHead& head, const std::vector<Section>& sections, const WebFiles& web) {
    auto html = head_html(head, web) + "<body>\n" + opening_html(head, sections) + "<main>\n";
    for (const auto& section : sections) {
        html += fmt::format("<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n",
                            section.id, html_escaped(section.title));
        html += section.html + "</section>\n";
    }
    html += "</main>\n" + closing_html(head) + "<script type=\"application/json\" id=\"theme\">" +
            script_json(VegaJson::parse(web.theme)) + "</script>\n";
    return html + inline_script(web.libraries) + inline_script(web.script) + "</body>\n</html>\n";
}

std::string live_page_html(const WebFiles& web) {
    const auto part = [](const char* title, const char* id) {
        return fmt::format("<section><h2>{}</h2><dl id=\"{}\"></dl></section>\n", title, id);
    };
    const auto list = [](const char* title, const char* id) {
        return fmt::format("<section><h2>{0}</h2><ul id=\"{1}\" aria-label=\"{0}\"{2}></ul></section>\n", title, id,
                           std::string_view(id) == "alarms" ? " aria-live=\"assertive\"" : "");
    };
    auto html = head_html({.title = "flightwatt watch", .facts = {}}, web);
    boost::replace_first(html, "img-src data: blob:", "img-src data: blob:; connect-src 'self'");
    html +=
        "<body>\n<main id=\"page\">\n<h1 id=\"title\">No aircraft yet</h1>\n"
        "<p id=\"connection\" class=\"warning\" role=\"status\"></p>\n"
        "<noscript><p class=\"warning\">This page needs JavaScript; /state is the same as JSON.</p></noscript>\n";
    html += list("Alarms", "alarms");
    if (web.libraries.empty()) {
        html += paragraph(
            "There are no charts: the libraries that draw them are not installed (scripts/install_dependencies).",
            "warning");
    } else {
        html += "<h2>Charts</h2>\n";
        for (const auto* id : {"charge", "power", "altitude"}) {
            html += fmt::format(
                "<figure><div class=\"figure\" id=\"{0}\" role=\"img\" aria-label=\"{0} over time\">"
                "</div></figure>\n",
                id);
        }
    }
    html += part("Now", "now") + part("Landing", "landing") + part("Schedule", "schedule") + part("Link", "link");
    html += list("Warnings", "warnings") + "</main>\n<script type=\"application/json\" id=\"theme\">" +
            script_json(VegaJson::parse(web.theme)) + "</script>\n";
    if (!web.libraries.empty()) html += inline_script(web.libraries);
    return html + inline_script(web.script) + "</body>\n</html>\n";
}

}  // namespace flightwatt::report
