#include "mechanical/physical_fit.h"

#include "base/error.h"
#include "base/statistics.h"
#include "mechanical/physical/student_t.h"
#include "mechanical/physical/term_choice.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// How far the power of a flight with these mean terms (over column_scale) is off, for its level and the coefficients,
/// at each node.
std::vector<double> node_sds_w(const PowerPosterior& posterior, const ColumnVector& mean, const ColumnVector& terms) {
    std::vector<double> sds;
    for (std::size_t i = 0; i < posterior.fits.size(); ++i) {
        const auto& fit = posterior.fits[i];
        const double power_w = fit.coefficients.dot(terms);
        const double level_w = posterior.nodes[i].level_sd * power_w;
        const double off_w = power_w - mean.dot(terms);
        sds.push_back(std::sqrt(level_w * level_w + terms.dot(fit.covariance * terms) + off_w * off_w));
    }
    return sds;
}

double weighted_square(const std::vector<double>& values, const std::vector<double>& weights) {
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += weights[i] * values[i] * values[i];
    return sum;
}

/// The grid's fits as one record: the means of coefficients and squared levels, and one scale and degrees of freedom
/// which make a Student's t of a typical flight's mixture.
void summarise(PhysicalModel& model, const PowerPosterior& posterior, const TermValues& typical) {
    const auto scale = column_scale();
    const auto count = model.terms.size();
    const ColumnVector mean = mean_coefficients(posterior);
    ColumnVector terms(mean.size());
    for (std::size_t i = 0; i < count; ++i)
        terms[static_cast<Eigen::Index>(i)] = typical[model.terms[i]] / scale[static_cast<int>(model.terms[i])];
    double shrink = 1.0;
    if (model.flights.size() > 1) {
        const auto sds_w = node_sds_w(posterior, mean, terms);
        const auto t = fit_student_t(sds_w, posterior.weights);
        shrink = t.scale * t.scale / weighted_square(sds_w, posterior.weights);
        std::vector<double> levels;
        for (const auto& node : posterior.nodes) levels.push_back(node.level_sd);
        model.level_sd = std::sqrt(shrink * weighted_square(levels, posterior.weights));
        model.degrees_of_freedom = t.degrees_of_freedom;
    }
    ColumnMatrix covariance = ColumnMatrix::Zero(mean.size(), mean.size());
    for (std::size_t n = 0; n < posterior.fits.size(); ++n) {
        const ColumnVector off = posterior.fits[n].coefficients - mean;
        covariance += shrink * posterior.weights[n] * (posterior.fits[n].covariance + off * off.transpose());
    }
    model.covariance.assign(count, std::vector<double>(count, 0.0));
    for (std::size_t i = 0; i < count; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const double row_scale = scale[static_cast<int>(model.terms[i])];
        model.coefficients[model.terms[i]] = mean[row] / row_scale;
        for (std::size_t j = 0; j < count; ++j)
            model.covariance[i][j] =
                covariance(row, static_cast<Eigen::Index>(j)) / row_scale / scale[static_cast<int>(model.terms[j])];
    }
    model.correlation_s = posterior.nodes[posterior.likeliest].correlation_s;
    model.drift_sd_w = std::sqrt(posterior.fits[posterior.likeliest].drift_variance_w2);
}

/// Means of the terms over all bins.
TermValues typical_values(std::span<const BinnedFlight> flights) {
    std::vector<FlightBin> bins;
    for (const auto& flight : flights) bins.insert(bins.end(), flight.bins.begin(), flight.bins.end());
    return mean_values(bins);
}

void add_value(FlownRange& range, double value, bool first) {
    range.low = first ? value : std::min(range.low, value);
    range.high = first ? value : std::max(range.high, value);
}

