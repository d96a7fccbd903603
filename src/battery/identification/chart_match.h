#pragma once

#include "battery/battery.h"
#include "battery/identified_battery.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::battery {

/// The open-circuit voltage that lithium-polymer packs are commonly said to have, a cell: 4.20 V full, 3.84 V half,
/// 3.27 V empty (the voltage chart that sellers of packs print, e.g. blog.ampow.com/lipo-voltage-chart). Packs differ
/// from it by some 80 mV; it stands in only for what no flight has shown.

/// [V] a cell at a state of charge, 0 to 100.
double lipo_chart_voltage_v(double soc_percent);

/// What flights show of a pack's open-circuit voltage, to be laid onto the LiPo chart.
struct ObservedOcv {
    std::vector<double> charge_ah;   ///< from where the curve begins, 0; rising
    std::vector<double> voltage_v;   ///< under load, falling
    Eigen::MatrixXd covariance_v2;   ///< of these voltages
    double resting_charge_ah = 0.0;  ///< of the fullest flight: at this charge
    double resting_voltage_v = 0.0;  ///< it rested at this voltage before
    int cells = 0;
};

/// How packs differ from the chart, a cell, as standard deviations: lipo_chart_sd_v, alike over 40 % of the charge, and
/// 10 mV at each point that is compared. Chen's and Rincon-Mora's curve of a polymer cell (2006) differs from it by 55
/// mV, the two curves of the synthetic packs by 72 and 83 mV; the constants were chosen with these three in view. The
/// 10 mV keep a curve's smoothness from telling the capacity: real curves are smoother than any model of their
/// difference.
inline constexpr double lipo_chart_correlation_percent = 40.0;
inline constexpr double lipo_chart_local_sd_v = 0.01;
inline constexpr double lipo_chart_soc_sd_percent = 4.0;  ///< an error of its charge, which counts where it is steep

/// How probable a capacity is, with a charge missing where the curve begins.
struct CapacityHypothesis {
    double capacity_ah = 0.0;
    double missing_ah = 0.0;
    double probability = 0.0;
    bool is_full = false;  ///< as a charger leaves it: then `missing_ah` is 0 to some percent
};

/// The posterior on a grid, probabilities summing to 1: four points of the curve follow the chart with an error as
/// above, a common one of 30 mV a cell under load, and one of 20 mV at rest. Prior: any part of the charge may have
/// been drawn, from all to a fiftieth (or the capacity is `given_ah`); half of all packs begin full, within 3 % (half a
/// normal distribution), the others 0 to 90 % short. Throws UsageError if the curve exceeds the given capacity by a
/// tenth.
std::vector<CapacityHypothesis> capacity_posterior(const ObservedOcv& shown, std::optional<double> given_ah);

/// Quantile of the capacity.
double capacity_quantile_ah(std::span<const CapacityHypothesis> posterior, double probability);

/// What was probably missing where the curve begins, if the capacity is its median: 0 where that counts as full, else a
/// median.
double estimate_depletion_ah(std::span<const CapacityHypothesis> posterior);

/// 95 % interval of the charge missing from a full pack where it began `offset_ah` behind the curve's beginning, with
/// that standard error; not below 0.
Interval depletion_interval_ah(std::span<const CapacityHypothesis> posterior, double offset_ah,
                               double standard_error_ah);

}  // namespace flightwatt::battery
