#pragma once

#include "report/sections/section.h"
#include "report/web_files.h"

#include <string>
#include <utility>
#include <vector>

namespace flightwatt::report {

/// What stands at the top of the page.
struct PageHead {
    std::string title;
    std::vector<std::pair<std::string, std::string>> facts;  ///< "computed" - "2026-01-01 12:00 UTC", ...
    std::vector<std::string> notes;                          ///< what is not here, and why
};

/// One HTML file that needs nothing else: styles, scripts, figures and their data are in it, and its policy
/// forbids it every request.
std::string page_html(const PageHead& head, const std::vector<Section>& sections, const WebFiles& web);

}  // namespace flightwatt::report
