#include "flight/select/circuits.h"

#include "base/number.h"
#include "base/statistics.h"
#include "base/units.h"
#include "flight/select/device_check.h"
#include "flight/select/device_sum.h"
#include "flight/select/outliers.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr double min_power_fraction = 0.02;  // of the largest power; less is a spare input
// Packs of as many cells are at most as far apart: 4.2 V a cell when full, 3.15 V when empty.
constexpr double max_voltage_difference = 0.25;
// Bounds of the highest voltage of a cell in a log: above that of a full one, and below that of one that still flies.
constexpr double full_cell_v = 4.45;
constexpr double empty_cell_v = 3.3;
constexpr double exceeded_by = 0.01;  // of the samples
// Two sensors of one pack. Equal packs in parallel share the current less evenly, by their resistances.
constexpr double same_voltage = 0.02;
constexpr double same_current = 0.03;
constexpr double same_current_by_escs = 0.15;  // these do not measure the electronics
constexpr double nearly_all = 0.95;            // of the samples
constexpr double failed_part = 0.8;            // of the other sensor's mean power: with less it failed in flight
constexpr double suspect_part = 0.04;          // of the power: could hide some percent of the energy
constexpr std::size_t enough_samples = 10;

/// A battery monitor as logged.
struct Monitor {
    std::string name;    ///< "BAT 0", "BAT2"
    int number;          ///< from 1 on
    std::string stated;  ///< its kind by the log's parameters, see FlightInfo::monitor_kinds
    Track power_w;
    Track voltage_v;
    Track current_a;
    Track charge_ah;
    Track energy_wh;
    Track battery_temperature_c;
    double mean_w = 0.0;
    double mean_v = 0.0;
    double high_v = 0.0;  ///< exceeded by a hundredth of the samples
    double mean_a = 0.0;
    std::optional<double> stated_capacity_ah = {};  ///< see FlightInfo::monitor_capacities_ah
    std::optional<int> stated_cells = {};           ///< see FlightInfo::monitor_cells
    std::string exclusion = {};                     ///< why it is not counted; empty if it is

    bool has_current() const { return !power_w.empty() && !current_a.empty(); }
    std::string text() const { return fmt::format("{} ({:.2f} V, {:.2f} A)", name, mean_v, mean_a); }
};

std::string message_of(const Track& track) { return track.source.substr(0, track.source.find('.')); }

/// The monitor's track of that name; empty if it reports none within physical bounds.
Track track_of(const FlightSeries& series, const Track& power, std::string_view name) {
    const auto found = std::ranges::find_if(series.tracks, [&](const Track& track) {
        return track.name == name && track.device == power.device && message_of(track) == message_of(power);
    });
    return found == series.tracks.end() ? Track{} : within_bounds(*found);
}

/// The number of a monitor, from 1 on, by its id, "0" of the first; without a number in it by its place.
int number_of(const std::string& id, std::size_t place) {
    constexpr std::uint64_t max_id = 99;
    return static_cast<int>(std::min<std::uint64_t>(parse_unsigned(id).value_or(place), max_id)) + 1;
}

/// The monitors that state a voltage, in the order of the log; empty without a number. Of messages without a number the
/// first one counts.
std::vector<Monitor> monitors_of(const FlightSeries& series) {
    std::vector<Monitor> monitors;
    bool is_numbered = false;
    bool has_plain = false;
    for (const auto& power : series.tracks) {
        if (power.name != "power_w" || power.source.find(" * ") == std::string::npos) continue;
        if (power.device.empty() && std::exchange(has_plain, true)) continue;
        is_numbered = is_numbered || !power.device.empty();
        const auto message = message_of(power);
        const auto id = power.device.empty() ? std::string("0") : power.device;
        const bool is_named = power.device.empty() || std::isdigit(static_cast<unsigned char>(message.back())) != 0;
        Monitor monitor{is_named ? message : fmt::format("{} {}", message, power.device),
                        number_of(id, monitors.size()),
                        {},
                        within_bounds(power),
                        track_of(series, power, "voltage_v"),
                        track_of(series, power, "current_a"),
                        track_of(series, power, "charge_ah"),
                        track_of(series, power, "energy_wh"),
                        track_of(series, power, "battery_temperature_c")};
        if (monitor.voltage_v.empty()) continue;
        const auto kind = series.monitor_kinds.find(id);
        if (kind != series.monitor_kinds.end()) monitor.stated = kind->second;
        const auto capacity = series.monitor_capacities_ah.find(id);
        if (capacity != series.monitor_capacities_ah.end()) monitor.stated_capacity_ah = capacity->second;
        monitor.stated_cells = stated_cells(series, id);
        monitor.mean_v = mean(monitor.voltage_v.value);
        monitor.high_v = quantile_of(monitor.voltage_v.value, 1.0 - exceeded_by);
        if (monitor.has_current()) {
            monitor.mean_w = mean(monitor.power_w.value);
            monitor.mean_a = mean(monitor.current_a.value);
        }
        monitors.push_back(std::move(monitor));
    }
    return is_numbered ? monitors : std::vector<Monitor>{};
}

