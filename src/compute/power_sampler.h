#pragma once

#include "base/toml_reader.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::compute {

/// Power at a time, the sampler's own.
struct PowerReading {
    std::chrono::steady_clock::time_point time;
    double power_w = 0.0;
};

/// `automatic` stands for the first sensor that is there, in this order; `ina3221` for either way to it.
enum class SamplerKind {
    automatic,
    ina238,
    ina3221_iio,
    ina3221_hwmon,
    rapl,
    power_supply,
    command,
    recorded,
    ina3221
};

/// "auto", "ina3221-iio" and so on.
std::string_view to_string(SamplerKind kind);
std::optional<SamplerKind> sampler_kind_from(std::string_view name);

/// Something that tells the power of this computer.
struct PowerSampler {
    SamplerKind kind = SamplerKind::recorded;
    std::string source;              ///< what it reads, for people: "VDD_IN (/sys/...)"
    std::vector<std::string> found;  ///< what probing found, a line a sensor
    /// The readings since the last call: of a sensor the one that it shows now, of a program those that it
    /// has printed meanwhile. Throws InputError for what is no reading, NoResultError if there is no more.
    std::function<std::vector<PowerReading>()> read;
    /// A file that poll() finds readable when readings come by themselves; -1: ask for them.
    std::function<int()> file = [] { return -1; };
};

/// How power is to be sampled.
struct SamplerSettings {
    SamplerKind kind = SamplerKind::automatic;
    std::filesystem::path sysfs = "/sys";
    double interval_s = 0.1;
    bool interval_is_given = false;
    std::vector<std::string> rails;    ///< those that add up to the total; empty: chosen by their names
    std::vector<std::string> command;  ///< a program that prints watts, a number a line
    std::filesystem::path folder;      ///< that recordings and their idle one are relative to
    std::string file;                  ///< recordings: with {component} and {parameter}s in it
    std::string idle_file;             ///< the recording of the idle computer
    Location where;
};

/// The [sampler] of a profile's specification, or what it is by default; `folder` is what its paths are relative
/// to. Throws InputError.
SamplerSettings read_sampler_settings(const TomlTable& root, const std::filesystem::path& folder);

/// Opens a live sampler: by its kind, or the first that probing finds. A sysfs root that holds a folder sys/ (a
/// recorded tree) is entered there. Throws NoResultError if there is none, saying where it was looked for.
PowerSampler open_sampler(const SamplerSettings& settings);

/// A sampler of a program that prints watts, a number a line: one that goes on printing, each line stamped
/// when it arrives; or one that prints and exits with 0, which is started anew for every reading. It ends
/// with the sampler, its children too. Reading throws InputError for a line that is no number and
/// NoResultError when the program fails or ends without a line.
PowerSampler open_command_sampler(const SamplerSettings& settings);

}  // namespace flightwatt::compute
