#include "helpers/document.h"

#include "base/atomic_file.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cctype>
#include <regex>
#include <sstream>

namespace flightwatt::test {
namespace {

constexpr std::size_t max_line = 120;

std::vector<std::string> matches_of(const std::string& text, const std::regex& pattern) {
    std::vector<std::string> found;
    for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) found.push_back((*it)[1]);
    return found;
}

std::vector<std::string> words_in_code(const std::string& text) {
    static const std::regex code("`([^`]+)`");
    return matches_of(text, code);
}

std::vector<std::string> split(const std::string& text, const std::regex& separator) {
    return {std::sregex_token_iterator(text.begin(), text.end(), separator, -1), std::sregex_token_iterator()};
}

std::size_t characters_of(const std::string& line) {
    return static_cast<std::size_t>(std::count_if(
        line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::vector<std::string> cells_of(const std::string& row) {
    std::vector<std::string> cells;
    std::stringstream stream(row.substr(1));
    for (std::string cell; std::getline(stream, cell, '|');) {
        const auto from = cell.find_first_not_of(' ');
        const auto to = cell.find_last_not_of(' ');
        cells.push_back(from == std::string::npos ? "" : cell.substr(from, to - from + 1));
    }
    return cells;
}

/// "### `[components.NAME]`" is the anchor "componentsname".
std::string anchor_of(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0 || c == '_' || c == '-' || byte >= 0x80) {
            anchor += static_cast<char>(std::tolower(byte));
        } else if (c == ' ') {
            anchor += '-';
        }
    }
    return anchor;
}

std::string without_brackets(std::string word) {
    std::erase_if(word, [](char c) { return c == '[' || c == ']'; });
    return word;
}

/// Goes through a page line by line.
class Reader {
  public:
    explicit Reader(Document& document) : document_(document) {}

    void read(const std::string& line) {
        ++line_;
        if (line.starts_with("```")) return fence(line);
        if (in_fence_) {
            if (example_ != nullptr) example_->text += line + "\n";
            if (in_key_block_) block_row(line);
            return;
        }
        if (line.starts_with("#")) return heading(line);
        for (const auto& target : matches_of(line, link_)) document_.links.push_back({target, line_});
        if (line.starts_with("|")) return row(line);
        in_key_table_ = false;
        if (characters_of(line) > max_line && !line.starts_with("<!--") && !line.starts_with("!["))
            document_.long_lines.push_back(line);
    }

  private:
    void fence(const std::string& line) {
        in_fence_ = !in_fence_;
        example_ = nullptr;
        is_column_ = line == "```text columns";
        in_key_block_ = line == "```text keys" || is_column_;
        parents_.clear();
        const auto blank = in_key_block_ ? std::string::npos : line.find(' ');
        if (!in_fence_ || blank == std::string::npos) return;
        document_.examples.push_back({line.substr(blank + 1), "", line_});
        example_ = &document_.examples.back();
    }

    void heading(const std::string& line) {
        const auto level = line.find_first_not_of('#');
        const auto text = line.substr(level + 1);
        document_.anchors.push_back(anchor_of(text));
        in_key_table_ = false;
        if (level == 2) section_ = text;
        if (level > 3) return;
        tables_.clear();
        if (level == 3)
            for (const auto& word : words_in_code(text)) tables_.push_back(without_brackets(word));
    }

    void row(const std::string& line) {
        const auto cells = cells_of(line);
        if (cells.size() == 4 && (cells[0] == "key" || cells[0] == "column")) {
            in_key_table_ = true;
            is_column_ = cells[0] == "column";
        } else if (in_key_table_ && !cells[0].starts_with("---")) {
            for (const auto& key : words_in_code(cells[0]))
                document_.keys.push_back({section_, tables_, key, cells[1], cells[2], is_column_, line_});
        }
    }

    /// A line "key  type  default  meaning" of a block, without a default of what is only written. Keys of a table are
    /// indented below it. Lines that continue a meaning are indented further.
    void block_row(const std::string& line) {
        constexpr std::size_t max_indent = 12;
        const auto indent = line.find_first_not_of(' ');
        if (indent > max_indent) return;  // also that of an empty line
        auto fields = split(line.substr(indent), std::regex("  +"));
        if (fields.size() == 3) fields.insert(fields.begin() + 2, "written");
        fields.resize(4);
        parents_.resize(std::min(parents_.size(), indent / 2));
        std::vector<std::string> paths;
        for (const auto& parent : parents_.empty() ? std::vector<std::string>{""} : parents_.back())
            for (const auto& key : split(fields[0], std::regex(", "))) paths.push_back(parent + key);
        for (auto& path : paths) {
            document_.keys.push_back({section_, tables_, path, fields[1], fields[2], is_column_, line_});
            path += ".";
        }
        parents_.push_back(paths);
    }

    Document& document_;
    std::size_t line_ = 0;
    bool in_fence_ = false;
    bool in_key_table_ = false;
    bool in_key_block_ = false;
    std::vector<std::vector<std::string>> parents_;  ///< of a line in a block: the paths of each table above it
    bool is_column_ = false;
    DocumentedExample* example_ = nullptr;
    std::string section_;
    std::vector<std::string> tables_;
    const std::regex link_{R"(\]\(([^)\s]+)\))"};
};

std::vector<std::string> words_of(const std::string& path) {
    std::vector<std::string> words;
    std::stringstream stream(path);
    for (std::string word; std::getline(stream, word, '.');) words.push_back(without_brackets(word));
    return words;
}

bool is_wildcard(const std::string& word) {
    return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
}

}  // namespace

Document read_document(const std::filesystem::path& path) {
    Document document{path, read_file(path), {}, {}, {}, {}, {}};
    Reader reader(document);
    std::stringstream stream(document.text);
    for (std::string line; std::getline(stream, line);) reader.read(line);
    return document;
}

std::vector<DocumentedExample> example_files() {
    std::vector<DocumentedExample> examples;
    for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "tests" / "docs" / "files"))
        examples.push_back({entry.path().stem().string(), read_file(entry.path()), 1});
    std::ranges::sort(examples, {}, &DocumentedExample::kind);
    return examples;
}

std::vector<std::filesystem::path> all_documents() {
    const auto root = source_dir();
    std::vector<std::filesystem::path> found{root / "logs" / "README.md"};
    for (const auto& folder : {root, root / "docs", root / "docs" / "reference"}) {
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".md") found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

bool path_matches(const std::string& documented, const std::string& path) {
    const auto words = words_of(documented);
    const auto given = words_of(path);
    return std::equal(words.begin(), words.end(), given.begin(), given.end(),
                      [](const auto& word, const auto& is) { return word == is || is_wildcard(word); });
}

}  // namespace flightwatt::test
