#pragma once

#include "compute/leave_one_out.h"
#include "compute/profiling/spread_nodes.h"

#include <optional>
#include <string>
#include <vector>

/// Power between nodes that need not be a grid: the thin-plate spline r^2 log r and a plane, exact at the
/// nodes (Duchon 1977). Points are given as one value a parameter.
namespace flightwatt::compute {

/// Power [W] at `at` from the nodes `known`, all of them scaled together. Throws NoAnswerError if the nodes are
/// too few, or lie so that they determine nothing (all on a line).
std::vector<double> interpolate_thin_plate(AxisScale scale, const std::vector<std::vector<double>>& known,
                                           const std::vector<double>& power_w,
                                           const std::vector<std::vector<double>>& at);

/// Finds each node from the others, all by one solution (Rippa, Adv. Comput. Math. 11, 1999); std::nullopt if
/// one node less does not determine the spline. Axes stay scaled by all nodes and by the points `at` that are
/// to be found later.
std::optional<LeaveOneOut> leave_one_out(AxisScale scale, const std::vector<std::vector<double>>& known,
                                         const std::vector<double>& power_w,
                                         const std::vector<std::vector<double>>& at = {});

/// The scale of the axes that finds the nodes best (by RMS error), and how well.
struct ScaleChoice {
    AxisScale scale = AxisScale::value;
    LeaveOneOut error;
};

/// std::nullopt if there are fewer than 3 nodes, or no more than parameters and one.
std::optional<ScaleChoice> choose_scale(const std::vector<std::vector<double>>& known,
                                        const std::vector<double>& power_w,
                                        const std::vector<std::vector<double>>& at = {});

}  // namespace flightwatt::compute
