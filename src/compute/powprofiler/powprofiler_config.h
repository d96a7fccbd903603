#pragma once

#include "base/error.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// A layer 1 recording and the QoS that it was made with.
struct PowprofilerCombination {
    std::filesystem::path recording;
    std::vector<double> qos;
    Location where;
};

/// A program of [components]: its arguments are fixed texts and ranges, in order.
struct PowprofilerComponent {
    struct Argument {
        std::string fixed;           ///< empty: a range
        std::vector<double> values;  ///< of the range
    };
    std::string name;
    std::string source;  ///< the program
    std::vector<Argument> arguments;
    std::optional<double> runtime_s;  ///< none: until it ends
    Location where;
};

/// A powprofiler configuration file: what to run, or what was recorded.
struct PowprofilerConfig {
    double sampling_hz = 10.0;  ///< [settings] frequency, or what powprofiler samples at unless told
    std::vector<PowprofilerCombination> combinations;
    std::string combinations_name;  ///< the layer 2 that name= asks for, "m2l.csv"
    std::vector<PowprofilerComponent> components;
};

/// Reads [settings], [components] with a [component.NAME] each (src, range = min, max, step or min, max,
/// pow(n), fixed, runtime in ms) and [combinations], lines of `file.csv=value,value` whose recordings stand
/// beside the file. '#' begins a comment; the settings h and directory are passed over. Throws InputError for
/// a line that is none of these, and for combinations with different numbers of values.
PowprofilerConfig read_powprofiler_config(const std::filesystem::path& path);

/// Throws InputError if the file has no [combinations], or one of their recordings does not exist.
void require_recordings(const PowprofilerConfig& config, const std::filesystem::path& path);

}  // namespace flightwatt::compute
