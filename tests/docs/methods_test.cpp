#include "base/atomic_file.h"
#include "helpers/document.h"
#include "helpers/test_paths.h"

#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

namespace flightwatt::test {
namespace {

std::string methods() { return read_file(source_dir() / "docs" / "methods.md"); }

TEST(Methods, NameFunctionsThatExist) {
    // "`a`, `b` (`src/file.h`)": functions, and the file that declares them.
    const std::regex named(R"re(((?:`\w+`(?:,\s+)?)+)\s+\(`(src/[^`]+)`\))re");
    const std::regex word(R"re(`(\w+)`)re");
    const auto text = methods();
    std::size_t functions = 0;
    for (std::sregex_iterator it(text.begin(), text.end(), named), end; it != end; ++it) {
        const auto file = source_dir() / (*it)[2].str();
        ASSERT_TRUE(std::filesystem::exists(file)) << file;
        const auto source = read_file(file);
        const auto names = (*it)[1].str();
        for (std::sregex_iterator name(names.begin(), names.end(), word); name != end; ++name) {
            ++functions;
            EXPECT_TRUE(std::regex_search(source, std::regex("\\b" + (*name)[1].str() + "\\(")))
                << file << " has no function " << (*name)[1];
        }
    }
    EXPECT_GT(functions, 20U);
}

TEST(Library, IsDocumentedWithFunctionsThatExist) {
    const auto header = read_file(source_dir() / "include/flightwatt/predictor.h");
    std::stringstream lines(read_file(source_dir() / "docs" / "live.md"));
    const std::regex word(R"re(`([a-z]\w+)`)re");
    std::size_t functions = 0;
    bool in_section = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) in_section = line == "## As a library";
        // The first cells of the table.
        const auto part = line.starts_with("| `") ? line.substr(0, line.find('|', 1)) : "";
        if (!in_section) continue;
        for (std::sregex_iterator it(part.begin(), part.end(), word), end; it != end; ++it, ++functions)
            EXPECT_TRUE(std::regex_search(header, std::regex("\\b" + (*it)[1].str() + "\\("))) << (*it)[1];
    }
    EXPECT_GE(functions, 8U);
    const auto example = read_file(source_dir() / "examples/live_predictor.cpp");
    const std::regex used(R"re((?:predictor\.|live::)(\w{2,}))re");
    for (std::sregex_iterator it(example.begin(), example.end(), used), end; it != end; ++it)
        EXPECT_TRUE(std::regex_search(header, std::regex("\\b" + (*it)[1].str() + "\\b"))) << (*it)[1];
}

TEST(Methods, NumberTheirEquationsInOrder) {
    const std::regex number(R"re(\(Eq\. (\d+)\)$)re");
    std::stringstream lines(methods());
    int last = 0;
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, number)) continue;
        EXPECT_EQ(std::stoi(match[1]), last + 1) << line;
        last = std::stoi(match[1]);
    }
    EXPECT_GT(last, 30);
}

TEST(Methods, HaveTheEquationsThatTheSourceRefersTo) {
    const std::regex reference(R"re(docs/methods\.md, Eqs?\. (\d+)(?: (?:to|and) (\d+))?)re");
    const auto text = methods();
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source_dir() / "src")) {
        if (!entry.is_regular_file()) continue;
        const auto source = read_file(entry.path());
        for (std::sregex_iterator it(source.begin(), source.end(), reference), end; it != end; ++it) {
            for (const std::size_t group : {1U, 2U}) {
                if (!(*it)[group].matched) continue;
                EXPECT_NE(text.find("(Eq. " + (*it)[group].str() + ")"), std::string::npos)
                    << entry.path() << " refers to Eq. " << (*it)[group];
            }
        }
    }
}

}  // namespace
}  // namespace flightwatt::test
