#include "flight/select/device_check.h"

#include "base/statistics.h"
#include "base/units.h"
#include "flight/checks/runs.h"
#include "flight/select/device_sum.h"

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

    double all_j() const {
        double sum_j = 0.0;
        for (const auto& watts : power_w) sum_j = energy_j(watts, sum_j);
        return sum_j;
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

/// One device compared with the others, sample by sample.
struct DeviceComparison {
    const std::vector<double>& own_w;
    std::vector<double> median_w;  ///< of the others
    std::vector<double> sum_w;     ///< of the others
    std::vector<bool> is_stuck;
};

/// Equal reports in a row that show a pack's sensor to be stuck: more where it is slower than the log.
std::size_t stuck_reports_of_pack(const Track& track) {
    constexpr std::size_t stuck_updates = 4;
    std::vector<double> lengths;
    for (const auto& run : runs_of_equal(track.value, 1)) lengths.push_back(static_cast<double>(run.size()));
    if (lengths.size() < 2) return stuck_reports;
    return std::max(stuck_reports, stuck_updates * static_cast<std::size_t>(median_high(std::move(lengths))));
}

DeviceComparison compare_with_others(const DeviceTable& table, std::size_t device, const std::vector<Track>& reported,
                                     bool are_packs = false) {
    DeviceComparison compared{table.power_w[device], {}, {}, std::vector<bool>(table.time_s.size(), false)};
    for (std::size_t i = 0; i < table.time_s.size(); ++i) {
        std::vector<double> others;
        for (std::size_t d = 0; d < table.power_w.size(); ++d)
            if (d != device) others.push_back(table.power_w[d][i]);
        compared.sum_w.push_back(std::reduce(others.begin(), others.end()));
        compared.median_w.push_back(median(std::move(others)));
    }
    for (const auto& track : reported) {
        for (const auto& run : runs_of_equal(track.value, are_packs ? stuck_reports_of_pack(track) : stuck_reports)) {
            const auto first = std::ranges::lower_bound(table.time_s, track.time_s[run.begin]) - table.time_s.begin();
            const auto last = std::ranges::upper_bound(table.time_s, track.time_s[run.end - 1]) - table.time_s.begin();
            std::fill(compared.is_stuck.begin() + first, compared.is_stuck.begin() + std::max(first, last), true);
        }
    }
    return compared;
}

/// Suspect samples of one device: their times, its energy, and its expected energy.
struct SuspectInterval {
    double own_j = 0.0;
    double expected_j = 0.0;
    double lasts_s = 0.0;
    double from_s = 0.0;
    double to_s = 0.0;
};

template <typename IsSuspect, typename Expected>
SuspectInterval suspect_samples(const DeviceTable& table, const DeviceComparison& compared, const IsSuspect& is_suspect,
                                const Expected& expected_w) {
    SuspectInterval suspect;
    for (std::size_t i = 0; i < table.time_s.size(); ++i) {
        if (!is_suspect(i)) continue;
        if (suspect.lasts_s == 0.0) suspect.from_s = table.time_s[i] - table.step_s[i];
        suspect.to_s = table.time_s[i];
        suspect.lasts_s += table.step_s[i];
        suspect.own_j += compared.own_w[i] * table.step_s[i];
        suspect.expected_j += expected_w(i) * table.step_s[i];
    }
    return suspect;
}

/// A motor that is stuck, or almost without power while the others run; expected is their median.
SuspectInterval check_motor(const DeviceTable& table, const DeviceComparison& compared) {
    const double running_w = motor_on_fraction * quantile_of(compared.median_w, 0.75);
    const auto others_w = [&](std::size_t i) { return compared.median_w[i]; };
    const auto idles = [&](std::size_t i) {
        return others_w(i) > running_w && compared.own_w[i] < off_fraction * others_w(i);
    };
    return suspect_samples(
        table, compared, [&](std::size_t i) { return idles(i) || compared.is_stuck[i]; }, others_w);
}

/// A circuit that is stuck; expected is its share of the others' power at other times, or an equal share if these are
/// too few.
SuspectInterval check_circuit(const DeviceTable& table, const DeviceComparison& compared,
                              const std::vector<Track>& reported, double all_j) {
    const bool is_steady_load = std::ranges::any_of(
        reported, [](const Track& track) { return is_constant(track) && track.value.front() != 0.0; });
    if (is_steady_load && table.energy_j(compared.own_w) < small_load_fraction * all_j) return {};
    const auto others_w = [&](std::size_t i) { return compared.sum_w[i]; };
    const auto moving = suspect_samples(
        table, compared, [&](std::size_t i) { return !compared.is_stuck[i]; }, others_w);
    const bool is_known = moving.expected_j > min_reference_fraction * table.energy_j(compared.sum_w);
    const double share =
        is_known ? moving.own_j / moving.expected_j : 1.0 / static_cast<double>(table.power_w.size() - 1);
    return suspect_samples(
        table, compared, [&](std::size_t i) { return compared.is_stuck[i]; },
        [&](std::size_t i) { return share * others_w(i); });
}

/// A device that reduces the sum, or is the sum of the others; empty otherwise.
std::string check_share(const DeviceTable& table, const DeviceComparison& compared, double all_j) {
    const double own_j = table.energy_j(compared.own_w);
    if (own_j < -suspect_energy_fraction * std::abs(all_j)) {
        return fmt::format("reports negative power, {:.0f} % of the sum: is it a source, or is its sensor reversed?",
                           units::percentage(own_j, all_j));
    }
    std::vector<double> difference_w(compared.sum_w.size());
    std::ranges::transform(compared.own_w, compared.sum_w, difference_w.begin(),
                           [](double own_w, double others_w) { return std::abs(own_w - others_w); });
    const auto is_part = [&](const auto& power_w) { return table.energy_j(power_w) > same_power_fraction * own_j; };
    const bool are_parts = std::ranges::count_if(table.power_w, is_part) > 2;  // itself, and two others
    if (are_parts && table.energy_j(difference_w) < same_power_fraction * own_j)
        return "reports the sum of all others: if it is the pack, the energy is counted twice";
    return "";
}

/// Ids that are missing between others; of "node/motor" those of the motor, if all differ.
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
    if (missing.empty() || missing.size() == ids.size()) return "";  // numbered otherwise
    return fmt::format("{} {} {} missing between {} and {}: the sum is without {}", message, fmt::join(missing, ", "),
                       missing.size() > 1 ? "are" : "is", *std::prev(ids.lower_bound(missing.front())),
                       *ids.upper_bound(missing.back()), missing.size() > 1 ? "their power" : "its power");
}

