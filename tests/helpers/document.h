#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flightwatt::test {

/// One key or column of a table "| key | type or unit | default | meaning |", or of a block "text keys".
struct DocumentedKey {
    std::string section;              ///< heading of the second level above it: "Mission file"
    std::vector<std::string> tables;  ///< what the heading of the third level names in `...`: "plan.levels"
    std::string key;                  ///< may begin with its table: "time.column"
    std::string unit;                 ///< of a number, else the type; "any" of a key that is permitted and not used
    std::string fallback;             ///< the column "default"
    bool is_column = false;           ///< of a table, and not a key
    std::size_t line = 0;
};

/// A block in fences whose language is followed by what it is: "toml mission".
struct DocumentedExample {
    std::string kind;
    std::string text;
    std::size_t line = 0;
};

struct DocumentedLink {
    std::string target;
    std::size_t line = 0;
};

/// What tests want to know of a page.
struct Document {
    std::filesystem::path path;
    std::string text;
    std::vector<DocumentedKey> keys;
    std::vector<DocumentedExample> examples;
    std::vector<DocumentedLink> links;
    std::vector<std::string> anchors;     ///< of its headings, as GitHub makes them
    std::vector<std::string> long_lines;  ///< of prose: longer than 120 characters
};

Document read_document(const std::filesystem::path& path);

/// Examples that no page shows: tests/docs/files, with the name of a file as its kind.
std::vector<DocumentedExample> example_files();

/// All pages of the project: README.md and the others of its folder, docs/, docs/reference/ and logs/README.md.
std::vector<std::filesystem::path> all_documents();

/// Whether a path like "components.detection.qos" is meant by "components.NAME.qos": words in capitals stand
/// for any word. "[]" behind a word is not read.
bool path_matches(const std::string& documented, const std::string& path);

}  // namespace flightwatt::test
