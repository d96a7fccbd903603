#include "mechanical/fit/frequency_scan.h"

#include "base/parallel.h"
#include "mechanical/fit/fourier_basis.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mechanical {

ScanGrid scan_grid(const FrequencyRange& range, int order) {
    const double step_rad = range.high_rad / std::ceil(range.high_rad * order / turn_between_rad);
    return {order, step_rad, static_cast<std::size_t>(std::ceil(range.low_rad / step_rad)),
            static_cast<std::size_t>(std::round(range.high_rad / step_rad))};
}

FrequencyScan scan_flight(const PhaseSamples& samples, int order, const FrequencyRange& range) {
    const auto grid = scan_grid(range, order);
    if (samples.scan && samples.scan->grid == grid) return *samples.scan;
    FrequencyScan scan{grid, std::vector<double>(grid.size(), as_vector(samples.power_w).squaredNorm())};
    const auto sums = trigonometric_sums(samples, grid.step_rad, 2 * static_cast<std::size_t>(order) * grid.last + 1);
    for (std::size_t i = 0; i < scan.square_sum.size(); ++i)
        scan.square_sum[i] -= explained_square_sum(sums, grid.first + i, order);
    return scan;
}

FrequencyScan scan_frequencies(std::span<const PhaseSamples> flights, int order, const FrequencyRange& range) {
    const auto grid = scan_grid(range, order);
    FrequencyScan scan{grid, std::vector<double>(grid.size(), 0.0)};
    // A block at a time, because those of thousands of flights would fill the memory.
    constexpr std::size_t block = 64;
    for (std::size_t begin = 0; begin < flights.size(); begin += block) {
        const auto some = flights.subspan(begin, std::min(block, flights.size() - begin));
        std::vector<FrequencyScan> made(some.size());
        for_each_in_parallel(some.size(), [&](std::size_t i) { made[i] = scan_flight(some[i], order, range); });
        for (const auto& flight : made)
            for (std::size_t i = 0; i < scan.square_sum.size(); ++i) scan.square_sum[i] += flight.square_sum[i];
    }
    return scan;
}

std::vector<Candidate> minima(const FrequencyScan& scan) {
    std::vector<Candidate> found;
    const auto& sums = scan.square_sum;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const bool falls = i == 0 || sums[i] <= sums[i - 1];
        const bool rises = i + 1 == sums.size() || sums[i] < sums[i + 1];
        if (falls && rises) found.push_back({scan.grid.theta_rad(i), sums[i]});
    }
    std::ranges::sort(found, {}, &Candidate::square_sum);
    return found;
}

Candidate lowest_between(const FrequencyScan& scan, double low_rad, double high_rad) {
    Candidate lowest;
    for (std::size_t i = 0; i < scan.square_sum.size(); ++i) {
        const double theta_rad = scan.grid.theta_rad(i);
        if (theta_rad >= low_rad && theta_rad <= high_rad && scan.square_sum[i] < lowest.square_sum)
            lowest = {theta_rad, scan.square_sum[i]};
    }
    return lowest;
}

}  // namespace flightwatt::mechanical
