#include "compute/sensors/power_rail.h"

#include "base/error.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

/// The input of the whole module: TX2, Xavier NX, Orin NX and Nano; Nano; Nano under newer kernels.
constexpr std::string_view total_rails[] = {"VDD_IN", "POM_5V_IN", "5V_IN"};
/// Behind another rail that is measured too: AGX Orin's is made from VIN_SYS_5V0; NC is not connected.
constexpr std::string_view derived_rails[] = {"VDDQ_VDD2_1V8AO", "NC"};

}  // namespace

std::vector<std::size_t> rails_of_total(const std::vector<std::string>& names,
                                        const std::vector<std::string>& wanted) {
    std::vector<std::size_t> chosen;
    for (const auto& name : wanted) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) {
            throw NoAnswerError(
                fmt::format("there is no rail '{}'; there are {}", name, fmt::join(names, ", ")));
        }
        chosen.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    if (!chosen.empty()) return chosen;
    for (const auto total : total_rails) {
        const auto found = std::find(names.begin(), names.end(), total);
        if (found != names.end()) return {static_cast<std::size_t>(found - names.begin())};
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto derived = std::find(std::begin(derived_rails), std::end(derived_rails), names[i]);
        if (derived == std::end(derived_rails)) chosen.push_back(i);
    }
    return chosen;
}

}  // namespace flightwatt::compute
