#include "mission/replanning/adaptive_flight.h"

#include "base/units.h"
#include "mission/flown_charge.h"
#include "mission/plan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/math/distributions/normal.hpp>

namespace flightwatt::mission {
namespace {

/// The relaxation's plan leaves at most what one slot could spend, and the next decision spends it; only near
/// the end is it worth a search.
SlotChoiceEffort effort_for(double slots_left) {
    constexpr double searched_slots = 8.0;
    return {slots_left <= searched_slots ? 1e-4 : 1.0, 200};
}

constexpr double jump_factor = 2.0;  ///< of the drain foreseen: beyond, charge was lost otherwise

/// Charge as what it is worth in energy at the planner's constant voltage [points]: the integral of the known
/// open-circuit voltage over it. The state of charge itself where that is constant.
double worth_of_charge(const AdaptivePlanner& planner, double soc_percent) {
    if (!planner.open_circuit) return soc_percent;
    const auto& [knots, voltage_v] = *planner.open_circuit;
    double sum = 0.0;
    for (std::size_t k = 1; k < knots.size() && knots[k - 1] < soc_percent; ++k) {
        const double to_percent = std::min(knots[k], soc_percent);
        const double part = (to_percent - knots[k - 1]) / (knots[k] - knots[k - 1]);
        const double to_v = std::lerp(voltage_v[k - 1], voltage_v[k], part);
        sum += (to_percent - knots[k - 1]) * (voltage_v[k - 1] + to_v) / 2.0;
    }
    return sum / planner.known.battery.voltage_v;
}

/// From one decision to the next, in the planned phase's own time.
struct Interval {
    flight::Phase phase = flight::Phase::takeoff;
    double phase_begins_s = 0.0;  ///< planned mission time
    double from_s = 0.0;
    double to_s = 0.0;
    double begin_s() const { return phase_begins_s + from_s; }
};

std::vector<Interval> intervals_of(const Mission& known) {
    std::vector<Interval> intervals;
    double begins_s = 0.0;
    for (const auto phase : flight::all_phases) {
        const double duration_s = known.duration_s[phase];
        const double every_s = known.adaptive->decide_every_s;
        const auto count =
            static_cast<std::size_t>(std::ceil((duration_s - same_time_tolerance_s(duration_s)) / every_s));
        for (std::size_t k = 0; k < count; ++k) {
            const double from_s = static_cast<double>(k) * every_s;
            const double to_s = k + 1 == count ? duration_s : from_s + every_s;
            intervals.push_back({phase, begins_s, from_s, to_s});
        }
        begins_s += duration_s;
    }
    return intervals;
}

/// Seconds flown and points drained so far, where they tell of mechanical power.
struct Learned {
    double time_s = 0.0;
    double observed_percent = 0.0;
    double foreseen_percent = 0.0;
    double mechanical_percent = 0.0;

    double factor(const AdaptivePolicy& policy) const {
        if (mechanical_percent <= 0.0) return 1.0;
        const double gain = time_s / (time_s + policy.learning_time_s);
        return std::max(0.0, 1.0 + gain * (observed_percent - foreseen_percent) / mechanical_percent);
    }
};

/// One flight in the air.
class Flight {
  public:
    Flight(const AdaptivePlanner& planner, const Mission& actual,
           const std::vector<Disturbance>& disturbances)
        : adaptive_(planner), known_(planner.known), planner_(planner.planner), disturbances_(disturbances) {
        flight_.flown = actual;
        flight_.flown.battery = disturbed(actual.battery, disturbances);
        flight_.flown.schedule.clear();
        charge_.soc_percent = actual.initial_soc_percent;
        reserve_percent_ = worth_of_charge(planner, known_.reserve_soc_percent);
        for (const auto phase : flight::all_phases) {
            end_s_ += known_.duration_s[phase];
            if (!actual.mechanical || actual.duration_s[phase] == 0.0) continue;
            curves_[phase] =
                flown_model(actual.mechanical->phases[phase], actual.duration_s[phase], actual.phase_clock);
        }
        const auto& policy = *known_.adaptive;
        reach_ = policy.mechanical_sd_percent / units::percent_per_whole *
                 boost::math::quantile(boost::math::normal_distribution<double>(), policy.probability);
        for (const auto phase : flight::all_phases) {
            if (known_.duration_s[phase] > 0.0)
                rest_mechanical_percent_ += mechanical_percent(phase, 0.0, known_.duration_s[phase]);
        }
    }

    void fly(const Interval& interval) {
        const double before_percent = worth_left();
        double foreseen_percent = 0.0;
        for (const auto& stretch : decide(interval)) {
            if (stretch.phase != interval.phase || stretch.from_s >= interval.to_s) break;
            const auto to_s = std::min(stretch.to_s, interval.to_s);
            const auto& known = planner_.drains.configurations;
            const auto choice =
                static_cast<std::size_t>(std::find(known.begin(), known.end(), stretch.run) - known.begin());
            foreseen_percent += drain_percent(planner_.drains, {choice, stretch.phase, stretch.from_s, to_s});
            run({stretch.phase, stretch.from_s, to_s, stretch.run});
        }
        learn(interval, before_percent - worth_left(), foreseen_percent);
    }

    AdaptiveFlight landed(const battery::Battery& battery) {
        flight_.flown.battery = battery;
        flight_.flown.schedule =
            at_same_part(std::move(flight_.flown.schedule), known_.duration_s, flight_.flown.duration_s);
        flight_.flown.plan.reset();
        flight_.flown.adaptive.reset();
        flight_.decisions.mechanical_factor = learned_.factor(*known_.adaptive);
        return std::move(flight_);
    }

