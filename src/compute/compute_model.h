#pragma once

#include "compute/power_profile.h"

#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// A piece of on-board software.
struct Component {
    std::string name;
    PowerProfile profile;
};

/// The software that a mission may run.
struct ComputeModel {
    std::vector<Component> components;
};

/// A component at work.
struct RunningComponent {
    std::size_t component = 0;  ///< index into ComputeModel::components
    std::vector<double> qos;    ///< one value a parameter of its profile
    bool operator==(const RunningComponent&) const = default;
};

/// What runs at a time; a component that is not named is off and draws nothing.
using Configuration = std::vector<RunningComponent>;

/// Power [W] of everything that runs: the components add (section IV-B of the paper). Throws InputError for a
/// QoS out of range.
double power_w(const ComputeModel& model, const Configuration& configuration);

}  // namespace flightwatt::compute