std::string describe(const SuspectInterval& suspect, const std::string& name, double all_j) {
    const bool is_off = suspect.own_j < off_fraction * suspect.expected_j;
    return fmt::format(
        "{} reports {} ({:.2f} W) for {:.0f} s from {:.1f} to {:.1f} s, unlike the others: is it off, or its sensor "
        "damaged? With their power the energy would change by {:+.0f} %",
        name, is_off ? "almost no power" : "a constant value", suspect.own_j / suspect.lasts_s, suspect.lasts_s,
        suspect.from_s, suspect.to_s, units::percentage(suspect.expected_j - suspect.own_j, all_j));
}

bool is_suspect(const SuspectInterval& suspect, double all_j) {
    return std::abs(suspect.expected_j - suspect.own_j) > suspect_energy_fraction * std::abs(all_j);
}

/// The power of a device, and its current if it reports one.
std::vector<Track> reported_by(const Device& device, const std::vector<Device>& currents) {
    std::vector<Track> reported{device.track};
    const auto current = std::ranges::find(currents, device.name, &Device::name);
    if (current != currents.end()) reported.push_back(current->track);
    return reported;
}

}  // namespace

std::vector<std::string> find_suspect_devices(const FlightSeries& series, std::string_view message) {
    std::vector<std::string> findings;
    auto devices = devices_of(series, "power_w", message);
    if (devices.empty()) return findings;
    if (auto missing = missing_ids(devices, message); !missing.empty()) findings.push_back(std::move(missing));
    const auto max_reports = devices.front().track.time_s.size();
    std::erase_if(devices, [&](const Device& device) { return reports_rarely(device, max_reports); });
    if (devices.size() < 2 || max_reports < stuck_reports) return findings;
    if (devices.size() > max_compared_devices) {
        findings.push_back(fmt::format("{} {} devices: too many to compare them", devices.size(), message));
        return findings;
    }
    const auto currents = devices_of(series, "current_a", message);
    const auto table = table_of(devices);
    const double all_j = table.all_j();
    for (std::size_t d = 0; d < devices.size(); ++d) {
        const auto reported = reported_by(devices[d], currents);
        const auto compared = compare_with_others(table, d, reported);
        const auto suspect =
            message == "ESC" ? check_motor(table, compared) : check_circuit(table, compared, reported, all_j);
        if (is_suspect(suspect, all_j)) findings.push_back(describe(suspect, devices[d].name, all_j));
        if (const auto finding = check_share(table, compared, all_j); !finding.empty())
            findings.push_back(fmt::format("{} {} {}", message, devices[d].id, finding));
    }
    return findings;
}

std::vector<std::string> find_suspect_packs(std::vector<Device> powers, const std::vector<Device>& currents) {
    std::vector<std::string> findings;
    std::ranges::stable_sort(powers, std::ranges::greater(), [](const Device& d) { return d.track.time_s.size(); });
    if (powers.size() < 2 || powers.front().track.time_s.size() < stuck_reports) return findings;
    const auto table = table_of(powers);
    const double all_j = table.all_j();
    std::vector<DeviceComparison> compared;
    for (std::size_t d = 0; d < powers.size(); ++d)
        compared.push_back(compare_with_others(table, d, reported_by(powers[d], currents), true));
    const auto logged = compared;
    for (std::size_t d = 0; d < powers.size(); ++d) {
        if (is_constant(powers[d].track)) continue;              // a steady load
        for (std::size_t i = 0; i < table.time_s.size(); ++i) {  // at rest all currents may stay
            const auto moving = std::ranges::count_if(logged, [&](const auto& of) { return !of.is_stuck[i]; });
            compared[d].is_stuck[i] = logged[d].is_stuck[i] && moving > 0;
        }
        const auto suspect = check_circuit(table, compared[d], reported_by(powers[d], currents), all_j);
        if (is_suspect(suspect, all_j)) findings.push_back(describe(suspect, powers[d].name, all_j));
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
