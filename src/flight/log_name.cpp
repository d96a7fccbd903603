#include "flight/log_name.h"

#include <regex>

namespace flightwatt::flight {

std::optional<std::chrono::sys_seconds> start_in_name(const std::string& name) {
    constexpr int century = 2000;
    constexpr int hours_a_day = 24;
    constexpr int sixty = 60;  // minutes, and seconds
    static const std::regex pattern(
        "(?:^|[^0-9])([0-9]{2})_([0-9]{2})_([0-9]{2})__([0-9]{2})_([0-9]{2})_([0-9]{2})(?:$|[^0-9])");
    std::smatch found;
    if (!std::regex_search(name, found, pattern)) return std::nullopt;
    const auto part = [&](std::size_t group) { return std::stoi(found[group].str()); };
    const std::chrono::year_month_day date{std::chrono::year{century + part(1)},
                                           std::chrono::month{static_cast<unsigned>(part(2))},
                                           std::chrono::day{static_cast<unsigned>(part(3))}};
    if (!date.ok() || part(4) >= hours_a_day || part(5) >= sixty || part(6) >= sixty) return std::nullopt;
    return std::chrono::sys_days{date} + std::chrono::hours{part(4)} + std::chrono::minutes{part(5)} +
           std::chrono::seconds{part(6)};
}

}  // namespace flightwatt::flight
