#pragma once

#include "battery/landing_forecast.h"
#include "mechanical/prediction.h"
#include "mission/cruise_path.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

/// A place on a path: so much of an element's time has passed.
struct PathPlace {
    std::size_t element = 0;
    double part = 0.0;  ///< of 1
};

/// Where a path is after a time from its start, at most its duration.
PathPlace place_at(const FlownPath& flown, double time_s);

/// What is left of a path from a place on, which may have been found in another wind.
FlownPath rest_from(const FlownPath& flown, const PathPlace& place);

/// A prediction of what is left of a path, and how long that takes: means over the winds that let it be flown.
struct RemainingPath {
    mechanical::RestPrediction cruise;
    double duration_s = 0.0;
    double forbidden_part = 0.0;               ///< of the winds, of 1
    std::vector<battery::PowerStretch> power;  ///< in the plan's wind, as the model has it, in order
};

/// A plan's path as it is flown in each of the winds that its spread makes likely, for forecasts of what is left of it
/// from many places: flying it takes most of the time of a forecast.
class PathForecast {
  public:
    explicit PathForecast(PathPlan plan);

    const PathPlan& plan() const { return plan_; }
    /// In the plan's wind. Throws InputError where that forbids it.
    const FlownPath& flown() const;
    /// As predict_rest_of_path.
    RemainingPath predict(const mechanical::FlightProgress& flown, const PathPlace& place) const;

  private:
    /// A piece of an element, and the sums over it and those before it.
    struct SummedPiece {
        double start_s = 0.0;
        double time_s = 0.0;
        mechanical::TermValues terms;  ///< zeros where the motor stands
        mechanical::TermValues before;
    };
    struct FlownElementInWind {
        std::vector<SummedPiece> pieces;
        double duration_s = 0.0;
        mechanical::TermValues sums;
        bool is_forbidden = false;
    };
    using PathInWind = std::vector<FlownElementInWind>;
    struct Rest {
        double duration_s = 0.0;
        mechanical::TermValues mean_terms;
        bool is_forbidden = false;
    };

    FlownElementInWind fly_element(const PathElement& element, const Wind& wind) const;
    static Rest rest_of(const PathInWind& path, const PathPlace& place);

    PathPlan plan_;
    std::vector<PathInWind> in_likely_winds_;
    FlownPath flown_;  ///< in the plan's wind, crawling where that forbids it
};

/// The rest of a cruise along its path (predict_rest_by_motion), over 7 equally likely speeds by 7 directions of the wind
/// that the plan's spread makes of its wind, none slower than 0; where they differ the interval is wider. Throws
/// NoAnswerError as predict_rest_by_motion, or where most of the winds forbid what is left.
RemainingPath predict_rest_of_path(const PathPlan& plan, const mechanical::FlightProgress& flown,
                                   const PathPlace& place);

}  // namespace flightwatt::mission
