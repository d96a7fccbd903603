#include "compute/profile_interpolation.h"

#include "compute/profiling/thin_plate.h"

#include <cmath>
#include <limits>

namespace flightwatt::compute {

std::vector<std::vector<double>> grid_points(const PowerProfile& profile) {
    std::vector<std::vector<double>> points(profile.power_w.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
        auto rest = k;
        points[k].resize(profile.axes.size());
        for (std::size_t i = profile.axes.size(); i-- > 0;) {
            points[k][i] = profile.axes[i][rest % profile.axes[i].size()];
            rest /= profile.axes[i].size();
        }
    }
    return points;
}

LeaveOneOut leave_one_out(const PowerProfile& profile) {
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
        errors.push_back(ways == 0 ? std::numeric_limits<double>::quiet_NaN()
                                   : sum / ways - profile.power_w[k]);
    }
    return summarize_errors("linear between neighbours", std::move(errors), profile.power_w);
}

std::vector<LeaveOneOut> interpolation_errors(const PowerProfile& profile) {
    std::vector<LeaveOneOut> errors{leave_one_out(profile)};
    if (const auto choice = choose_scale(grid_points(profile), profile.power_w))
        errors.push_back(choice->error);
    return errors;
}

}  // namespace flightwatt::compute