/// Removes the monitors that measure fuel, or no current; notes are of the former, and of the latter at a voltage at
/// which they may supply the motors.
void remove_unmeasured(std::vector<Monitor>& monitors, std::vector<std::string>& notes) {
    const auto is_fuel = [](const Monitor& monitor) { return monitor.stated == fuel_monitor; };
    double largest_v = 0.0;
    for (const auto& monitor : monitors) {
        if (is_fuel(monitor))
            notes.push_back(fmt::format("{} is not counted: it measures fuel, by its parameter", monitor.name));
        else if (monitor.has_current())
            largest_v = std::max(largest_v, monitor.mean_v);
    }
    for (const auto& monitor : monitors) {
        if (is_fuel(monitor) || monitor.has_current()) continue;
        if (largest_v > 0.0 && monitor.mean_v >= (1.0 - max_voltage_difference) * largest_v)
            notes.push_back(fmt::format(
                "{} states {:.1f} V but no current: if it is a pack of its own, what it supplies is not counted",
                monitor.name, monitor.mean_v));
    }
    std::erase_if(monitors, [&](const Monitor& monitor) { return is_fuel(monitor) || !monitor.has_current(); });
}

/// Whether two tracks are within a part of each other at nearly all samples at which the second one is at least a tenth
/// of its largest: at rest sensors have offsets, and ESCs do not measure the electronics.
bool agree(const Track& track, const Track& other, double within) {
    constexpr double compared_part = 0.1;
    const auto values = resample(other, track.time_s);
    const double largest = std::ranges::max(other.value, {}, [](double value) { return std::abs(value); });
    std::size_t compared = 0;
    std::size_t equal = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool is_measured = track.time_s[i] >= other.time_s.front() && track.time_s[i] <= other.time_s.back();
        if (!is_measured || std::abs(values[i]) < compared_part * std::abs(largest)) continue;
        ++compared;
        if (std::abs(track.value[i] - values[i]) <= within * std::abs(values[i])) ++equal;
    }
    return compared >= enough_samples && static_cast<double>(equal) >= nearly_all * static_cast<double>(compared);
}

/// Whether two tracks of a pack agree with those of another monitor, where that one measures.
bool agrees_with(const Monitor& monitor, const Monitor& other) {
    const bool by_escs = monitor.stated == escs_monitor || other.stated == escs_monitor;
    return agree(monitor.voltage_v, other.voltage_v, same_voltage) &&
           agree(monitor.current_a, other.current_a, by_escs ? same_current_by_escs : same_current);
}

bool are_smart(const Monitor& monitor, const Monitor& other) {
    return monitor.stated == smart_pack_monitor && other.stated == smart_pack_monitor;
}

/// Excludes one of two monitors that measure one pack: the one that fails in flight, else the second.
void exclude_second_sensor(Monitor& first, Monitor& second) {
    if (are_smart(first, second)) return;
    const bool agrees = agrees_with(second, first);
    const bool agrees_in_part = agrees_with(first, second);
    const auto fails = [](const Monitor& monitor, const Monitor& other) {
        return std::abs(monitor.mean_w) < failed_part * std::abs(other.mean_w);
    };
    constexpr auto same =
        "voltage and current of {} are the same {}: both measure one pack, whose energy would be counted twice";
    constexpr auto always = "at nearly every sample";
    constexpr auto in_part = "wherever this one measures, which is not throughout";
    if (agrees && !agrees_in_part && fails(first, second))
        first.exclusion = fmt::format(same, second.name, in_part);
    else if (agrees)
        second.exclusion = fmt::format(same, first.name, always);
    else if (agrees_in_part && fails(second, first))
        second.exclusion = fmt::format(same, first.name, in_part);
}

