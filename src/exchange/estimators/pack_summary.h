#pragma once

#include "base/statistics.h"
#include "exchange/autopilot_parameters.h"

#include <functional>
#include <string>

#include <Eigen/Core>

/// Values of a battery and an aircraft that the programs which read parameters (`reader`: their name, for errors) need.
namespace flightwatt::exchange {

/// A battery for readers that know a single resistance: that of the steady state, with the RC pair settled.
struct PackSummary {
    battery::Battery battery;  ///< with the RC pair's resistance in series
    int cells = 1;             ///< in series
    double capacity_mah = 0.0;
    double energy_wh = 0.0;        ///< at the open-circuit voltage, from full to empty
    double lowest_percent = 10.0;  ///< lowest charge in use: the mission's reserve, else above the steep drop
};

/// Returns the summary of the input's battery. Throws InputError without one.
PackSummary summarize_pack(const EstimatorInput& input, const std::string& reader);

/// Returns the battery monitors that the parameters are for: of the battery, else the first one, which counts all. Adds
/// a comment, and a note, of several, and of parts of the charge that are not known.
std::vector<flight::MonitorShare> noted_monitors(const EstimatorInput& input, ParameterText& result);

/// Returns the input's model. Throws InputError without one.
const mechanical::MechanicalModel& required_model(const EstimatorInput& input, const std::string& reader);

/// Returns the mean power of a phase by the model, plus that of the computer [W].
double mean_power_w(const EstimatorInput& input, flight::Phase phase);

/// State of charge at which cruise_current_a() is computed [%].
inline constexpr double half_charged_percent = 50.0;

/// Returns the current [A] at which the half charged pack delivers the power of the cruise. Throws NoResultError if it
/// cannot.
double cruise_current_a(const EstimatorInput& input, const PackSummary& pack);

/// A polynomial fitted to a curve by least squares.
struct CurveFit {
    Eigen::VectorXd coefficients;  ///< of 1, x, x^2 ...
    double max_error = 0.0;        ///< largest deviation at the fitted points
};
/// Fits a polynomial of an order to a curve at `points` equal steps of a range.
CurveFit fit_polynomial(const Interval& range, int points, int order, const std::function<double(double)>& curve);

/// The open-circuit voltage as a line over the state of charge.
struct VoltageLine {
    double empty_v = 0.0;
    double full_v = 0.0;
    double lowest_percent = 0.0;  ///< fitted from there to 100 %
    double error_v = 0.0;         ///< largest deviation of the curve from the line in the fitted range
    double error_below_v = 0.0;   ///< the same below lowest_percent
};
/// Fits a line to a battery's open-circuit voltage from `lowest_percent` to 100 %.
VoltageLine fit_voltage_line(const battery::Battery& battery, double lowest_percent);

// Properties that a simulator with one power, one resistance and a line as voltage does not represent, as texts.

/// Returns that all phases have the power of the cruise, with the powers of take-off and landing by the model.
std::string power_limit(const EstimatorInput& input);
/// States the limit of a single resistance.
inline constexpr auto resistance_limit =
    "the RC pair, which is part of the resistance: the voltage follows the load at once";
/// Returns that the voltage is a line, with its largest errors.
std::string voltage_limit(const VoltageLine& line);

/// Adds a note for each limit to a result; returns the notes as lines that begin with `prefix`.
std::string note_limits(const std::vector<std::string>& limits, const std::string& prefix, ParameterText& result);

}  // namespace flightwatt::exchange
