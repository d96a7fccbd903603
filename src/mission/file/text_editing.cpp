#include "mission/file/text_editing.h"

#include "base/toml_text.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <regex>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

struct Line {
    std::string text;
    bool is_kept = true;
};

std::vector<Line> lines_of(std::string_view text) {
    std::vector<Line> lines;
    while (!text.empty()) {
        const auto end = std::min(text.find('\n'), text.size());
        lines.push_back({std::string(text.substr(0, end))});
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

char first_character(const std::string& line) {
    const auto at = line.find_first_not_of(" \t\r");
    return at == std::string::npos ? '\0' : line[at];
}

bool is_blank(const std::string& line) { return first_character(line) == '\0'; }
bool is_comment(const std::string& line) { return first_character(line) == '#'; }
bool is_header(const std::string& line) { return first_character(line) == '['; }

/// The section that begins at `header` up to the next, without the comments that stand apart at its end.
void drop_section(std::vector<Line>& lines, std::size_t header) {
    auto end = header + 1;
    while (end < lines.size() && !is_header(lines[end].text)) ++end;
    auto last = end;
    while (last > header + 1 && (is_blank(lines[last - 1].text) || is_comment(lines[last - 1].text))) --last;
    while (last < end && is_comment(lines[last].text)) ++last;  // directly below its last key
    if (last == end && end < lines.size()) {                    // or directly above the next header, which it is of
        while (last > header + 1 && is_comment(lines[last - 1].text)) --last;
    }
    auto first = header;
    while (first > 0 && is_comment(lines[first - 1].text)) --first;
    for (auto i = first; i < last; ++i) lines[i].is_kept = false;
    if (first > 0 && last < lines.size() && is_blank(lines[first - 1].text) && is_blank(lines[last].text))
        lines[last].is_kept = false;
}

void drop_schedule(std::vector<Line>& lines) {
    static const std::regex of_header(R"(^\s*\[\[?\s*(plan|policy|schedule)\s*(\.|\]).*)");
    static const std::regex of_key(R"(^\s*(plan|policy|schedule)\s*(\.|=).*)");
    bool in_root = true;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        in_root = in_root && !is_header(lines[i].text);
        if (std::regex_match(lines[i].text, of_header)) drop_section(lines, i);
        if (in_root && std::regex_match(lines[i].text, of_key)) lines[i].is_kept = false;
    }
}

/// Puts the text of `wanted` where `read` stands in the line, quoted on one line.
void rename_file(std::vector<Line>& lines, const toml::value<std::string>& read, const std::string& wanted) {
    const auto place = read.source().begin;
    if (place.line < 1 || place.line > lines.size()) return;
    auto& line = lines[place.line - 1].text;
    const std::size_t start = place.column - 1;
    if (start >= line.size() || (line[start] != '"' && line[start] != '\'')) return;
    const auto end = line.find(line[start], start + 1);
    if (end == std::string::npos) return;
    line.replace(start, end + 1 - start, toml_string(wanted));
}

/// Follows both tables and renames what differs in a text.
void rename_files(std::vector<Line>& lines, const toml::table& read, const toml::table& wanted) {
    for (auto&& [key, node] : read) {
        const auto* other = wanted.get(key.str());
        if (other == nullptr) continue;
        if (const auto* table = node.as_table(); table != nullptr && other->is_table()) {
            rename_files(lines, *table, *other->as_table());
        } else if (const auto* text = node.as_string(); text != nullptr && other->is_string()) {
            if (text->get() != other->as_string()->get()) rename_file(lines, *text, other->as_string()->get());
        }
    }
}

std::string joined(const std::vector<Line>& lines) {
    std::string text;
    for (const auto& line : lines)
        if (line.is_kept) text += line.text + "\n";
    while (text.ends_with("\n\n")) text.pop_back();
    return text;
}

}  // namespace

std::string normalise_text(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    std::string plain;
    plain.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i)
        if (!text.substr(i).starts_with("\r\n")) plain += text[i];
    return plain;
}

std::optional<std::string> edit_keeping_comments(std::string_view text, const toml::table& read,
                                                 const toml::table& wanted) {
    auto lines = lines_of(text);
    rename_files(lines, read, wanted);
    drop_schedule(lines);
    auto kept = joined(lines);
    if (!read.contains("format") && wanted.contains("format")) {
        const auto version = wanted["format"].value_or<std::int64_t>(0);
        std::size_t at = 0;  // below the comments that the file begins with
        while (at < kept.size() && kept[at] == '#') at = kept.find('\n', at) + 1;
        kept.insert(at, fmt::format("format = {}\n", version));
    }
    try {
        if (toml::parse(kept) == wanted) return kept;
    } catch (const toml::parse_error&) {
        // a section that was written in a way not looked for
    }
    return std::nullopt;
}

}  // namespace flightwatt::mission