/// Whether a monitor's power is that of a set of two or more others.
bool is_sum_of_others(const std::vector<Monitor>& monitors, std::size_t of) {
    constexpr std::size_t max_monitors = 6;  // the number of sets doubles with each
    if (monitors.size() < 3 || monitors.size() > max_monitors) return false;
    for (unsigned set = 0; set < 1U << monitors.size(); ++set) {
        if (std::popcount(set) < 2 || (set >> of & 1U) != 0) continue;
        Track sum{.time_s = monitors[of].power_w.time_s,
                  .value = std::vector<double>(monitors[of].power_w.time_s.size())};
        for (std::size_t m = 0; m < monitors.size(); ++m)
            if ((set >> m & 1U) != 0)
                std::ranges::transform(sum.value, resample(monitors[m].power_w, sum.time_s), sum.value.begin(),
                                       std::plus());
        if (agree(monitors[of].power_w, sum, same_current)) return true;
    }
    return false;
}

/// Sets why monitors are not counted.
void exclude(std::vector<Monitor>& monitors) {
    const auto largest = std::ranges::max(monitors, {}, [](const Monitor& m) { return std::abs(m.mean_w); });
    for (std::size_t m = 0; m < monitors.size(); ++m) {
        auto& monitor = monitors[m];
        if (std::abs(monitor.mean_w) < min_power_fraction * std::abs(largest.mean_w))
            monitor.exclusion = "a spare input, as it draws less than 2 % of the power";
        else if (monitors.size() > 1 && (monitor.stated == sum_monitor || is_sum_of_others(monitors, m)))
            monitor.exclusion = "the sum of others";
        else if (monitor.stated == same_pins_monitor)
            monitor.exclusion =
                "on the pins of another, by its parameters: one pack, whose energy would be counted twice";
    }
    for (std::size_t m = 1; m < monitors.size(); ++m) {
        for (std::size_t other = 0; other < m && monitors[m].exclusion.empty(); ++other)
            if (monitors[other].exclusion.empty()) exclude_second_sensor(monitors[other], monitors[m]);
    }
}

/// Whether two packs have different numbers of cells in series: 12.5 V are 3 and 16.8 V 4 or 5.
bool have_other_cells(const Monitor& pack, const Monitor& other) {
    const auto& [low, high] = std::minmax(pack.high_v, other.high_v);
    const double most_of_low = std::max(std::ceil(low / full_cell_v), std::floor(low / empty_cell_v));
    return most_of_low < std::ceil(high / full_cell_v);
}

/// The packs that count, by circuit: a pack belongs to the first circuit whose largest pack has about its voltage, and
/// may have as many cells.
std::vector<std::vector<const Monitor*>> packs_by_circuit(const std::vector<Monitor>& monitors) {
    std::vector<const Monitor*> packs;
    for (const auto& monitor : monitors)
        if (monitor.exclusion.empty()) packs.push_back(&monitor);
    std::ranges::stable_sort(packs, std::greater(), [](const Monitor* pack) { return std::abs(pack->mean_w); });
    std::vector<std::vector<const Monitor*>> circuits;
    for (const auto* pack : packs) {
        const auto circuit = std::ranges::find_if(circuits, [&](const auto& of) {
            const auto& largest = *of.front();
            return std::abs(pack->mean_v - largest.mean_v) <= max_voltage_difference * largest.mean_v &&
                   !have_other_cells(*pack, largest);
        });
        if (circuit == circuits.end())
            circuits.push_back({pack});
        else
            circuit->push_back(pack);
    }
    return circuits;
}

std::string names_of(const std::vector<const Monitor*>& packs) {
    std::vector<std::string> names;
    names.reserve(packs.size());
    for (const auto* pack : packs) names.push_back(pack->name);
    return fmt::format("{}", fmt::join(names, " and "));
}

