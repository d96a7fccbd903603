#include "live/sources.h"

#include "base/number.h"

#include <cmath>

namespace flightwatt::live {

void SourceReport::count(std::string_view reason, std::size_t times) {
    if (times > 0) unusable[std::string(reason)] += times;
}

std::optional<IncomingMessage> parse_message_line(std::string_view line) {
    const auto blank = line.find(' ');
    if (blank == std::string_view::npos || blank + 1 >= line.size()) return std::nullopt;
    const auto time_s = parse_number(line.substr(0, blank));
    if (!time_s || !std::isfinite(*time_s)) return std::nullopt;
    return IncomingMessage{time_s, std::string(line.substr(blank + 1))};
}

}  // namespace flightwatt::live
