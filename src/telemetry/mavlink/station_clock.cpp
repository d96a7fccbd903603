#include "telemetry/mavlink/station_clock.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

namespace flightwatt::telemetry {
namespace {

constexpr double min_step_s = 2.0;
constexpr double max_pause_s = 60.0;      // by the autopilot's clock; after more, another recording may be appended
constexpr std::size_t enough_times = 10;  // of a part: fewer are late, or of another vehicle
constexpr double running_part = 0.5;      // of the time of reception, in which a boot clock runs

double lag_s(const BootTime& time) { return time.received_s - time.boot_s; }

/// Messages in a row whose lags change little by little.
struct Part {
    BootTime first;
    BootTime last;
    double least_lag_s = std::numeric_limits<double>::infinity();  ///< that of a message that no link kept back
    std::size_t count = 0;

    bool is_clock() const {
        return count >= enough_times &&
               last.boot_s - first.boot_s >= running_part * (last.received_s - first.received_s);
    }
};

/// The parts between jumps of the lag, of those with enough messages.
std::vector<Part> steady_parts(const std::vector<BootTime>& times) {
    std::vector<Part> parts;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (i == 0 || std::abs(lag_s(times[i]) - lag_s(times[i - 1])) >= min_step_s)
            parts.emplace_back().first = times[i];
        auto& part = parts.back();
        part.last = times[i];
        part.least_lag_s = std::min(part.least_lag_s, lag_s(times[i]));
        ++part.count;
    }
    std::erase_if(parts, [](const Part& part) { return !part.is_clock(); });
    return parts;
}

}  // namespace

bool ClockStep::has_passed(std::size_t place, double received_s) const {
    if (place >= behind.place) return true;
    return place > before.place && std::abs(received_s - behind.received_s) < std::abs(received_s - before.received_s);
}

std::vector<ClockStep> find_clock_steps(const std::vector<BootTime>& times) {
    const auto parts = steady_parts(times);
    std::vector<ClockStep> steps;
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const auto& before = parts[i - 1];
        const auto& behind = parts[i];
        const double step_s = behind.least_lag_s - before.least_lag_s;
        const double pause_s = behind.first.boot_s - before.last.boot_s;
        if (std::abs(step_s) >= min_step_s && std::abs(pause_s) <= max_pause_s && pause_s > -min_step_s)
            steps.push_back({before.last, behind.first, step_s});
    }
    return steps;
}

std::vector<std::size_t> find_other_vehicles(const std::vector<VehicleChange>& changes,
                                             const std::vector<BootTime>& times) {
    constexpr std::size_t max_changes = 20;
    std::map<std::size_t, std::size_t> places;  // by that of the clock's change
    if (changes.size() > max_changes) return {};
    for (const auto& change : changes) {
        const auto from = std::ranges::upper_bound(times, change.before, {}, &BootTime::place);
        const auto to = std::ranges::lower_bound(times, change.behind, {}, &BootTime::place);
        if (from == times.begin() || to == times.end()) continue;
        for (auto time = to; time >= from; --time) {
            if (std::abs(lag_s(*time) - lag_s(*std::prev(time))) < min_step_s) continue;
            const auto [place, is_new] = places.try_emplace(time->place, time->place);
            place->second = std::min(place->second, change.behind);
            break;
        }
    }
    std::vector<std::size_t> rising;
    rising.reserve(places.size());
    for (const auto& [changed, place] : places) rising.push_back(place);
    return rising;
}

}  // namespace flightwatt::telemetry
