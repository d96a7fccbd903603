#pragma once

#include "flight/checks/power_record.h"

#include <string>
#include <vector>

namespace flightwatt::flight {

/// What the rules for samples of a power record found: faults exclude a flight from fits, warnings do not.
struct SampleFindings {
    std::vector<std::string> faults;
    std::vector<std::string> warnings;
};

/// Applies the table of rules in sample_rules.cpp. `resting`: the samples at rest with the motor off, in order.
SampleFindings apply_sample_rules(const PowerRecord& record, const std::vector<std::size_t>& resting);

}  // namespace flightwatt::flight
