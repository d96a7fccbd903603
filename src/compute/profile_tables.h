#pragma once

#include "compute/profile_outcome.h"
#include "compute/profile_specification.h"

#include <string>

/// Layer 2 as files.
namespace flightwatt::compute {

/// Power that stands in power_w of a node: its total, or what is above `idle`; the standard error then holds
/// that of idle too.
struct ReportedPower {
    double power_w = 0.0;
    double standard_error_w = 0.0;
};

ReportedPower reported_power(const PowerEstimate& total, const std::optional<PowerEstimate>& idle, bool above_idle);

/// A number with so many decimals, or `unknown` for one that is not finite.
std::string number_or(double value, int decimals, const std::string& unknown);

/// A component's profile, as missions and read_power_profile take it: its parameters, power_w, and on what
/// that rests. Comment lines say how it was made, and of what power_w consists. energy_j is power_w times
/// duration_s; interpolated nodes have neither.
std::string layer2_csv(const ComponentEstimate& component, const ProfileOutcome& outcome,
                       const ProfileSpecification& specification);

/// Writes NAME.csv of each component and idle.csv into the folder. A component of which nothing could be measured leaves
/// no file.
void write_profiles(const ProfileOutcome& outcome, const ProfileSpecification& specification,
                    const std::filesystem::path& folder);

}  // namespace flightwatt::compute
