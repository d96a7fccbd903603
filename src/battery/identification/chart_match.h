#pragma once

#include "battery/battery.h"
#include "battery/identified_battery.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::battery {

/// The usual open-circuit voltage of a cell [V] at a state of charge, 0 to 100; it stands in only for what no flight has
/// shown. LiPo: the chart that sellers of packs print (e.g. blog.ampow.com/lipo-voltage-chart). The other two are round
/// numbers of ours: NMC near the LG M50 (Chen et al. 2020), high-voltage LiPo as a LiPo charged to 4.35 V.
double chart_voltage_v(Chemistry chemistry, double soc_percent);

/// A charged cell rests at most at this voltage, other than one of high voltage.
inline constexpr double max_charged_cell_v = 4.25;

/// What flights show of a pack's open-circuit voltage, to be laid onto a chart.
struct ObservedOcv {
    std::vector<double> charge_ah;   ///< from where the curve begins, 0; rising
    std::vector<double> voltage_v;   ///< under load, falling
    Eigen::MatrixXd covariance_v2;   ///< of these voltages
    double resting_charge_ah = 0.0;  ///< of the fullest flight: at this charge
    double resting_voltage_v = 0.0;  ///< it rested at this voltage before
    int cells = 0;
};

/// How packs differ from their chart, a cell, as standard deviations: chart_sd_v, alike over 40 % of the charge, and
/// 10 mV at each point that is compared. Chen's and Rincon-Mora's curve of a polymer cell (2006) differs from LiPo's by
/// 55 mV, the two curves of the synthetic packs by 72 and 83 mV; the constants were chosen with these three in view. The
/// 10 mV keep a curve's smoothness from telling the capacity: real curves are smoother than any model of their
/// difference.
inline constexpr double chart_correlation_percent = 40.0;
inline constexpr double chart_local_sd_v = 0.01;
inline constexpr double chart_soc_sd_percent = 4.0;  ///< an error of its charge, which counts where it is steep

/// Standard deviation [V] of a cell's voltage at a state of charge where it is continued in parallel to the chart from
/// another: near to it packs differ from the chart alike, far from it they do not.
double extrapolation_sd_v(Chemistry chemistry, double soc_percent, double known_percent);

/// How probable a capacity is, with a charge missing where the curve begins.
struct CapacityHypothesis {
    double capacity_ah = 0.0;
    double missing_ah = 0.0;
    double probability = 0.0;
    bool is_full = false;  ///< as a charger leaves it: then `missing_ah` is 0 to some percent
    Chemistry chemistry = Chemistry::lipo;
};

/// The posterior on a grid, probabilities summing to 1: four points of the curve follow one of the charts with an error
/// as above, a common one of 30 mV a cell under load, and one of 20 mV at rest. Prior: 75 % LiPo, 15 % NMC, 10 % of
/// high voltage, or that alone above max_charged_cell_v; any part of the charge may have been drawn, from all to a
/// fiftieth (or the capacity is `given_ah`); half of all packs begin full, within 3 % (half a normal distribution), the
/// others 0 to 90 % short. Throws UsageError if the curve exceeds the given capacity by a tenth.
std::vector<CapacityHypothesis> capacity_posterior(const ObservedOcv& shown, std::optional<double> given_ah);

Chemistry most_probable_chemistry(std::span<const CapacityHypothesis> posterior);

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
