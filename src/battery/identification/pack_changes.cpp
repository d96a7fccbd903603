#include "battery/identification/pack_changes.h"

#include "base/statistics.h"
#include "base/units.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::battery {
namespace {

constexpr double early_step = 0.03;  // of the voltage: more than a pack recovers then
constexpr double late_step = 0.01;   // later, or at a counter reset
constexpr double recovery_s = 5.0;
constexpr double settled_s = 15.0;  // after which no pack recovers the late step
constexpr std::size_t compared_samples = 5;
constexpr double reset_fraction = 0.2;  // a counter that falls below this fraction was reset
constexpr double min_counted_ah = 0.005;

/// At rest or not, sample by sample.
struct RestMask {
    std::vector<bool> resting;
    std::vector<double> since_load_s;  ///< negative before the first load
    std::size_t last_load = 0;         ///< one behind it
};

RestMask rests_of(const PackRecord& record) {
    RestMask mask;
    mask.resting.reserve(record.time_s.size());
    mask.since_load_s.reserve(record.time_s.size());
    const double load_a = load_threshold_a(*std::ranges::max_element(record.current_a));
    double loaded_s = 0.0;
    for (std::size_t i = 0; i < record.time_s.size(); ++i) {
        mask.resting.push_back(record.current_a[i] < load_a);
        if (!mask.resting.back()) {
            loaded_s = record.time_s[i];
            mask.last_load = i + 1;
        }
        mask.since_load_s.push_back(mask.last_load == 0 ? -1.0 : record.time_s[i] - loaded_s);
    }
    return mask;
}

/// Relative change of the resting voltage at sample `at`; 0 if not known.
double step_at(const PackRecord& record, const RestMask& mask, std::size_t at, double from_s) {
    std::vector<double> before;
    std::vector<double> after;
    for (std::size_t i = at; i-- > 0 && before.size() < compared_samples;) {
        if (!mask.resting[i] || mask.since_load_s[i] < from_s) break;
        before.push_back(record.voltage_v[i]);
    }
    for (std::size_t i = at; i < mask.resting.size() && mask.resting[i] && after.size() < compared_samples; ++i)
        after.push_back(record.voltage_v[i]);
    if (before.empty() || after.empty()) return 0.0;
    const double was_v = median_high(std::move(before));
    return (median_high(std::move(after)) - was_v) / was_v;
}

bool is_reset(const std::vector<double>& counter_ah, std::size_t at) {
    return !counter_ah.empty() && counter_ah[at - 1] > min_counted_ah &&
           counter_ah[at] < reset_fraction * counter_ah[at - 1];
}

PackRecord part_of(const PackRecord& whole, std::size_t first, std::size_t last) {
    const auto cut = [&](const std::vector<double>& values) {
        if (values.empty()) return values;
        return std::vector(values.begin() + static_cast<std::ptrdiff_t>(first),
                           values.begin() + static_cast<std::ptrdiff_t>(last));
    };
    return {cut(whole.time_s), cut(whole.voltage_v), cut(whole.current_a), cut(whole.counter_ah),
            cut(whole.throttle_percent)};
}

}  // namespace

std::vector<double> integrated_charge_ah(const std::vector<double>& time_s, const std::vector<double>& current_a) {
    std::vector<double> charge(time_s.size(), 0.0);
    for (std::size_t i = 1; i < charge.size(); ++i) {
        const double mean_a = (current_a[i - 1] + current_a[i]) / 2.0;
        charge[i] = charge[i - 1] + units::ah_from_coulomb(mean_a * (time_s[i] - time_s[i - 1]));
    }
    return charge;
}

std::vector<PackRecord> split_at_pack_changes(PackRecord record, std::vector<std::string>& notes,
                                              const std::function<bool(double)>& stands) {
    const auto mask = rests_of(record);
    const auto drawn_ah = integrated_charge_ah(record.time_s, record.current_a);
    const auto logged_ah = record.counter_ah;
    std::vector<std::size_t> starts{0};
    double missing_ah = 0.0;
    for (std::size_t i = 1; i < record.time_s.size(); ++i) {
        const bool reset = is_reset(logged_ah, i);
        const bool between_loads = mask.resting[i] && mask.since_load_s[i] > 0.0 && i < mask.last_load;
        const double change = (record.voltage_v[i] - record.voltage_v[i - 1]) / record.voltage_v[i - 1];
        // The step is estimated from all samples around it; it is where two neighbours differ by most of it.
        double step = 0.0;
        if (between_loads && std::abs(change) > late_step / 2.0 && stands(record.time_s[i])) {
            step = step_at(record, mask, i, reset ? 0.0 : settled_s);
            if (const double early = step_at(record, mask, i, recovery_s); early > early_step) step = early;
        }
        const bool rises = change > step / 2.0 && step > late_step;
        const bool falls = change < step / 2.0 && -step > (reset ? late_step : early_step);  // as electronics load it
        if (rises || falls) {
            notes.push_back(
                fmt::format("the pack was changed at {:.0f} s: the voltage {} from {:.2f} to {:.2f} V at "
                            "rest{}; its discharges are separated",
                            record.time_s[i], rises ? "rises" : "falls", record.voltage_v[i - 1], record.voltage_v[i],
                            reset ? " and the charge counter is reset" : ""));
            starts.push_back(i);
            missing_ah = 0.0;
        } else if (reset) {
            notes.push_back(
                fmt::format("the charge counter is reset at {:.0f} s, with the same pack: continued from {:.3f} Ah",
                            record.time_s[i], logged_ah[i - 1] + missing_ah));
            missing_ah += logged_ah[i - 1] - logged_ah[i] + drawn_ah[i] - drawn_ah[i - 1];
        }
        if (!record.counter_ah.empty()) record.counter_ah[i] += missing_ah;
    }
    starts.push_back(record.time_s.size());
    std::vector<PackRecord> parts;
    for (std::size_t p = 1; p < starts.size(); ++p) parts.push_back(part_of(record, starts[p - 1], starts[p]));
    return parts;
}

}  // namespace flightwatt::battery
