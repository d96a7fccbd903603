#include "battery/discharge.h"

#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

namespace flightwatt::battery {
namespace {

constexpr double time_tolerance_s = 1e-10;
constexpr double full_percent = units::percent_per_whole;

/// The power at the times of a step, which its checks and Runge-Kutta's stages ask for again and again.
class RememberedPower {
  public:
    explicit RememberedPower(const std::function<double(double)>& power_w) : power_w_(power_w) { time_s_.fill(NAN); }

    double at(double time_s) {
        for (std::size_t i = 0; i < time_s_.size(); ++i)
            if (time_s_[i] == time_s) return at_time_w_[i];
        next_ = (next_ + 1) % time_s_.size();
        time_s_[next_] = time_s;
        return at_time_w_[next_] = power_w_(time_s);
    }

  private:
    static constexpr std::size_t times_of_a_step = 4;  // its start, quarter, middle and end
    const std::function<double(double)>& power_w_;
    std::array<double, times_of_a_step> time_s_{};
    std::array<double, times_of_a_step> at_time_w_{};
    std::size_t next_ = 0;
};

/// One step from `time_s` on.
struct Step {
    const Battery& battery;
    RememberedPower& power_w;
    double time_s;
    BatteryState from;
};

/// The state one Runge-Kutta step later.
BatteryState after(const Step& step, double elapsed_s) {
    using State = std::array<double, 2>;  // state of charge, voltage of the RC pair
    const auto& battery = step.battery;
    const auto rate = [&](const State& x, State& per_s, double time) {
        const BatteryState state{x[0], x[1]};
        // The limit is looked for at the step's samples: what lies beyond it is only taken away.
        const double current_a = limited_current_a(battery, step.power_w.at(time), state);
        per_s[0] = -units::percentage(current_a, units::coulomb_from_ah(battery.capacity_ah));
        per_s[1] = 0.0;
        if (!battery.thevenin) return;
        const auto& [curve, rc_ohm, tau_s] = *battery.thevenin;
        per_s[1] = (rc_ohm * current_a - x[1]) / tau_s;
    };
    boost::numeric::odeint::runge_kutta4<State> stepper;
    State x{step.from.soc_percent, step.from.rc_voltage_v};
    stepper.do_step(rate, x, step.time_s, elapsed_s);
    return {std::min(x[0], full_percent), x[1]};
}

/// A step's states, each integrated once: all that is looked for is looked for at its start, its middle and its end.
class StepStates {
  public:
    StepStates(const Step& step, double length_s) : step_(&step), length_s_(length_s) {}

    const Step& step() const { return *step_; }
    double length_s() const { return length_s_; }

    BatteryState at(double elapsed_s) {
        if (elapsed_s == 0.0) return step_->from;
        if (elapsed_s == length_s_) return kept(end_, elapsed_s);
        if (elapsed_s == length_s_ / 2.0) return kept(middle_, elapsed_s);
        return after(*step_, elapsed_s);
    }

  private:
    const BatteryState& kept(std::optional<BatteryState>& state, double elapsed_s) const {
        if (!state) state = after(*step_, elapsed_s);
        return *state;
    }

