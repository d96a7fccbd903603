#pragma once

#include "cli/output/json_document.h"
#include "cli/screen_table.h"
#include "compute/compute_model.h"
#include "compute/profile_outcome.h"
#include "compute/profile_tables.h"

#include <cstddef>
#include <string>
#include <vector>

namespace flightwatt::compute {
Fields<LeaveOneOutErrors> record_fields(const LeaveOneOutErrors*);
}

/// Output of profile.
namespace flightwatt::cli {

/// The measured powers as tables. `above_idle`: power over the idle power instead of total
/// power.
std::string profile_text(const compute::ProfileOutcome& outcome, bool above_idle, const Screen& screen = {});

/// JSON of a measured profile.
struct ProfileOutput {
    const compute::ProfileOutcome& outcome;
    bool above_idle = false;
};
Fields<ProfileOutput> record_fields(const ProfileOutput*);

/// The errors of interpolating a profile as a table under its name.
std::string interpolation_text(const std::string& file, std::size_t nodes, const compute::LeaveOneOutErrors& error,
                               const Screen& screen = {});

}  // namespace flightwatt::cli
