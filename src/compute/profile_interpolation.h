#pragma once

#include "compute/compute_model.h"
#include "compute/qos_range.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// How well each node is found from the others: interpolated minus measured [W], NaN for a node that cannot be
/// found so.
struct LeaveOneOutErrors {
    std::string method;
    std::vector<double> error_w;
    std::size_t nodes = 0;  ///< that could be found
    double mean_absolute_w = 0.0;
    double mean_absolute_percent = 0.0;
    double rms_w = 0.0;
    double largest_w = 0.0;
};

/// The summary of `error_w` beside the true powers.
LeaveOneOutErrors summarize_errors(std::string method, std::vector<double> error_w, const std::vector<double>& power_w);

/// Power [W] at `at` from the nodes `known`, which need not be a grid: the thin-plate spline r^2 log r and a plane,
/// exact at the nodes (Duchon 1977), all points scaled together. Throws NoResultError if the nodes are
/// too few, or lie so that they determine nothing (all on a line).
std::vector<double> interpolate_thin_plate(AxisScale scale, const QosPoints& known, const std::vector<double>& power_w,
                                           const QosPoints& at);

/// Finds each node from the others, all by one solution (Rippa, Adv. Comput. Math. 11, 1999); std::nullopt if one node
/// less does not determine the spline. Axes stay scaled by all nodes and by the points `at` that are to be found later.
std::optional<LeaveOneOutErrors> leave_one_out(AxisScale scale, const QosPoints& known,
                                               const std::vector<double>& power_w, const QosPoints& at = {});

/// The scale of the axes that finds the nodes best (by RMS error), and how well.
struct ScaleChoice {
    AxisScale scale = AxisScale::value;
    LeaveOneOutErrors error;
};

/// std::nullopt if there are fewer than 3 nodes, or no more than parameters and one.
std::optional<ScaleChoice> choose_scale(const QosPoints& known, const std::vector<double>& power_w,
                                        const QosPoints& at = {});

/// The nodes of a profile, in the order of its power_w.
QosPoints grid_points(const PowerProfile& profile);

/// Finds each node of a profile as a mission would, linearly between its neighbours, without itself: the
/// mean over the axes that have a neighbour on both sides. Nodes at an end of every axis cannot be found so
/// (a profile is never extrapolated) and are NaN.
LeaveOneOutErrors leave_one_out(const PowerProfile& profile);

/// That, and how well the thin plate of --trials does where there are nodes enough.
std::vector<LeaveOneOutErrors> interpolation_errors(const PowerProfile& profile);

}  // namespace flightwatt::compute
