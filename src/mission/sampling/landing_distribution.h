#pragma once

#include "mission/mission.h"
#include "mission/sampling/flight_draws.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// Remaining charge of drawn flights of a mission.
struct LandingDistribution {
    std::vector<double> left_percent;  ///< rising; negative where the battery failed: FlightOutcome::remaining_percent
    double nominal_percent = 0.0;      ///< of the flight as stated
    double reserve_percent = 0.0;
    double sd_percent = 0.0;  ///< of left_percent; 0 where nothing differs

    /// The part of the flights that lands below the reserve.
    double below() const;
    /// Of `below`, by the number of flights; 0 where nothing varies.
    double standard_error() const;
    /// The state of charge that `probability` of the flights land with or above.
    double quantile_percent(double probability) const;
    /// That above the reserve: not negative just where as many keep the reserve.
    double spare_percent(double probability) const { return quantile_percent(probability) - reserve_percent; }
};

inline constexpr std::size_t landing_flights = 20000;  ///< standard error of a probability of 0.95: 0.0015

/// Flies `flights` flights of the mission (sampling/flight_draws.h), with a seed of its own: the same for each call, so
/// that schedules are compared on the same flights, and independent of any --samples.
LandingDistribution draw_landings(const Mission& mission, const FlightUncertainty& uncertainty,
                                  std::size_t flights = landing_flights);

/// The same with as few flights as show on which side of `probability` (0.5 to below 1) the mission is, by four
/// standard errors. Throws std::invalid_argument for another probability.
LandingDistribution draw_landings_until_known(const Mission& mission, const FlightUncertainty& uncertainty,
                                              double probability, std::size_t max_flights = landing_flights);

/// Secant search with bracketing for the least margin above a reserve whose plan keeps the reserve with a probability.
class MarginSearch {
  public:
    explicit MarginSearch(double first_percent) : margin_percent_(first_percent) {}

    double margin_percent() const { return margin_percent_; }

    /// Surplus of the plan's flights with that probability, and its target.
    void add_result(double slack_percent, double wanted_percent) {
        auto& end_percent = slack_percent >= 0.0 ? enough_percent_ : too_little_percent_;
        end_percent = margin_percent_;
        const double step = margin_per_slack(slack_percent);
        last_ = {margin_percent_, slack_percent};
        move_to(margin_percent_ + step * (wanted_percent - slack_percent));
    }

    /// There is no plan with this margin.
    void mark_infeasible() {
        enough_percent_ = margin_percent_;
        move_to(std::midpoint(too_little_percent_.value_or(0.0), margin_percent_));
    }

    /// The bracket is closed.
    bool has_converged() const {
        return too_little_percent_ && enough_percent_ && *enough_percent_ - *too_little_percent_ < 1e-6;
    }

  private:
    struct PlanAtMargin {
        double margin_percent;
        double slack_percent;
    };

    /// Margin per point of slack, by the last two plans.
    double margin_per_slack(double slack_percent) const {
        constexpr double least = 0.5;
        constexpr double most = 8.0;
        if (!last_ || slack_percent == last_->slack_percent) return 1.0;
        const double slope = (margin_percent_ - last_->margin_percent) / (slack_percent - last_->slack_percent);
        return slope > 0.0 ? std::clamp(slope, least, most) : 1.0;
    }

    void move_to(double margin_percent) {
        margin_percent_ = margin_percent;
        if (!too_little_percent_ || !enough_percent_) return;
        if (!(margin_percent_ > *too_little_percent_ && margin_percent_ < *enough_percent_))
            margin_percent_ = std::midpoint(*too_little_percent_, *enough_percent_);
    }

    double margin_percent_;
    std::optional<PlanAtMargin> last_;
    std::optional<double> too_little_percent_;
    std::optional<double> enough_percent_;
};

/// A drawn flight.
struct DrawnFlight {
    MissionSetup setup;
    std::vector<LoadSegment> segments;
    std::vector<double> times_s = {};  ///< at which its charge is noted: rising, and segments start there
};

/// How one flight ended.
struct FlightOutcome {
    double final_soc_percent = 0.0;
    bool depleted = false;
    bool battery_failure = false;  ///< that, or cut off, or beyond the power limit, or on a path that the wind forbids
    /// Final charge [points]; after a failure minus the later demand, as a fraction of the full energy.
    double remaining_percent = 0.0;
    std::vector<double> soc_percent;  ///< at the times that were asked for
};

/// A battery failure counts as below the reserve at any charge.
inline bool misses_reserve(const FlightOutcome& landing, double reserve_soc_percent) {
    return landing.battery_failure || landing.final_soc_percent < reserve_soc_percent;
}

/// Draws flight number `number` onto `flight`, which is the mission or another flight of it: copying less is faster.
using FlightDraw = std::function<void(std::size_t number, DrawnFlight& flight)>;

/// One flight, through its segments as advance_segment() does.
FlightOutcome simulate_flight(const DrawnFlight& flight);

/// Flights of a mission from number `first` on, on all threads. The result of a flight depends on its number alone.
std::vector<FlightOutcome> fly_drawn(const MissionSetup& mission, const FlightDraw& draw, std::size_t first,
                                     std::size_t count);

}  // namespace flightwatt::mission
