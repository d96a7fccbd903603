#pragma once

#include "report/page.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::report {

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
