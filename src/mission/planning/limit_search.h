#pragma once

#include "base/error.h"
#include "mission/mission.h"
#include "mission/mission_summary.h"

#include <functional>
#include <map>
#include <optional>
#include <string>

namespace flightwatt::mission {

/// State of charge at the end less the reserve [points]: an integral where the source is constant, else simulated.
/// Negative if the reserve is not kept, and the more so the earlier the battery ends.
double surplus_percent(const Mission& mission);

/// What is left of a mission above its reserve, as one of its numbers changes; and where nothing is any more.
class LimitSearch {
  public:
    LimitSearch(MissionVariation variation, const std::optional<double>& probability)
        : variation_(std::move(variation)), probability_(probability) {}

    /// Throws InputError where the schedule does not fit.
    Mission mission(double value) const;

    std::optional<Mission> mission_if_it_fits(double value);

    /// Why the last that did not fit the schedule does not.
    const std::optional<InputError>& misfit() const { return misfit_; }

    /// What the flight as stated has left above the reserve, or that part of the flights which the probability asks
    /// for.
    double surplus(double value) const;
    double surplus(const Mission& mission) const;
    std::optional<double> surplus_if_it_fits(double value);

    /// To so many bits limits can be known: flights that are drawn show less.
    int accurate_bits() const { return probability_ ? 14 : 48; }

    /// " in 95 % of its flights", or nothing.
    std::string share_text() const;

    /// The value as a limit, of which `beyond` is a little more.
    FeasibilityLimit limit(double value, double beyond) const;

  private:
    MissionVariation variation_;
    std::optional<double> probability_;
    std::optional<InputError> misfit_;
    mutable std::map<double, double> known_;  ///< surplus by value: drawn flights take long
};

}  // namespace flightwatt::mission