/// The only track, or the sum of several, whose notes go to `chosen`.
Track sum_of(std::vector<Device> devices, ChosenTrack& chosen) {
    auto sum = devices.size() == 1 ? DeviceSum{std::move(devices.front().track), "", {}}
                                   : sum_over_devices(std::move(devices));
    std::ranges::move(sum.notes, std::back_inserter(chosen.notes));
    if (!sum.ambiguity.empty()) chosen.not_chosen.push_back(std::move(sum.ambiguity));
    sum.track.device.clear();
    return std::move(sum.track);
}

std::vector<Device> devices_of(const std::vector<const Monitor*>& packs, Track Monitor::*member) {
    std::vector<Device> devices;
    devices.reserve(packs.size());
    for (const auto* pack : packs) devices.push_back({pack->name, "", pack->*member, {}});
    return devices;
}

/// The sum of the packs' counters; empty if one of several is missing or does not count.
Track counter_of(const std::vector<const Monitor*>& packs, Track Monitor::*member, ChosenTrack& chosen) {
    for (const auto* pack : packs) {
        const auto& counter = pack->*member;
        if (packs.size() == 1 || !is_constant(counter)) continue;
        if (!counter.empty())
            chosen.notes.push_back(fmt::format("the counter of {} stays at {:g}: the counters are not used", pack->name,
                                               counter.value.front()));
        return {};
    }
    ChosenTrack unused;
    return sum_of(devices_of(packs, member), unused);
}

/// The capacity of packs together; std::nullopt unless each is stated.
std::optional<double> stated_capacity_ah(const std::vector<const Monitor*>& packs) {
    double sum_ah = 0.0;
    for (const auto* pack : packs) {
        if (!pack->stated_capacity_ah) return std::nullopt;
        sum_ah += *pack->stated_capacity_ah;
    }
    return sum_ah;
}

/// The cells in series of packs at one voltage; std::nullopt where they state different ones, or none.
std::optional<int> common_cells(const std::vector<const Monitor*>& packs) {
    std::set<int> cells;
    for (const auto* pack : packs)
        if (pack->stated_cells) cells.insert(*pack->stated_cells);
    return cells.size() == 1 ? std::optional(*cells.begin()) : std::nullopt;
}

/// The monitors of packs, each with its part of the mean current; unknown if one of them measures nothing.
std::vector<MonitorShare> shares_of(const std::vector<const Monitor*>& packs) {
    double sum_a = 0.0;
    for (const auto* pack : packs) sum_a += pack->mean_a;
    const auto is_known = [&](const Monitor* pack) { return pack->mean_a / sum_a > 0.0; };
    const bool are_known = std::ranges::all_of(packs, is_known);
    std::vector<MonitorShare> shares;
    shares.reserve(packs.size());
    for (const auto* pack : packs) shares.push_back({pack->number, are_known ? pack->mean_a / sum_a : 0.0});
    std::ranges::sort(shares, {}, &MonitorShare::number);
    return shares;
}

Circuit circuit_of(const std::vector<const Monitor*>& packs, ChosenTrack& power) {
    ChosenTrack unused;
    Circuit circuit{names_of(packs),
                    0.0,
                    sum_of(devices_of(packs, &Monitor::power_w), power),
                    packs.front()->voltage_v,
                    sum_of(devices_of(packs, &Monitor::current_a), unused),
                    counter_of(packs, &Monitor::charge_ah, power),
                    stated_capacity_ah(packs),
                    packs.front()->battery_temperature_c,
                    common_cells(packs),
                    shares_of(packs)};
    circuit.voltage_v.device.clear();
    circuit.battery_temperature_c.device.clear();
    if (!circuit.power_w.empty()) circuit.mean_power_w = mean(circuit.power_w.value);
    return circuit;
}

