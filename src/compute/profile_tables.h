#pragma once

#include "compute/profile_outcome.h"
#include "compute/profile_specification.h"

#include <string>

/// Files of layer 2.
namespace flightwatt::compute {

/// power_w of a node: its total, or the excess over `idle`, whose standard error is then included.
struct ReportedPower {
    double power_w = 0.0;
    double standard_error_w = 0.0;
};

ReportedPower reported_power(const PowerEstimate& total, const std::optional<PowerEstimate>& idle, bool above_idle);

/// A number with `decimals` decimals, or `unknown` for one that is not finite.
std::string number_or(double value, int decimals, const std::string& unknown);

/// A component's profile, as read_power_profile reads it: parameters, power_w and its evidence, with comment lines on
/// the sampler and on idle power. energy_j is power_w times duration_s.
std::string layer2_csv(const ComponentEstimate& component, const ProfileOutcome& outcome,
                       const ProfileSpecification& specification);

/// Writes NAME.csv of each component and idle.csv into the folder; a component without measured nodes has no file.
void write_profiles(const ProfileOutcome& outcome, const ProfileSpecification& specification,
                    const std::filesystem::path& folder);

}  // namespace flightwatt::compute
