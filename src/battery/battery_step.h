#pragma once

#include "base/units.h"
#include "battery/battery.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace flightwatt::battery {

/// A quantity over a step of time: the parabola through its start, middle and end.
struct Parabola {
    double start = 0.0;
    double middle = 0.0;
    double end = 0.0;

    // At a fraction p of the step, from 0 to 1, it is start + p (slope + p curvature).
    double curvature() const { return 2.0 * (start - 2.0 * middle + end); }
    double slope() const { return 4.0 * middle - 3.0 * start - end; }
    double at(double fraction) const { return start + fraction * (slope() + fraction * curvature()); }

    double minimum() const {
        const double bend = start - 2.0 * middle + end;
        const double rise = end - start;
        return std::abs(rise) < 2.0 * bend ? middle - rise * rise / (8.0 * bend) : std::min(start, end);
    }

    /// The first fraction of the step at which it is below 0; infinity without one.
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

/// The constants of a circuit.
struct Circuit {
    double resistance_ohm = 0.0;
    double percent_per_as = 1.0;  ///< state of charge per coulomb [points]
    double rc_resistance_ohm = 0.0;
    double rc_time_constant_s = 1.0;
};

/// A circuit at one moment.
struct CircuitMoment {
    double soc_percent = 0.0;
    double rc_voltage_v = 0.0;
    double power_w = 0.0;
    double current_a = 0.0;
    double source_v = 0.0;
    double terminal_v = 0.0;
    double spare_v2 = 0.0;  ///< U^2 - 4 R P: below 0 beyond the power limit
};

/// An RC pair over a step, dU/dt = (R I - U) / tau. Of a current that is a parabola the solution is exact, and linear
/// in the current at the start, the middle and the end.
struct RcStep {
    RcStep(const Circuit& circuit, double length_s) {
        decay = std::exp(-length_s / circuit.rc_time_constant_s);
        const double c = circuit.rc_time_constant_s / length_s;
        // The particular solution, R (I - tau I' + tau^2 I''), and the decaying one.
        const auto of_current = [&](const Parabola& current_a) {
            const double bent_a = 2.0 * current_a.curvature() * c * c;
            const double first_a = current_a.start - c * current_a.slope() + bent_a;
            const double last_a = current_a.end - c * (current_a.slope() + 2.0 * current_a.curvature()) + bent_a;
            return circuit.rc_resistance_ohm * (last_a - first_a * decay);
        };
        of_first_ohm = of_current({1.0, 0.0, 0.0});
        of_middle_ohm = of_current({0.0, 1.0, 0.0});
        of_last_ohm = of_current({0.0, 0.0, 1.0});
    }

    double decay;
    double of_first_ohm;
    double of_middle_ohm;
    double of_last_ohm;
};

/// A circuit's constants for steps of one length.
struct StepLength {
    StepLength(const Circuit& circuit, double length_s)
        : percent_per_a(circuit.percent_per_as * length_s / 6.0),
          half(circuit, 0.5 * length_s),
          whole(circuit, length_s) {}

    double percent_per_a;  ///< [points] for each of Simpson's six parts
    RcStep half;
    RcStep whole;
};

/// One of the straight lines of an open-circuit voltage: offset + slope * charge, from one charge to another.
struct VoltageSegment {
    double low_percent = 0.0;
    double high_percent = 0.0;
    double offset_v = 0.0;
    double slope_v = 0.0;
};

/// The line at a state of charge; the first and the last line are unbounded.
inline VoltageSegment find_voltage_segment(const OpenCircuitVoltage& curve, double soc_percent) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const auto& [knots_percent, knots_v] = curve;
    const auto above = std::upper_bound(knots_percent.begin() + 1, knots_percent.end() - 1, soc_percent);
    const auto upper = static_cast<std::size_t>(above - knots_percent.begin());
    const double low_percent = knots_percent[upper - 1];
    const double high_percent = knots_percent[upper];
    const double slope_v = (knots_v[upper] - knots_v[upper - 1]) / (high_percent - low_percent);
    return {upper == 1 ? -infinite : low_percent, upper + 1 == knots_percent.size() ? infinite : high_percent,
            knots_v[upper - 1] - slope_v * low_percent, slope_v};
}

/// The open-circuit voltage for a sequence of charges: the last line is cached.
class VoltageLine {
  public:
    VoltageLine(const OpenCircuitVoltage& curve, double soc_percent) : curve_(&curve) { (*this)(soc_percent); }

    double operator()(double soc_percent) {
        if (soc_percent < segment_.low_percent || soc_percent >= segment_.high_percent)
            segment_ = find_voltage_segment(*curve_, soc_percent);
        return segment_.offset_v + segment_.slope_v * std::clamp(soc_percent, 0.0, 100.0);
    }

