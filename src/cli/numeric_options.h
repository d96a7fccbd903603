#pragma once

#include "cli/stage.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

/// Options that hold numbers. All throw UsageError "--option TEXT: expected ..." for another value.
namespace flightwatt::cli {

/// A whole number from `least` to `most`. The option's value is a string: program_options would take -1 for a
/// large number.
std::uint64_t count_option(const StageCall& call, const std::string& option, std::uint64_t least = 0,
                           std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// A number from `least` to `most`.
double number_option(const StageCall& call, const std::string& option, double least, double most);

/// A finite number above 0 and at most `most`, or std::nullopt where the option was not given. `unit` is that
/// of the number, for the message.
std::optional<double> positive_option(const StageCall& call, const std::string& option, const std::string& unit,
                                      double most = std::numeric_limits<double>::infinity());

}  // namespace flightwatt::cli
