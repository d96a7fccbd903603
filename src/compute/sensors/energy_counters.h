#pragma once

#include "compute/sensors/power_sampler.h"

#include <filesystem>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// A counter of the energy that a part of the processor has used.
struct EnergyCounter {
    std::string name;            ///< "package-0"
    std::filesystem::path file;  ///< energy_uj
    double range_uj = 0.0;       ///< where it begins at 0 again
    bool is_package = false;     ///< a whole processor, whose parts have counters of their own
};

/// The counters that can be read below class/powercap (Intel and AMD RAPL through the kernel's powercap
/// driver): intel-rapl:0 and below.
std::vector<EnergyCounter> energy_counters(const std::filesystem::path& sysfs);

/// A sampler of mean power between calls: the first call gives no reading. Takes the counters named, or all
/// packages: core and uncore are parts of these, and psys contains them.
PowerSampler sampler_of_counters(const std::vector<EnergyCounter>& counters,
                                 const std::vector<std::string>& wanted);

/// Two readings of a counter apart as power [W]: energy since the last, over time. `range_uj` is where the
/// counter begins at 0 again.
double power_of_counter_w(double last_uj, double now_uj, double range_uj, double time_s);

}  // namespace flightwatt::compute
