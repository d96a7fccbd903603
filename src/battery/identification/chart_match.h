#pragma once

#include "battery/battery.h"
#include "battery/identified_battery.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::battery {

/// The typical open-circuit voltage of a cell [V] at a state of charge, 0 to 100, for charges that no flight has shown.
/// LiPo: the chart that sellers of packs print (e.g. blog.ampow.com/lipo-voltage-chart). The other two are round
/// numbers of ours: NMC near the LG M50 (Chen et al. 2020), high-voltage LiPo as a LiPo charged to 4.35 V.
double chart_voltage_v(Chemistry chemistry, double soc_percent);

/// Maximum resting voltage of a charged cell that is not a high-voltage one.
inline constexpr double max_charged_cell_v = 4.25;

/// The open-circuit voltage that flights show, to be compared with a chart.
struct ObservedOcv {
    std::vector<double> charge_ah;   ///< from where the curve begins, 0; rising
    std::vector<double> voltage_v;   ///< under load, falling
    Eigen::MatrixXd covariance_v2;   ///< of these voltages
    double resting_charge_ah = 0.0;  ///< of the fullest flight
    double resting_voltage_v = 0.0;  ///< of the fullest flight
    int cells = 0;
};

/// Standard deviations of packs from their chart, a cell: chart_sd_v, correlated over 40 % of the charge, and 10 mV at
/// each point that is compared, as real curves are smoother than the model of their difference. Chosen with Chen's and
/// Rincon-Mora's polymer cell (2006), 55 mV from LiPo's chart, and two synthetic packs, 72 and 83 mV from it, in view.
inline constexpr double chart_correlation_percent = 40.0;
inline constexpr double chart_local_sd_v = 0.01;
inline constexpr double chart_soc_sd_percent = 4.0;  ///< error of its charge, which matters where it is steep

/// Standard deviation [V] of a cell's voltage at a state of charge that is extrapolated in parallel to the chart from
/// another.
double extrapolation_sd_v(Chemistry chemistry, double soc_percent, double known_percent);

/// Probability of a capacity, with a charge missing where the curve begins.
struct CapacityHypothesis {
    double capacity_ah = 0.0;
    double missing_ah = 0.0;
    double probability = 0.0;
    bool is_full = false;  ///< charged: `missing_ah` is 0 to some percent
    Chemistry chemistry = Chemistry::lipo;
};

/// The posterior on a grid (docs/methods.md), probabilities summing to 1: four points of the curve follow one of the
/// charts with the errors above, a common one of 30 mV a cell under load, and one of 20 mV at rest. Prior: 75 % LiPo,
/// 15 % NMC, 10 % high voltage (alone above max_charged_cell_v); drawn fraction of the capacity uniform on [1/50, 1];
/// half of all packs begin full within 3 %, the others 0 to 90 % short. Empty if the curve exceeds the given capacity by
/// a tenth.
std::vector<CapacityHypothesis> capacity_posterior(const ObservedOcv& shown, std::optional<double> given_ah);

Chemistry most_probable_chemistry(std::span<const CapacityHypothesis> posterior);

/// Quantile of the capacity.
double capacity_quantile_ah(std::span<const CapacityHypothesis> posterior, double probability);

/// Charge missing where the curve begins, for the median capacity: 0 where that counts as full, else a median.
double estimate_depletion_ah(std::span<const CapacityHypothesis> posterior);

/// 95 % interval of the charge missing from a full pack at `offset_ah` on the curve, with that standard error; not
/// below 0.
Interval depletion_interval_ah(std::span<const CapacityHypothesis> posterior, double offset_ah,
                               double standard_error_ah);

}  // namespace flightwatt::battery
