#include "mission/utility.h"

#include "base/piecewise_linear.h"

#include <cmath>
#include <stdexcept>

namespace flightwatt::mission {

double utility_per_s(const Utility& utility, const std::vector<double>& qos) {
    if (!utility.parameter) return utility.weight;
    const double q = qos.at(*utility.parameter);
    switch (utility.shape) {
        case UtilityShape::linear:
            return utility.weight * q;
        case UtilityShape::square_root:
            return utility.weight * std::sqrt(q);
        case UtilityShape::logarithm:
            return utility.weight * std::log1p(q);
        case UtilityShape::points:
            return utility.weight * interpolate_extended(utility.points_qos, utility.points_value, q);
    }
    throw std::logic_error("utility_per_s: no such shape");
}

double utility_per_s(const std::vector<std::optional<Utility>>& utilities,
                     const compute::Configuration& configuration) {
    double sum = 0.0;
    for (const auto& running : configuration) {
        if (running.component >= utilities.size() || !utilities[running.component]) continue;
        sum += utility_per_s(*utilities[running.component], running.qos);
    }
    return sum;
}

}  // namespace flightwatt::mission
