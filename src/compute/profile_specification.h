#pragma once

#include "base/error.h"
#include "compute/power_sampler.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// One point of a component's ranges, with the commands to run there.
struct ProfiledConfiguration {
    std::vector<double> qos;                         ///< one value a parameter
    std::vector<std::vector<std::string>> commands;  ///< run at the same time; no shell
    std::filesystem::path recording;                 ///< of power, instead of running
};

/// Duration of a run.
struct ProfileTiming {
    std::optional<double> duration_s;  ///< after the warm-up; none: until the commands end by themselves
    double warm_up_s = 0.0;            ///< the samples of this time are discarded
    double timeout_s = 600.0;          ///< of commands without duration_s
};

/// A component, or several that run at the same time.
struct ProfiledComponent {
    std::string name;
    std::vector<std::string> parameters;
    std::vector<ProfiledConfiguration> configurations;
    ProfileTiming timing;
};

/// Components to profile, and how.
struct ProfileSpecification {
    std::string file;
    std::vector<ProfiledComponent> components;
    std::size_t repeats = 1;
    std::uint64_t seed = 1;   ///< of the order of the runs
    double idle_s = 10.0;     ///< of the idle computer; 0: not measured
    bool above_idle = false;  ///< profiles contain power above idle
    SamplerSettings sampler;
};

/// Reads a specification (docs/formats.md), in TOML. Paths are relative to the file. Throws InputError with file, line
/// and column.
ProfileSpecification read_profile_specification(const std::filesystem::path& path);

/// The same from TOML text of the file `path`.
ProfileSpecification parse_profile_specification(std::string_view text, const std::filesystem::path& path);

}  // namespace flightwatt::compute
