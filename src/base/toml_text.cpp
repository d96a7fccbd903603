#include "base/toml_text.h"

#include "base/utf8.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt {
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

}  // namespace flightwatt
