#pragma once

#include "base/error.h"

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// Power at a time, the sampler's own.
struct PowerReading {
    std::chrono::steady_clock::time_point time;
    double power_w = 0.0;
};

/// Something that tells the power of this computer.
struct PowerSampler {
    std::string kind;                ///< one of sampler_kinds
    std::string source;              ///< what it reads, for people: "VDD_IN (/sys/...)"
    std::vector<std::string> found;  ///< what probing found, a line a sensor
    /// The readings since the last call: of a sensor the one that it shows now, of a program those that it
    /// has printed meanwhile. Throws InputError for what is no reading, NoAnswerError if there is no more.
    std::function<std::vector<PowerReading>()> read;
    /// A file that poll() finds readable when readings come by themselves; -1: ask for them.
    std::function<int()> file = [] { return -1; };
};

/// How power is to be sampled.
struct SamplerSettings {
    std::string kind = "auto";
    std::filesystem::path sysfs = "/sys";
    double interval_s = 0.1;
    bool interval_is_given = false;
    std::vector<std::string> rails;    ///< those that add up to the total; empty: chosen by their names
    std::vector<std::string> command;  ///< of kind "command": a program that prints watts, a number a line
    std::filesystem::path folder;      ///< that recordings and their idle one are relative to
    std::string file;                  ///< of kind "recorded": with {component} and {parameter}s in it
    std::string idle_file;             ///< the recording of the idle computer
    Location where;
};

/// "auto" and what it may stand for, in the order in which it tries, and those that are only taken by name.
inline const std::vector<std::string> sampler_kinds{"auto",         "ina3221-iio", "ina3221-hwmon", "rapl",
                                                    "power_supply", "command",     "recorded"};

/// Opens a live sampler: by name, or the first that probing finds. A sysfs root that holds a folder sys/ (a
/// recorded tree) is entered there. Throws NoAnswerError if there is none, saying where it was looked for.
PowerSampler open_sampler(const SamplerSettings& settings);

}  // namespace flightwatt::compute
