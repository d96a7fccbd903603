#pragma once

#include "base/error.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::compute {

/// One profiled configuration of a component.
struct ProfileNode {
    std::vector<double> qos;  ///< one value a parameter
    double power_w = 0.0;
    Location where;
    std::optional<double> standard_error_w = {};
};

/// Power of a component as a function of its quality of service (QoS): the nodes of a full grid. A component
/// without parameters has constant power, one node. A profile may hold what a component draws on top of
/// another, so a node's power may be zero or, within the noise, below.
struct PowerProfile {
    std::string file;
    std::vector<std::string> parameters;
    std::vector<std::vector<double>> axes;      ///< the values that each parameter was profiled at, rising
    std::vector<double> power_w;                ///< of every node; the last parameter runs fastest
    std::vector<double> standard_error_w = {};  ///< of every node; empty unless all are known
};

/// The grid of `nodes`, which may come in any order. Throws InputError for no nodes, for a node that is there
/// twice (at its second place), and for an incomplete grid (naming the first node that is missing).
PowerProfile make_power_profile(const std::string& file, const std::vector<std::string>& parameters,
                                std::vector<ProfileNode> nodes);

/// Throws InputError at `where` (the place that asks for the value) if `value` is outside of what the
/// parameter was profiled at: a profile is never extrapolated. `parameter` counts from 0.
void require_in_range(const PowerProfile& profile, std::size_t parameter, double value, const Location& where);

/// Power [W] at `qos` (one value a parameter), multilinear between the nodes around it and exact at them.
/// Throws InputError, placed in the profile, if a value is out of range.
double power_w(const PowerProfile& profile, const std::vector<double>& qos);

/// "PROFILE: -0.2 W at fps = 3: ..." where a node's power is negative; empty if none is.
std::string negative_power_warning(const PowerProfile& profile);

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

/// "detection fps 10, encryption key_bits 240", or with another text between name and value; "nothing" if none runs.
std::string describe(const ComputeModel& model, const Configuration& configuration, std::string_view equals = " ");

}  // namespace flightwatt::compute
