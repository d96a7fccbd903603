#pragma once

#include "base/error.h"

#include <cstddef>
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

/// Power of a component over its quality of service (QoS): the nodes of a full grid, one node without parameters. A
/// profile of what a component adds to another may have zero or, within the noise, negative power.
struct PowerProfile {
    std::string file;
    std::vector<std::string> parameters;
    std::vector<std::vector<double>> axes;      ///< profiled values of each parameter, rising
    std::vector<double> power_w;                ///< of every node; the last parameter runs fastest
    std::vector<double> standard_error_w = {};  ///< of every node; empty unless all are known
    double excluded_idle_w = 0.0;  ///< of the idle computer, which the powers are above; 0: they include it
    double included_idle_w = 0.0;  ///< of the idle computer, which the powers include; 0: none, or not known
};

/// The grid of `nodes`, in any order. Throws InputError for no nodes, for a duplicate node (at its second occurrence),
/// and for an incomplete grid (naming the first missing node).
PowerProfile make_power_profile(const std::string& file, const std::vector<std::string>& parameters,
                                std::vector<ProfileNode> nodes);

/// Throws InputError at `where` if `value` is outside of the parameter's profiled range: a profile is never
/// extrapolated. `parameter` counts from 0.
void require_in_range(const PowerProfile& profile, std::size_t parameter, double value, const Location& where);

/// Power [W] at `qos` (one value a parameter), multilinear between nodes. Throws InputError, placed in the profile, if
/// a value is out of range.
double power_w(const PowerProfile& profile, const std::vector<double>& qos);

/// Sets powers below 0 to 0, and returns a warning with the lowest; empty if no power is below 0.
std::string remove_negative_power(PowerProfile& profile);

/// Errors of interpolating each node of a profile from the others.
struct LeaveOneOutErrors {
    std::size_t nodes = 0;  ///< that could be interpolated
    double mean_absolute_w = 0.0;
    double mean_absolute_percent = 0.0;
    double rms_w = 0.0;
    double largest_w = 0.0;
};

/// Interpolates each node linearly between its neighbours: the mean over the axes on which it has two. Other nodes are
/// skipped.
LeaveOneOutErrors leave_one_out(const PowerProfile& profile);

/// On-board software.
struct Component {
    std::string name;
    PowerProfile profile;
};

/// The software that a mission may run.
struct ComputeModel {
    std::vector<Component> components;
};

/// A component that runs, and how.
struct RunningComponent {
    std::size_t component = 0;  ///< index into ComputeModel::components
    std::vector<double> qos;    ///< one value a parameter of its profile
    bool operator==(const RunningComponent&) const = default;
};

/// Components that run at the same time; the others are off and draw nothing.
using Configuration = std::vector<RunningComponent>;

/// Power [W] of everything that runs: the components add (section IV-B of the paper). Throws InputError for a
/// QoS out of range.
double power_w(const ComputeModel& model, const Configuration& configuration);

/// "detection fps 10, encryption key_bits 240", with `equals` between name and value; "nothing" if none runs.
std::string describe(const ComputeModel& model, const Configuration& configuration, std::string_view equals = " ");

/// Limit of a component: more would take weeks to profile.
inline constexpr std::size_t max_configurations = 100000;

/// Configurations of a component: one value a parameter each.
using QosPoints = std::vector<std::vector<double>>;

/// A parameter of quality of service and the values that it is profiled at.
struct QosRange {
    std::string name;
    std::vector<double> values;  ///< rising
};

/// from, from + step, ... up to `to`, included if it is a whole number of steps away; `step` > 0, `to` >= `from`.
/// Rounded to 12 digits, so that 0.1 + 0.2 is 0.3 on a command line.
std::vector<double> linear_range(double from, double to, double step);

/// The node `index` of a grid, the last axis running fastest.
std::vector<double> grid_point(const std::vector<std::vector<double>>& axes, std::size_t index);

/// Every combination of the values, the last parameter running fastest; one empty combination of no ranges.
QosPoints cartesian_product(const std::vector<QosRange>& ranges);

/// "fps=4 key_bits=32", or with other texts between name and value and between parameters.
std::string format_qos(const std::vector<std::string>& parameters, const std::vector<double>& qos,
                       std::string_view equals = "=", std::string_view between = " ");

/// `text` with every {name} of a parameter replaced by its value; other braces are kept (they may be a shell's).
std::string substitute_qos(const std::string& text, const std::vector<std::string>& parameters,
                           const std::vector<double>& qos);

}  // namespace flightwatt::compute
