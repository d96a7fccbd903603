#include "compute/leave_one_out.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flightwatt::compute {

LeaveOneOut summarize_errors(std::string method, std::vector<double> error_w,
                             const std::vector<double>& power_w) {
    LeaveOneOut summary;
    summary.method = std::move(method);
    double squares = 0.0;
    for (std::size_t i = 0; i < error_w.size(); ++i) {
        if (std::isnan(error_w[i])) continue;
        ++summary.nodes;
        const double size = std::abs(error_w[i]);
        summary.mean_absolute_w += size;
        summary.mean_absolute_percent += units::percent_of(size, std::abs(power_w[i]));
        squares += size * size;
        summary.largest_w = std::max(summary.largest_w, size);
    }
    const auto count = static_cast<double>(summary.nodes);
    if (summary.nodes > 0) {
        summary.mean_absolute_w /= count;
        summary.mean_absolute_percent /= count;
        summary.rms_w = std::sqrt(squares / count);
    }
    summary.error_w = std::move(error_w);
    return summary;
}

}  // namespace flightwatt::compute
