// Who may include whom, and what of a module others may see, read off the include lines.

#include "helpers/test_paths.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt {
namespace {

/// The modules that a module may include, besides itself: the table "| module | may include |" of
/// ARCHITECTURE.md, which is the only place that says so.
std::map<std::string, std::set<std::string>> read_layout() {
    std::map<std::string, std::set<std::string>> layout;
    std::ifstream file(test::source_dir() / "ARCHITECTURE.md");
    const std::regex row(R"re(\| ([a-z/]+) \| ([a-z/, -]+) \|)re");
    const std::regex name("[a-z/]+");
    bool in_table = false;
    for (std::string line; std::getline(file, line);) {
        if (line == "| module | may include |") in_table = true;
        if (!line.starts_with("|")) in_table = false;
        std::smatch match;
        if (!in_table || !std::regex_match(line, match, row) || match[1] == "module") continue;
        const auto names = match[2].str();
        auto& includes = layout[match[1]];
        for (std::sregex_iterator it(names.begin(), names.end(), name), end; it != end; ++it)
            includes.insert(it->str());
    }
    return layout;
}

const std::map<std::string, std::set<std::string>>& allowed() {
    static const auto layout = read_layout();
    return layout;
}

constexpr std::size_t most_public_headers = 16;

struct IncludeLine {
    std::filesystem::path file;  ///< below the project's folder
    std::size_t line = 0;
    std::string target;  ///< "mission/planning/planner.h"
};

/// The module of a path below src/: its first folder, or cli/output.
std::string module_of(const std::filesystem::path& below_src) {
    auto first = below_src.begin()->string();
    if (first == "cli" && std::next(below_src.begin())->string() == "output") return "cli/output";
    return first;
}

/// A header below a sub-folder of its module is private to the module.
bool is_private(const std::filesystem::path& below_src) {
    const auto folder = below_src.parent_path().generic_string();
    return folder != module_of(below_src);
}

std::vector<IncludeLine> include_lines(const std::string& folder) {
    const std::regex pattern("^\\s*#include \"([^\"]+/[^\"]+)\"");
    std::vector<IncludeLine> found;
    const auto root = test::source_dir();
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
        if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
        std::ifstream file(entry.path());
        std::string line;
        for (std::size_t number = 1; std::getline(file, line); ++number) {
            std::smatch match;
            if (!std::regex_search(line, match, pattern)) continue;
            found.push_back({entry.path().lexically_relative(root), number, match[1].str()});
        }
    }
    return found;
}

std::filesystem::path below(const std::filesystem::path& path, const char* folder) {
    return path.lexically_relative(folder);
}

TEST(IncludeArrows, PointOnlyWhereTheLayoutAllows) {
    const auto lines = include_lines("src");
    for (const auto& [file, line, target] : lines) {
        const auto module = module_of(below(file, "src"));
        const auto included = module_of(target);
        ASSERT_TRUE(allowed().contains(module)) << "a module that the layout does not have: " << file;
        EXPECT_TRUE(included == module || allowed().at(module).contains(included))
            << file.string() << ":" << line << ": " << module << " may not include " << included;
    }
    EXPECT_GT(lines.size(), 500U) << "the include lines were not found";
}

TEST(IncludeArrows, HeadersInSubFoldersArePrivateToTheirModule) {
    for (const auto* folder : {"src", "tools", "tests"}) {
        for (const auto& [file, line, target] : include_lines(folder)) {
            if (!std::filesystem::exists(test::source_dir() / "src" / target) || !is_private(target)) continue;
            const auto place = below(file, folder);
            const auto first = place.begin()->string();
            if (folder == std::string("tests") && (first == "helpers" || first == "bench" || first == "fuzz")) continue;
            // A test is inside of the module that it mirrors; helpers, benchmarks and fuzz targets are inside of all.
            EXPECT_TRUE(folder != std::string("tools") && module_of(place) == module_of(target))
                << file.string() << ":" << line << ": " << target << " is private to " << module_of(target);
        }
    }
}

TEST(IncludeArrows, AModuleHasFewPublicHeaders) {
    std::map<std::string, std::size_t> headers;
    const auto src = test::source_dir() / "src";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(src)) {
        const auto path = entry.path().lexically_relative(src);
        if (path.extension() == ".h" && !is_private(path)) ++headers[module_of(path)];
    }
    EXPECT_EQ(headers.size(), allowed().size());
    for (const auto& [module, count] : headers) {
        EXPECT_LE(count, most_public_headers) << module << " has too many public headers";
    }
}

}  // namespace
}  // namespace flightwatt
