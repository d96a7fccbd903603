#pragma once

#include "report/figure.h"

#include <string>
#include <vector>

namespace flightwatt::report {

/// A part of the page. Its figures stand in its HTML already; they are kept to be rendered as files.
struct Section {
    std::string id;
    std::string title;
    std::string html;
    std::vector<Figure> figures;
};

/// Puts a figure at the end of a section.
void add_figure(Section& section, Figure figure);

}  // namespace flightwatt::report
