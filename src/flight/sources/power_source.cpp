#include "flight/sources/power_source.h"

#include "flight/track.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

/// The first of `fields` that the table has with the given quantity; nullptr if it has none.
const telemetry::Column* first_column(const telemetry::MessageTable& table,
                                      std::initializer_list<const char*> fields, units::Quantity quantity) {
    for (const auto* field : fields) {
        const auto* column = table.column(field);
        if (column != nullptr && column->quantity == quantity) return column;
    }
    return nullptr;
}

std::vector<double> products(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> result(a.size());
    std::transform(a.begin(), a.end(), b.begin(), result.begin(), std::multiplies<>());
    return result;
}

struct VoltageAndCurrent {
    const telemetry::Column* voltage = nullptr;
    const telemetry::Column* current = nullptr;
    bool known() const { return voltage != nullptr && current != nullptr; }
};

VoltageAndCurrent voltage_and_current(const telemetry::MessageTable& table) {
    return {first_column(table, {"voltage", "bat", "bat_volts"}, units::Quantity::volt),
            first_column(table, {"current", "amp", "amps"}, units::Quantity::ampere)};
}

MeasuredPower product_power(const telemetry::MessageTable& table) {
    const auto [voltage, current] = voltage_and_current(table);
    if (voltage == nullptr || current == nullptr) return {};
    return {make_track(table.time_s, products(voltage->values, current->values), Merge::mean),
            fmt::format("{0}.{1} * {0}.{2}", table.message, voltage->field, current->field)};
}

/// True if most samples of ENERGY.power are nowhere near voltage times current: another layout of the message
/// than was assumed.
bool contradicts_product(const telemetry::MessageTable& table, const telemetry::Column& power) {
    const auto [voltage, current] = voltage_and_current(table);
    if (voltage == nullptr || current == nullptr) return false;
    std::size_t compared = 0;
    std::size_t apart = 0;
    for (std::size_t i = 0; i < power.values.size(); ++i) {
        const double product = voltage->values[i] * current->values[i];
        if (!(std::abs(product) > 1.0) || !std::isfinite(power.values[i])) continue;
        ++compared;
        if (std::abs(power.values[i] - product) > 0.2 * std::abs(product)) ++apart;
    }
    return compared >= 10 && 2 * apart > compared;
}

/// A quantity summed over devices.
struct DeviceSum {
    Track track;
    std::size_t devices = 0;
};

/// Sum over the devices (motors, circuits) that a message reports one at a time, on the clock of the device
/// that reports most, as long as all of them report.
DeviceSum sum_over_devices(const telemetry::MessageTable& table, std::initializer_list<const char*> id_fields,
                           const std::vector<double>& column_values) {
    std::map<std::vector<double>, std::pair<std::vector<double>, std::vector<double>>> rows;
    for (std::size_t i = 0; i < column_values.size(); ++i) {
        std::vector<double> id;
        for (const auto* field : id_fields) {
            if (const auto* column = table.column(field)) id.push_back(column->values[i]);
        }
        auto& [times, values] = rows[id];
        times.push_back(table.time_s[i]);
        values.push_back(column_values[i]);
    }
    std::vector<Track> devices;
    for (const auto& [id, row] : rows) {
        auto track = make_track(row.first, row.second, Merge::mean);
        if (!track.empty()) devices.push_back(std::move(track));
    }
    if (devices.empty()) return {};
    std::stable_sort(devices.begin(), devices.end(),
                     [](const Track& a, const Track& b) { return a.time_s.size() > b.time_s.size(); });
    DeviceSum sum{devices.front(), devices.size()};
    for (std::size_t d = 1; d < devices.size(); ++d) {
        const auto more = resample(devices[d], sum.track.time_s);
        for (std::size_t i = 0; i < more.size(); ++i) sum.track.value[i] += more[i];
    }
    return sum;
}

MeasuredPower summed_power(const telemetry::MessageTable& table,
                           std::initializer_list<const char*> id_fields) {
    const auto* power = first_column(table, {"power"}, units::Quantity::watt);
    const auto [voltage, current] = voltage_and_current(table);
    if (power == nullptr && (voltage == nullptr || current == nullptr)) return {};
    auto sum = sum_over_devices(
        table, id_fields, power != nullptr ? power->values : products(voltage->values, current->values));
    if (sum.devices == 0) return {};
    return {std::move(sum.track), fmt::format("{}, summed over {} devices", table.message, sum.devices)};
}

constexpr std::initializer_list<const char*> esc_ids{"node_id", "motor_id"};
constexpr std::initializer_list<const char*> power_device_ids{"node_id", "circuit"};

bool measures_something(const Track& power) {
    return power.time_s.size() >= 2 &&
           std::any_of(power.value.begin(), power.value.end(), [](double value) { return value != 0.0; });
}

/// Takes a candidate if it measures something, or says why not.
bool take(MeasuredPower candidate, MeasuredPower& chosen, std::vector<std::string>& passed_over) {
    if (candidate.source.empty()) return false;
    if (measures_something(candidate.power_w)) {
        chosen = std::move(candidate);
        return true;
    }
    passed_over.push_back(candidate.source + (candidate.power_w.time_s.size() < 2
                                                  ? " has no two finite values"
                                                  : " is 0 throughout"));
    return false;
}

}  // namespace

MeasuredPower choose_power(const telemetry::SenderLog& sender, std::vector<std::string>& passed_over) {
    MeasuredPower chosen;
    if (const auto* energy = sender.table("ENERGY")) {
        if (const auto* power = first_column(*energy, {"power"}, units::Quantity::watt)) {
            if (contradicts_product(*energy, *power)) {
                passed_over.emplace_back("ENERGY.power is not voltage times current");
            } else if (take({make_track(energy->time_s, power->values, Merge::mean), "ENERGY.power"}, chosen,
                            passed_over)) {
                return chosen;
            }
        }
        if (take(product_power(*energy), chosen, passed_over)) return chosen;
    }
    if (const auto* bat = sender.table("BAT")) {
        if (take(product_power(*bat), chosen, passed_over)) return chosen;
        if (!voltage_and_current(*bat).known()) passed_over.emplace_back("BAT has no current");
    }
    if (const auto* esc = sender.table("ESC")) {
        if (take(summed_power(*esc, esc_ids), chosen, passed_over)) return chosen;
    }
    if (const auto* device = sender.table("POWER_DEVICE")) {
        if (take(summed_power(*device, power_device_ids), chosen, passed_over)) return chosen;
    }
    return {};
}

MeasuredCurrent summed_current(const telemetry::SenderLog& sender) {
    const auto sum_of = [](const telemetry::MessageTable* table,
                           std::initializer_list<const char*> id_fields) {
        const auto* current = table == nullptr ? nullptr : voltage_and_current(*table).current;
        if (current == nullptr) return MeasuredCurrent{};
        auto sum = sum_over_devices(*table, id_fields, current->values);
        if (sum.devices == 0) return MeasuredCurrent{};
        return MeasuredCurrent{
            std::move(sum.track),
            fmt::format("{}.{}, summed over {} devices", table->message, current->field, sum.devices)};
    };
    auto current = sum_of(sender.table("ESC"), esc_ids);
    return current.source.empty() ? sum_of(sender.table("POWER_DEVICE"), power_device_ids) : current;
}

}  // namespace flightwatt::flight
