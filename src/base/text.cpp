#include "base/text.h"

#include "base/units.h"

#include <cctype>
#include <cmath>
#include <cstdint>

#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt {
namespace {

/// The bytes that may follow the first one: others would be an overlong form, a surrogate or beyond Unicode.
bool may_follow(unsigned lead, unsigned second) {
    const unsigned low = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
    const unsigned high = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
    return second >= low && second <= high;
}

}  // namespace

Utf8Character first_character(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(text[i])); };
    const unsigned lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    if (lead < 0xC2 || lead > 0xF4) return {};
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    char32_t code = lead & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        const bool goes_on = i < text.size() && (i == 1 ? may_follow(lead, byte(1)) : continues_character(text[i]));
        if (!goes_on) return {Utf8Character{}.code, i};
        code = code << 6U | (byte(i) & 0x3FU);
    }
    return {code, length};
}

std::string valid_utf8(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const auto [code, bytes] = first_character(text);
        result += code == Utf8Character{}.code ? std::string_view("\xEF\xBF\xBD") : text.substr(0, bytes);
        text.remove_prefix(bytes);
    }
    return result;
}

std::size_t character_count(std::string_view text) {
    return text.size() - static_cast<std::size_t>(std::ranges::count_if(text, continues_character));
}

std::string toml_string(std::string_view text) {
    std::string result = "\"";
    const auto valid = valid_utf8(text);
    for (const char c : valid) {
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
            result += fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
        } else {
            result += c;
        }
    }
    return result + '"';
}

std::string toml_real(double value) {
    auto text = fmt::format("{}", value);
    if (text.find_first_of(".en") == std::string::npos) text += ".0";
    return text;
}

std::string toml_reals(const std::vector<double>& values) {
    std::vector<std::string> texts;
    texts.reserve(values.size());
    for (const double value : values) texts.push_back(toml_real(value));
    return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string toml_strings(const std::vector<std::string>& texts) {
    std::vector<std::string> quoted;
    quoted.reserve(texts.size());
    for (const auto& text : texts) quoted.push_back(toml_string(text));
    return fmt::format("[{}]", fmt::join(quoted, ", "));
}

std::string toml_key(const std::string& name) {
    const bool bare = !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
        return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '-');
    });
    return bare ? name : toml_string(name);
}

std::string toml_inline_table(const std::vector<std::string>& pairs) {
    return pairs.empty() ? "{}" : fmt::format("{{ {} }}", fmt::join(pairs, ", "));
}

std::vector<std::string> split(const std::string& text, const char* separators) {
    std::vector<std::string> parts;
    boost::algorithm::split(parts, text, boost::algorithm::is_any_of(separators));
    std::erase(parts, "");
    return parts;
}

std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return text.substr(text.starts_with(mark) ? mark.size() : 0);
}

std::size_t line_of_offset(std::string_view text, std::size_t offset) {
    return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, offset), '\n'));
}

std::string one_line(std::string_view text) {
    constexpr unsigned char first_printed = 0x20;
    constexpr unsigned char delete_character = 0x7F;
    std::string line;
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '\n' || c == '\t') {
            line += ' ';
        } else if (code < first_printed || code == delete_character) {
            line += fmt::format("\\x{:02x}", code);
        } else {
            line += c;
        }
    }
    return line;
}

std::string duration_text(double duration_s) {
    constexpr std::int64_t per_minute = 60;
    constexpr std::int64_t per_hour = 3600;
    constexpr double max_s = 1e9;
    const double length_s = std::abs(duration_s);
    if (!(length_s >= units::seconds_per_minute - 0.05) || length_s > max_s) return fmt::format("{:.1f} s", duration_s);
    const auto whole = static_cast<std::int64_t>(std::llround(length_s));
    std::string text = duration_s < 0.0 ? "-" : "";
    if (whole >= per_hour) text += fmt::format("{} h ", whole / per_hour);
    if (whole % per_hour != 0) text += fmt::format("{} min ", whole % per_hour / per_minute);
    if (whole % per_minute != 0) text += fmt::format("{} s ", whole % per_minute);
    text.pop_back();
    return text;
}

}  // namespace flightwatt
