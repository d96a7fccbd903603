#pragma once

#include "compute/power_profile.h"
#include "compute/profiling/scattered_interpolation.h"

#include <vector>

namespace flightwatt::compute {

/// The nodes of a profile, in the order of its power_w.
std::vector<std::vector<double>> grid_points(const PowerProfile& profile);

/// Leaves each node of a profile out and finds it as a mission would, linearly between its neighbours: the
/// mean over the axes that have a neighbour on both sides. Nodes at an end of every axis cannot be found so
/// (a profile is never extrapolated) and are NaN.
LeaveOneOut leave_grid_nodes_out(const PowerProfile& profile);

}  // namespace flightwatt::compute
