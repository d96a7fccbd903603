#pragma once

#include "base/error.h"
#include "compute/power_sampler.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// One point of a component's ranges, and what is to be run there.
struct ProfiledConfiguration {
    std::vector<double> qos;                         ///< one value a parameter
    std::vector<std::vector<std::string>> commands;  ///< run at the same time; no shell
    std::filesystem::path recording;                 ///< of power, instead of running
};

/// How long a configuration is watched.
struct ProfileTiming {
    std::optional<double> duration_s;  ///< after the warm-up; none: until the commands end by themselves
    double warm_up_s = 0.0;            ///< the samples of this time are discarded
    double timeout_s = 600.0;          ///< of commands that should end by themselves
};

/// A component, or several that run at the same time.
struct ProfiledComponent {
    std::string name;
    std::vector<std::string> parameters;
    std::vector<ProfiledConfiguration> configurations;
    ProfileTiming timing;
};

/// What is to be profiled, and how.
struct ProfileSpecification {
    std::string file;
    std::vector<ProfiledComponent> components;
    std::size_t repeats = 1;
    std::uint64_t seed = 1;   ///< of the order of the runs
    double idle_s = 10.0;     ///< how long the idle computer is watched; 0: not at all
    bool above_idle = false;  ///< whether profiles hold what comes on top of idle
    SamplerSettings sampler;
};

/// Reads a specification (docs/formats.md); paths in it are relative to it. A .cfg is powprofiler's, either of its
/// kinds ([components] to run, [combinations] of recordings). Anything else is TOML. Throws InputError with file,
/// line and column.
ProfileSpecification read_profile_specification(const std::filesystem::path& path);

/// The same from TOML text; `path` for messages and what is relative to it.
ProfileSpecification parse_profile_specification(std::string_view text, const std::filesystem::path& path);

/// The same from powprofiler's .cfg. Parameters have no names there: they are called qos_1, qos_2, ...;
/// `directory` and h are passed over, frequency is the sampling's.
ProfileSpecification read_powprofiler_specification(const std::filesystem::path& path);

}  // namespace flightwatt::compute
