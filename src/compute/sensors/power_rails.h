#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// A supply line of a board, and how its power now is read [W]. `read` throws InputError naming the file.
struct PowerRail {
    std::string name;    ///< the board's name for it, "VDD_IN"
    std::string source;  ///< the files
    std::function<double()> read;
};

/// A counter of the energy that a part of the processor has used. `read_uj` throws InputError naming the file.
struct EnergyCounter {
    std::string name;    ///< "package-0"
    std::string source;  ///< its energy_uj
    std::function<double()> read_uj;
    double range_uj = 0.0;    ///< where it begins at 0 again
    bool is_package = false;  ///< a whole processor, whose parts have counters of their own
};

/// Which of the rails (by name) add up to the power of the board: those `wanted`; else the one that is known
/// to carry everything (VDD_IN, POM_5V_IN, ...); else all but those that are fed by another rail. Returns
/// indices. Throws NoResultError for one wanted that is not there, listing those that are.
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

/// The counters that can be read below class/powercap (Intel and AMD RAPL through the kernel's powercap
/// driver): intel-rapl:0 and below.
std::vector<EnergyCounter> energy_counters(const std::filesystem::path& sysfs);

/// Two readings of a counter as power [W]: energy since the last, over time. `range_uj` is where the counter
/// begins at 0 again.
double power_of_counter_w(double last_uj, double now_uj, double range_uj, double time_s);

}  // namespace flightwatt::compute
