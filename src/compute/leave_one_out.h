#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// How well each node is found from the others: interpolated minus measured [W], NaN for a node that cannot be
/// found so.
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
LeaveOneOut summarize_errors(std::string method, std::vector<double> error_w,
                             const std::vector<double>& power_w);

}  // namespace flightwatt::compute
