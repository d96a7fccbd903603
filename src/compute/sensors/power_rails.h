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

/// TI INA3221 by NVIDIA's IIO driver (Jetson Nano, TX2, Xavier; L4T up to 32): bus/i2c/drivers/ina3221x and
/// bus/iio/devices, with rail_name_0, in_power0_input [mW], else in_voltage0_input [mV] times in_current0_input [mA].
std::vector<PowerRail> iio_rails(const std::filesystem::path& sysfs);

/// TI INA3221 by the kernel's hwmon driver (Orin, Xavier; L4T from 34; Documentation/hwmon/ina3221): in1_label,
/// in1_input [mV] times curr1_input [mA]; channels with in1_enable 0 are skipped.
std::vector<PowerRail> hwmon_rails(const std::filesystem::path& sysfs);

/// TI INA238 by the kernel's hwmon driver (input of Jetson Thor; Documentation/hwmon/ina238): power1_input [uW], else
/// in1_input [mV] times curr1_input [mA]; in0 is the shunt.
std::vector<PowerRail> ina238_rails(const std::filesystem::path& sysfs);

/// class/power_supply/BAT0: power_now [uW], else voltage_now [uV] times current_now [uA]. Those whose status is
/// Charging or Full do not measure the load and are skipped.
std::vector<PowerRail> power_supply_rails(const std::filesystem::path& sysfs);

/// Energy counters of Intel and AMD RAPL below class/powercap, intel-rapl:0 and below. They wrap at
/// max_energy_range_uj.
std::vector<PowerRail> rapl_rails(const std::filesystem::path& sysfs);

}  // namespace flightwatt::compute
