#include "mission/sampling/landing_search.h"

#include "battery/battery_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace flightwatt::mission {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t compared_flights = 64;  // simulated in any case, to know the error of the estimates
constexpr double reach_of_errors = 4.0;       // twice what it takes if the greatest error is that of the simulated ones
constexpr double least_error_percent = 0.05;
constexpr double same_estimates_percent = 0.5;  // between the landings of two variations as stated

/// Remaining charge by the mean power of each segment, in long steps; below 0 about the demand that is not met. Not a
/// number where a peak of the power may end the flight: of a settled RC pair it would.
double estimate_left_percent(const DrawnFlight& flight) {
    constexpr double steps_of_flight = 12.0;
    const auto& setup = flight.setup;
    const auto circuit = circuit_of(setup.battery);
    auto settled = circuit;
    settled.resistance_ohm += std::exchange(settled.rc_resistance_ohm, 0.0);
    const auto open_circuit = open_circuit_of(setup.battery);
    battery::CircuitMoment now{.soc_percent = setup.initial_soc_percent};
    const battery::VoltageLine line(open_circuit, now.soc_percent);
    battery::CircuitRun run(circuit, line);
    battery::CircuitRun run_settled(settled, line);
    for (const auto& segment : flight.segments) {
        const double length_s = segment.end_s - segment.start_s;
        if (length_s <= 0.0) continue;
        const double count = std::ceil(steps_of_flight * length_s / flight.segments.back().end_s);
        const double energy_j = mechanical_energy_j(segment, segment.end_s) + compute_energy_j(segment, segment.end_s);
        now.power_w = energy_j / length_s;
        run.complete(now);
        const battery::StepLength length(circuit, length_s / count);
        for (int k = 0; k < static_cast<int>(count); ++k) {
            auto middle = now;
            auto end = now;
            run.step(length, now, middle, end);
            now = end;
        }
        battery::CircuitMoment peak{.soc_percent = now.soc_percent, .power_w = bounds_of(segment).high};
        run_settled.complete(peak);
        if (!(peak.spare_v2 >= 0.0 && peak.terminal_v >= setup.cutoff_voltage_v)) return unknown;
    }
    return now.soc_percent;
}

/// The landings of one variation: estimates of all flights, replaced by simulations where that matters.
class MixedLandings {
  public:
    /// `error_percent` is known of estimates, and grows with what simulations show.
    MixedLandings(const MissionSetup& mission, const FlightDraw& draw, double& error_percent)
        : mission_(mission), draw_(draw), error_percent_(error_percent) {}

    void add(double estimated_percent) {
        left_percent_.push_back(estimated_percent);
        is_simulated_.push_back(false);
        if (std::isnan(estimated_percent) || left_percent_.size() <= compared_flights)
            simulate_next_.push_back(left_percent_.size() - 1);
    }

    /// Simulates the flights near a landing, until all are that may be as near, by the errors that this shows.
    void resolve_near(double percent) {
        simulate();
        for (double reach_percent = -1.0; reach_percent < reach_of_errors * error_percent_;) {
            reach_percent = reach_of_errors * error_percent_;
            for (std::size_t i = 0; i < left_percent_.size(); ++i)
                if (!is_simulated_[i] && std::abs(left_percent_[i] - percent) <= reach_percent)
                    simulate_next_.push_back(i);
            simulate();
        }
    }

    /// Simulates all flights that may fail: how long before its end a flight fails is but roughly estimated.
    void resolve_failures() {
        for (std::size_t i = 0; i < left_percent_.size(); ++i)
            if (!is_simulated_[i] && left_percent_[i] < reach_of_errors * error_percent_) simulate_next_.push_back(i);
        simulate();
    }

    const std::vector<double>& left_percent() const { return left_percent_; }

  private:
    void simulate() {
        const FlightDraw draw_next = [&](std::size_t i, DrawnFlight& flight) { draw_(simulate_next_[i], flight); };
        const auto landings = fly_drawn(mission_, draw_next, 0, simulate_next_.size());
        for (std::size_t i = 0; i < landings.size(); ++i) {
            auto& left = left_percent_[simulate_next_[i]];
            // How long before its end a flight fails does not matter.
            constexpr double failed_percent = -1.0;
            const double off =
                std::abs(std::max(landings[i].remaining_percent, failed_percent) - std::max(left, failed_percent));
            if (off > error_percent_) error_percent_ = off;
            left = landings[i].remaining_percent;
            is_simulated_[simulate_next_[i]] = true;
        }
        simulate_next_.clear();
    }

    const MissionSetup& mission_;
    const FlightDraw& draw_;
    double& error_percent_;
    std::vector<double> left_percent_;
    std::vector<bool> is_simulated_;
    std::vector<std::size_t> simulate_next_;
};

}  // namespace

LandingDistribution LandingSearch::landings(const Mission& mission, const FlightUncertainty& uncertainty) {
    const auto draw = landing_draw(mission, uncertainty);
    DrawnFlight stated{mission.setup, {}};
    draw(stated_flight, stated);
    LandingDistribution result;
    result.nominal_percent = simulate_flight(stated).remaining_percent;
    result.reserve_percent = mission.setup.reserve_soc_percent;
    if (uncertainty.sources.varied.empty() || mission.setup.cruise_path)
        return draw_landings_until_known(mission, uncertainty, probability_);
    double moved_percent = result.nominal_percent - of_stated_percent_;
    if (estimated_percent_.empty() || std::abs(moved_percent) > same_estimates_percent) {
        estimated_percent_.clear();
        error_percent_ = least_error_percent;
        of_stated_percent_ = result.nominal_percent;
        moved_percent = 0.0;
    }
    error_percent_ = std::max(error_percent_, std::abs(moved_percent));
    MixedLandings mixed(mission.setup, draw, error_percent_);
    const auto add = [&](std::size_t flights) {
        estimate_until(flights, mission.setup, draw, moved_percent);
        for (auto i = mixed.left_percent().size(); i < flights; ++i) mixed.add(estimated_percent_[i] + moved_percent);
        mixed.resolve_near(result.reserve_percent);
        result.set_left_percent(mixed.left_percent());
    };
    draw_until_known(add, result, probability_);
    for (auto last_percent = unknown; result.quantile_percent(probability_) != last_percent;) {
        last_percent = result.quantile_percent(probability_);
        if (last_percent < 0.0) mixed.resolve_failures();
        mixed.resolve_near(last_percent);
        result.set_left_percent(mixed.left_percent());
    }
    return result;
}

void LandingSearch::estimate_until(std::size_t flights, const MissionSetup& mission, const FlightDraw& draw,
                                   double moved_percent) {
    const auto known = estimated_percent_.size();
    if (known >= flights) return;
    estimated_percent_.resize(flights);
    for_each_drawn(mission, draw, known, flights - known, [&](std::size_t i, const DrawnFlight& flight) {
        estimated_percent_[i] = estimate_left_percent(flight) - moved_percent;
    });
}

}  // namespace flightwatt::mission
