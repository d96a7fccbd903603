#include "compute/profile_interpolation.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace flightwatt::compute {
LeaveOneOutErrors summarize_errors(std::vector<double> error_w, const std::vector<double>& power_w) {
    LeaveOneOutErrors summary;
    double squares = 0.0;
    for (std::size_t i = 0; i < error_w.size(); ++i) {
        if (std::isnan(error_w[i])) continue;
        ++summary.nodes;
        const double size = std::abs(error_w[i]);
        summary.mean_absolute_w += size;
        summary.mean_absolute_percent += units::percentage(size, std::abs(power_w[i]));
        squares += size * size;
        summary.largest_w = std::max(summary.largest_w, size);
    }
    const auto count = static_cast<double>(std::max<std::size_t>(summary.nodes, 1));
    summary.mean_absolute_w /= count;
    summary.mean_absolute_percent /= count;
    summary.rms_w = std::sqrt(squares / count);
    summary.error_w = std::move(error_w);
    return summary;
}

LeaveOneOutErrors leave_one_out(const PowerProfile& profile) {
    std::vector<double> errors;
    for (std::size_t k = 0; k < profile.power_w.size(); ++k) {
        double sum = 0.0;
        int ways = 0;
        std::size_t stride = 1;
        for (std::size_t i = profile.axes.size(); i-- > 0;) {
            const auto& axis = profile.axes[i];
            const auto place = k / stride % axis.size();
            if (place > 0 && place + 1 < axis.size()) {
                const double fraction = (axis[place] - axis[place - 1]) / (axis[place + 1] - axis[place - 1]);
                sum += std::lerp(profile.power_w[k - stride], profile.power_w[k + stride], fraction);
                ++ways;
            }
            stride *= axis.size();
        }
        errors.push_back(ways == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / ways - profile.power_w[k]);
    }
    return summarize_errors(std::move(errors), profile.power_w);
}

}  // namespace flightwatt::compute
