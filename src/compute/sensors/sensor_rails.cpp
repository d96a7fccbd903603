#include "compute/sensors/sensor_rails.h"

#include "base/units.h"
#include "compute/sensors/sysfs_file.h"

#include <cmath>
#include <set>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

using std::filesystem::path;

constexpr int channels = 3;  // of an INA3221

/// Folders that exist, each once: sysfs shows the same device at several places.
class DeviceFolders {
  public:
    void add(const path& folder) {
        std::error_code none;
        const auto real = std::filesystem::canonical(folder, none);
        if (!none && seen_.insert(real).second) folders_.push_back(folder);
    }
    const std::vector<path>& folders() const { return folders_; }

  private:
    std::set<path> seen_;
    std::vector<path> folders_;
};

PowerRail product_rail(const std::string& name, const path& voltage_mv, const path& current_ma) {
    return {name, fmt::format("{} x {}", voltage_mv.string(), current_ma.filename().string()),
            [voltage_mv, current_ma] {
                return units::volt_from_millivolt(require_sysfs_number(voltage_mv)) *
                       units::ampere_from_milliampere(require_sysfs_number(current_ma));
            }};
}

void add_iio_channels(const path& folder, std::vector<PowerRail>& rails) {
    for (int i = 0; i < channels; ++i) {
        const auto name = sysfs_text(folder / fmt::format("rail_name_{}", i))
                              .value_or(fmt::format("{}.{}", folder.filename().string(), i));
        const auto power = folder / fmt::format("in_power{}_input", i);
        const auto voltage = folder / fmt::format("in_voltage{}_input", i);
        const auto current = folder / fmt::format("in_current{}_input", i);
        if (sysfs_number(power)) {
            rails.push_back({name, power.string(),
                             [power] { return units::watt_from_milliwatt(require_sysfs_number(power)); }});
        } else if (sysfs_number(voltage) && sysfs_number(current)) {
            rails.push_back(product_rail(name, voltage, current));
        }
    }
}

void add_hwmon_channels(const path& folder, std::vector<PowerRail>& rails) {
    for (int i = 1; i <= channels; ++i) {
        const auto voltage = folder / fmt::format("in{}_input", i);
        const auto current = folder / fmt::format("curr{}_input", i);
        if (sysfs_number(folder / fmt::format("in{}_enable", i)) == 0.0) continue;
        if (!sysfs_number(voltage) || !sysfs_number(current)) continue;
        const auto label = sysfs_text(folder / fmt::format("in{}_label", i))
                               .value_or(fmt::format("{}.{}", folder.filename().string(), i));
        rails.push_back(product_rail(label, voltage, current));
    }
}

}  // namespace

std::vector<PowerRail> iio_rails(const path& sysfs) {
    DeviceFolders devices;
    for (const auto& driver : sysfs_entries(sysfs / "bus/i2c/drivers", "ina3221")) {
        for (const auto& chip : sysfs_entries(driver)) {
            for (const auto& device : sysfs_entries(chip, "iio")) devices.add(device);
        }
    }
    for (const auto& device : sysfs_entries(sysfs / "bus/iio/devices", "iio:device")) {
        const auto name = sysfs_text(device / "name").value_or("");
        if (name.starts_with("ina3221") || sysfs_text(device / "rail_name_0")) devices.add(device);
    }
    std::vector<PowerRail> rails;
    for (const auto& folder : devices.folders()) add_iio_channels(folder, rails);
    return rails;
}

std::vector<PowerRail> hwmon_rails(const path& sysfs) {
    DeviceFolders devices;
    for (const auto& driver : sysfs_entries(sysfs / "bus/i2c/drivers", "ina3221")) {
        for (const auto& chip : sysfs_entries(driver)) {
            for (const auto& device : sysfs_entries(chip / "hwmon", "hwmon")) devices.add(device);
        }
    }
    for (const auto& device : sysfs_entries(sysfs / "class/hwmon", "hwmon")) {
        if (sysfs_text(device / "name").value_or("").starts_with("ina3221")) devices.add(device);
    }
    std::vector<PowerRail> rails;
    for (const auto& folder : devices.folders()) add_hwmon_channels(folder, rails);
    return rails;
}

std::vector<PowerRail> power_supply_rails(const path& sysfs) {
    std::vector<PowerRail> rails;
    for (const auto& supply : sysfs_entries(sysfs / "class/power_supply")) {
        const auto status = sysfs_text(supply / "status").value_or("");
        if (status == "Charging" || status == "Full") continue;
        const auto name = supply.filename().string();
        const auto power = supply / "power_now";
        const auto voltage = supply / "voltage_now";
        const auto current = supply / "current_now";
        // Drivers differ in the sign of a discharge.
        if (sysfs_number(power)) {
            rails.push_back({name, power.string(), [power] {
                                 return units::watt_from_microwatt(std::abs(require_sysfs_number(power)));
                             }});
        } else if (sysfs_number(voltage) && sysfs_number(current)) {
            rails.push_back({name, voltage.string() + " x current_now", [voltage, current] {
                                 return units::volt_from_microvolt(require_sysfs_number(voltage)) *
                                        std::abs(
                                            units::ampere_from_microampere(require_sysfs_number(current)));
                             }});
        }
    }
    return rails;
}

}  // namespace flightwatt::compute
