#pragma once

#include "report/page.h"

#include <filesystem>
#include <vector>

namespace flightwatt::report {

/// Which files were made of every figure, beside its specification.
struct FigureFiles {
    std::size_t figures = 0;
    bool has_svg = false;
    bool has_pdf = false;
};

/// Writes every figure's specification to FOLDER/ID.vl.json, renders them to ID.svg with node, and to ID.pdf
/// with rsvg-convert; what of both programs is not there makes no files. Throws OutputError where the folder
/// cannot be written or a program that is there fails.
FigureFiles write_figures(const std::vector<Section>& sections, const WebFiles& web,
                          const std::filesystem::path& folder);

}  // namespace flightwatt::report
