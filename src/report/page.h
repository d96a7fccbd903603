#pragma once

#include "report/html.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flightwatt::report {

/// What the page is made of besides its contents.
struct WebFiles {
    std::filesystem::path folder;
    std::string style;
    std::string theme;      ///< Vega's configuration in light and dark, JSON
    std::string libraries;  ///< Vega, Vega-Lite and Vega-Embed
    std::string script;     ///< the page's own
};

/// The folder web/ of these programs: ../share/flightwatt/web beside the folder of the running program, or
/// what FLIGHTWATT_WEB says. Throws InputError where it is absent.
std::filesystem::path web_folder();

/// Throws InputError where a file is missing, saying how to install the libraries.
WebFiles read_web_files(const std::filesystem::path& folder);

/// What stands around the sections.
struct PageHead {
    std::string title;
    std::vector<std::pair<std::string, std::string>> facts;  ///< at the end: "computed" - "2026-01-01 12:00 UTC", ...
};

/// One HTML file that needs nothing else: styles, scripts, figures and their data are in it, and its policy
/// forbids it every request.
std::string page_html(const PageHead& head, const std::vector<Section>& sections, const WebFiles& web);

/// The same for the page of a flight in the air; without libraries where they are not installed.
WebFiles read_live_web_files(const std::filesystem::path& folder);

/// The page of a flight in the air, which listens to its server's events (docs/live.md) and asks nothing else. Without
/// the libraries that draw it shows the same without charts, and says so.
std::string live_page_html(const WebFiles& web);

/// Which files were made of every figure, beside its specification.
struct FigureFiles {
    std::size_t figures = 0;
    bool has_svg = false;
    bool has_pdf = false;
};

/// Writes every figure's specification to FOLDER/ID.vl.json, renders them to ID.svg with node, and to ID.pdf with
/// rsvg-convert; what of both programs is not there makes no files. With `width_pt` (points of 1/72 inch) they are so
/// wide, and their type is set at 8 points. Throws OutputError where the folder cannot be written or a program that is
/// there fails.
FigureFiles write_figures(const std::vector<Section>& sections, const WebFiles& web,
                          const std::filesystem::path& folder, const std::optional<double>& width_pt = std::nullopt);

/// "3.5in", "89mm", "9cm" or "252pt" in points. Throws UsageError for what is none, or not from 1.5 to 20 inches.
double parse_figure_width_pt(const std::string& text);

}  // namespace flightwatt::report
