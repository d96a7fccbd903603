#include "cli/help.h"

#include "base/atomic_file.h"
#include "cli/stage.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

std::string first_heading(std::string_view text) {
    const auto start = text.starts_with("# ") ? 0 : text.find("\n# ");
    if (start == std::string_view::npos) return "";
    const auto heading = text.substr(text.find("# ", start) + 2);
    return std::string(heading.substr(0, heading.find('\n')));
}

/// Whether a pager ran. One that was left early has shown what was wanted.
bool page_through(std::string_view text) {
    constexpr int no_such_command = 127;
    ::setenv("LESS", "FRX", 0);  // as git does: a short page is printed and less ends
    std::FILE* pager = ::popen("${PAGER:-less}", "w");
    if (pager == nullptr) return false;
    std::fwrite(text.data(), 1, text.size(), pager);
    const int status = ::pclose(pager);
    return !(WIFEXITED(status) && WEXITSTATUS(status) == no_such_command);
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

void show_page(std::string_view text) {
    if (::isatty(STDOUT_FILENO) == 0 || !page_through(text)) print(text);
}

std::string version_text() {
    const std::string_view known = commit != nullptr ? commit() : "";
    return known.empty() ? FLIGHTWATT_VERSION : fmt::format(FLIGHTWATT_VERSION " ({})", known);
}

}  // namespace flightwatt::cli
