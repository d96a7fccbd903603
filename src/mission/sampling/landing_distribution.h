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

/// The remaining charge of drawn flights of a mission.
struct LandingDistribution {
    std::vector<double> left_percent;  ///< FlightOutcome::remaining_percent, rising; negative if the battery failed
    double nominal_percent = 0.0;      ///< remaining charge of the mission as stated
    double reserve_percent = 0.0;
    double sd_percent = 0.0;  ///< standard deviation of left_percent; 0 if nothing differs

    /// Sets left_percent, in any order, and its standard deviation.
    void set_left_percent(std::vector<double> percent);
    /// Returns the fraction of the flights that lands below the reserve.
    double below() const;
    /// Returns the standard error of below(), by the number of flights; 0 if nothing differs.
    double standard_error() const;
    /// Returns the state of charge [%] at or above which a fraction `probability` of the flights lands.
    double quantile_percent(double probability) const;
    /// Returns the same less the reserve: not negative if and only if that fraction of the flights keeps the reserve.
    double spare_percent(double probability) const { return quantile_percent(probability) - reserve_percent; }
};

/// Number of drawn flights.
inline constexpr std::size_t landing_flights = 20000;  ///< standard error of a probability of 0.95: 0.0015

/// Draws and simulates landing_flights flights of the mission (sampling/flight_draws.h). The seed is the same in each
/// call, so that schedules are compared on the same flights, and differs from that of --samples.
LandingDistribution draw_landings(const Mission& mission, const FlightUncertainty& uncertainty);

/// Draws flights as draw_landings(), but only until they show by four standard errors whether the mission keeps its
/// reserve with more or less than `probability` (0.5 to below 1). Throws std::invalid_argument for another probability.
LandingDistribution draw_landings_until_known(const Mission& mission, const FlightUncertainty& uncertainty,
                                              double probability);

/// Searches the least margin above a reserve with which a plan keeps the reserve with a probability: by secants, with
/// bracketing.
class MarginSearch {
  public:
    /// Begins the search at a margin.
    explicit MarginSearch(double first_percent) : margin_percent_(first_percent) {}

    double margin_percent() const { return margin_percent_; }

    /// Adds the result of the plan with the current margin: the surplus of its flights with that probability, and the
    /// target of that.
    void add_result(double slack_percent, double wanted_percent) {
        auto& end_percent = slack_percent >= 0.0 ? enough_percent_ : too_little_percent_;
        end_percent = margin_percent_;
        const double step = margin_per_slack(slack_percent);
        last_ = {margin_percent_, slack_percent};
        move_to(margin_percent_ + step * (wanted_percent - slack_percent));
    }

    /// States that there is no plan with the current margin.
    void mark_infeasible() {
        enough_percent_ = margin_percent_;
        move_to(std::midpoint(too_little_percent_.value_or(0.0), margin_percent_));
    }

    /// Returns whether the bracket is closed.
    bool has_converged() const {
        return too_little_percent_ && enough_percent_ && *enough_percent_ - *too_little_percent_ < 1e-6;
    }

  private:
    struct PlanAtMargin {
        double margin_percent;
        double slack_percent;
    };

    /// Returns the change of margin per point of slack, by the last two plans.
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

/// A drawn flight, ready to be simulated.
struct DrawnFlight {
    MissionSetup setup;
    std::vector<LoadSegment> segments;
    std::vector<double> times_s = {};  ///< times at which its charge is noted: rising, and at starts of segments
};

/// The end of one simulated flight.
struct FlightOutcome {
    double final_soc_percent = 0.0;
    bool depleted = false;
    bool battery_failure = false;  ///< depleted, cut off, beyond the power limit, or on a path that the wind forbids
    /// Final charge [points]; after a failure minus the later demand, as a fraction of the full energy.
    double remaining_percent = 0.0;
    std::vector<double> soc_percent;  ///< at DrawnFlight::times_s
};

/// Returns whether a flight lands below the reserve; one with a battery failure does at any charge.
inline bool misses_reserve(const FlightOutcome& landing, double reserve_soc_percent) {
    return landing.battery_failure || landing.final_soc_percent < reserve_soc_percent;
}

/// Overwrites `flight`, which is the mission or an earlier drawn flight of it, with drawn flight number `number`:
/// copying less is faster.
using FlightDraw = std::function<void(std::size_t number, DrawnFlight& flight)>;

/// Returns how draw_landings() draws, and for the number `stated_flight` the mission as stated. Refers to its arguments.
FlightDraw landing_draw(const Mission& mission, const FlightUncertainty& uncertainty);
inline constexpr auto stated_flight = static_cast<std::size_t>(-1);

/// Calls `draw_until`, which adds flights to `landings`, with more and more flights until draw_landings_until_known() has
/// enough of them.
void draw_until_known(const std::function<void(std::size_t flights)>& draw_until, const LandingDistribution& landings,
                      double probability);

/// Simulates one flight through its segments by advance_segment().
FlightOutcome simulate_flight(const DrawnFlight& flight);

/// Draws `count` flights of a mission from number `first`, on all threads.
void for_each_drawn(const MissionSetup& mission, const FlightDraw& draw, std::size_t first, std::size_t count,
                    const std::function<void(std::size_t number, const DrawnFlight& flight)>& work);

/// Draws and simulates `count` flights of a mission from number `first`, on all threads. The result of a flight depends
/// on its number alone.
std::vector<FlightOutcome> fly_drawn(const MissionSetup& mission, const FlightDraw& draw, std::size_t first,
                                     std::size_t count);

}  // namespace flightwatt::mission
