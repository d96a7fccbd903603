#pragma once

#include "report/html.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flightwatt::report {

/// The styles and scripts of a page.
struct WebFiles {
    std::filesystem::path folder;
    std::string style;
    std::string theme;      ///< Vega's configuration in light and dark, JSON
    std::string libraries;  ///< Vega, Vega-Lite and Vega-Embed
    std::string script;     ///< the page's own
};

/// Returns the folder web/: $FLIGHTWATT_WEB, or ../share/flightwatt/web from the running program's folder. Throws
/// InputError if it is absent.
std::filesystem::path web_folder();

/// Reads the files of a report. Throws InputError for a missing file, with how to install the libraries.
WebFiles read_web_files(const std::filesystem::path& folder);

/// The title of a page, and the facts at its end.
struct PageHead {
    std::string title;                                       ///< title of the tab
    std::string name;                                        ///< title in the bar at the top
    std::vector<std::pair<std::string, std::string>> facts;  ///< "computed" - "2026-01-01 12:00 UTC", ...
};

/// Returns a self-contained HTML file with styles, scripts, figures and data; its content security policy forbids all
/// requests.
std::string page_html(const PageHead& head, const std::vector<Section>& sections, const WebFiles& web);

/// Reads the files of the live page, without the libraries if they are not installed.
WebFiles read_live_web_files(const std::filesystem::path& folder);

/// Returns the page of a flight in progress, which receives the events of its server (docs/live.md). Without the
/// libraries it has no charts.
std::string live_page_html(const WebFiles& web);

/// Number of figures, and the kinds of files that were written for each.
struct FigureFiles {
    std::size_t figures = 0;
    bool has_svg = false;
    bool has_pdf = false;
};

/// The layout of figures for papers, in points (1/72 inch).
struct FigureLayout {
    std::optional<double> width_pt;  ///< width, with type of 8 points
    /// Maximum height; panels have at least 40 px. Default: 3/4 of a given width
    std::optional<double> height_pt;
    bool is_serif = false;
};

/// Writes FOLDER/ID.vl.json of every figure, and ID.svg by node and ID.pdf by rsvg-convert if these programs are
/// installed. Throws OutputError if the folder cannot be written or a program fails.
FigureFiles write_figures(const std::vector<Section>& sections, const WebFiles& web,
                          const std::filesystem::path& folder, const FigureLayout& layout = {});

/// Parses "3.5in", "89mm", "9cm" or "252pt" and returns points. Throws UsageError "--OPTION TEXT: ..." for another
/// text, and for lengths outside of 1.5 to 20 inches.
double parse_figure_length_pt(const std::string& option, const std::string& text);

}  // namespace flightwatt::report
