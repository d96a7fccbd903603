#include "battery/discharge.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <boost/numeric/odeint/algebra/vector_space_algebra.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

namespace flightwatt {
namespace {

constexpr double time_tolerance_s = 1e-10;
constexpr double full_percent = units::percent_per_whole;

/// Halves [low, high], where `is_before` holds at low and not at high, down to the tolerance.
template <typename Predicate>
void bisect(double& low, double& high, const Predicate& is_before) {
    while (high - low > time_tolerance_s) {
        const double middle = low + (high - low) / 2.0;
        if (middle <= low || middle >= high) return;  // the doubles here are further apart than the tolerance
        (is_before(middle) ? low : high) = middle;
    }
}

/// The state of charge one Runge-Kutta step later. `power_w` is within the limit over the step.
double step(const Battery& battery, const PowerOverTime& power_w, double time_s, double step_s,
            double soc_percent) {
    namespace odeint = boost::numeric::odeint;
    odeint::runge_kutta4<double, double, double, double, odeint::vector_space_algebra> stepper;
    const double limit_w = power_limit_w(battery);
    const auto rate = [&](double /*soc*/, double& percent_per_s, double time) {
        // The limit was looked for at the step's samples: this min() only takes away rounding beyond it.
        const double current_a = internal_current_a(battery, std::min(power_w(time), limit_w));
        percent_per_s = -units::percent_of(current_a, units::coulomb_from_ah(battery.capacity_ah));
    };
    stepper.do_step(rate, soc_percent, time_s, step_s);
    return std::min(soc_percent, full_percent);
}

/// How far into the step from `time_s` the power stays within the limit: the first instant beyond it, if
/// one of the step's samples is. `within_s` becomes the last time known to be good.
std::optional<Undeliverable> first_excess(const Battery& battery, const PowerOverTime& power_w, double time_s,
                                          double step_s, double& within_s) {
    const double limit_w = power_limit_w(battery);
    const auto is_within = [&](double time) { return power_w(time) <= limit_w; };
    within_s = time_s;
    for (const double sample_s : {time_s, time_s + step_s / 2.0, time_s + step_s}) {
        if (is_within(sample_s)) {
            within_s = sample_s;
            continue;
        }
        double beyond_s = sample_s;
        bisect(within_s, beyond_s, is_within);
        return Undeliverable{beyond_s, power_w(beyond_s), limit_w};
    }
    return std::nullopt;
}

/// One step, ended by the first of the two accidents.
Discharge guarded_step(const Battery& battery, const PowerOverTime& power_w, double time_s, double step_s,
                       double soc_percent) {
    double within_s = time_s;
    const auto excess = first_excess(battery, power_w, time_s, step_s, within_s);
    if (excess) step_s = within_s - time_s;
    const auto soc_after = [&](double elapsed_s) {
        return step(battery, power_w, time_s, elapsed_s, soc_percent);
    };
    const double soc = soc_after(step_s);
    if (soc > 0.0) return {soc, std::nullopt, excess};
    double left_s = 0.0;
    double empty_s = step_s;
    bisect(left_s, empty_s, [&](double elapsed_s) { return soc_after(elapsed_s) > 0.0; });
    return {0.0, time_s + empty_s, std::nullopt};
}

}  // namespace

Discharge discharge(const Battery& battery, const PowerOverTime& power_w, double from_s, double to_s,
                    double soc_percent, double max_step_s) {
    if (!(to_s >= from_s) || !(max_step_s > 0.0) || !(soc_percent <= full_percent)) {
        throw std::invalid_argument("discharge: from_s <= to_s, a positive step and at most 100 % are due");
    }
    if (soc_percent <= 0.0) return {0.0, from_s, std::nullopt};
    const double length_s = to_s - from_s;
    // A quotient a rounding error above a whole number is that number.
    const auto steps =
        static_cast<std::uint64_t>(std::max(1.0, std::ceil(length_s / max_step_s * (1.0 - 1e-12))));
    Discharge state{soc_percent, std::nullopt, std::nullopt};
    double time_s = from_s;
    for (std::uint64_t k = 1; k <= steps; ++k) {
        const double part = static_cast<double>(k) / static_cast<double>(steps);
        const double next_s = k == steps ? to_s : from_s + length_s * part;
        state = guarded_step(battery, power_w, time_s, next_s - time_s, state.soc_percent);
        if (state.empty_at_s || state.undeliverable) return state;
        time_s = next_s;
    }
    return state;
}

}  // namespace flightwatt
