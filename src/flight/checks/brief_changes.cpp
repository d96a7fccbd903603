#include "base/units.h"
#include "flight/checks/power_rules.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double doubtful_change_fraction = 0.02;  // of the energy
constexpr std::size_t max_change = 5;
constexpr std::size_t max_fall_without_throttle = 3;
constexpr double change_factor = 0.65;
constexpr double fall_factor_without_throttle = 0.3;
constexpr double single_fall_factor = 0.2;
constexpr double single_rise_part = 0.5;  // of what was held for three samples
constexpr double throttle_factor = 0.7;
constexpr double coarse_percent = 5.0;
constexpr double min_neighbour_part = 0.1;  // of what was held for three samples

struct BriefChanges {
    const PowerRecord& record;
    double held_w;  ///< at most, for three samples

    static auto range(const std::vector<double>& values, const IndexSpan& change) {
        return std::ranges::minmax(part_of(values, change));
    }
    /// Of the samples before and after.
    static auto beside(const std::vector<double>& values, const IndexSpan& change) {
        return std::minmax({values[change.begin - 1], values[change.end]});
    }

    bool is_fall(const IndexSpan& change) const {
        const auto& throttle = record.throttle_percent;
        const double max_w = range(record.power_w, change).max;
        const double lower_w = beside(record.power_w, change).first;
        if (lower_w <= min_neighbour_part * held_w) return false;
        if (change.size() == 1 && max_w < single_fall_factor * lower_w) return true;
        if (throttle.empty())
            return change.size() <= max_fall_without_throttle && max_w < fall_factor_without_throttle * lower_w;
        const double least = range(throttle, change).min;
        return max_w < change_factor * lower_w && least > open_throttle_percent &&
               least >= throttle_factor * beside(throttle, change).first;
    }

    bool is_rise(const IndexSpan& change) const {
        const auto& throttle = record.throttle_percent;
        const double min_w = range(record.power_w, change).min;
        const double higher_w = beside(record.power_w, change).second;
        if (change.size() == 1 && min_w - higher_w > single_rise_part * held_w) return true;
        if (throttle.empty() || min_w - higher_w <= min_neighbour_part * held_w) return false;
        return change_factor * min_w > higher_w &&
               range(throttle, change).max <= beside(throttle, change).second / throttle_factor + coarse_percent;
    }

    double carried_j(const IndexSpan& change) const {
        const auto [lower_w, higher_w] = beside(record.power_w, change);
        double energy_j = 0.0;
        for (auto i = change.begin; i < change.end; ++i) {
            const double power_w = record.power_w[i];
            energy_j += (power_w > higher_w ? power_w - higher_w : lower_w - power_w) * record.step_s[i];
        }
        return energy_j;
    }
};

}  // namespace

Texts power_changes_briefly(const PowerRecord& record) {
    const auto& power_w = record.power_w;
    double held_w = 0.0;
    for (std::size_t i = 2; i < power_w.size(); ++i)
        held_w = std::max(held_w, std::min({power_w[i - 2], power_w[i - 1], power_w[i]}));
    const BriefChanges brief{record, held_w};
    double carried_j = 0.0;
    std::size_t changes = 0;
    for (const auto& [first, last] : record.in_flight) {
        for (auto i = std::max<std::size_t>(first, 1); i < last; ++i) {
            for (auto end = i + 1; end <= i + max_change && end < power_w.size(); ++end) {
                const IndexSpan change{i, end};
                if (!brief.is_fall(change) && !brief.is_rise(change)) continue;
                carried_j += brief.carried_j(change);
                ++changes;
                i = end;
                break;
            }
        }
    }
    if (carried_j <= doubtful_change_fraction * record.energy_j) return {};
    return {fmt::format("{} time{} the power rises or falls for up to {} samples{}: {:.0f} % of the energy", changes,
                        changes == 1 ? "" : "s", max_change,
                        record.throttle_percent.empty() ? "" : " and the throttle does not",
                        units::percentage(carried_j, record.energy_j))};
}

}  // namespace flightwatt::flight
