#pragma once

#include <numbers>
#include <optional>
#include <string_view>

/// The only place that holds a conversion factor.
namespace flightwatt::units {

inline constexpr double seconds_per_hour = 3600.0;
inline constexpr double seconds_per_minute = 60.0;
inline constexpr double pprz_full_scale = 9600.0;  ///< Paparazzi's MAX_PPRZ: full throttle in "pprz"
inline constexpr double percent_per_whole = 100.0;
inline constexpr double rad_per_turn = 2.0 * std::numbers::pi;
inline constexpr double degree_per_rad = 180.0 / std::numbers::pi;
inline constexpr double standard_gravity_m_per_s2 = 9.80665;
inline constexpr double metre_per_degree = 111195.0;  ///< of a great circle on a sphere as large as the earth
inline constexpr double metre_per_foot = 0.3048;
inline constexpr double metre_per_mile = 1609.344;
inline constexpr double metre_per_nautical_mile = 1852.0;
inline constexpr double metre_per_kilometre = 1000.0;
/// The paper's Table I counts time in units of which every phase lasts 28, whatever its seconds.
inline constexpr double table_one_time_per_phase = 28.0;

constexpr double wh_from_joule(double energy_j) { return energy_j / seconds_per_hour; }
constexpr double joule_from_wh(double energy_wh) { return energy_wh * seconds_per_hour; }
constexpr double coulomb_from_ah(double charge_ah) { return charge_ah * seconds_per_hour; }
constexpr double ah_from_coulomb(double charge_as) { return charge_as / seconds_per_hour; }
constexpr double mv_from_v(double voltage_v) { return voltage_v * 1000.0; }
constexpr double minute_from_second(double time_s) { return time_s / seconds_per_minute; }
constexpr double percentage(double part, double whole) { return part / whole * percent_per_whole; }
constexpr double amount_from_percent(double whole, double percent) { return whole * percent / percent_per_whole; }
constexpr double percent_from_pprz(double throttle_pprz) { return throttle_pprz / pprz_full_scale * percent_per_whole; }
constexpr double pprz_from_percent(double throttle_percent) {
    return throttle_percent / percent_per_whole * pprz_full_scale;
}

constexpr double rad_from_turns(double turns) { return turns * rad_per_turn; }
/// Table I's xi, an angular frequency, from omega * duration of the phase.
constexpr double table_one_xi_from_rad(double theta_rad) { return theta_rad / table_one_time_per_phase; }

constexpr double milli = 1e-3;
constexpr double micro = 1e-6;
constexpr double watt_from_milliwatt(double power_mw) { return power_mw * milli; }
constexpr double volt_from_millivolt(double voltage_mv) { return voltage_mv * milli; }
constexpr double ampere_from_milliampere(double current_ma) { return current_ma * milli; }
constexpr double joule_from_microjoule(double energy_uj) { return energy_uj * micro; }

/// Quantity of a declared unit; the base unit of each is the suffix used in names.
enum class Quantity {
    volt,
    ampere,
    watt,
    ampere_hour,
    watt_hour,
    metre,
    metre_per_second,
    second,
    percent,
    degree,
    celsius,
    kilogram
};

struct Unit {
    Quantity quantity;
    double factor;  ///< value in the base unit = factor * raw value
};

/// Reads a unit as Paparazzi's message definitions and the logs of other programs write it: "V", "1e-1V", "decivolt",
/// "mAh", "cm/s", "pprz", "ft", "km/h", "1e7deg" (ten millionths of a degree).
/// std::nullopt for other quantities.
std::optional<Unit> parse_unit(std::string_view text);

}  // namespace flightwatt::units
