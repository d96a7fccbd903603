#include "flight/airspeed.h"

#include <algorithm>

namespace flightwatt::flight {

std::optional<double> mean_cubed_airspeed_m3_per_s3(const Track& airspeed, double start_s, double end_s) {
    constexpr double reach_s = 5.0;
    const auto& time_s = airspeed.time_s;
    double sum = 0.0;
    double covered_s = 0.0;
    double covered_until_s = start_s;
    std::size_t count = 0;
    const auto first = std::lower_bound(time_s.begin(), time_s.end(), start_s) - time_s.begin();
    for (auto i = static_cast<std::size_t>(first); i < time_s.size() && time_s[i] <= end_s; ++i) {
        const double speed = airspeed.value[i];
        sum += speed * speed * speed;
        ++count;
        const double until_s = std::min(time_s[i] + reach_s, end_s);
        covered_s += until_s - std::max(covered_until_s, std::max(time_s[i] - reach_s, start_s));
        covered_until_s = until_s;
    }
    if (count == 0 || covered_s < 0.5 * (end_s - start_s)) return std::nullopt;
    return sum / static_cast<double>(count);
}

}  // namespace flightwatt::flight
