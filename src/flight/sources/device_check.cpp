#include "flight/sources/device_check.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/runs.h"
#include "flight/sources/device_sum.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr std::size_t alike_reports = 30;
constexpr double doubtful_missing_fraction = 0.04;  // of the energy
constexpr double next_to_nothing_fraction = 0.05;   // of the others' median
constexpr double running_fraction = 0.2;            // of the others' upper quartile
constexpr double small_load_fraction = 0.25;        // of the energy: electronics
constexpr double telling_fraction = 0.1;            // of the others' energy, from which a circuit's part is known
constexpr double alike_fraction = 0.05;             // of its energy, by which a device differs from the others' sum
constexpr std::size_t max_judged = 32;

/// The devices' power on one clock.
struct DeviceTable {
    std::vector<double> time_s;
    std::vector<double> step_s;  ///< for which each sample counts; what is longer than a gap does not
    std::vector<std::vector<double>> power_w;

    double energy_j(const std::vector<double>& watts, double before_j = 0.0) const {
        return std::transform_reduce(watts.begin(), watts.end(), step_s.begin(), before_j);
    }
};

DeviceTable table_of(const std::vector<Device>& devices) {
    DeviceTable table;
    table.time_s = devices.front().track.time_s;
    const auto& time_s = table.time_s;
    const double max_s = gap_threshold_s(time_s);
    table.step_s.assign(time_s.size(), 0.0);
    for (std::size_t i = 1; i < time_s.size(); ++i) table.step_s[i] = std::min(time_s[i] - time_s[i - 1], max_s);
    table.power_w.reserve(devices.size());
    for (const auto& device : devices) table.power_w.push_back(resample(device.track, time_s));
    return table;
}

/// What one device does beside the others, sample by sample.
struct DeviceComparison {
    const std::vector<double>& own_w;
    std::vector<double> median_w;  ///< of the others
    std::vector<double> sum_w;     ///< of the others
    std::vector<bool> stands;
};

DeviceComparison beside_others(const DeviceTable& table, std::size_t device, const std::vector<Track>& reported) {
    DeviceComparison beside{table.power_w[device], {}, {}, std::vector<bool>(table.time_s.size(), false)};
    for (std::size_t i = 0; i < table.time_s.size(); ++i) {
        std::vector<double> others;
        for (std::size_t d = 0; d < table.power_w.size(); ++d)
            if (d != device) others.push_back(table.power_w[d][i]);
        beside.sum_w.push_back(std::reduce(others.begin(), others.end()));
        beside.median_w.push_back(median(std::move(others)));
    }
    for (const auto& track : reported) {
        for (const auto& run : runs_of_equal(track.value, alike_reports)) {
            const auto first = std::ranges::lower_bound(table.time_s, track.time_s[run.begin]) - table.time_s.begin();
            const auto last = std::ranges::upper_bound(table.time_s, track.time_s[run.end - 1]) - table.time_s.begin();
            std::fill(beside.stands.begin() + first, beside.stands.begin() + std::max(first, last), true);
        }
    }
    return beside;
}

/// What is doubted of one device: from when to when, what it drew, and what it would have drawn with the others.
struct SuspectInterval {
    double own_j = 0.0;
    double expected_j = 0.0;
    double lasts_s = 0.0;
    double from_s = 0.0;
    double to_s = 0.0;
};

template <typename IsSuspect, typename Expected>
SuspectInterval suspect_samples(const DeviceTable& table, const DeviceComparison& beside, const IsSuspect& is_suspect,
                                const Expected& expected_w) {
    SuspectInterval doubt;
    for (std::size_t i = 0; i < table.time_s.size(); ++i) {
        if (!is_suspect(i)) continue;
        if (doubt.lasts_s == 0.0) doubt.from_s = table.time_s[i] - table.step_s[i];
        doubt.to_s = table.time_s[i];
        doubt.lasts_s += table.step_s[i];
        doubt.own_j += beside.own_w[i] * table.step_s[i];
        doubt.expected_j += expected_w(i) * table.step_s[i];
    }
    return doubt;
}

