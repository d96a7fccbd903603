#include "flight/segmentation/activity.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace flightwatt::flight {
namespace {

/// The ground beside an activity: the last (or first) twenty seconds of the rest there.
double ground_beside(const ResampledFlight& grid, GridSpan rest, bool before) {
    const auto length = std::min(grid.steps(20.0) + 1, rest.end - rest.begin);
    return median_altitude_m(
        grid, before ? GridSpan{rest.end - length, rest.end} : GridSpan{rest.begin, rest.begin + length});
}

double median_of_upper_half(const std::vector<double>& heights, double highest) {
    std::vector<double> upper;
    upper.reserve(heights.size());
    std::copy_if(heights.begin(), heights.end(), std::back_inserter(upper),
                 [&](double h) { return h > 0.5 * highest; });
    return upper.empty() ? highest : median_high(std::move(upper));
}

}  // namespace

std::vector<Activity> find_activities(const ResampledFlight& grid, const std::vector<GridSpan>& rests,
                                      const SegmentationOptions& options) {
    const auto reach = grid.steps(options.rest_s);
    std::vector<Activity> activities;
    std::size_t r = 0;
    for (const auto& piece : grid.pieces) {
        const GridSpan* before = nullptr;
        for (auto begin = piece.begin; begin < piece.end;) {
            const bool last = r == rests.size() || rests[r].begin >= piece.end;
            const auto end = last ? piece.end : rests[r].begin;
            if (end > begin) {
                Activity activity{{begin, end}, {begin, end}, std::nullopt, std::nullopt};
                if (before != nullptr) {
                    activity.ground_before_m = ground_beside(grid, *before, true);
                    activity.span.begin -= std::min(reach, before->end - before->begin);
                }
                if (!last) {
                    activity.ground_after_m = ground_beside(grid, rests[r], false);
                    activity.span.end += std::min(reach, rests[r].end - rests[r].begin);
                }
                activities.push_back(activity);
            }
            if (last) break;
            before = &rests[r++];
            begin = before->end;
        }
    }
    return activities;
}

GroundLevels estimate_ground_levels(const ResampledFlight& grid, const Activity& activity,
                                    const std::optional<double>& planned_ground_m) {
    const auto first = grid.altitude_m.begin() + static_cast<std::ptrdiff_t>(activity.span.begin);
    const auto last = grid.altitude_m.begin() + static_cast<std::ptrdiff_t>(activity.span.end);
    const auto [lowest, highest] = std::minmax_element(first, last);
    if (!activity.ground_before_m && !activity.ground_after_m) {
        // In the air from the first to the last line: the flight plan's ground, unless the log goes below it.
        const double ground_m = std::min(planned_ground_m.value_or(*lowest), *lowest);
        return {ground_m, ground_m};
    }
    const double after_m = activity.ground_after_m ? *activity.ground_after_m : *activity.ground_before_m;
    const double before_m = activity.ground_before_m.value_or(after_m);
    const bool disagree = std::abs(before_m - after_m) > std::max(10.0, (*highest - after_m) / 3.0);
    return {disagree ? after_m : before_m, after_m, disagree};
}

Heights compute_heights(const ResampledFlight& grid, const Activity& activity, const GroundLevels& grounds) {
    Heights heights;
    const auto count = activity.span.end - activity.span.begin;
    heights.height_m.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double part = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.0;
        const double ground_m = std::lerp(grounds.before_m, grounds.after_m, part);
        heights.height_m.push_back(grid.altitude_m[activity.span.begin + i] - ground_m);
    }
    heights.ground_m = grounds.before_m;
    heights.max_m = *std::max_element(heights.height_m.begin(), heights.height_m.end());
    heights.cruise_height_m = median_of_upper_half(heights.height_m, heights.max_m);
    return heights;
}

}  // namespace flightwatt::flight
