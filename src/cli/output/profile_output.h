#pragma once

#include "cli/screen_table.h"
#include "cli/stage.h"
#include "compute/compute_model.h"
#include "compute/profile_outcome.h"
#include "compute/profile_tables.h"

#include <string>

namespace flightwatt::compute {
Fields<LeaveOneOutErrors> record_fields(const LeaveOneOutErrors*);
}

/// Output of profile.
namespace flightwatt::cli {

/// JSON of a measured profile.
struct ProfileOutput {
    const compute::ProfileOutcome* outcome = nullptr;
    bool above_idle = false;  ///< power over the idle power instead of total power
};
Fields<ProfileOutput> record_fields(const ProfileOutput*);

/// The measured powers as tables.
std::string profile_text(const ProfileOutput& profile, const Screen& screen = {});

}  // namespace flightwatt::cli
