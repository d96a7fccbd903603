#pragma once

#include "base/error.h"
#include "compute/compute_model.h"

#include <filesystem>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// The names that a user gives to a profile that has none of its own. At most one of the two lists is filled.
struct ProfileNaming {
    /// Of powprofiler's flags 200, 201, ..., or of the values of a .cfg, in order.
    std::vector<std::string> parameters;
    /// Of the columns of a file without header; one is "power_w", and "_" passes a column over.
    std::vector<std::string> columns;
    Location where;  ///< of the names, for messages
};

/// Reads a profile in any of the formats:
///   - our own CSV: a header of the parameters' names and then power_w, '#' begins a comment line; on what it
///     rests may follow, as `flightwatt profile` writes it: standard_error_w is kept
///   - powprofiler layer 2: a header of flags (powprofiler.h), names from `naming.parameters`
///   - a CSV without header (powprofiler's and gnuplot's), names from `naming.columns`
///   - powprofiler layer 1, the recording of one configuration: constant power, its mean
///   - powprofiler .cfg with [combinations]: each node is the mean of a layer 1 file
/// Throws InputError for a file that is none of these, names that do not fit, and what make_power_profile refuses.
PowerProfile read_power_profile(const std::filesystem::path& path, const ProfileNaming& naming = {});

}  // namespace flightwatt::compute
