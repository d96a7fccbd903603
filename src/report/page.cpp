#include "report/page.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/program_files.h"

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
        escaped(head.title), web.style);
}

std::string contents_html(const std::vector<Section>& sections) {
    std::string html = "<nav aria-label=\"Contents\"><ul>\n";
    for (const auto& section : sections) {
        html += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id, escaped(section.title));
    }
    return html + "</ul></nav>\n";
}

std::string opening_html(const PageHead& head, const std::vector<Section>& sections) {
    auto html = fmt::format("<header>\n<h1>{}</h1>\n<dl>\n", escaped(head.title));
    for (const auto& [name, value] : head.facts) {
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(value));
    }
    html += "</dl>\n";
    for (const auto& note : head.notes) html += paragraph(note, "warning");
    return html + contents_html(sections) +
           "<p class=\"soft keys\">In figures over time: drag to move, Ctrl and wheel to zoom, double-click for "
           "all; with the keyboard + and \u2212, arrows, 0, and the tab key for the series. The menu in a "
           "figure's corner saves it.</p>\n"
           "<noscript><p class=\"warning\">The figures need JavaScript; the tables do not.</p></noscript>\n"
           "</header>\n";
}

}  // namespace

std::filesystem::path web_folder() { return program_files("web", "FLIGHTWATT_WEB", "the report's web files"); }

WebFiles read_web_files(const std::filesystem::path& folder) {
    WebFiles files;
    files.folder = folder;
    files.style = read_file(folder / "page.css");
    files.theme = read_file(folder / "theme.json");
    for (const auto* library : {"vega", "vega-lite", "vega-embed"}) {
        const auto path = folder / "node_modules" / library / "build" / (std::string(library) + ".min.js");
        if (reading_error(path)) {
            throw InputError({path.string()}, "the report's figures need this library, and it is not there",
                             "run scripts/install_dependencies with the npm registry at hand");
        }
        files.libraries += read_file(path) + "\n";
    }
    files.script = read_file(folder / "fit_width.js") + read_file(folder / "page.js");
    return files;
}

std::string page_html(const PageHead& head, const std::vector<Section>& sections, const WebFiles& web) {
    auto html = head_html(head, web) + "<body>\n" + opening_html(head, sections) + "<main>\n";
    for (const auto& section : sections) {
        html += fmt::format("<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n",
                            section.id, escaped(section.title));
        html += section.html + "</section>\n";
    }
    html += "</main>\n<script type=\"application/json\" id=\"theme\">" + script_json(VegaJson::parse(web.theme)) +
            "</script>\n";
    return html + inline_script(web.libraries) + inline_script(web.script) + "</body>\n</html>\n";
}

}  // namespace flightwatt::report
