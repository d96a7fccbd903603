#pragma once

#include "compute/compute_model.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// How the utility grows with the quality of service q. All are monotone.
enum class UtilityShape {
    linear,       ///< q
    square_root,  ///< sqrt(q)
    logarithm,    ///< ln(1 + q): 0 at 0
    points        ///< straight lines between given points
};

/// The utility of a component's quality of service a second while it runs: weight * shape(q). A component that
/// is off has none.
struct Utility {
    std::optional<std::size_t> parameter;  ///< of the profile; none: the weight itself, whenever it runs
    double weight = 1.0;
    UtilityShape shape = UtilityShape::linear;
    std::vector<double> points_qos;    ///< rising, around the profile's whole range; only of `points`
    std::vector<double> points_value;  ///< not falling, as many
};

double utility_per_s(const Utility& utility, const std::vector<double>& qos);

/// The utility of a configuration a second: the sum over the components that run and have a utility.
/// `utilities` has one entry a component of the model (or none at all).
double utility_per_s(const std::vector<std::optional<Utility>>& utilities,
                     const compute::Configuration& configuration);

}  // namespace flightwatt::mission
