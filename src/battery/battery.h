#pragma once

#include "base/toml_reader.h"

#include <filesystem>
#include <string>

namespace flightwatt {

/// A battery as an equivalent circuit: an ideal source behind a resistor (Eqs. 8-10).
struct Battery {
    std::string name;
    double voltage_v = 0.0;       ///< U_int, of the source
    double resistance_ohm = 0.0;  ///< R_int; 0 is an ideal source
    double capacity_ah = 0.0;     ///< Q_c
};

/// The greatest power that a load can draw, U^2 / (4 R) [W]; infinite if the resistance is 0.
double power_limit_w(const Battery& battery);

/// I_int [A] while the load draws `power_w` (Eq. 10): the smaller root of R I^2 - U I + P = 0, in a form that
/// is exact for R = 0. Negative power charges: the current is then negative. Throws NoAnswerError if the
/// power is above the limit.
double internal_current_a(const Battery& battery, double power_w);

/// Reads voltage_v, resistance_ohm, capacity_ah and optionally name. Throws InputError for keys missing or
/// unknown, a voltage or capacity that is not positive, or a negative resistance.
Battery read_battery(const std::filesystem::path& path);
Battery battery_from(const TomlTable& table);

}  // namespace flightwatt
