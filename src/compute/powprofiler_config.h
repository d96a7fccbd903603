#pragma once

#include "base/error.h"

#include <filesystem>
#include <vector>

namespace flightwatt {

/// A layer 1 recording and the QoS that it was made with.
struct PowprofilerCombination {
    std::filesystem::path recording;
    std::vector<double> qos;
    Location where;
};

/// The [combinations] of a powprofiler configuration file.
struct PowprofilerConfig {
    double sampling_hz = 0.0;  ///< [settings] frequency, or powprofiler's 10 Hz
    std::vector<PowprofilerCombination> combinations;
};

/// Reads `file.csv=value,value` lines; the recordings stand beside the file. '#' begins a comment; the other
/// settings (h, directory) and name=FILE, the layer 2 that powprofiler would write, are passed over. Throws
/// InputError for a line that is none of these, a file without [combinations], or combinations with different
/// numbers of values.
PowprofilerConfig read_powprofiler_config(const std::filesystem::path& path);

}  // namespace flightwatt