/// What the model rests on.
void describe_flights(PhysicalModel& model, std::span<const BinnedFlight> flights) {
    std::vector<double> cruise_speeds;
    std::vector<double> cruise_cubes;
    double duration_s = 0.0;
    for (const auto& flight : flights) {
        model.flights.push_back(flight.flight);
        double sum = 0.0;
        double cubes = 0.0;
        double of_cruise_s = 0.0;
        for (const auto& bin : flight.bins) {
            add_value(model.airspeed_m_per_s, bin.airspeed_m_per_s, model.bins == 0);
            add_value(model.climb_m_per_s, bin.values[PowerTerm::climb], model.bins == 0);
            ++model.bins;
            model.samples += bin.samples;
            duration_s += bin.duration_s;
            if (bin.phase != flight::Phase::cruise) continue;
            sum += bin.airspeed_m_per_s * bin.duration_s;
            cubes += bin.values[PowerTerm::drag] * bin.duration_s;
            of_cruise_s += bin.duration_s;
        }
        if (!(of_cruise_s > 0.0)) continue;
        cruise_speeds.push_back(sum / of_cruise_s);
        cruise_cubes.push_back(cubes / of_cruise_s);
    }
    model.bin_s = duration_s / static_cast<double>(model.bins);
    if (cruise_speeds.empty()) return;
    model.mean_airspeed_m_per_s = mean(cruise_speeds);
    model.cubic_mean_airspeed_m_per_s = std::cbrt(mean(cruise_cubes));
}

/// A sum of squares of so many normal numbers differs between flights as their drifts' variances do (2 / v is its
/// relative variance): at most the independent stretches of drift, less what the coefficients took.
double drift_degrees_of_freedom(const PhysicalModel& model, const std::vector<double>& variances_w2) {
    const double stretches =
        static_cast<double>(model.bins) * model.bin_s / std::max(2.0 * model.correlation_s, model.bin_s);
    const double most = std::max(1.0, stretches - static_cast<double>(model.terms.size()));
    if (variances_w2.size() < 2 || !(mean(variances_w2) > 0.0)) return most;
    const auto flights = static_cast<double>(variances_w2.size());
    const double relative = sample_variance(variances_w2) / std::pow(mean(variances_w2), 2);
    const double by_chance = 2.0 * flights / most;
    return std::clamp(2.0 / std::max(relative - by_chance, 2.0 / most), std::min(flights - 1.0, most), most);
}

PhysicalModel fit_terms(std::span<const BinnedFlight> flights, const PowerRegression& regression,
                        const std::vector<PowerTerm>& terms) {
    PhysicalModel model;
    model.terms = terms;
    std::ranges::sort(model.terms);
    describe_flights(model, flights);
    const auto posterior = regression.posterior(columns_of(model.terms));
    if (!posterior) throw NoResultError("the flights' motion does not determine a power model: it hardly varies");
    summarise(model, *posterior, typical_values(flights));
    model.drift_degrees_of_freedom = drift_degrees_of_freedom(model, posterior->drift_variances_w2);
    return model;
}

}  // namespace

PhysicalModel fit_power_terms(std::span<const BinnedFlight> flights, const std::vector<PowerTerm>& terms) {
    return fit_terms(flights, PowerRegression(flights), terms);
}

PhysicalFit fit_physical_model(std::span<const BinnedFlight> flights) {
    PhysicalFit fit;
    std::vector<BinnedFlight> moving;
    std::size_t bins = 0;
    for (const auto& flight : flights) {
        if (!flight.no_bins_reason.empty()) {
            fit.skipped.push_back({flight.flight, flight.no_bins_reason});
            continue;
        }
        moving.push_back(flight);
        bins += flight.bins.size();
    }
    if (moving.empty()) {
        std::string reasons;
        for (const auto& [flight, reason] : fit.skipped) reasons += fmt::format("; {}: {}", flight, reason);
        throw NoResultError("no flight tells how its power follows its motion" + reasons);
    }
    constexpr std::size_t min_bins = 10;
    if (bins < min_bins) {
        throw NoResultError(
            fmt::format("{} stretches of {:.0f} s with power, airspeed and altitude: a physical model "
                        "needs {} or more",
                        bins, default_bin_s, min_bins));
    }
    const PowerRegression regression(moving);
    auto choice = select_terms(moving, regression);
    if (choice.terms.empty())
        throw NoResultError("power follows neither the airspeed's cube nor a constant: are power and airspeed sound?");
    fit.trials = std::move(choice.trials);
    fit.folds = choice.folds;
    fit.folds_are_flights = moving.size() > 1;
    fit.phases_decided = choice.phases_decided;
    fit.model = fit_terms(moving, regression, choice.terms);
    return fit;
}

}  // namespace flightwatt::mechanical
