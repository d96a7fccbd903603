#include "base/error.h"
#include "exchange/parameters/pack_facts.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

namespace flightwatt::exchange {
namespace {

constexpr auto inav = "INAV";
constexpr int max_inav_cells = 12;
constexpr double cw_per_w = 100.0;     // INAV's powers are in 0.01 W,
constexpr double mwh_per_wh = 1000.0;  // its energies in mWh,
constexpr double cm_per_m = 100.0;     // its speeds in cm/s

/// Whole and not negative, as INAV's settings are.
template <typename Stored>
long long whole(double value, const char* name) {
    const double rounded = std::round(value);
    if (rounded >= 0.0 && rounded <= static_cast<double>(std::numeric_limits<Stored>::max()))
        return static_cast<long long>(rounded);
    throw InputError({}, fmt::format("{} would be {:.6g}: INAV takes 0 to {}", name, rounded,
                                     static_cast<long long>(std::numeric_limits<Stored>::max())));
}

}  // namespace

ParameterText to_inav(const EstimatorInput& input) {
    const auto pack = summarize_pack(input, inav);
    const auto& model = required_model(input, inav);
    if (pack.cells > max_inav_cells) {
        throw InputError({}, fmt::format("bat_cells would be {}: INAV takes up to {}", pack.cells, max_inav_cells),
                         "is the number of cells right (--cells)?");
    }
    const double cruise_w = mean_power_w(input, flight::Phase::cruise);
    const double idle_w = input.idle_w.value_or(input.compute_w);
    if (idle_w >= cruise_w) {
        throw InputError({}, fmt::format("idles at {:.1f} W, and cruises at {:.1f} W", idle_w, cruise_w),
                         "expected the power while the motor stands (--idle-power)");
    }
    ParameterText result;
    const auto set = [&](const char* name, auto value) { result.text += fmt::format("set {} = {}\n", name, value); };
    result.text = "# Written by flightwatt export " FLIGHTWATT_VERSION ", for INAV's CLI; then: save\n";
    set("bat_cells", pack.cells);
    set("battery_capacity_unit", "MWH");
    set("battery_capacity", whole<std::uint32_t>(pack.energy_wh * mwh_per_wh, "battery_capacity"));
    set("idle_power", whole<std::uint16_t>(idle_w * cw_per_w, "idle_power"));
    set("cruise_power", whole<std::uint32_t>((cruise_w - idle_w) * cw_per_w, "cruise_power"));
    if (model.physical) {
        set("nav_fw_cruise_speed",
            whole<std::uint16_t>(model.physical->mean_airspeed_m_per_s * cm_per_m, "nav_fw_cruise_speed"));
    } else {
        result.notes.emplace_back(
            "the model knows no airspeed: nav_fw_cruise_speed is left out (fit --model physical)");
    }
    if (input.reserve_percent) {
        set("rth_energy_margin", whole<std::uint8_t>(*input.reserve_percent, "rth_energy_margin"));
    } else {
        result.notes.emplace_back("no mission says what should be left: rth_energy_margin is left out");
    }
    return result;
}

}  // namespace flightwatt::exchange
