#pragma once

#include "mechanical/flight_bins.h"
#include "mechanical/physical_model.h"

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace flightwatt::mechanical {

/// The columns of a regression: PowerTerm's.
inline constexpr int column_count = static_cast<int>(power_term_count);

using ColumnMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, column_count, column_count>;
using ColumnVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, column_count, 1>;

/// The normal equations of one flight's bins with drift correlation R: products = X' R^-1 X, responses = X' R^-1 y and
/// square = y' R^-1 y.
struct NormalEquations {
    ColumnMatrix products = ColumnMatrix::Zero(column_count, column_count);
    ColumnVector responses = ColumnVector::Zero(column_count);
    double square = 0.0;
    double log_determinant = 0.0;  ///< of R
    std::size_t bins = 0;

    NormalEquations select(const std::vector<int>& columns) const;
    /// The sum of squares of the residuals.
    double square_about(const ColumnVector& coefficients) const;
};

/// The columns of terms.
std::vector<int> columns_of(const std::vector<PowerTerm>& terms);

/// The values of all terms as a vector.
inline Eigen::Map<const Eigen::Vector<double, column_count>> as_columns(const TermValues& values) {
    return Eigen::Map<const Eigen::Vector<double, column_count>>(values.values.data());
}

/// Sums over bins whose drift is correlated by exp(-lag / correlation_s); 0: not at all. Bins shorter than
/// default_bin_s weigh in proportion.
NormalEquations accumulate_normal_equations(std::span<const FlightBin> bins, double correlation_s);

/// Assumed variance of the flights' levels and correlation of the drift.
struct VarianceGridPoint {
    double correlation_s = 0.0;
    double level_sd = 0.0;  ///< relative to the power
};

struct GlsFit {
    ColumnVector coefficients;
    ColumnMatrix covariance;
    double drift_variance_w2 = 0.0;
    double log_likelihood = 0.0;  ///< restricted (REML), but for a constant
};

/// Generalised least squares with given variances: flights differ by a factor with sd level_sd, so their covariance is
/// level_sd^2 m m' + drift, with the expected power m. std::nullopt where the columns are not determined.
std::optional<GlsFit> fit_gls(std::span<const NormalEquations> flights, const std::vector<int>& columns,
                              double level_sd);

/// The fits at all points of a grid, with their posterior weights.
struct PowerPosterior {
    std::vector<VarianceGridPoint> nodes;
    std::vector<GlsFit> fits;
    std::vector<double> weights;  ///< sum to 1
    std::size_t likeliest = 0;
    std::vector<double> drift_variances_w2;  ///< of each flight about the likeliest fit at the flight's own level
};

ColumnVector mean_coefficients(const PowerPosterior& posterior);

/// default_bin_s, or the longest bin of flights that have only much shorter ones.
double usual_bin_s(std::span<const BinnedFlight> flights);

/// The normal equations of each flight for every correlation of the grid.
class PowerRegression {
  public:
    explicit PowerRegression(std::span<const BinnedFlight> flights);

    /// Over the grid of drift correlations and level sds: weight = REML likelihood times prior. A single flight has a
    /// level sd of 0. std::nullopt where the columns are not determined.
    std::optional<PowerPosterior> posterior(const std::vector<int>& columns) const;

  private:
    std::vector<double> correlations_s_;
    std::vector<std::vector<NormalEquations>> by_correlation_;
    std::size_t flights_ = 0;
};

/// The prior of the sd between flights is half a Student's t of 3 degrees of freedom with this scale: air density,
/// load, and above all a few percent of airspeed error, which count three times in its cube, add up to about a tenth.
inline constexpr double level_prior_scale = 0.1;

/// The mean power of a motion ahead.
struct PosteriorPower {
    double mean_w = 0.0;          ///< not below 0
    double model_w = 0.0;         ///< without this flight's measurements
    double level = 0.0;           ///< estimate of this flight's own level, relative to the power
    double parameter_sd_w = 0.0;  ///< of level and coefficients
    double drift_sd_w = 0.0;      ///< of the drift ahead
};

/// For each motion ahead: level and coefficients are updated by the bins flown (Bayes' rule for normal errors), and the
/// last drift decays (docs/methods.md, Power from airspeed and climb). Motions of 0 s have no power. The model has a
/// level sd; the bins of `flown` end before `now_s`, on one clock.
std::vector<PosteriorPower> predict_posterior_power(const PhysicalModel& model, std::span<const FlightBin> flown,
                                                    double now_s, std::span<const MotionAhead> ahead);

}  // namespace flightwatt::mechanical
