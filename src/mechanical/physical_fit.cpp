#include "mechanical/physical_fit.h"

#include "base/error.h"
#include "base/statistics.h"
#include "mechanical/physical/term_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/math/special_functions/digamma.hpp>
#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// The posterior as one record: means of coefficients and squared level sds, scaled to the Student's t whose variances
/// have the same mean and variance of their logarithm, for the power of a typical flight.
void summarise(PhysicalModel& model, const PowerPosterior& posterior, const TermValues& typical) {
    const ColumnVector mean = mean_coefficients(posterior);
    const ColumnVector terms = as_columns(typical)(columns_of(model.terms));
    ColumnMatrix covariance = ColumnMatrix::Zero(mean.size(), mean.size());
    double level_variance = 0.0;
    double variance_w2 = 0.0;
    double logarithm = 0.0;
    double logarithm_square = 0.0;
    for (std::size_t n = 0; n < posterior.fits.size(); ++n) {
        const auto& fit = posterior.fits[n];
        const double weight = posterior.weights[n];
        const ColumnVector off = fit.coefficients - mean;
        const ColumnMatrix own = fit.covariance + off * off.transpose();
        const double level = posterior.nodes[n].level_sd;
        const double own_w2 = std::pow(level * fit.coefficients.dot(terms), 2) + terms.dot(own * terms);
        covariance += weight * own;
        level_variance += weight * level * level;
        variance_w2 += weight * own_w2;
        const double own_logarithm = std::log(std::max(own_w2, std::numeric_limits<double>::min()));
        logarithm += weight * own_logarithm;
        logarithm_square += weight * own_logarithm * own_logarithm;
    }
    if (model.flights.size() > 1) {
        constexpr double max_degrees_of_freedom = 200.0;
        // Of nu / chi^2 with nu degrees of freedom the logarithm has the variance trigamma(nu / 2), some 2/nu + 2/nu^2.
        const double spread = std::max(logarithm_square - logarithm * logarithm, 1.0 / max_degrees_of_freedom);
        const double freedom = std::clamp((1.0 + std::sqrt(1.0 + 2.0 * spread)) / spread, 1.0, max_degrees_of_freedom);
        const double scale_w2 = std::exp(logarithm + boost::math::digamma(0.5 * freedom)) / (0.5 * freedom);
        const double scale = variance_w2 > 0.0 ? scale_w2 / variance_w2 : 1.0;
        covariance *= scale;
        model.degrees_of_freedom = freedom;
        model.level_sd = std::sqrt(scale * level_variance);
    }
    for (std::size_t i = 0; i < model.terms.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        model.coefficients[model.terms[i]] = mean[row];
        auto& cells = model.covariance.emplace_back();
        for (Eigen::Index column = 0; column < mean.size(); ++column) cells.push_back(covariance(row, column));
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

void add_value(Interval& range, double value, bool first) {
    range.low = first ? value : std::min(range.low, value);
    range.high = first ? value : std::max(range.high, value);
}

/// The flights, bins and ranges of motion that the model rests on.
void describe_flights(PhysicalModel& model, std::span<const BinnedFlight> flights) {
    std::vector<double> cruise_speeds;
    std::vector<double> cruise_squares;
    std::vector<double> cruise_cubes;
    double duration_s = 0.0;
    model.load.rotors = flights.front().load.rotors;
    if (std::ranges::all_of(flights, &BinnedFlight::payload_known)) model.payload_kg.emplace();
    for (const auto& flight : flights) {
        if (model.payload_kg) add_value(*model.payload_kg, flight.load.payload_kg, model.flights.empty());
        model.load.payload_kg += flight.load.payload_kg / static_cast<double>(flights.size());
        model.flights.push_back(flight.flight);
        double sum = 0.0;
        double squares = 0.0;
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
            squares += bin.airspeed_m_per_s * bin.airspeed_m_per_s * bin.duration_s;
            cubes += bin.values[PowerTerm::drag] * bin.duration_s;
            of_cruise_s += bin.duration_s;
        }
        if (!(of_cruise_s > 0.0)) continue;
        cruise_speeds.push_back(sum / of_cruise_s);
        cruise_squares.push_back(squares / of_cruise_s);
        cruise_cubes.push_back(cubes / of_cruise_s);
    }
    model.bin_s = duration_s / static_cast<double>(model.bins);
    if (cruise_speeds.empty()) return;
    model.mean_airspeed_m_per_s = mean(cruise_speeds);
    model.cubic_mean_airspeed_m_per_s = std::cbrt(mean(cruise_cubes));
    model.airspeed_spread_m_per_s =
        std::sqrt(std::max(0.0, mean(cruise_squares) - std::pow(model.mean_airspeed_m_per_s, 2)));
}

/// From the differences of drift variances between flights: the relative variance of a variance is 2 / v. At most the
/// number of independent intervals less the coefficients.
double drift_degrees_of_freedom(const PhysicalModel& model, const std::vector<double>& variances_w2) {
    const double intervals =
        static_cast<double>(model.bins) * model.bin_s / std::max(2.0 * model.correlation_s, model.bin_s);
    const double max = std::max(1.0, intervals - static_cast<double>(model.terms.size()));
    if (variances_w2.size() < 2 || !(mean(variances_w2) > 0.0)) return max;
    const auto flights = static_cast<double>(variances_w2.size());
    const double relative = sample_variance(variances_w2) / std::pow(mean(variances_w2), 2);
    const double by_chance = 2.0 * flights / max;
    return std::clamp(2.0 / std::max(relative - by_chance, 2.0 / max), std::min(flights - 1.0, max), max);
}

/// What errors of estimated airspeeds add to the covariance of the coefficients, by their changes in the likeliest fit:
/// with the airspeeds of a flight shifted by their common error, and with as much noise again in the bins, which
/// flattens slopes (Fuller, Measurement Error Models, 1987).
ColumnMatrix airspeed_covariance(std::span<const BinnedFlight> flights, const std::vector<int>& columns,
                                 const VarianceGridPoint& node) {
    std::vector<NormalEquations> sums;
    for (const auto& flight : flights) sums.push_back(accumulate_normal_equations(flight.bins, node.correlation_s));
    const auto fit = fit_gls(sums, columns, node.level_sd);
    ColumnMatrix covariance = ColumnMatrix::Zero(std::ssize(columns), std::ssize(columns));
    const auto add_change = [&](const std::vector<NormalEquations>& changed) {
        const auto other = fit_gls(changed, columns, node.level_sd);
        if (!fit || !other) return;
        const ColumnVector change = other->coefficients - fit->coefficients;
        covariance += change * change.transpose();
    };
    auto noisy = sums;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        if (flights[i].airspeed_sd_m_per_s == 0.0) continue;
        auto shifted_bins = flights[i].bins;
        for (auto& bin : shifted_bins) {
            const auto slopes = airspeed_slopes(bin);
            const double correlation = std::exp(-bin.duration_s / node.correlation_s);
            const double of_difference =  // from the bin before, in accumulate_normal_equations()
                (1.0 + correlation * correlation) / (1.0 - correlation * correlation);
            const double noise =
                weight_of_bin(bin.duration_s) * std::pow(flights[i].airspeed_sd_m_per_s, 2) * of_difference;
            noisy[i].products += noise * as_columns(slopes) * as_columns(slopes).transpose();
            for (const auto term : all_power_terms)
                bin.values[term] += flights[i].mean_airspeed_sd_m_per_s * slopes[term];
        }
        auto shifted = sums;
        shifted[i] = accumulate_normal_equations(shifted_bins, node.correlation_s);
        add_change(shifted);
    }
    add_change(noisy);
    return covariance;
}

