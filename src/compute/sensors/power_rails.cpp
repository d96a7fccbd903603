#include "compute/sensors/power_rails.h"

#include "base/error.h"
#include "base/number.h"
#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

/// The input of the whole module: TX2, Xavier NX, Orin NX and Nano; Nano; Nano under newer kernels.
constexpr std::string_view total_rails[] = {"VDD_IN", "POM_5V_IN", "5V_IN"};
/// Behind another rail that is measured too: AGX Orin's is made from VIN_SYS_5V0; NC is not connected.
constexpr std::string_view derived_rails[] = {"VDDQ_VDD2_1V8AO", "NC"};

using std::filesystem::path;

constexpr int channels = 3;  // of an INA3221

/// The first line without its end; std::nullopt if it cannot be read.
std::optional<std::string> sysfs_text(const path& file) {
    constexpr std::size_t max_line = 256;
    std::ifstream stream(file);
    std::array<char, max_line> text{};
    if (!stream.getline(text.data(), text.size())) return std::nullopt;
    std::string line(text.data());
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    return line;
}

std::optional<double> sysfs_number(const path& file) {
    const auto text = sysfs_text(file);
    return text ? parse_number(*text) : std::nullopt;
}

double require_sysfs_number(const path& file) {
    const auto text = sysfs_text(file);
    if (!text) throw InputError({file.string()}, "the sensor cannot be read");
    if (const auto value = parse_number(*text)) return *value;
    throw InputError({file.string(), 1}, fmt::format("the sensor says '{}', expected a number", *text));
}

/// The entries whose names begin with `prefix`, sorted; none if there is no such folder.
std::vector<path> sysfs_entries(const path& folder, std::string_view prefix = "") {
    std::vector<path> found;
    std::error_code none;
    for (std::filesystem::directory_iterator it(folder, none), end; it != end; it.increment(none)) {
        if (it->path().filename().string().starts_with(prefix)) found.push_back(it->path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

/// Takes a folder that exists, once: sysfs shows the same device at several places.
void add_device(std::vector<path>& devices, const path& folder) {
    std::error_code none;
    const auto is_same = [&](const path& device) { return std::filesystem::equivalent(device, folder, none); };
    if (!std::filesystem::exists(folder, none) || std::ranges::any_of(devices, is_same)) return;
    devices.push_back(folder);
}

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
            rails.push_back(
                {name, power.string(), [power] { return units::watt_from_milliwatt(require_sysfs_number(power)); }});
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

/// The folders of a chip's hwmon driver.
std::vector<path> hwmon_devices(const path& sysfs, std::string_view chip_name) {
    std::vector<path> devices;
    for (const auto& driver : sysfs_entries(sysfs / "bus/i2c/drivers", chip_name)) {
        for (const auto& chip : sysfs_entries(driver)) {
            for (const auto& device : sysfs_entries(chip / "hwmon", "hwmon")) add_device(devices, device);
        }
    }
    for (const auto& device : sysfs_entries(sysfs / "class/hwmon", "hwmon")) {
        if (sysfs_text(device / "name").value_or("").starts_with(chip_name)) add_device(devices, device);
    }
    return devices;
}

}  // namespace

std::vector<std::size_t> rails_of_total(const std::vector<std::string>& names, const std::vector<std::string>& wanted) {
    std::vector<std::size_t> chosen;
    for (const auto& name : wanted) {
        const auto found = std::ranges::find(names, name);
        if (found == names.end()) {
            throw NoResultError(fmt::format("there is no rail '{}'; there are {}", name, fmt::join(names, ", ")));
        }
        chosen.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    if (!chosen.empty()) return chosen;
    for (const auto total : total_rails) {
        const auto found = std::ranges::find(names, total);
        if (found != names.end()) return {static_cast<std::size_t>(found - names.begin())};
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (std::ranges::find(derived_rails, names[i]) == std::end(derived_rails)) chosen.push_back(i);
    }
    return chosen;
}

std::vector<PowerRail> iio_rails(const path& sysfs) {
    std::vector<path> devices;
    for (const auto& driver : sysfs_entries(sysfs / "bus/i2c/drivers", "ina3221")) {
        for (const auto& chip : sysfs_entries(driver)) {
            for (const auto& device : sysfs_entries(chip, "iio")) add_device(devices, device);
        }
    }
    for (const auto& device : sysfs_entries(sysfs / "bus/iio/devices", "iio:device")) {
        const auto name = sysfs_text(device / "name").value_or("");
        if (name.starts_with("ina3221") || sysfs_text(device / "rail_name_0")) add_device(devices, device);
    }
    std::vector<PowerRail> rails;
    for (const auto& folder : devices) add_iio_channels(folder, rails);
    return rails;
}

std::vector<PowerRail> hwmon_rails(const path& sysfs) {
    std::vector<PowerRail> rails;
    for (const auto& folder : hwmon_devices(sysfs, "ina3221")) add_hwmon_channels(folder, rails);
    return rails;
}

std::vector<PowerRail> ina238_rails(const path& sysfs) {
    std::vector<PowerRail> rails;
    for (const auto& folder : hwmon_devices(sysfs, "ina238")) {
        const auto name = sysfs_text(folder / "in1_label").value_or("VIN " + folder.filename().string());
        const auto power = folder / "power1_input";
        const auto voltage = folder / "in1_input";
        const auto current = folder / "curr1_input";
        if (sysfs_number(power)) {
            rails.push_back(
                {name, power.string(), [power] { return units::watt_from_microwatt(require_sysfs_number(power)); }});
        } else if (sysfs_number(voltage) && sysfs_number(current)) {
            rails.push_back(product_rail(name, voltage, current));
        }
    }
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
            rails.push_back({name, power.string(),
                             [power] { return units::watt_from_microwatt(std::abs(require_sysfs_number(power))); }});
        } else if (sysfs_number(voltage) && sysfs_number(current)) {
            rails.push_back({name, voltage.string() + " x current_now", [voltage, current] {
                                 return units::volt_from_microvolt(require_sysfs_number(voltage)) *
                                        std::abs(units::ampere_from_microampere(require_sysfs_number(current)));
                             }});
        }
    }
    return rails;
}

std::vector<EnergyCounter> energy_counters(const path& sysfs) {
    std::vector<EnergyCounter> counters;
    // Not intel-rapl-mmio:0, which counts the package once more.
    for (const auto& zone : sysfs_entries(sysfs / "class/powercap", "intel-rapl:")) {
        const auto file = zone / "energy_uj";
        const auto range_uj = sysfs_number(zone / "max_energy_range_uj");
        if (!sysfs_number(file) || !range_uj) continue;
        const auto name = sysfs_text(zone / "name").value_or(zone.filename().string());
        counters.push_back({name, file.string(), [file] { return require_sysfs_number(file); }, *range_uj,
                            name.starts_with("package")});
    }
    return counters;
}

double power_of_counter_w(double last_uj, double now_uj, double range_uj, double time_s) {
    const double energy_uj = now_uj - last_uj + (now_uj < last_uj ? range_uj : 0.0);
    return units::joule_from_microjoule(energy_uj) / time_s;
}

}  // namespace flightwatt::compute
