#pragma once

#include "base/error.h"
#include "mission/mission.h"
#include "mission/mission_summary.h"

#include <functional>
#include <map>
#include <optional>
#include <string>

namespace flightwatt::mission {

/// Final state of charge minus the reserve [points], by integration for a constant source, else simulated. Negative if
/// the reserve is not kept, the more so the earlier the battery ends.
double surplus_percent(const Mission& mission);

/// Surplus over the reserve as a function of one of the mission's numbers.
class LimitSearch {
  public:
    LimitSearch(MissionVariation variation, const std::optional<double>& probability)
        : variation_(std::move(variation)), probability_(probability) {}

    /// The mission at a value, with the schedule of least energy demand. Throws InputError where the schedule does not
    /// fit.
    Mission mission(double value) const;

    bool fits(double value);

    /// The error of the last value that did not fit the schedule.
    const std::optional<InputError>& misfit() const { return misfit_; }

    /// Surplus [points] of the flight as stated, or with the search's probability; none where the schedule does not
    /// fit.
    std::optional<double> surplus(double value);

    /// To which limits can be known: drawn flights show less.
    double relative_accuracy() const { return probability_ ? 0x1p-14 : 0x1p-48; }

    /// " in 95 % of its flights", or nothing.
    std::string share_text() const;

    /// The value as a limit; `beyond` is slightly more.
    FeasibilityLimit limit(double value, double beyond) const;

  private:
    MissionVariation variation_;
    std::optional<double> probability_;
    std::optional<InputError> misfit_;
    std::map<double, std::optional<double>> known_;  ///< surplus by value: drawn flights take long
};

}  // namespace flightwatt::mission
