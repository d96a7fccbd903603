#pragma once

#include "compute/sensors/power_rail.h"

#include <filesystem>
#include <vector>

/// The rails that sensors offer below a sysfs root ("/sys"); none where there is no such sensor.
namespace flightwatt::compute {

/// TI INA3221 through NVIDIA's IIO driver (Jetson Nano, TX2, Xavier under L4T up to 32):
/// bus/i2c/drivers/ina3221x/1-0040/iio:device0 (or iio_device) and bus/iio/devices/iio:device0, with
/// rail_name_0, in_power0_input [mW], else in_voltage0_input [mV] times in_current0_input [mA].
std::vector<PowerRail> iio_rails(const std::filesystem::path& sysfs);

/// TI INA3221 through the kernel's hwmon driver (Orin, Xavier under L4T from 34;
/// Documentation/hwmon/ina3221): class/hwmon/hwmon3 whose name is ina3221, and
/// bus/i2c/drivers/ina3221/1-0040/hwmon/hwmon3, with in1_label, in1_input [mV] times curr1_input [mA];
/// channels with in1_enable 0 are passed over.
std::vector<PowerRail> hwmon_rails(const std::filesystem::path& sysfs);

/// Batteries and supplies: class/power_supply/BAT0 with power_now [uW], else voltage_now [uV] times
/// current_now [uA]. Those whose status is Charging or Full do not show the load, and are passed over.
std::vector<PowerRail> power_supply_rails(const std::filesystem::path& sysfs);

}  // namespace flightwatt::compute
