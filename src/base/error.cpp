#include "base/error.h"

#include <utility>

namespace flightwatt {

std::string to_string(const Location& where) {
    std::string text = where.file;
    if (where.line > 0) text += ":" + std::to_string(where.line);
    if (where.line > 0 && where.column > 0) text += ":" + std::to_string(where.column);
    return text;
}

InputError::InputError(Location where, const std::string& message, std::string hint)
    : std::runtime_error(message), where_(std::move(where)), hint_(std::move(hint)) {}

}  // namespace flightwatt
