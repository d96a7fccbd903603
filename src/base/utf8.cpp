#include "base/utf8.h"

#include <algorithm>

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

}  // namespace flightwatt
