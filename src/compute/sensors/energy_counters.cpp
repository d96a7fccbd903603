#include "compute/sensors/energy_counters.h"

#include "base/units.h"
#include "compute/sensors/power_rails.h"

#include <algorithm>
#include <iterator>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

using Clock = std::chrono::steady_clock;

/// The counters as they were at the last call.
struct CounterState {
    std::vector<EnergyCounter> counters;
    std::vector<double> energy_uj;
    Clock::time_point time;
};

std::vector<PowerReading> read_counters(CounterState& state) {
    std::vector<double> now_uj;
    const auto time = Clock::now();
    for (const auto& counter : state.counters) now_uj.push_back(require_sysfs_number(counter.file));
    std::vector<PowerReading> readings;
    const double time_s = std::chrono::duration<double>(time - state.time).count();
    if (!state.energy_uj.empty() && time_s > 0.0) {
        PowerReading reading{time, 0.0};
        for (std::size_t i = 0; i < now_uj.size(); ++i) {
            reading.power_w +=
                power_of_counter_w(state.energy_uj[i], now_uj[i], state.counters[i].range_uj, time_s);
        }
        readings.push_back(reading);
    }
    state.energy_uj = std::move(now_uj);
    state.time = time;
    return readings;
}

std::vector<EnergyCounter> counters_of_total(const std::vector<EnergyCounter>& counters,
                                             const std::vector<std::string>& wanted) {
    std::vector<EnergyCounter> chosen;
    if (wanted.empty()) {
        std::ranges::copy_if(counters, std::back_inserter(chosen), &EnergyCounter::is_package);
        return chosen.empty() ? std::vector{counters.front()} : chosen;
    }
    std::vector<std::string> names;
    for (const auto& counter : counters) names.push_back(counter.name);
    for (const auto index : rails_of_total(names, wanted)) chosen.push_back(counters[index]);
    return chosen;
}

}  // namespace

double power_of_counter_w(double last_uj, double now_uj, double range_uj, double time_s) {
    const double energy_uj = now_uj - last_uj + (now_uj < last_uj ? range_uj : 0.0);
    return units::joule_from_microjoule(energy_uj) / time_s;
}

std::vector<EnergyCounter> energy_counters(const std::filesystem::path& sysfs) {
    std::vector<EnergyCounter> counters;
    // Not intel-rapl-mmio:0, which counts the package once more.
    for (const auto& zone : sysfs_entries(sysfs / "class/powercap", "intel-rapl:")) {
        const auto file = zone / "energy_uj";
        const auto range_uj = sysfs_number(zone / "max_energy_range_uj");
        if (!sysfs_number(file) || !range_uj) continue;
        const auto folder = zone.filename().string();
        const auto name = sysfs_text(zone / "name").value_or(folder);
        counters.push_back({name, file, *range_uj, name.starts_with("package")});
    }
    return counters;
}

PowerSampler sampler_of_counters(const std::vector<EnergyCounter>& counters,
                                 const std::vector<std::string>& wanted) {
    auto state = std::make_shared<CounterState>();
    state->counters = counters_of_total(counters, wanted);
    std::vector<std::string> sources;
    for (const auto& counter : state->counters) {
        sources.push_back(fmt::format("{} ({})", counter.name, counter.file.string()));
    }
    PowerSampler sampler;
    sampler.kind = SamplerKind::rapl;
    sampler.source = fmt::format("{}", fmt::join(sources, " + "));
    sampler.read = [state] { return read_counters(*state); };
    return sampler;
}

}  // namespace flightwatt::compute
