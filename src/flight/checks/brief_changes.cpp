#include "base/statistics.h"
#include "flight/checks/power_warnings.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double doubtful_change_fraction = 0.02;  // of the energy
constexpr double doubtful_beside_throttle_fraction = 0.04;
constexpr std::size_t min_at_throttle = 10;
constexpr std::size_t max_change = 5;
constexpr std::size_t max_fall_without_throttle = 3;
constexpr double change_factor = 0.65;
constexpr double fall_factor_without_throttle = 0.3;
constexpr double throttle_factor = 0.7;
constexpr double running_throttle_percent = 30.0;
constexpr double min_neighbour_part = 0.1;  // of what was held for three samples

/// The samples [first, last) and those beside them.
struct BriefChange {
    std::size_t first;
    std::size_t last;
    double lower_w;  ///< of the two neighbours
    double higher_w;
};

struct BriefChangeDetector {
    const PowerRecord& record;
    double held_w = 0.0;

    auto least_and_most(const std::vector<double>& values, const BriefChange& change) const {
        const auto at = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
        const auto [least, most] = std::minmax_element(at(change.first), at(change.last));
        return std::pair(*least, *most);
    }

    bool falls(const BriefChange& change) const {
        const auto& throttle = record.throttle_percent;
        const auto max_w = least_and_most(record.power_w, change).second;
        if (change.lower_w <= min_neighbour_part * held_w) return false;
        const auto length = change.last - change.first;
        if (length == 1 && max_w < 0.2 * change.lower_w) return true;
        if (throttle.empty())
            return length <= max_fall_without_throttle && max_w < fall_factor_without_throttle * change.lower_w;
        const double beside = std::min(throttle[change.first - 1], throttle[change.last]);
        const double least = least_and_most(throttle, change).first;
        return max_w < change_factor * change.lower_w && least > running_throttle_percent &&
               least >= throttle_factor * beside;
    }

    bool rises(const BriefChange& change) const {
        const auto& throttle = record.throttle_percent;
        const auto min_w = least_and_most(record.power_w, change).first;
        if (change.last - change.first == 1 && min_w - change.higher_w > held_w / 2.0) return true;
        if (throttle.empty() || min_w - change.higher_w <= min_neighbour_part * held_w) return false;
        const double beside = std::max(throttle[change.first - 1], throttle[change.last]);
        constexpr double coarse_percent = 5.0;
        return change_factor * min_w > change.higher_w &&
               least_and_most(throttle, change).second <= beside / throttle_factor + coarse_percent;
    }

    double carried_j(const BriefChange& change, double max_s) const {
        double energy_j = 0.0;
        for (auto i = change.first; i < change.last; ++i) {
            const double power_w = record.power_w[i];
            const double apart_w = power_w > change.higher_w ? power_w - change.higher_w : change.lower_w - power_w;
            energy_j += apart_w * std::min(record.time_s[i + 1] - record.time_s[i - 1], max_s) / 2.0;
        }
        return energy_j;
    }
};

/// The flown samples by throttle.
std::map<int, std::vector<std::size_t>> samples_by_throttle(const PowerRecord& record) {
    constexpr double step_percent = 5.0;
    std::map<int, std::vector<std::size_t>> samples;
    for_each_in_flight(record, [&](std::size_t i) {
        const double percent = record.throttle_percent[i];
        if (percent > running_throttle_percent) samples[static_cast<int>(percent / step_percent)].push_back(i);
    });
    std::erase_if(samples, [](const auto& step) { return step.second.size() < min_at_throttle; });
    return samples;
}

}  // namespace

void warn_of_power_beside_throttle(const PowerCheckInput& input, Warnings& warnings) {
    const auto& record = input.record;
    if (record.throttle_percent.empty()) return;
    const auto by_throttle = samples_by_throttle(record);
    if (by_throttle.size() < 2) return;  // a switch, or a throttle that stands still
    const double max_s = gap_threshold_s(record.time_s);
    double lacking_j = 0.0;
    double beyond_j = 0.0;
    std::size_t samples = 0;
    for (const auto& [step, at_step] : by_throttle) {
        std::vector<double> powers;
        for (const auto i : at_step) powers.push_back(record.power_w[i]);
        const double median_w = median_high(std::move(powers));
        for (const auto i : at_step) {
            const double power_w = record.power_w[i];
            const bool is_usual = power_w >= change_factor * median_w && change_factor * power_w <= median_w;
            if (is_usual || i == 0 || i + 1 == record.time_s.size()) continue;
            const double lasts_s = std::min((record.time_s[i + 1] - record.time_s[i - 1]) / 2.0, max_s);
            (power_w < median_w ? lacking_j : beyond_j) += std::abs(power_w - median_w) * lasts_s;
            ++samples;
        }
    }
    if (lacking_j + beyond_j <= doubtful_beside_throttle_fraction * input.record.energy_j) return;
    warnings.push_back(
        fmt::format("power is far from what it usually is at the same throttle in {} samples in flight: {} % "
                    "of the energy less, {} % more",
                    samples, percent_of_whole(lacking_j / input.record.energy_j),
                    percent_of_whole(beyond_j / input.record.energy_j)));
}

void warn_of_brief_changes(const PowerCheckInput& input, Warnings& warnings) {
    const auto& record = input.record;
    const auto& power_w = record.power_w;
    const double max_s = gap_threshold_s(record.time_s);
    BriefChangeDetector judge{record};
    for (std::size_t i = 2; i < power_w.size(); ++i)
        judge.held_w = std::max(judge.held_w, std::min({power_w[i - 2], power_w[i - 1], power_w[i]}));
    double carried_j = 0.0;
    std::size_t changes = 0;
    for (const auto& [first, last] : record.in_flight) {
        for (auto i = std::max<std::size_t>(first, 1); i < last; ++i) {
            for (auto end = i + 1; end <= i + max_change && end < power_w.size(); ++end) {
                const auto [lower_w, higher_w] = std::minmax(power_w[i - 1], power_w[end]);
                const BriefChange change{i, end, lower_w, higher_w};
                if (!judge.falls(change) && !judge.rises(change)) continue;
                carried_j += judge.carried_j(change, max_s);
                ++changes;
                i = end;
                break;
            }
        }
    }
    const double part = carried_j / input.record.energy_j;
    if (part <= doubtful_change_fraction) return;
    warnings.push_back(fmt::format("{} time{} the power rises or falls for up to {} samples{}: {} % of the energy",
                                   changes, changes == 1 ? "" : "s", max_change,
                                   record.throttle_percent.empty() ? "" : " and the throttle does not",
                                   percent_of_whole(part)));
}

}  // namespace flightwatt::flight
