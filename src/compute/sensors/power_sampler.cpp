#include "compute/sensors/power_sampler.h"

#include "compute/sensors/command_sampler.h"
#include "compute/sensors/energy_counters.h"
#include "compute/sensors/power_rail.h"
#include "compute/sensors/sensor_rails.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

using Clock = std::chrono::steady_clock;

struct Sensor {
    std::string kind;
    std::vector<PowerRail> rails;         ///< either
    std::vector<EnergyCounter> counters;  ///< or

    std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const auto& rail : rails) all.push_back(rail.name);
        for (const auto& counter : counters) all.push_back(counter.name);
        return all;
    }
};

std::vector<Sensor> probe(const std::filesystem::path& sysfs) {
    return {{"ina3221-iio", iio_rails(sysfs), {}},
            {"ina3221-hwmon", hwmon_rails(sysfs), {}},
            {"rapl", {}, energy_counters(sysfs)},
            {"power_supply", power_supply_rails(sysfs), {}}};
}

/// The middle of the time that the reading took.
template <typename Read>
PowerReading stamped(const Read& read) {
    const auto before = Clock::now();
    const double power_w = read();
    return {before + (Clock::now() - before) / 2, power_w};
}

PowerSampler sampler_of_rails(const Sensor& sensor, const std::vector<std::string>& wanted) {
    std::vector<PowerRail> chosen;
    std::vector<std::string> sources;
    for (const auto index : rails_of_total(sensor.names(), wanted)) {
        chosen.push_back(sensor.rails[index]);
        sources.push_back(fmt::format("{} ({})", chosen.back().name, chosen.back().source));
    }
    PowerSampler sampler;
    sampler.kind = sensor.kind;
    sampler.source = fmt::format("{}", fmt::join(sources, " + "));
    sampler.read = [chosen] {
        return std::vector<PowerReading>{stamped([&] {
            double power_w = 0.0;
            for (const auto& rail : chosen) power_w += rail.read();
            return power_w;
        })};
    };
    return sampler;
}

PowerSampler sampler_of(const Sensor& sensor, const std::vector<std::string>& wanted) {
    return sensor.counters.empty() ? sampler_of_rails(sensor, wanted)
                                   : sampler_of_counters(sensor.counters, wanted);
}

std::vector<std::string> lines_of(const std::vector<Sensor>& sensors) {
    std::vector<std::string> lines;
    for (const auto& sensor : sensors) {
        if (sensor.names().empty()) continue;
        lines.push_back(fmt::format("{}: {}", sensor.kind, fmt::join(sensor.names(), ", ")));
    }
    return lines;
}

/// "ina3221" stands for either way to it.
bool is_asked_for(const std::string& kind, const Sensor& sensor) {
    return kind == "auto" || kind == sensor.kind || (kind == "ina3221" && sensor.kind.starts_with("ina3221"));
}

}  // namespace

PowerSampler open_sampler(const SamplerSettings& settings) {
    if (settings.kind == "command") return open_command_sampler(settings);
    std::error_code none;
    const auto inner = settings.sysfs / "sys";
    const auto sysfs = std::filesystem::is_directory(inner, none) ? inner : settings.sysfs;
    const auto sensors = probe(sysfs);
    for (const auto& sensor : sensors) {
        if (!is_asked_for(settings.kind, sensor) || sensor.names().empty()) continue;
        auto sampler = sampler_of(sensor, settings.rails);
        sampler.found = lines_of(sensors);
        return sampler;
    }
    throw NoAnswerError(fmt::format(
        "there is no {} below {} that can be read; looked for INA3221 (bus/i2c/drivers/ina3221*, bus/iio, "
        "class/hwmon), RAPL (class/powercap, often for root alone) and class/power_supply; a [sampler] of "
        "kind "
        "\"command\" reads any other meter",
        settings.kind == "auto" ? "power sensor" : "sensor of kind " + settings.kind, sysfs.string()));
}

}  // namespace flightwatt::compute
