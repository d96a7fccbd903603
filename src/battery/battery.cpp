#include "battery/battery.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace flightwatt {

double power_limit_w(const Battery& battery) {
    if (battery.resistance_ohm == 0.0) return std::numeric_limits<double>::infinity();
    return battery.voltage_v * battery.voltage_v / (4.0 * battery.resistance_ohm);
}

double internal_current_a(const Battery& battery, double power_w) {
    const double limit_w = power_limit_w(battery);
    if (power_w > limit_w) {
        throw NoAnswerError(
            fmt::format("the battery cannot deliver {} W: its limit U^2 / (4 R) is {} W", power_w, limit_w));
    }
    const double u = battery.voltage_v;
    // (U - sqrt(D)) / (2 R), multiplied out: no difference of near numbers, no division by R. At the limit
    // rounding may leave D a hair below zero.
    const double discriminant = std::max(0.0, u * u - 4.0 * battery.resistance_ohm * power_w);
    return 2.0 * power_w / (u + std::sqrt(discriminant));
}

Battery battery_from(const TomlTable& table) {
    const auto positive = [&](std::string_view key) {
        const double value = table.number(key);
        constexpr double absurd = 1e6;  // squared and divided, values below stay numbers
        if (value <= 0.0 || value > absurd) {
            throw InputError(table.where(key), fmt::format("{} = {} is not {}", key, value,
                                                           value <= 0.0 ? "positive" : "of this world"));
        }
        return value;
    };
    Battery battery;
    battery.name = table.optional_string("name").value_or("");
    battery.voltage_v = positive("voltage_v");
    battery.resistance_ohm = table.number("resistance_ohm");
    if (battery.resistance_ohm < 0.0) {
        throw InputError(table.where("resistance_ohm"),
                         fmt::format("resistance_ohm = {} is negative", battery.resistance_ohm));
    }
    battery.capacity_ah = positive("capacity_ah");
    table.refuse_unknown_keys();
    return battery;
}

Battery read_battery(const std::filesystem::path& path) { return battery_from(read_toml(path)); }

}  // namespace flightwatt
