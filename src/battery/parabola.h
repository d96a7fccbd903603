#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace flightwatt::battery {

/// A quantity over a step of time: the parabola through its start, middle and end.
struct Parabola {
    double start = 0.0;
    double middle = 0.0;
    double end = 0.0;

    // At a part p of the step, from 0 to 1, it is start + p (slope + p curvature).
    double curvature() const { return 2.0 * (start - 2.0 * middle + end); }
    double slope() const { return 4.0 * middle - 3.0 * start - end; }
    double at(double part) const { return start + part * (slope() + part * curvature()); }
    double mean() const { return (start + 4.0 * middle + end) / 6.0; }

    double minimum() const {
        const double bend = start - 2.0 * middle + end;
        const double rise = end - start;
        return std::abs(rise) < 2.0 * bend ? middle - rise * rise / (8.0 * bend) : std::min(start, end);
    }

    /// The first part at which it is below 0; infinite if there is none.
    double first_zero_crossing() const {
        if (start < 0.0) return 0.0;
        if (!(middle < 0.0) && !(minimum() < 0.0)) return std::numeric_limits<double>::infinity();
        const double a = curvature();
        const double b = slope();
        const double root = std::sqrt(std::max(0.0, b * b - 4.0 * a * start));
        // The smaller positive root, without a difference of near numbers.
        return std::clamp(b < 0.0 ? 2.0 * start / (root - b) : (-b - root) / (2.0 * a), 0.0, 1.0);
    }
};

/// An RC pair over a step of some length, dU/dt = (R I - U) / tau, of which a current that is a parabola has an exact
/// solution.
struct RcStep {
    RcStep(double resistance_ohm, double time_constant_s, double length_s)
        : ohm(resistance_ohm), tau_per_step(time_constant_s / length_s), decay(std::exp(-length_s / time_constant_s)) {}

    double voltage_after(double voltage_v, const Parabola& current_a) const {
        // What the current holds up, R (I - tau I' + tau^2 I''), and what decays.
        const double bent_a = 2.0 * tau_per_step * tau_per_step * current_a.curvature();
        const double first_v = ohm * (current_a.start - tau_per_step * current_a.slope() + bent_a);
        const double last_slope_a = current_a.slope() + 2.0 * current_a.curvature();
        const double last_v = ohm * (current_a.end - tau_per_step * last_slope_a + bent_a);
        return last_v + (voltage_v - first_v) * decay;
    }

    double ohm;
    double tau_per_step;  ///< tau, in lengths of the step
    double decay;
};

}  // namespace flightwatt::battery
