#pragma once

#include "compute/profiling/spread_nodes.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// A way to power between nodes that need not be a grid.
enum class ScatteredMethod {
    plane,             ///< least squares: constant and linear terms
    products,          ///< least squares: every product of different parameters
    thin_plate,        ///< exact at the nodes: r^2 log r and a plane (Duchon 1977)
    inverse_distance,  ///< exact at the nodes: weights 1 / r^2 (Shepard 1968)
};

/// A method on scaled axes, and how well it finds nodes that it was not given.
struct ScatteredChoice {
    ScatteredMethod method = ScatteredMethod::plane;
    AxisScale scale = AxisScale::value;
};

std::string to_string(const ScatteredChoice& choice);

/// Errors (interpolated minus measured, [W]) of leaving each node out and finding it from the others; NaN for
/// one that cannot be found so.
struct LeaveOneOut {
    std::string method;
    std::vector<double> error_w;
    std::size_t nodes = 0;  ///< that could be found
    double mean_absolute_w = 0.0;
    double mean_absolute_percent = 0.0;
    double rms_w = 0.0;
    double largest_w = 0.0;
};

/// The summary of `error_w` beside the true powers.
LeaveOneOut summarize_left_out(std::string method, std::vector<double> error_w,
                               const std::vector<double>& power_w);

/// Power [W] at `at` from the nodes `known` (all points given as one value a parameter; scaled together).
/// Throws NoAnswerError if the nodes are too few, or lie so that they determine nothing (all on a line).
std::vector<double> interpolate_scattered(const ScatteredChoice& choice,
                                          const std::vector<std::vector<double>>& known,
                                          const std::vector<double>& power_w,
                                          const std::vector<std::vector<double>>& at);

/// Leaves each node out; std::nullopt if the method does not work with one node less. Axes stay scaled by all
/// nodes and by the points `at` that are to be found later. For the spline by Rippa's formula (Adv. Comput.
/// Math. 11, 1999), for least squares by the leverages, so one solution serves all.
std::optional<LeaveOneOut> leave_one_out(const ScatteredChoice& choice,
                                         const std::vector<std::vector<double>>& known,
                                         const std::vector<double>& power_w,
                                         const std::vector<std::vector<double>>& at = {});

/// Every method on every scale that works with one node less, the one with the least RMS error first; none if
/// there are fewer than 3 nodes.
std::vector<std::pair<ScatteredChoice, LeaveOneOut>> ranked_methods(
    const std::vector<std::vector<double>>& known, const std::vector<double>& power_w,
    const std::vector<std::vector<double>>& at = {});

}  // namespace flightwatt::compute
