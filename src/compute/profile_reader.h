#pragma once

#include "base/error.h"
#include "compute/compute_model.h"

#include <filesystem>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// Names for a profile without a header of names. At most one of the two lists is filled.
struct ProfileNaming {
    /// Of powprofiler's flags 200, 201, ..., or of the values of a .cfg.
    std::vector<std::string> parameters;
    /// Of the columns of a file without header; one is "power_w", "_" skips a column.
    std::vector<std::string> columns;
    Location where;  ///< of the names, for messages
};

/// Reads a profile in any of the formats:
///   - CSV of `flightwatt profile`: a header of the parameters, power_w and further columns, of which standard_error_w
///     and total_power_w (less power_w: the idle computer) are read; '#' begins a comment line
///   - powprofiler layer 2: a header of flags (powprofiler.h), names from `naming.parameters`
///   - a CSV without header (powprofiler's and gnuplot's), names from `naming.columns`
///   - powprofiler layer 1, the recording of one configuration: constant power, its mean
///   - powprofiler .cfg with [combinations]: each node is the mean of a layer 1 file
/// Throws InputError for another format, names that do not fit, and as make_power_profile.
PowerProfile read_power_profile(const std::filesystem::path& path, const ProfileNaming& naming = {});

}  // namespace flightwatt::compute
