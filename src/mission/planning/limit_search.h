#pragma once

#include "base/error.h"
#include "mission/mission.h"
#include "mission/mission_summary.h"

#include <functional>
#include <map>
#include <numeric>
#include <optional>

namespace flightwatt::mission {

/// State of charge at the end less the reserve [points]: an integral where the source is constant, else simulated. Negative
/// if the reserve is not kept, and the more so the earlier the battery ends.
double surplus_percent(const Mission& mission);

/// What is left of a mission above its reserve, as one of its numbers changes; and where nothing is any more.
class LimitSearch {
  public:
    /// How well a probability is computed: a rough one is much sooner known.
    enum class Accuracy { rough, exact };

    LimitSearch(MissionVariation variation, const std::optional<double>& probability)
        : variation_(std::move(variation)), probability_(probability) {}

    /// Throws InputError where the schedule does not fit.
    Mission mission(double value) const;

    std::optional<Mission> mission_if_it_fits(double value);

    /// Why the last that did not fit the schedule does not.
    const std::optional<InputError>& misfit() const { return misfit_; }

    /// What the flight as stated has left above reserve and margin.
    double surplus(double value) const { return surplus(mission(value)); }
    double surplus(Mission changed) const;

    /// What that part of the flights which the probability asks for has left above the reserve, without one the flight
    /// as stated; none where the schedule does not fit.
    std::optional<double> drawn_surplus(double value, Accuracy accuracy = Accuracy::exact);

    /// The value, found by `find` for the margin that is set, with which the part of the flights that the probability
    /// asks for, no more and no less, keep the reserve; without one, that of the flight as stated. Where its flights
    /// fail from one value to the next, the last with which they do not.
    double find_with_margin(const std::function<double()>& find);

    /// The value as a limit, of which `beyond` is a little more. Its flights were drawn exactly.
    FeasibilityLimit limit(double value, double beyond) const;

  private:
    MissionVariation variation_;
    std::optional<double> probability_;
    double margin_percent_ = 0.0;  ///< above the reserve
    std::optional<InputError> misfit_;
    std::map<double, double> margins_percent_;  ///< that the flights of a value need
};

}  // namespace flightwatt::mission