    const Step* step_;
    double length_s_;
    std::optional<BatteryState> middle_;
    std::optional<BatteryState> end_;
};

/// Where in a step something came to hold: not yet at `last_before_s`, at `first_s` it did.
struct Onset {
    double last_before_s;
    double first_s;
};

/// The onset of `holds` in [0, length_s], if it holds at one of the samples 0, half and all of it.
template <typename Predicate>
std::optional<Onset> first_onset(double length_s, const Predicate& holds) {
    double before_s = 0.0;
    for (double at_s : {0.0, length_s / 2.0, length_s}) {
        if (!holds(at_s)) {
            before_s = at_s;
            continue;
        }
        while (at_s - before_s > time_tolerance_s) {
            const double middle_s = before_s + (at_s - before_s) / 2.0;
            if (middle_s <= before_s || middle_s >= at_s) break;  // the doubles are no nearer than this
            (holds(middle_s) ? at_s : before_s) = middle_s;
        }
        return Onset{before_s, at_s};
    }
    return std::nullopt;
}

/// Where the power first goes beyond what the battery can deliver.
std::optional<Onset> first_excess(StepStates& states) {
    const auto& step = states.step();
    const bool limited = step.battery.resistance_ohm > 0.0 || step.battery.thevenin;
    if (!limited) return std::nullopt;
    return first_onset(states.length_s(), [&](double elapsed_s) {
        const auto state = step.battery.thevenin ? states.at(elapsed_s) : step.from;
        return step.power_w.at(step.time_s + elapsed_s) > power_limit_w(step.battery, state);
    });
}

bool is_below_cutoff(StepStates& states, double elapsed_s, double cutoff_v) {
    const auto& step = states.step();
    const auto state = states.at(elapsed_s);
    const double current_a = limited_current_a(step.battery, step.power_w.at(step.time_s + elapsed_s), state);
    return terminal_voltage_v(step.battery, state, current_a) < cutoff_v;
}

/// One step, ended by the first of empty, cut-off voltage and power limit.
Discharge guarded_step(const Step& step, double length_s, double cutoff_v) {
    std::optional<Undeliverable> undeliverable;
    StepStates states(step, length_s);
    if (const auto excess = first_excess(states)) {
        const double beyond_s = step.time_s + excess->first_s;
        undeliverable =
            Undeliverable{beyond_s, step.power_w.at(beyond_s), power_limit_w(step.battery, states.at(excess->first_s))};
        // At once: nothing else comes before it.
        if (excess->first_s == 0.0) return {step.from, std::nullopt, std::nullopt, undeliverable};
        length_s = excess->last_before_s;
        states = StepStates(step, length_s);
    }
    const auto state = states.at(length_s);
    std::optional<Onset> cut_off;
    if (cutoff_v > 0.0) cut_off = first_onset(length_s, [&](double s) { return is_below_cutoff(states, s, cutoff_v); });
    std::optional<Onset> empty;
    if (state.soc_percent <= 0.0)
        empty = first_onset(length_s, [&](double s) { return states.at(s).soc_percent <= 0.0; });
    if (empty && (!cut_off || empty->first_s <= cut_off->first_s))
        return {{0.0, states.at(empty->first_s).rc_voltage_v}, step.time_s + empty->first_s};
    if (cut_off) return {states.at(cut_off->first_s), std::nullopt, step.time_s + cut_off->first_s};
    return {state, std::nullopt, std::nullopt, undeliverable};
}

}  // namespace

Discharge discharge(const Battery& battery, const Load& load, const BatteryState& state,
                    const DischargeOptions& options) {
    if (!(load.end_s >= load.start_s) || !(options.max_step_s > 0.0) || !(state.soc_percent <= full_percent) ||
        !(options.cutoff_voltage_v >= 0.0)) {
        throw std::invalid_argument(
            "discharge: needs start_s <= end_s, a positive step, at most 100 % and no negative voltage");
    }
    if (state.soc_percent <= 0.0) return {{0.0, state.rc_voltage_v}, load.start_s};
    double max_step_s = options.max_step_s;
    if (battery.thevenin) max_step_s = std::min(max_step_s, battery.thevenin->rc_time_constant_s / 2.0);
    const double length_s = load.end_s - load.start_s;
    // A quotient a rounding error above a whole number is that number.
    const auto steps = static_cast<std::uint64_t>(std::max(1.0, std::ceil(length_s / max_step_s * (1.0 - 1e-12))));
    Discharge result{state};
    RememberedPower power_w(load.power_w);
    double time_s = load.start_s;
    for (std::uint64_t k = 1; k <= steps; ++k) {
        const double part = static_cast<double>(k) / static_cast<double>(steps);
        const double next_s = k == steps ? load.end_s : load.start_s + length_s * part;
        result = guarded_step({battery, power_w, time_s, result}, next_s - time_s, options.cutoff_voltage_v);
        if (result.ended_at_s() || result.undeliverable) return result;
        time_s = next_s;
    }
    return result;
}

}  // namespace flightwatt::battery
