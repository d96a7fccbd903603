#pragma once

#include "base/csv.h"
#include "base/error.h"
#include "compute/qos_range.h"

#include <cstddef>
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

/// A program of [components].
struct PowprofilerComponent {
    std::string name;
    std::string source;               ///< the program
    std::string arguments;            ///< " -f {qos_1} {qos_2}", a placeholder for each range
    std::vector<QosRange> ranges;     ///< qos_1, qos_2, ...
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

/// What the columns of a powprofiler CSV are. Its header is a row of integer flags, one or more (joined by
/// '+') a column: 0 nothing, 100 total power, 101 CPU, 102 GPU, 130..132 energy, 160..162 state of charge,
/// 200 + i the i-th QoS parameter. Only total power and parameters are read: the energy of a layer 2 made by
/// [combinations] is a raw sum of samples.
struct PowprofilerColumns {
    std::size_t power = 0;                ///< the column of flag 100
    std::vector<std::size_t> parameters;  ///< the columns of flags 200, 201, ...; empty in a layer 1
};

/// The columns of a table that was read without header; std::nullopt if its first row is no row of flags.
/// Throws InputError if the flags hold no total power, one flag twice, or parameters with a gap.
std::optional<PowprofilerColumns> powprofiler_columns(const CsvTable& table);

/// The total power [W] of a layer 1 that was read without header: one configuration over time, at equal steps.
/// Throws InputError for another header, no samples, or a cell that is no number.
std::vector<double> layer1_power_w(const CsvTable& table);

}  // namespace flightwatt::compute
