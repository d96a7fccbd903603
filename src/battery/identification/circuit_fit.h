#pragma once

#include "battery/battery.h"
#include "battery/discharge_record.h"
#include "battery/identified_battery.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::battery {

/// A record and the charge [Ah] that was missing from the battery when it began, counted from where the curve begins.
struct AlignedRecord {
    const DischargeRecord* record = nullptr;
    double initial_charge_ah = 0.0;
};

/// What is believed of a pack before its voltages are looked at, as standard deviations. A resting voltage lies beside
/// the curve that holds under load, because a pack goes on relaxing for an hour: in all flights alike (50 mV a cell),
/// and in each: 10 mV a cell of packs that come from the charger, and 0.3 of what it rests lower than the fullest. The
/// curve's slope does not jump by more than some 0.15 V a segment and cell.
inline constexpr double common_rest_sd_v = 0.05;
inline constexpr double charged_rest_sd_v = 0.01;
inline constexpr double lower_rest_fraction = 0.3;
inline constexpr double slope_change_sd_v = 0.15;

/// [V] How unsure a resting voltage is: the standard deviation of a record's own part.
double rest_sd_v(const DischargeRecord& record, const FitWeights& weights);

/// The fit of least squares with these knots. Given the time constant all else is linear (variable projection: Golub
/// and Pereyra 1973), so that one alone is searched for: on a grid from two usual intervals to a quarter of the longest
/// record, then by Brent's method; or it is given (0: no RC pair). Throws NoResultError where the records do not
/// determine the resistance.
CircuitFit fit_circuit(std::span<const AlignedRecord> records, const std::vector<double>& knots_ah,
                       const FitWeights& weights, std::optional<double> rc_time_constant_s = std::nullopt);

/// Where the parameters of a fit stand in its derivatives.
struct FitColumns {
    Eigen::Index knots = 0;       ///< from column 0 on
    Eigen::Index resistance = 0;  ///< this column
    Eigen::Index rest = 0;        ///< from this one on, one a record
    Eigen::Index common = 0;      ///< the common rest
    Eigen::Index rc = 0;          ///< rc_resistance, then the logarithm of rc_time_constant; absent without an RC pair
    Eigen::Index width = 0;
};
FitColumns fit_columns(const CircuitFit& fit);

/// Derivatives of the fitted voltages by what all records share, one row a used sample: the knots, the resistance and,
/// with an RC pair, its resistance and the logarithm of its time constant. (By a record's rest they are 1 before its
/// first load.)
Eigen::MatrixXd shared_jacobian(std::span<const AlignedRecord> records, const CircuitFit& fit);

/// What is believed, as rows of the columns of FitColumns: of each record its rest, then the common rest, then the
/// bends of the curve.
Eigen::MatrixXd prior_rows(std::span<const AlignedRecord> records, const CircuitFit& fit);

/// [V/Ah] The curve's slope at the used samples of one record.
Eigen::VectorXd slopes_v_per_ah(const AlignedRecord& aligned, const CircuitFit& fit);

}  // namespace flightwatt::battery
