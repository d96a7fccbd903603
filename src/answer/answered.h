#pragma once

#include <optional>
#include <string>
#include <utility>

namespace flightwatt::answer {

/// A quantity that is answered, or the reason why it is not.
struct Answered {
    std::optional<double> value = {};
    std::string basis = {};    ///< "measured on 3 flights", "physics: ...", "assumed: ..."
    std::string unknown = {};  ///< why there is no value, and what would give one; empty if there is one
};

inline Answered known(double value, std::string basis) { return {value, std::move(basis), {}}; }
inline Answered unknown(std::string reason) { return {std::nullopt, {}, std::move(reason)}; }

}  // namespace flightwatt::answer
