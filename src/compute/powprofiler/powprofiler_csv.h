#pragma once

#include "base/csv.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace flightwatt::compute {

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

}  // namespace flightwatt::compute
