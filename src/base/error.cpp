#include "base/error.h"

#include "base/text.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt {

std::string to_string(const Location& where) {
    std::string text = where.file;
    if (where.line > 0) text += ":" + std::to_string(where.line);
    if (where.line > 0 && where.column > 0) text += ":" + std::to_string(where.column);
    return text;
}

std::string truncated(std::string_view text) {
    constexpr std::size_t most = 2000;
    constexpr std::size_t tail = 400;  // errors end with the expected value
    if (text.size() <= most) return std::string(text);
    auto head_end = most - tail;
    auto tail_begin = text.size() - tail;
    while (head_end > 0 && continues_character(text[head_end])) --head_end;
    while (tail_begin < text.size() && continues_character(text[tail_begin])) ++tail_begin;
    return fmt::format("{} ... {}", text.substr(0, head_end), text.substr(tail_begin));
}

std::string short_list(const std::vector<std::string>& names) {
    constexpr std::size_t shown = 12;
    const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), shown));
    auto text = fmt::format("{}", fmt::join(names.begin(), end, ", "));
    if (names.size() > shown) text += fmt::format(" ... and {} more", names.size() - shown);
    return text;
}

InputError::InputError(Location where, const std::string& message, const std::string& hint)
    : std::runtime_error(truncated(message)), where_(std::move(where)), hint_(truncated(hint)) {}

}  // namespace flightwatt
