#include "report/sections/section.h"

#include "report/html.h"

namespace flightwatt::report {

void add_figure(Section& section, Figure figure) {
    section.html += figure_html(figure);
    section.figures.push_back(std::move(figure));
}

}  // namespace flightwatt::report
