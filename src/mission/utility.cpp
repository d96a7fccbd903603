#include "mission/utility.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flightwatt::mission {
namespace {

double interpolated(const Utility& utility, double q) {
    const auto& x = utility.points_qos;
    const auto& y = utility.points_worth;
    const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, q);
    const auto i = static_cast<std::size_t>(above - x.begin());
    return y[i - 1] + (q - x[i - 1]) / (x[i] - x[i - 1]) * (y[i] - y[i - 1]);
}

}  // namespace

double worth(const Utility& utility, const std::vector<double>& qos) {
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
            return utility.weight * interpolated(utility, q);
    }
    throw std::logic_error("worth: no such shape");
}

double worth(const std::vector<std::optional<Utility>>& utilities,
             const compute::Configuration& configuration) {
    double sum = 0.0;
    for (const auto& running : configuration) {
        if (running.component >= utilities.size() || !utilities[running.component]) continue;
        sum += worth(*utilities[running.component], running.qos);
    }
    return sum;
}

}  // namespace flightwatt::mission
