#pragma once

#include "report/html.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flightwatt::report {

/// Styles and scripts of a page.
struct WebFiles {
    std::filesystem::path folder;
    std::string style;
    std::string theme;      ///< Vega's configuration in light and dark, JSON
    std::string libraries;  ///< Vega, Vega-Lite and Vega-Embed
    std::string script;     ///< the page's own
};

/// The folder web/: ../share/flightwatt/web from the running program's folder, or $FLIGHTWATT_WEB. Throws InputError
/// where it is absent.
std::filesystem::path web_folder();

/// Throws InputError for a missing file, with how to install the libraries.
WebFiles read_web_files(const std::filesystem::path& folder);

/// Title, and the facts at the end of a page.
struct PageHead {
    std::string title;                                       ///< of the tab
    std::string name;                                        ///< in the bar at the top
    std::vector<std::pair<std::string, std::string>> facts;  ///< "computed" - "2026-01-01 12:00 UTC", ...
};

/// A self-contained HTML file with styles, scripts, figures and data; its policy refuses all requests.
std::string page_html(const PageHead& head, const std::vector<Section>& sections, const WebFiles& web);

/// Files of the live page; without libraries where they are not installed.
WebFiles read_live_web_files(const std::filesystem::path& folder);

/// The page of a flight in the air, which listens to its server's events (docs/live.md). Without the libraries it has
/// no charts.
std::string live_page_html(const WebFiles& web);

/// Kinds of files that were written for each figure.
struct FigureFiles {
    std::size_t figures = 0;
    bool has_svg = false;
    bool has_pdf = false;
};

/// Layout of figures for papers, in points (1/72 inch).
struct FigureLayout {
    std::optional<double> width_pt;   ///< with type of 8 points
    std::optional<double> height_pt;  ///< maximum; panels keep 50 px. Default: 4.5 inches, if a width is given
    bool is_serif = false;
};

/// Writes FOLDER/ID.vl.json of every figure, ID.svg by node and ID.pdf by rsvg-convert, where these programs are
/// installed. Throws OutputError where the folder cannot be written or a program fails.
FigureFiles write_figures(const std::vector<Section>& sections, const WebFiles& web,
                          const std::filesystem::path& folder, const FigureLayout& layout = {});

/// "3.5in", "89mm", "9cm" or "252pt" in points. Throws UsageError "--OPTION TEXT: ..." for another text, or not 1.5 to
/// 20 inches.
double parse_figure_length_pt(const std::string& option, const std::string& text);

}  // namespace flightwatt::report