/// A motor that stands still, or runs on next to nothing while the others run: it is expected to draw their median.
SuspectInterval doubt_of_motor(const DeviceTable& table, const DeviceComparison& beside) {
    auto sorted = beside.median_w;
    std::ranges::sort(sorted);
    const double running_w = running_fraction * quantile(sorted, 0.75);
    const auto others_w = [&](std::size_t i) { return beside.median_w[i]; };
    const auto idles = [&](std::size_t i) {
        return others_w(i) > running_w && beside.own_w[i] < next_to_nothing_fraction * others_w(i);
    };
    return suspect_samples(
        table, beside, [&](std::size_t i) { return idles(i) || beside.stands[i]; }, others_w);
}

/// A circuit that stands still: it is expected to draw the part of the others' power that it draws where it moves; of
/// that which hardly does, an equal one.
SuspectInterval doubt_of_circuit(const DeviceTable& table, const DeviceComparison& beside,
                                 const std::vector<Track>& reported, double all_j) {
    const bool is_steady_load = std::ranges::any_of(
        reported, [](const Track& track) { return is_constant(track) && track.value.front() != 0.0; });
    if (is_steady_load && table.energy_j(beside.own_w) < small_load_fraction * all_j) return {};
    const auto others_w = [&](std::size_t i) { return beside.sum_w[i]; };
    const auto moving = suspect_samples(
        table, beside, [&](std::size_t i) { return !beside.stands[i]; }, others_w);
    const bool tells = moving.expected_j > telling_fraction * table.energy_j(beside.sum_w);
    const double part = tells ? moving.own_j / moving.expected_j : 1.0 / static_cast<double>(table.power_w.size() - 1);
    return suspect_samples(
        table, beside, [&](std::size_t i) { return beside.stands[i]; },
        [&](std::size_t i) { return part * others_w(i); });
}

/// What is odd of a device's part in the sum: it is taken off, or it is the others' sum.
std::string odd_part(const DeviceTable& table, const DeviceComparison& beside, double all_j) {
    const double own_j = table.energy_j(beside.own_w);
    if (own_j < -doubtful_missing_fraction * std::abs(all_j)) {
        return fmt::format("reports negative power, {:.0f} % of the sum: a source, or a sensor that is reversed?",
                           units::percentage(own_j, all_j));
    }
    std::vector<double> apart_w(beside.sum_w.size());
    std::ranges::transform(beside.own_w, beside.sum_w, apart_w.begin(),
                           [](double own_w, double others_w) { return std::abs(own_w - others_w); });
    const auto is_part = [&](const auto& power_w) { return table.energy_j(power_w) > alike_fraction * own_j; };
    const bool has_parts = std::ranges::count_if(table.power_w, is_part) > 2;  // itself, and two others
    if (has_parts && table.energy_j(apart_w) < alike_fraction * own_j)
        return "reports what all others do together: if it is the pack's, the energy is counted twice";
    return "";
}

/// Which ids are missing between others: of "node/motor" the motor's, where all differ.
std::string missing_ids(const std::vector<Device>& devices, std::string_view message) {
    std::set<int> ids;
    for (const auto& device : devices) {
        int id = 0;
        const auto* const end = device.id.data() + device.id.size();
        const auto parsed = std::from_chars(device.id.data() + device.id.rfind('/') + 1, end, id);
        if (parsed.ec != std::errc() || parsed.ptr != end || !ids.insert(id).second) return "";
    }
    std::vector<int> missing;
    for (int id = *ids.begin(); id < *ids.rbegin() && missing.size() < ids.size(); ++id)
        if (!ids.contains(id)) missing.push_back(id);
    if (missing.empty() || missing.size() == ids.size()) return "";  // numbered by other rules
    return fmt::format("{} {} {} missing between {} and {}: what {} is not in the sum", message,
                       fmt::join(missing, ", "), missing.size() > 1 ? "are" : "is",
                       *std::prev(ids.lower_bound(missing.front())), *ids.upper_bound(missing.back()),
                       missing.size() > 1 ? "they draw" : "it draws");
}

