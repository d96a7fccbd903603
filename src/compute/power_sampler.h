#pragma once

#include "base/toml_reader.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::compute {

/// Power, with the sampler's time.
struct PowerReading {
    std::chrono::steady_clock::time_point time;
    double power_w = 0.0;
};

/// `automatic`: the first available sensor in this order.
enum class SamplerKind { automatic, ina3221, rapl, command, recorded };

/// "auto", "ina3221" and so on.
std::string_view to_string(SamplerKind kind);

/// A power meter of this computer.
struct PowerSampler {
    SamplerKind kind = SamplerKind::recorded;
    std::string source;  ///< "VDD_IN (/sys/...)"
    /// The current value of a sensor, or the lines that a program printed since the last call. Throws InputError for an
    /// invalid reading, NoResultError when the program has failed.
    std::function<std::vector<PowerReading>()> read;
    /// Readable (poll()) when a program has printed; -1 of a sensor, which is polled.
    std::function<int()> file = [] { return -1; };
};

/// [sampler] of a specification.
struct SamplerSettings {
    SamplerKind kind = SamplerKind::automatic;
    std::filesystem::path sysfs = "/sys";
    double interval_s = 0.1;
    bool interval_is_given = false;
    std::vector<std::string> rails;    ///< whose sum is the total; empty: chosen by name
    std::vector<std::string> command;  ///< a program that prints watts, a number a line
    std::filesystem::path folder;      ///< of recordings with relative paths
    std::string file;                  ///< recordings: a path with {component} and {PARAMETER}
    std::string idle_file;             ///< the recording of the idle computer
    Location where;
};

/// Reads [sampler] of a profile's specification; paths are relative to `folder`. Throws InputError.
SamplerSettings read_sampler_settings(const TomlTable& root, const std::filesystem::path& folder);

/// Opens a live sampler: by its kind, or the first available one. Throws NoResultError if there is no sensor, with the
/// searched paths.
PowerSampler open_sampler(const SamplerSettings& settings);

}  // namespace flightwatt::compute
