#pragma once

#include "compute/leave_one_out.h"
#include "compute/power_profile.h"

#include <vector>

namespace flightwatt::compute {

/// The nodes of a profile, in the order of its power_w.
std::vector<std::vector<double>> grid_points(const PowerProfile& profile);

/// Finds each node of a profile as a mission would, linearly between its neighbours, without itself: the
/// mean over the axes that have a neighbour on both sides. Nodes at an end of every axis cannot be found so
/// (a profile is never extrapolated) and are NaN.
LeaveOneOut leave_one_out(const PowerProfile& profile);

/// That, and how well the thin plate of --trials does where there are nodes enough.
std::vector<LeaveOneOut> interpolation_errors(const PowerProfile& profile);

}  // namespace flightwatt::compute