std::string said_of(const SuspectInterval& doubt, std::string_view message, const std::string& id, double all_j) {
    const bool nothing = doubt.own_j < next_to_nothing_fraction * doubt.expected_j;
    const auto what = nothing ? fmt::format("next to nothing ({:.2f} W)", doubt.own_j / doubt.lasts_s)
                              : fmt::format("the same value again and again ({:.2f} W)", doubt.own_j / doubt.lasts_s);
    return fmt::format(
        "{} {} reports {} for {:.0f} s from {:.1f} to {:.1f} s, while the others go on: is it off, or its sensor dead? "
        "Drawing what they do, it would change the energy by {:+.0f} %",
        message, id, what, doubt.lasts_s, doubt.from_s, doubt.to_s,
        units::percentage(doubt.expected_j - doubt.own_j, all_j));
}

}  // namespace

std::vector<std::string> find_suspect_devices(const FlightSeries& series, std::string_view message) {
    std::vector<std::string> doubts;
    auto devices = devices_of(series, "power_w", message);
    if (devices.empty()) return doubts;
    if (auto missing = missing_ids(devices, message); !missing.empty()) doubts.push_back(std::move(missing));
    const auto most = devices.front().track.time_s.size();
    std::erase_if(devices, [&](const Device& device) { return reports_rarely(device, most); });
    if (devices.size() < 2 || most < alike_reports) return doubts;
    if (devices.size() > max_judged) {
        doubts.push_back(fmt::format("{} {} devices: none is judged beside the others", devices.size(), message));
        return doubts;
    }
    const auto currents = devices_of(series, "current_a", message);
    const auto table = table_of(devices);
    double all_j = 0.0;
    for (const auto& power_w : table.power_w) all_j = table.energy_j(power_w, all_j);
    for (std::size_t d = 0; d < devices.size(); ++d) {
        std::vector<Track> reported{devices[d].track};
        const auto current = std::ranges::find(currents, devices[d].id, &Device::id);
        if (current != currents.end()) reported.push_back(current->track);
        const auto beside = beside_others(table, d, reported);
        const auto doubt =
            message == "ESC" ? doubt_of_motor(table, beside) : doubt_of_circuit(table, beside, reported, all_j);
        if (std::abs(doubt.expected_j - doubt.own_j) > doubtful_missing_fraction * std::abs(all_j))
            doubts.push_back(said_of(doubt, message, devices[d].id, all_j));
        if (const auto odd = odd_part(table, beside, all_j); !odd.empty())
            doubts.push_back(fmt::format("{} {} {}", message, devices[d].id, odd));
    }
    return doubts;
}

std::string differing_voltages_reason(const FlightSeries& series) {
    constexpr double max_apart = 1.1;
    const auto currents = devices_of(series, "current_a", "POWER_DEVICE");
    std::vector<double> voltages;
    for (const auto& device : devices_of(series, "power_w", "POWER_DEVICE")) {
        const auto current = std::ranges::find(currents, device.id, &Device::id);
        if (current == currents.end()) continue;
        const auto sum = [](const Track& track) { return std::reduce(track.value.begin(), track.value.end()); };
        const double volts = sum(device.track) / sum(current->track);
        if (std::isfinite(volts) && volts > 0.0) voltages.push_back(volts);
    }
    if (voltages.empty()) return "";
    const auto [low, high] = std::ranges::minmax(voltages);
    if (high <= max_apart * low) return "";
    return fmt::format(
        "the circuits of POWER_DEVICE have {:.1f} to {:.1f} V: voltage and current of the pack are not known", low,
        high);
}

}  // namespace flightwatt::flight
