#pragma once

#include "compute/compute_model.h"

#include <cstddef>
#include <vector>

namespace flightwatt::compute {

/// How well each node is found from the others: interpolated minus measured [W], NaN for a node that cannot be
/// found so.
struct LeaveOneOutErrors {
    std::vector<double> error_w;
    std::size_t nodes = 0;  ///< that could be found
    double mean_absolute_w = 0.0;
    double mean_absolute_percent = 0.0;
    double rms_w = 0.0;
    double largest_w = 0.0;
};

/// The summary of `error_w` beside the true powers.
LeaveOneOutErrors summarize_errors(std::vector<double> error_w, const std::vector<double>& power_w);

/// Finds each node of a profile as a mission would, linearly between its neighbours, without itself: the
/// mean over the axes that have a neighbour on both sides. Nodes at an end of every axis cannot be found so
/// (a profile is never extrapolated) and are NaN.
LeaveOneOutErrors leave_one_out(const PowerProfile& profile);

}  // namespace flightwatt::compute
