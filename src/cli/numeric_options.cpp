#include "cli/numeric_options.h"

#include "base/error.h"
#include "base/number.h"

#include <cmath>

#include <fmt/format.h>

namespace flightwatt::cli {

std::uint64_t count_option(const StageCall& call, const std::string& option, std::uint64_t least, std::uint64_t most) {
    const auto text = call.get<std::string>(option);
    const auto number = parse_unsigned(text);
    if (number && *number >= least && *number <= most) return *number;
    const auto range = most < std::numeric_limits<std::uint64_t>::max() ? fmt::format(" from {} to {}", least, most)
                       : least > 0                                      ? fmt::format(" from {}", least)
                                                                        : std::string();
    throw UsageError(fmt::format("--{} {}: expected a whole number{}", option, one_line(text), range));
}

double number_option(const StageCall& call, const std::string& option, double least, double most) {
    const auto value = call.get<double>(option);
    if (value >= least && value <= most) return value;
    throw UsageError(fmt::format("--{} {:g}: expected {:g} to {:g}", option, value, least, most));
}

std::optional<double> positive_option(const StageCall& call, const std::string& option, const std::string& unit,
                                      double most) {
    const auto value = call.get_optional<double>(option);
    if (!value || (*value > 0.0 && *value <= most && std::isfinite(*value))) return value;
    const auto limit = std::isfinite(most) ? fmt::format(" and at most {:g}", most) : std::string();
    throw UsageError(fmt::format("--{} {:g}: expected more than 0{} {}", option, *value, limit, unit));
}

}  // namespace flightwatt::cli
