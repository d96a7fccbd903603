#include "flight/segmentation/hover_record.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::flight {
namespace {

constexpr double lifting_fraction = 0.7;  // of the usual effort in flight: an idling motor has less, a descent more
constexpr double min_hover_s = 5.0;
constexpr double max_detector_s = 1.5;

/// The median effort above half of its 90th percentile.
double usual_effort(const std::vector<double>& motor_percent) {
    auto sorted = motor_percent;
    std::ranges::sort(sorted);
    const double half = 0.5 * quantile(sorted, 0.9);
    const auto high = std::ranges::upper_bound(sorted, half);
    return high == sorted.end() ? half : *(high + (sorted.end() - high) / 2);
}

/// Whether a state takes a value after `from_s` and up to `to_s`.
bool takes(const Track& state, double value, double from_s, double to_s) {
    for (auto i = static_cast<std::size_t>(std::ranges::upper_bound(state.time_s, from_s) - state.time_s.begin());
         i < state.time_s.size() && state.time_s[i] <= to_s; ++i)
        if (state.value[i] == value) return true;
    return false;
}

}  // namespace

std::vector<IndexSpan> find_hovers(const SelectedTracks& tracks, const ResampledFlight& grid) {
    const auto& armed = tracks["armed"];
    const auto& landed = tracks["landed"];
    const bool is_stated = !armed.empty() || !landed.empty();
    if (tracks.series().firmware != "rotorcraft" || !is_stated || grid.motor_percent.empty()) return {};
    const double lifting = lifting_fraction * usual_effort(grid.motor_percent);
    if (!(lifting > 0.0)) return {};
    std::vector<IndexSpan> hovers;
    for (const auto& run : runs_of({0, grid.size()}, [&](std::size_t i) { return grid.motor_percent[i] >= lifting; })) {
        const double from_s = hovers.empty() ? 0.0 : grid.time_s(hovers.back().end - 1);
        const bool is_same = !hovers.empty() && !takes(landed, 1.0, from_s, grid.time_s(run.begin)) &&
                             !takes(armed, 0.0, from_s, grid.time_s(run.begin));
        if (is_same)
            hovers.back().end = run.end;
        else
            hovers.push_back(run);
    }
    std::erase_if(hovers, [&](const IndexSpan& hover) { return hover.size() <= grid.steps(min_hover_s); });
    return hovers;
}

std::vector<IndexSpan> rests_between(const std::vector<IndexSpan>& hovers, const ResampledFlight& grid) {
    std::vector<IndexSpan> rests;
    std::size_t begin = 0;
    const auto add = [&](std::size_t end) {
        // A rest does not extend across a jump of the altitude.
        for (const auto& piece : grid.pieces) {
            const IndexSpan rest{std::max(begin, piece.begin), std::min(end, piece.end)};
            if (rest.begin < rest.end) rests.push_back(rest);
        }
    };
    for (const auto& hover : hovers) {
        add(hover.begin);
        begin = hover.end;
    }
    add(grid.size());
    return rests;
}

double confirmed_by_detector(const Track& detector, double edge_s, bool landed) {
    constexpr std::size_t min_reports = 10;
    if (detector.time_s.size() < min_reports) return edge_s;
    double nearest_s = edge_s + 2.0 * max_detector_s;
    for (std::size_t i = 1; i < detector.value.size(); ++i) {
        const bool turns = detector.value[i] != detector.value[i - 1] && (detector.value[i] == 1.0) == landed;
        if (turns && std::abs(detector.time_s[i] - edge_s) < std::abs(nearest_s - edge_s))
            nearest_s = detector.time_s[i];
    }
    return std::abs(nearest_s - edge_s) <= max_detector_s ? nearest_s : edge_s;
}

}  // namespace flightwatt::flight
