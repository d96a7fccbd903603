#pragma once

#include "base/csv.h"
#include "base/error.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace flightwatt::compute {

/// A layer 1 recording and the QoS that it was made with.
struct PowprofilerCombination {
    std::filesystem::path recording;
    std::vector<double> qos;
    Location where;
};

/// Reads [combinations] of a powprofiler configuration file: lines of `file.csv=value,value` whose recordings are in the
/// file's folder. '#' begins a comment; [settings] and the sections of components are ignored. Throws InputError for
/// another line, no combinations, different numbers of values, and a recording that cannot be read.
std::vector<PowprofilerCombination> read_powprofiler_config(const std::filesystem::path& path);

/// Columns of a powprofiler CSV by its header, a row of integer flags, one or more (joined by '+') a column: 0 nothing,
/// 100 total power, 101 CPU, 102 GPU, 130..132 energy, 160..162 state of charge, 200 + i the i-th QoS parameter. Only
/// total power and parameters are read: the energy of a layer 2 made by [combinations] is a raw sum of samples.
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
