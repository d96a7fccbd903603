#include "flight/sources/device_check.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/runs.h"
#include "flight/sources/device_sum.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr std::size_t stuck_reports = 30;         // equal ones in a row
constexpr double suspect_energy_fraction = 0.04;  // of all devices
constexpr double off_fraction = 0.05;             // of the others' median
constexpr double motor_on_fraction = 0.2;         // of the others' upper quartile
constexpr double small_load_fraction = 0.25;      // of the energy: electronics
constexpr double min_reference_fraction = 0.1;    // of the others' energy, to estimate a circuit's share
constexpr double same_power_fraction = 0.05;      // difference of a device from the sum of the others
constexpr std::size_t max_compared_devices = 32;

/// The devices' power on one clock.
struct DeviceTable {
    std::vector<double> time_s;
    std::vector<double> step_s;  ///< duration of each sample, at most that of a gap
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

/// The samples of a table in which a device repeats one of its reported values.
std::vector<bool> repeated_samples(const DeviceTable& table, const std::vector<Track>& reported) {
    std::vector<bool> is_stuck(table.time_s.size(), false);
    for (const auto& track : reported) {
        for (const auto& run : runs_of_equal(track.value, stuck_reports)) {
            const auto first = std::ranges::lower_bound(table.time_s, track.time_s[run.begin]) - table.time_s.begin();
            const auto last = std::ranges::upper_bound(table.time_s, track.time_s[run.end - 1]) - table.time_s.begin();
            std::fill(is_stuck.begin() + first, is_stuck.begin() + std::max(first, last), true);
        }
    }
    return is_stuck;
}

/// Samples of a device unlike the others': stuck, or of a motor almost without power while the others run.
std::vector<bool> suspect_samples(const DeviceTable& table, std::size_t device, const std::vector<Track>& reported,
                                  bool is_motor) {
    auto suspect = repeated_samples(table, reported);
    if (!is_motor) return suspect;
    std::vector<double> median_w;  // of the others
    for (std::size_t i = 0; i < table.time_s.size(); ++i) {
        std::vector<double> others;
        for (std::size_t d = 0; d < table.power_w.size(); ++d)
            if (d != device) others.push_back(table.power_w[d][i]);
        median_w.push_back(median(std::move(others)));
    }
    auto sorted = median_w;
    std::ranges::sort(sorted);
    const double running_w = motor_on_fraction * quantile(sorted, 0.75);
    for (std::size_t i = 0; i < suspect.size(); ++i)
        if (median_w[i] > running_w && table.power_w[device][i] < off_fraction * median_w[i]) suspect[i] = true;
    return suspect;
}

/// Energies of a device and of the others in some samples, and the duration of these.
struct EnergyShare {
    double own_j = 0.0;
    double others_j = 0.0;
    double lasts_s = 0.0;
};

EnergyShare share_where(const DeviceTable& table, std::size_t device, const std::vector<bool>& samples, bool value) {
    EnergyShare share;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i] != value) continue;
        share.lasts_s += table.step_s[i];
        for (std::size_t d = 0; d < table.power_w.size(); ++d)
            (d == device ? share.own_j : share.others_j) += table.power_w[d][i] * table.step_s[i];
    }
    return share;
}

/// A device that is off or stuck for a significant part of the energy: expected is its share of the others' power at
/// other times, or an equal share if these are too few. Empty without one.
std::string check_device(const DeviceTable& table, std::size_t device, const std::vector<Track>& reported,
                         bool is_motor, double all_j) {
    const bool is_steady_load = std::ranges::any_of(
        reported, [](const Track& track) { return is_constant(track) && track.value.front() != 0.0; });
    if (!is_motor && is_steady_load && table.energy_j(table.power_w[device]) < small_load_fraction * all_j) return "";
    const auto suspect = suspect_samples(table, device, reported, is_motor);
    const auto usual = share_where(table, device, suspect, false);
    const auto [own_j, others_j, lasts_s] = share_where(table, device, suspect, true);
    const bool is_known = usual.others_j > min_reference_fraction * (usual.others_j + others_j);
    const double share = is_known ? usual.own_j / usual.others_j : 1.0 / static_cast<double>(table.power_w.size() - 1);
    const double missing_j = share * others_j - own_j;
    if (std::abs(missing_j) <= suspect_energy_fraction * std::abs(all_j)) return "";
    const auto first = std::ranges::find(suspect, true) - suspect.begin();
    return fmt::format(
        "reports {} ({:.2f} W) for {:.0f} s, first at {:.1f} s, unlike the others: is it off, or its "
        "sensor damaged? With their power the energy would change by {:+.0f} %",
        own_j < off_fraction * share * others_j ? "almost no power" : "a constant value", own_j / lasts_s, lasts_s,
        table.time_s[static_cast<std::size_t>(first)], units::percentage(missing_j, all_j));
}

/// Whether a device's power is the sum of all others', of which two or more take part.
bool is_sum_of_others(const DeviceTable& table, std::size_t device) {
    const auto& own_w = table.power_w[device];
    const double own_j = table.energy_j(own_w);
    std::vector<double> difference_w(own_w.size());
    for (std::size_t i = 0; i < own_w.size(); ++i) {
        double others_w = -own_w[i];
        for (const auto& power_w : table.power_w) others_w += power_w[i];
        difference_w[i] = std::abs(own_w[i] - others_w);
    }
    const auto is_part = [&](const auto& power_w) { return table.energy_j(power_w) > same_power_fraction * own_j; };
    return std::ranges::count_if(table.power_w, is_part) > 2 &&  // itself, and two others
           table.energy_j(difference_w) < same_power_fraction * own_j;
}

}  // namespace

std::vector<std::string> find_suspect_devices(const FlightSeries& series, std::string_view message) {
    std::vector<std::string> findings;
    auto devices = devices_of(series, "power_w", message);
    if (devices.empty()) return findings;
    const auto max_reports = devices.front().track.time_s.size();
    std::erase_if(devices, [&](const Device& device) { return reports_rarely(device, max_reports); });
    if (devices.size() < 2 || devices.size() > max_compared_devices || max_reports < stuck_reports) return findings;
    const auto currents = devices_of(series, "current_a", message);
    const auto table = table_of(devices);
    double all_j = 0.0;
    for (const auto& power_w : table.power_w) all_j = table.energy_j(power_w, all_j);
    for (std::size_t d = 0; d < devices.size(); ++d) {
        std::vector<Track> reported{devices[d].track};
        const auto current = std::ranges::find(currents, devices[d].id, &Device::id);
        if (current != currents.end()) reported.push_back(current->track);
        if (const auto finding = check_device(table, d, reported, message == "ESC", all_j); !finding.empty())
            findings.push_back(fmt::format("{} {} {}", message, devices[d].id, finding));
        const double own_j = table.energy_j(table.power_w[d]);
        if (own_j < -suspect_energy_fraction * std::abs(all_j))
            findings.push_back(fmt::format("{} {} reports negative power, {:.0f} % of the sum: is its sensor reversed?",
                                           message, devices[d].id, units::percentage(own_j, all_j)));
        if (is_sum_of_others(table, d))
            findings.push_back(
                fmt::format("{} {} reports the sum of all others: if it is the pack, the energy is "
                            "counted twice",
                            message, devices[d].id));
    }
    return findings;
}

std::string differing_voltages_reason(const FlightSeries& series) {
    constexpr double max_ratio = 1.1;
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
    if (high <= max_ratio * low) return "";
    return fmt::format(
        "the circuits of POWER_DEVICE have {:.1f} to {:.1f} V: voltage and current of the pack are unknown", low, high);
}

}  // namespace flightwatt::flight
