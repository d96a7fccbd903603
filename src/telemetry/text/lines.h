#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

/// Lines and words of a .data text, without copies.
namespace flightwatt::telemetry {

/// Removes the next word and the blank that ends it from the front of `rest`, and returns the word. Two blanks enclose
/// an empty word; a blank at the end starts none.
inline std::string_view take_word(std::string_view& rest, char separator = ' ') {
    const auto word = rest.substr(0, rest.find(separator));
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    return word;
}

/// Calls on_line(line without its break) for each line of `text`; the last line may lack its break.
template <typename OnLine>
void for_each_line(std::string_view text, const OnLine& on_line) {
    while (!text.empty()) on_line(take_word(text, '\n'));
}

}  // namespace flightwatt::telemetry