/// Packs that stop counting in flight, or that are not what their monitors state; of VTOLs, whose lift motors may have a
/// pack of their own that rests, without the former.
void add_suspicions(const FlightSeries& series, const std::vector<Monitor>& monitors,
                    const std::vector<std::vector<const Monitor*>>& circuits, std::vector<std::string>& notes) {
    const bool is_vtol = std::ranges::any_of(
        series.tracks, [](const Track& track) { return track.name == "vtol_state" && !track.empty(); });
    for (const auto& packs : circuits)
        if (packs.size() > 1 && !is_vtol)
            std::ranges::move(
                find_suspect_packs(devices_of(packs, &Monitor::power_w), devices_of(packs, &Monitor::current_a)),
                std::back_inserter(notes));
    double all_w = 0.0;
    std::vector<const Monitor*> counted;
    for (const auto& packs : circuits) counted.insert(counted.end(), packs.begin(), packs.end());
    for (const auto* monitor : counted) all_w += monitor->mean_w;
    for (const auto& monitor : monitors) {
        if (!monitor.exclusion.empty() || counted.size() < 2) continue;
        if (monitor.mean_w < -suspect_part * std::abs(all_w))
            notes.push_back(
                fmt::format("{} has a negative current, so that the sum over the batteries is smaller: is it "
                            "charged in flight, or is its sensor reversed?",
                            monitor.text()));
        for (const auto* other : counted) {
            if (other == &monitor) break;
            if (!are_smart(monitor, *other) && agree(monitor.current_a, other->current_a, same_current))
                notes.push_back(fmt::format(
                    "{} and {} have the same current at nearly every sample, though their voltages differ: if "
                    "one pack feeds both (a voltage with a wrong scale, or a tap of its cells), it is counted twice",
                    other->text(), monitor.text()));
        }
    }
}

void describe_choice(const std::vector<Monitor>& monitors, BatteryTracks& found) {
    std::vector<std::string> used;
    for (const auto& monitor : monitors)
        if (monitor.exclusion.empty()) used.push_back(monitor.text());
    if (used.size() > 1)
        found.note = fmt::format("the power is the sum over the {} {}",
                                 found.circuits.size() == 1 ? "batteries" : "batteries of circuits of their own",
                                 fmt::join(used, " and "));
    for (const auto& monitor : monitors)
        if (monitor.exclusion.empty() && monitor.stated == throttle_monitor && used.size() > 1)
            found.power_w.notes.push_back(fmt::format(
                "the current of {} is computed from the throttle, by its parameter: the power is part guess",
                monitor.name));
    for (const auto& monitor : monitors)
        if (!monitor.exclusion.empty())
            found.power_w.notes.push_back(fmt::format("{} is not counted: {}; the power is that of {}", monitor.text(),
                                                      monitor.exclusion, fmt::join(used, " and ")));
}

}  // namespace

std::optional<int> stated_cells(const FlightSeries& series, const std::string& id) {
    constexpr double max_cells = 100.0;
    const auto cells = series.monitor_cells.find(id);
    const bool is_stated = cells != series.monitor_cells.end() && cells->second >= 1.0 && cells->second <= max_cells;
    return is_stated ? std::optional(static_cast<int>(cells->second)) : std::nullopt;
}

std::optional<BatteryTracks> select_batteries(const FlightSeries& series) {
    BatteryTracks found;
    auto monitors = monitors_of(series);
    remove_unmeasured(monitors, found.power_w.notes);
    if (monitors.empty()) return std::nullopt;
    exclude(monitors);
    std::vector<Device> powers;
    std::vector<const Monitor*> all;
    const auto circuits = packs_by_circuit(monitors);
    for (const auto& packs : circuits) {
        all.insert(all.end(), packs.begin(), packs.end());
        found.circuits.push_back(circuit_of(packs, found.power_w));
        powers.push_back({found.circuits.back().name, "", found.circuits.back().power_w, {}});
    }
    std::ranges::stable_sort(found.circuits, std::greater(),
                             [](const Circuit& circuit) { return std::abs(circuit.mean_power_w); });
    static_cast<Track&>(found.power_w) = sum_of(std::move(powers), found.power_w);
    ChosenTrack unused;
    static_cast<Track&>(found.energy_wh) = counter_of(all, &Monitor::energy_wh, unused);
    describe_choice(monitors, found);
    add_suspicions(series, monitors, circuits, found.power_w.notes);
    return found;
}

}  // namespace flightwatt::flight
