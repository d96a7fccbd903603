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

/// What a regression needs of one flight's bins, their drift taken out: with the drift's correlation R,
/// products = X' R^-1 X and so on, columns in units of column_scale.
struct NormalEquations {
    ColumnMatrix products = ColumnMatrix::Zero(column_count, column_count);
    ColumnVector responses = ColumnVector::Zero(column_count);
    double square = 0.0;
    double log_determinant = 0.0;  ///< of R
    std::size_t bins = 0;
};

/// The typical sizes of the columns, which make them alike.
ColumnVector column_scale();

/// The columns of terms.
std::vector<int> columns_of(const std::vector<PowerTerm>& terms);

/// The columns of one bin, over `scale`.
ColumnVector column_values(const FlightBin& bin, const ColumnVector& scale);

/// Sums over bins whose drift is correlated by exp(-lag / correlation_s); 0: not at all.
NormalEquations accumulate_normal_equations(std::span<const FlightBin> bins, double correlation_s);

/// What the flights' levels and the drift are taken to be.
struct VarianceGridPoint {
    double correlation_s = 0.0;
    double level_sd = 0.0;  ///< as a part of the power
};

struct GlsFit {
    ColumnVector coefficients;  ///< in units of W over column_scale
    ColumnMatrix covariance;
    double drift_variance_w2 = 0.0;
    double log_likelihood = 0.0;  ///< restricted (REML), but for a constant
};

/// Generalised least squares with given variances: flights differ by a factor with sd level_sd, so their covariance is
/// level_sd^2 m m' + drift, m the power that the model expects. std::nullopt where the columns are not determined.
std::optional<GlsFit> fit_gls(std::span<const NormalEquations> flights, const std::vector<int>& columns,
                              double level_sd);

/// All nodes of a grid, with their posterior weights.
struct PowerPosterior {
    std::vector<VarianceGridPoint> nodes;
    std::vector<GlsFit> fits;
    std::vector<double> weights;  ///< sum to 1
    std::size_t likeliest = 0;
    std::vector<double> drift_variances_w2;  ///< of each flight about the likeliest fit at the flight's own level
};

ColumnVector mean_coefficients(const PowerPosterior& posterior);

/// Each flight's sums for every correlation of the grid.
class PowerRegression {
  public:
    explicit PowerRegression(std::span<const BinnedFlight> flights);

    /// Over the grid of drift correlations and level spreads: weight = REML likelihood times prior. A single flight
    /// has no spread. std::nullopt where the columns are not determined.
    std::optional<PowerPosterior> posterior(const std::vector<int>& columns) const;

  private:
    std::vector<std::vector<NormalEquations>> by_correlation_;
    std::size_t flights_ = 0;
};

/// The prior of the spread between flights is half a Student's t of 3 degrees of freedom with this scale: air density,
/// load, and above all a few percent of airspeed sensor, which count three times in its cube, make about a tenth.
inline constexpr double level_prior_scale = 0.1;

/// The mean power of what is still to fly, where its motion is known.
struct PosteriorPower {
    double mean_w = 0.0;          ///< not below 0
    double model_w = 0.0;         ///< what the model says without regard to this flight
    double level = 0.0;           ///< this flight's own level as it was learned: a part of the power
    double parameter_sd_w = 0.0;  ///< of level and coefficients, and
    double parameter_degrees_of_freedom = 1.0;
    double drift_sd_w = 0.0;  ///< of what will drift
    double drift_degrees_of_freedom = 1.0;
};

/// What was flown moves level and coefficients as far as they are uncertain (Bayes' rule for normal errors), and the
/// last drift dies away (docs/methods.md, Power from airspeed and climb), for each motion that may lie ahead (nothing of 0 s).
/// The model has a level spread; bins of `flown` lie before `now_s`, on one clock.
std::vector<PosteriorPower> predict_posterior_power(const PhysicalModel& model, std::span<const FlightBin> flown,
                                                    double now_s, std::span<const MotionAhead> ahead);

}  // namespace flightwatt::mechanical
