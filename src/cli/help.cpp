#include "cli/help.h"

#include "base/atomic_file.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

std::string first_heading(std::string_view text) {
    const auto start = text.starts_with("# ") ? 0 : text.find("\n# ");
    if (start == std::string_view::npos) return "";
    const auto heading = text.substr(text.find("# ", start) + 2);
    return std::string(heading.substr(0, heading.find('\n')));
}

}  // namespace

std::vector<HelpPage> help_pages(const std::filesystem::path& folder) {
    std::vector<HelpPage> pages;
    std::error_code absent;
    for (const auto& entry : std::filesystem::directory_iterator(folder, absent)) {
        const auto& file = entry.path();
        if (file.extension() == ".md") pages.push_back({file.stem(), first_heading(read_file(file)), file});
    }
    std::ranges::sort(pages, [](const auto& a, const auto& b) { return a.topic < b.topic; });
    return pages;
}

std::string version_text() {
    const std::string_view known = commit != nullptr ? commit() : "";
    return known.empty() ? FLIGHTWATT_VERSION : fmt::format(FLIGHTWATT_VERSION " ({})", known);
}

}  // namespace flightwatt::cli
