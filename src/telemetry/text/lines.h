#pragma once

#include "base/text.h"

#include <string_view>

/// Lines of a .data text, without copies.
namespace flightwatt::telemetry {

/// Calls on_line(line without its break) for each line of `text`; the last line may lack its break.
template <typename OnLine>
void for_each_line(std::string_view text, const OnLine& on_line) {
    while (!text.empty()) on_line(take_word(text, '\n'));
}

}  // namespace flightwatt::telemetry