  private:
    double mechanical_percent(flight::Phase phase, double from_s, double to_s) const {
        return drain_percent(planner_.mechanical_drains, {0, phase, from_s, to_s});
    }

    std::vector<Stretch> decide(const Interval& interval) {
        const auto& policy = *known_.adaptive;
        PlanStart start{interval.begin_s(), worth_left(), running_, running_for_s_};
        start.mechanical_factor = learned_.factor(policy);
        const double seen = policy.learning_time_s > 0.0
                                ? policy.learning_time_s / (learned_.time_s + policy.learning_time_s)
                                : 0.0;
        const double to_come = policy.learning_time_s / (end_s_ - start.time_s);
        const double margin_percent = reach_ * rest_mechanical_percent_ * std::sqrt(seen + to_come);
        const auto plan = plan_rest(known_, planner_, start, reserve_percent_ + margin_percent,
                                    effort_for((end_s_ - start.time_s) / known_.plan->slot_s));
        ++flight_.decisions.made;
        if (!plan.feasible) ++flight_.decisions.without_plan;
        if (plan.schedule.empty()) {
            // Nothing that the battery can deliver is known: fly on with what drains least.
            auto rest = with_least_schedule(known_).schedule;
            std::erase_if(rest, [&](const Stretch& s) {
                return s.phase < interval.phase || (s.phase == interval.phase && s.to_s <= interval.from_s);
            });
            if (!rest.empty()) rest.front().from_s = std::max(rest.front().from_s, interval.from_s);
            return rest;
        }
        return plan.schedule;
    }

    /// Runs a stretch of the plan in the flight as it is.
    void run(const Stretch& planned) {
        auto& schedule = flight_.flown.schedule;
        const bool goes_on = running_ && *running_ == planned.run;
        if (!goes_on) running_for_s_ = 0.0;
        running_for_s_ += planned.to_s - planned.from_s;
        running_ = planned.run;
        if (goes_on && !schedule.empty() && schedule.back().phase == planned.phase) {
            schedule.back().to_s = planned.to_s;
        } else {
            schedule.push_back(planned);
        }
        for (const auto& demand : disturbed({demand_of(planned)}, disturbances_))
            charge_ = mission::after_demand(flight_.flown, demand, charge_);
    }

    Demand demand_of(const Stretch& planned) const {
        const auto stretch = at_same_part({planned}, known_.duration_s, flight_.flown.duration_s).front();
        Demand demand;
        demand.phase = stretch.phase;
        for (const auto phase : flight::all_phases) {
            if (phase < stretch.phase) demand.phase_begins_s += flight_.flown.duration_s[phase];
        }
        demand.from_s = demand.phase_begins_s + stretch.from_s;
        demand.to_s = demand.phase_begins_s + stretch.to_s;
        demand.mechanical = curves_[stretch.phase];
        demand.compute_w = power_w(flight_.flown.compute, stretch.run);
        return demand;
    }

    void learn(const Interval& interval, double observed_percent, double foreseen_percent) {
        const double mechanical = mechanical_percent(interval.phase, interval.from_s, interval.to_s);
        rest_mechanical_percent_ = std::max(0.0, rest_mechanical_percent_ - mechanical);
        if (observed_percent < 0.0 || observed_percent > jump_factor * foreseen_percent) return;
        learned_.time_s += interval.to_s - interval.from_s;
        learned_.observed_percent += observed_percent;
        learned_.foreseen_percent += foreseen_percent;
        learned_.mechanical_percent += mechanical;
    }

    double worth_left() const { return worth_of_charge(adaptive_, charge_.soc_percent); }

    const AdaptivePlanner& adaptive_;
    const Mission& known_;
    const Planner& planner_;
    const std::vector<Disturbance>& disturbances_;
    AdaptiveFlight flight_;
    flight::PerPhase<std::optional<mechanical::FourierModel>> curves_;
    battery::Discharge charge_;
    Learned learned_;
    std::optional<compute::Configuration> running_;
    double running_for_s_ = 0.0;
    double end_s_ = 0.0;
    double reserve_percent_ = 0.0;  ///< as worth_left
    double reach_ = 0.0;            ///< what the reserve is kept against, as a part of mechanical power
    double rest_mechanical_percent_ = 0.0;
};

}  // namespace

AdaptivePlanner make_adaptive_planner(const Mission& mission) {
    if (!mission.adaptive) throw std::invalid_argument("make_adaptive_planner: the policy is not adaptive");
    AdaptivePlanner planner{mission, std::nullopt, {}};
    auto& battery = planner.known.battery;
    if (battery.thevenin) {
        battery.voltage_v = open_circuit_voltage_v(
            battery, (mission.initial_soc_percent + mission.reserve_soc_percent) / 2.0);
        battery.resistance_ohm += battery.thevenin->rc_resistance_ohm;
        planner.open_circuit = battery.thevenin->open_circuit;
        battery.thevenin.reset();
    }
    planner.known.cutoff_voltage_v = 0.0;
    planner.planner = make_planner(planner.known);
    return planner;
}

AdaptiveFlight fly_adaptively(const AdaptivePlanner& planner, const Mission& actual,
                              const std::vector<Disturbance>& disturbances) {
    Flight flight(planner, actual, disturbances);
    for (const auto& interval : intervals_of(planner.known)) flight.fly(interval);
    return flight.landed(actual.battery);
}

}  // namespace flightwatt::mission