void add_airspeed_errors(std::span<const BinnedFlight> flights, const VarianceGridPoint& node, PhysicalModel& model) {
    double square = 0.0;
    double estimated = 0.0;
    for (const auto& flight : flights) {
        square += flight.airspeed_sd_m_per_s * flight.airspeed_sd_m_per_s;
        estimated += flight.airspeed_sd_m_per_s > 0.0 ? 1.0 : 0.0;
    }
    if (estimated == 0.0) return;
    model.airspeed_sd_m_per_s = std::sqrt(square / estimated);
    const auto added = airspeed_covariance(flights, columns_of(model.terms), node);
    for (std::size_t i = 0; i < model.terms.size(); ++i)
        for (std::size_t j = 0; j < model.terms.size(); ++j)
            model.covariance[i][j] += added(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
}

PhysicalModel fit_terms(std::span<const BinnedFlight> flights, const PowerRegression& regression,
                        const std::vector<PowerTerm>& terms) {
    PhysicalModel model;
    model.terms = terms;
    std::ranges::sort(model.terms);
    describe_flights(model, flights);
    const auto posterior = regression.posterior(columns_of(model.terms));
    if (!posterior) throw NoResultError("the flights' motion varies too little to determine a power model");
    summarise(model, *posterior, typical_values(flights));
    add_airspeed_errors(flights, posterior->nodes[posterior->likeliest], model);
    model.drift_degrees_of_freedom = drift_degrees_of_freedom(model, posterior->drift_variances_w2);
    return model;
}

/// Drag and induced drag with the model's other terms; std::nullopt where the model contains both, or the flights do
/// not determine them.
std::optional<SpeedTerms> fit_speed_terms(std::span<const BinnedFlight> flights, const PowerRegression& regression,
                                          std::vector<PowerTerm> terms) {
    if (flights.front().is_rotorcraft) return std::nullopt;
    const auto chosen = terms.size();
    for (const auto term : {PowerTerm::drag, PowerTerm::induced})
        if (std::ranges::find(terms, term) == terms.end()) terms.push_back(term);
    if (terms.size() == chosen) return std::nullopt;
    if (!regression.posterior(columns_of(terms))) return std::nullopt;
    const auto model = fit_terms(flights, regression, terms);
    return SpeedTerms{model.terms, model.coefficients, model.covariance, model.degrees_of_freedom};
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
        throw NoResultError("no flight has power and motion to fit" + reasons);
    }
    if (bins < min_bins) {
        throw NoResultError(
            fmt::format("{} intervals of {:.0f} s with power, airspeed and altitude: a physical model "
                        "needs {} or more",
                        bins, default_bin_s, min_bins));
    }
    const PowerRegression regression(moving);
    auto choice = select_terms(moving, regression);
    if (choice.terms.empty())
        throw NoResultError("power follows neither the airspeed's cube nor a constant: check power and airspeed");
    fit.trials = std::move(choice.trials);
    fit.folds = choice.folds;
    fit.folds_are_flights = moving.size() > 1;
    fit.phases_decided = choice.phases_decided;
    fit.model = fit_terms(moving, regression, choice.terms);
    fit.model.speed_terms = fit_speed_terms(moving, regression, choice.terms);
    fit.speeds = speed_to_fly(fit.model);
    return fit;
}

}  // namespace flightwatt::mechanical
