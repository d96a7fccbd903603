#pragma once

#include "record/json_type.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::report {

/// The names of figures, and the kinds of files that were written for each.
struct FigureFiles {
    std::vector<std::string> names;  ///< empty where node is not installed
    bool has_pdf = false;
};

/// The layout of figures for papers, in points (1/72 inch).
struct FigureLayout {
    std::optional<double> width_pt;  ///< width, with type of 8 points
    /// Maximum height; panels have at least 40 px. Default: 3/4 of a given width
    std::optional<double> height_pt;
    bool is_serif = false;
};

/// Returns the folder web/ with what draws figures. Throws InputError for a missing library, with how to install it.
std::filesystem::path figure_tools(const std::filesystem::path& web);

/// Writes FOLDER/NAME.vl.json and NAME.svg of every figure of a report's document by node (web/render.mjs), and NAME.pdf
/// by rsvg-convert, if these programs are installed. Throws OutputError if the folder cannot be written or a program
/// fails.
FigureFiles write_figures(const Json& document, const std::filesystem::path& tools, const std::filesystem::path& folder,
                          const FigureLayout& layout = {});

/// Parses "3.5in", "89mm", "9cm" or "252pt" and returns points. Throws UsageError "--OPTION TEXT: ..." for another
/// text, and for lengths outside of 1.5 to 20 inches.
double parse_figure_length_pt(const std::string& option, const std::string& text);

}  // namespace flightwatt::report
