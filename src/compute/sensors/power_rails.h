#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// A supply line of a board, or a part of its processor. `read` gives its power [W] at a time (now); of a counter of
/// energy the mean power since the last call, NaN at the first. It throws InputError naming the file.
struct PowerRail {
    std::string name;    ///< the board's or the driver's name for it, "VDD_IN", "package-0"
    std::string source;  ///< the files
    std::function<double(std::chrono::steady_clock::time_point)> read;
};

/// Which of the rails (by name) add up to the power of the board: those `wanted`; else the one that is known
/// to carry everything (VDD_IN, POM_5V_IN, ...); else the processor's packages; else all but those that are fed by
/// another rail. Returns indices. Throws NoResultError for one wanted that is not there, listing those that are.
std::vector<std::size_t> rails_of_total(const std::vector<std::string>& names, const std::vector<std::string>& wanted);

/// TI INA3221 through NVIDIA's IIO driver (Jetson Nano, TX2, Xavier under L4T up to 32):
/// bus/i2c/drivers/ina3221x/1-0040/iio:device0 (or iio_device) and bus/iio/devices/iio:device0, with
/// rail_name_0, in_power0_input [mW], else in_voltage0_input [mV] times in_current0_input [mA].
std::vector<PowerRail> iio_rails(const std::filesystem::path& sysfs);

/// TI INA3221 through the kernel's hwmon driver (Orin, Xavier under L4T from 34; Documentation/hwmon/ina3221):
/// class/hwmon/hwmon3 whose name is ina3221, and bus/i2c/drivers/ina3221/1-0040/hwmon/hwmon3, with in1_label, in1_input
/// [mV] times curr1_input [mA]; channels with in1_enable 0 are passed over.
std::vector<PowerRail> hwmon_rails(const std::filesystem::path& sysfs);

/// TI INA238 through the kernel's hwmon driver (Jetson Thor, where it measures the input; Documentation/hwmon/ina238):
/// class/hwmon/hwmon2 whose name is ina238, and bus/i2c/drivers/ina238/2-0044/hwmon/hwmon2, with power1_input [uW],
/// else in1_input [mV] times curr1_input [mA]; in0 is the shunt's voltage.
std::vector<PowerRail> ina238_rails(const std::filesystem::path& sysfs);

/// Batteries and supplies: class/power_supply/BAT0 with power_now [uW], else voltage_now [uV] times
/// current_now [uA]. Those whose status is Charging or Full do not show the load, and are passed over.
std::vector<PowerRail> power_supply_rails(const std::filesystem::path& sysfs);

/// The counters of energy that can be read below class/powercap (Intel and AMD RAPL through the kernel's powercap
/// driver): intel-rapl:0 and below. They begin at 0 again at max_energy_range_uj.
std::vector<PowerRail> rapl_rails(const std::filesystem::path& sysfs);

}  // namespace flightwatt::compute
