#include "base/toml_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt {
namespace {

/// How many bytes the UTF-8 character at the front has; 0 if there is none.
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    std::size_t length = 0;
    if (byte(0) < 0x80)
        length = 1;
    else if (byte(0) >= 0xC2 && byte(0) < 0xE0)
        length = 2;
    else if (byte(0) >= 0xE0 && byte(0) < 0xF0)
        length = 3;
    else if (byte(0) >= 0xF0 && byte(0) < 0xF5)
        length = 4;
    if (length == 0 || length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xC0) != 0x80) return 0;
    // Overlong forms, surrogates and what lies beyond Unicode.
    const bool bad = (byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xED && byte(1) > 0x9F) ||
                     (byte(0) == 0xF0 && byte(1) < 0x90) || (byte(0) == 0xF4 && byte(1) > 0x8F);
    return bad ? 0 : length;
}

/// TOML holds UTF-8 alone; file names may be anything. Bytes that are none become U+FFFD.
std::string utf8_or_replaced(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const auto length = utf8_length(text);
        result += length == 0 ? std::string_view("\xEF\xBF\xBD") : text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return result;
}

}  // namespace

std::string toml_string(std::string_view text) {
    std::string result = "\"";
    const auto valid = utf8_or_replaced(text);
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

}  // namespace flightwatt