  private:
    const OpenCircuitVoltage* curve_;
    VoltageSegment segment_;
};

/// The one step of a battery under a load: over it the current is a parabola through its start, middle and end, with
/// which the RC pair's voltage is exact.
class CircuitRun {
  public:
    using Moment = CircuitMoment;

    CircuitRun(const Circuit& circuit, VoltageLine open_circuit)
        : circuit_(circuit), has_rc_(circuit.rc_resistance_ohm > 0.0), open_circuit_(open_circuit) {}

    /// Fills in a moment whose charge, RC voltage and power are known (Eq. 10).
    void complete(Moment& now) {
        constexpr double min_v = 1e-300;  // no 0 / 0 without power
        now.source_v = std::max(open_circuit_(now.soc_percent) - now.rc_voltage_v, 0.0);
        now.spare_v2 = now.source_v * now.source_v - 4.0 * circuit_.resistance_ohm * now.power_w;
        now.current_a = 2.0 * now.power_w / std::max(now.source_v + std::sqrt(std::max(now.spare_v2, 0.0)), min_v);
        now.terminal_v = now.source_v - circuit_.resistance_ohm * now.current_a;
    }

    /// From a start to the middle and the end, whose powers are known.
    void step(const StepLength& length, const Moment& start, Moment& middle, Moment& end) {
        advance_half(length, start, start.current_a, middle);
        complete(middle);
        advance_half(length, start, middle.current_a, middle);
        complete(middle);
        advance(length, start, middle.current_a, 2.0 * middle.current_a - start.current_a, end);
        complete(end);
        advance(length, start, middle.current_a, end.current_a, end);
        complete(end);
    }

  private:
    /// Half a step, with a current that is linear up to the middle.
    void advance_half(const StepLength& length, const Moment& start, double middle_a, Moment& middle) const {
        middle.soc_percent = start.soc_percent - 1.5 * length.percent_per_a * (start.current_a + middle_a);
        if (!has_rc_) return;
        const auto& rc = length.half;
        middle.rc_voltage_v = start.rc_voltage_v * rc.decay +
                              (rc.of_first_ohm + 0.5 * rc.of_middle_ohm) * start.current_a +
                              (rc.of_last_ohm + 0.5 * rc.of_middle_ohm) * middle_a;
    }

    void advance(const StepLength& length, const Moment& start, double middle_a, double end_a, Moment& end) const {
        end.soc_percent =
            std::min(start.soc_percent - length.percent_per_a * (start.current_a + 4.0 * middle_a + end_a), 100.0);
        if (!has_rc_) return;
        const auto& rc = length.whole;
        end.rc_voltage_v = start.rc_voltage_v * rc.decay + rc.of_first_ohm * start.current_a +
                           rc.of_middle_ohm * middle_a + rc.of_last_ohm * end_a;
    }

    const Circuit& circuit_;
    bool has_rc_;
    VoltageLine open_circuit_;
};

/// 0 or less where the battery may end within a step: empty, beyond the power limit, or below the cut-off voltage (0:
/// none). A parabola through three values is at most an eighth of its second difference below their minimum.
inline double end_margin(const CircuitMoment& start, const CircuitMoment& middle, const CircuitMoment& end,
                         double cutoff_v) {
    const auto lower_bound = [](double a, double b, double c) {
        return std::min({a, b, c}) - 0.125 * std::abs(a - 2.0 * b + c);
    };
    const double margin = std::min(end.soc_percent, lower_bound(start.spare_v2, middle.spare_v2, end.spare_v2));
    if (cutoff_v <= 0.0) return margin;
    return std::min(margin, lower_bound(start.terminal_v, middle.terminal_v, end.terminal_v) - cutoff_v);
}

/// The circuit of a battery; the paper's has no RC pair.
inline Circuit circuit_of(const Battery& battery) {
    Circuit circuit;
    circuit.resistance_ohm = battery.resistance_ohm;
    circuit.percent_per_as = units::percentage(1.0, units::coulomb_from_ah(battery.capacity_ah));
    if (!battery.thevenin || battery.thevenin->rc_resistance_ohm == 0.0) return circuit;
    circuit.rc_resistance_ohm = battery.thevenin->rc_resistance_ohm;
    circuit.rc_time_constant_s = battery.thevenin->rc_time_constant_s;
    return circuit;
}

/// Its open-circuit voltage; that of the paper's source is the same at every charge.
inline OpenCircuitVoltage open_circuit_of(const Battery& battery) {
    if (battery.thevenin) return battery.thevenin->open_circuit;
    return {{0.0, units::percent_per_whole}, {battery.voltage_v, battery.voltage_v}};
}

}  // namespace flightwatt::battery
