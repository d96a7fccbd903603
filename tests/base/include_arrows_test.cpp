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

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// The modules that a module may include, in addition to itself: the table "| module | may include |" of
/// ARCHITECTURE.md, which is the only place that states so.
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

constexpr std::size_t most_public_headers = 19;

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

/// Files below src/, each with those that it includes.
using Includes = std::map<std::string, std::set<std::string>>;

Includes includes_of_src() {
    Includes includes;
    for (const auto& [file, line, target] : include_lines("src")) {
        auto& targets = includes[below(file, "src").generic_string()];
        if (std::filesystem::exists(test::source_dir() / "src" / target)) targets.insert(target);
    }
    return includes;
}

/// All that `from` includes, directly or through others; itself only where they make a cycle.
std::set<std::string> reached(const Includes& includes, const std::string& from) {
    std::set<std::string> found;
    std::vector<std::string> open{from};
    while (!open.empty()) {
        const auto at = includes.find(open.back());
        open.pop_back();
        if (at == includes.end()) continue;
        for (const auto& target : at->second)
            if (found.insert(target).second) open.push_back(target);
    }
    return found;
}

bool is_public_header(const std::filesystem::path& below_src) {
    return below_src.extension() == ".h" && !is_private(below_src);
}

/// "live/a.h reaches live/state/b.h": a public header whose reader needs a private one.
std::vector<std::string> private_headers_reached(const Includes& includes) {
    std::vector<std::string> found;
    for (const auto& [file, targets] : includes) {
        if (!is_public_header(file)) continue;
        for (const auto& target : reached(includes, file))
            if (is_private(target)) found.push_back(file + " reaches " + target);
    }
    return found;
}

/// The units of cycles within a module; a unit is a header and the source of its name.
std::vector<std::string> units_in_cycles(const Includes& includes) {
    const auto unit_of = [](std::filesystem::path file) { return file.replace_extension().generic_string(); };
    Includes units;
    for (const auto& [file, targets] : includes)
        for (const auto& target : targets)
            if (module_of(file) == module_of(target) && unit_of(file) != unit_of(target))
                units[unit_of(file)].insert(unit_of(target));
    std::vector<std::string> found;
    for (const auto& [unit, targets] : units)
        if (reached(units, unit).contains(unit)) found.push_back(unit);
    return found;
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

TEST(IncludeArrows, OfPublicHeadersReachNoPrivateOnes) {
    EXPECT_THAT(private_headers_reached(includes_of_src()), IsEmpty());
}

TEST(IncludeArrows, OfUnitsOfAModuleMakeNoCycle) { EXPECT_THAT(units_in_cycles(includes_of_src()), IsEmpty()); }

TEST(IncludeArrows, OfMadeUpFilesThatAreWrongAreFound) {
    const Includes wrong{{"live/a.h", {"live/b.h"}},
                         {"live/b.h", {"base/csv.h", "live/state/c.h"}},
                         {"live/b.cpp", {"live/a.h"}},
                         {"live/d.cpp", {"live/a.h", "live/state/c.h"}}};
    EXPECT_THAT(private_headers_reached(wrong),
                ElementsAre("live/a.h reaches live/state/c.h", "live/b.h reaches live/state/c.h"));
    EXPECT_THAT(units_in_cycles(wrong), ElementsAre("live/a", "live/b"));
}

/// A header that no other module and no program includes is private, or belongs to another header.
TEST(IncludeArrows, LeadToEachPublicHeaderFromOutsideOfItsModule) {
    std::set<std::string> used;
    for (const auto* folder : {"src", "tools", "ros"})
        for (const auto& [file, line, target] : include_lines(folder))
            if (folder != std::string("src") || module_of(below(file, folder)) != module_of(target))
                used.insert(target);
    const auto src = test::source_dir() / "src";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(src)) {
        const auto header = entry.path().lexically_relative(src);
        if (!is_public_header(header)) continue;
        EXPECT_TRUE(used.contains(header.generic_string())) << header << " has no user outside of its module";
    }
}

/// What a .cpp defines for others is declared in the header of its name, in its folder or among the installed ones.
TEST(IncludeArrows, LeadFromEachSourceToAHeaderOfItsName) {
    const auto root = test::source_dir();
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "src")) {
        auto header = entry.path();
        if (header.extension() != ".cpp") continue;
        if (header.parent_path().filename() == "identification") continue;  // circuit_problem.h has several
        header.replace_extension(".h");
        EXPECT_TRUE(std::filesystem::exists(header) ||
                    std::filesystem::exists(root / "include/flightwatt" / header.filename()))
            << entry.path() << " has no header of its name";
    }
}

TEST(IncludeArrows, AModuleHasFewPublicHeaders) {
    std::map<std::string, std::size_t> headers;
    // The headers of src/library are those that are installed.
    for (const auto& entry : std::filesystem::directory_iterator(test::source_dir() / "include/flightwatt"))
        headers["library"] += entry.path().extension() == ".h";
    const auto src = test::source_dir() / "src";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(src)) {
        const auto path = entry.path().lexically_relative(src);
        if (is_public_header(path)) ++headers[module_of(path)];
    }
    EXPECT_EQ(headers.size(), allowed().size());
    for (const auto& [module, count] : headers) {
        EXPECT_LE(count, most_public_headers) << module << " has too many public headers";
    }
}

}  // namespace
}  // namespace flightwatt
