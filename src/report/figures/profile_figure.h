#pragma once

#include "compute/compute_model.h"
#include "report/figure.h"

#include <string>

namespace flightwatt::report {

/// The profiled power of every component over its first parameter, a panel a component; one line for each
/// value of the other parameters together. Points are what was profiled, told
/// apart where some of them were interpolated, with 95 % intervals where standard errors are known. A
/// component without parameters is a single point. The model has a component.
Figure profile_figure(const compute::ComputeModel& compute, const std::string& id);

}  // namespace flightwatt::report
