#include "compute/sensors/open_sampler.h"

#include "compute/sensors/energy_counters.h"
#include "compute/sensors/power_rails.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

struct Sensor {
    SamplerKind kind;
    std::vector<PowerRail> rails;         ///< either
    std::vector<EnergyCounter> counters;  ///< or

    std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const auto& rail : rails) all.push_back(rail.name);
        for (const auto& counter : counters) all.push_back(counter.name);
        return all;
    }

    bool is_asked_for(SamplerKind asked) const {
        const bool is_ina3221 = kind == SamplerKind::ina3221_iio || kind == SamplerKind::ina3221_hwmon;
        return asked == SamplerKind::automatic || asked == kind ||
               (asked == SamplerKind::ina3221 && is_ina3221);
    }
};

std::vector<Sensor> probe(const std::filesystem::path& sysfs) {
    return {{SamplerKind::ina3221_iio, iio_rails(sysfs), {}},
            {SamplerKind::ina3221_hwmon, hwmon_rails(sysfs), {}},
            {SamplerKind::rapl, {}, energy_counters(sysfs)},
            {SamplerKind::power_supply, power_supply_rails(sysfs), {}}};
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
        const auto before = std::chrono::steady_clock::now();
        double power_w = 0.0;
        for (const auto& rail : chosen) power_w += rail.read();
        // Stamped with the middle of the time that the reading took.
        return std::vector<PowerReading>{{before + (std::chrono::steady_clock::now() - before) / 2, power_w}};
    };
    return sampler;
}

std::vector<std::string> lines_of(const std::vector<Sensor>& sensors) {
    std::vector<std::string> lines;
    for (const auto& sensor : sensors) {
        if (sensor.names().empty()) continue;
        lines.push_back(fmt::format("{}: {}", to_string(sensor.kind), fmt::join(sensor.names(), ", ")));
    }
    return lines;
}

}  // namespace

PowerSampler open_sampler(const SamplerSettings& settings) {
    if (settings.kind == SamplerKind::command) return open_command_sampler(settings);
    std::error_code none;
    const auto inner = settings.sysfs / "sys";
    const auto sysfs = std::filesystem::is_directory(inner, none) ? inner : settings.sysfs;
    const auto sensors = probe(sysfs);
    for (const auto& sensor : sensors) {
        if (!sensor.is_asked_for(settings.kind) || sensor.names().empty()) continue;
        auto sampler = sensor.counters.empty() ? sampler_of_rails(sensor, settings.rails)
                                               : sampler_of_counters(sensor.counters, settings.rails);
        sampler.found = lines_of(sensors);
        return sampler;
    }
    throw NoAnswerError(fmt::format(
        "there is no {} below {} that can be read; looked for INA3221 (bus/i2c/drivers/ina3221*, bus/iio, "
        "class/hwmon), RAPL (class/powercap, often for root alone) and class/power_supply; a [sampler] of "
        "kind \"command\" reads any other meter",
        settings.kind == SamplerKind::automatic ? "power sensor"
                                                : fmt::format("sensor of kind {}", to_string(settings.kind)),
        sysfs.string()));
}

}  // namespace flightwatt::compute
