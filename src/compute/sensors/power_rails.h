#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// A supply line of a board, or a part of its processor. `read` returns the power [W] now; of an energy counter the
/// mean power since the last call, NaN at the first. Throws InputError naming the file.
struct PowerRail {
    std::string name;    ///< the board's or the driver's name for it, "VDD_IN", "package-0"
    std::string source;  ///< the files
    std::function<double(std::chrono::steady_clock::time_point)> read;
};

/// Indices of the rails whose sum is the power of the board: those `wanted`; else the total (VDD_IN, POM_5V_IN, ...);
/// else the processor's packages; else all that no other rail feeds. Throws NoResultError for a missing one.
std::vector<std::size_t> rails_of_total(const std::vector<std::string>& names, const std::vector<std::string>& wanted);

/// TI INA3221 of NVIDIA's Jetsons, by NVIDIA's IIO driver (L4T up to 32; bus/i2c/drivers/ina3221x, bus/iio/devices:
/// rail_name_0, in_power0_input [mW], else in_voltage0_input [mV] times in_current0_input [mA]), else by the kernel's
/// hwmon driver (L4T from 34; Documentation/hwmon/ina3221: in1_label, in1_input [mV] times curr1_input [mA]; channels
/// with in1_enable 0 are skipped).
std::vector<PowerRail> ina3221_rails(const std::filesystem::path& sysfs);

/// Energy counters of Intel and AMD RAPL below class/powercap, intel-rapl:0 and below. They wrap at
/// max_energy_range_uj.
std::vector<PowerRail> rapl_rails(const std::filesystem::path& sysfs);

}  // namespace flightwatt::compute
