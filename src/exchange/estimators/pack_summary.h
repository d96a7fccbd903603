#pragma once

#include "exchange/autopilot_parameters.h"

#include <functional>
#include <string>

#include <Eigen/Core>

/// A battery and an aircraft, as the readers of parameters know them.
namespace flightwatt::exchange {

/// The battery for readers with a single resistance: in the steady state of the RC pair.
struct PackSummary {
    battery::Battery battery;  ///< with the RC pair's resistance in series
    int cells = 1;             ///< in series
    double capacity_mah = 0.0;
    double energy_wh = 0.0;        ///< at the open-circuit voltage, from full to empty
    double lowest_percent = 10.0;  ///< that is flown: the mission's reserve, else above the steep drop of the voltage
};

/// Throws InputError without a battery.
PackSummary summarize_pack(const EstimatorInput& input, const std::string& reader);

/// Throws InputError without a model.
const mechanical::MechanicalModel& required_model(const EstimatorInput& input, const std::string& reader);

/// The model's mean power of a phase, and the computer's [W].
double mean_power_w(const EstimatorInput& input, flight::Phase phase);

inline constexpr double half_charged_percent = 50.0;

/// For that of the cruise, half charged. Throws NoResultError beyond the power limit.
double cruise_current_a(const EstimatorInput& input, const PackSummary& pack);

/// A least-squares polynomial of a curve.
struct CurveFit {
    Eigen::VectorXd coefficients;  ///< of 1, x, x^2 ...
    double max_error = 0.0;
};
CurveFit fit_polynomial(const mechanical::FlownRange& range, int points, int order,
                        const std::function<double(double)>& curve);

/// The open-circuit voltage as a line over the state of charge.
struct VoltageLine {
    double empty_v = 0.0;
    double full_v = 0.0;
    double lowest_percent = 0.0;  ///< fitted from there to 100 %
    double error_v = 0.0;         ///< largest deviation of the curve there
    double error_below_v = 0.0;   ///< below
};
VoltageLine fit_voltage_line(const battery::Battery& battery, double lowest_percent);

/// What a simulator with one power, one resistance and a line as voltage does not represent.
std::string power_limit(const EstimatorInput& input);
inline constexpr auto resistance_limit =
    "the RC pair, which is part of the resistance: the voltage follows the load at once";
std::string voltage_limit(const VoltageLine& line);

/// Adds a note for each limit to a result; returns the same as comments.
std::string note_limits(const std::vector<std::string>& limits, const std::string& prefix, ParameterText& result);

}  // namespace flightwatt::exchange
