#include "battery/identification/circuit_fit.h"

#include "base/error.h"
#include "base/piecewise_linear.h"
#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <boost/math/tools/minima.hpp>

namespace flightwatt::battery {
namespace {

constexpr int grid_points = 48;
constexpr double max_part = 0.25;  // of a record: what is slower looks like the open-circuit voltage

/// A channel of the used samples, one after the other.
template <typename Channel>
Eigen::VectorXd gathered(std::span<const AlignedRecord> records, const Channel& channel) {
    Eigen::Index samples = 0;
    for (const auto& aligned : records) samples += used_sample_count(*aligned.record);
    Eigen::VectorXd values(samples);
    Eigen::Index row = 0;
    for (const auto& aligned : records) {
        const auto& source = channel(aligned);
        for (std::size_t i = 0; i < source.size(); ++i)
            if (aligned.record->used[i]) values[row++] = source[i];
    }
    return values;
}

/// Derivatives by the knots and the resistance, one row a used sample.
Eigen::MatrixXd curve_columns(std::span<const AlignedRecord> records, const std::vector<double>& knots_ah) {
    const auto knots = static_cast<Eigen::Index>(knots_ah.size());
    const auto charge = gathered(records, [](const AlignedRecord& aligned) {
        auto values = aligned.record->charge_ah;
        for (auto& value : values) value += aligned.initial_charge_ah;
        return values;
    });
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(charge.size(), knots + 1);
    for (Eigen::Index row = 0; row < charge.size(); ++row) {
        const auto place = find_knot_interval(knots_ah, charge[row]);
        const auto lower = static_cast<Eigen::Index>(place.lower);
        columns(row, lower) = 1.0 - place.fraction;
        columns(row, lower + 1) = place.fraction;
    }
    columns.col(knots) = -gathered(records, [](const AlignedRecord& a) { return a.record->current_a; });
    return columns;
}

/// What is believed of the curve's bends, as rows of `width` columns that begin with the knots'.
Eigen::MatrixXd bend_rows(Eigen::Index knots, Eigen::Index width, const FitWeights& weights) {
    const double weight = weights.sample_error_v / (slope_change_sd_v * weights.cells);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(std::max<Eigen::Index>(0, knots - 2), width);
    for (Eigen::Index b = 0; b < rows.rows(); ++b) {
        rows(b, b) = weight;
        rows(b, b + 1) = -2.0 * weight;
        rows(b, b + 2) = weight;
    }
    return rows;
}

double common_rest_weight(const FitWeights& weights) {
    return weights.sample_error_v / (common_rest_sd_v * weights.cells);
}

/// Takes the records' own rests out of a least squares. Each stands in its record's rest samples and in one row of what
/// is believed, so one Householder reflection of these leaves it in that row alone; the other rows no longer know it.
class WithoutRests {
  public:
    WithoutRests(std::span<const AlignedRecord> records, const FitWeights& weights) {
        Eigen::Index first = 0;
        for (const auto& [record, initial_ah] : records) {
            Rest rest;
            rest.first = first;
            rest.rows = rest_sample_count(*record);
            rest.believed = weights.sample_error_v / rest_sd_v(*record, weights);
            rest.length = std::hypot(std::sqrt(static_cast<double>(rest.rows)), rest.believed);
            rests_.push_back(rest);
            first += used_sample_count(*record);
        }
    }

    /// Reflects a column of the samples that is `believed` in what is believed, a row a record. Returns those rows.
    Eigen::VectorXd reflect(Eigen::Ref<Eigen::VectorXd> samples, Eigen::VectorXd believed) const {
        for (Eigen::Index f = 0; f < believed.size(); ++f) {
            const auto& rest = at(f);
            const double last = rest.believed + rest.length;  // of the reflection's vector, whose others are 1
            auto part = samples.segment(rest.first, rest.rows);
            const double along =
                2.0 * (part.sum() + last * believed[f]) / (static_cast<double>(rest.rows) + last * last);
            part.array() -= along;
            believed[f] -= along * last;
        }
        return believed;
    }

    /// What is believed of all columns but one: nothing.
    Eigen::VectorXd nothing() const { return Eigen::VectorXd::Zero(std::ssize(rests_)); }

    /// Of the common rest, which stands in no sample.
    Eigen::VectorXd of_common_rest() const {
        Eigen::VectorXd believed(std::ssize(rests_));
        for (Eigen::Index f = 0; f < believed.size(); ++f) believed[f] = -at(f).believed;
        return believed;
    }

    struct Rest {
        Eigen::Index first = 0;  ///< row
        Eigen::Index rows = 0;
        double believed = 0.0;  ///< the rest's factor in the row of what is believed
        double length = 0.0;    ///< of its column
    };
    const Rest& at(Eigen::Index f) const { return rests_[static_cast<std::size_t>(f)]; }

  private:
    std::vector<Rest> rests_;
};

/// The settled currents of the used samples.
Eigen::VectorXd settled(std::span<const AlignedRecord> records, double time_constant_s) {
    return gathered(records, [&](const AlignedRecord& a) { return rc_branch_current_a(*a.record, time_constant_s); });
}

/// The time constants to search, as logarithms.
std::pair<double, double> time_constant_range(std::span<const AlignedRecord> records) {
    double max_s = 0.0;
    std::vector<double> intervals;
    for (const auto& [record, charge] : records) {
        const auto& time_s = record->time_s;
        max_s = std::max(max_s, time_s.back() - time_s.front());
        for (std::size_t i = 1; i < time_s.size(); ++i) intervals.push_back(time_s[i] - time_s[i - 1]);
    }
    const double low_s = 2.0 * median(std::move(intervals));
    return {std::log(low_s), std::log(std::max(2.0 * low_s, max_part * max_s))};
}

/// What is linear whatever the time constant, without the records' own rests: columns of the knots, the resistance, the
/// common rest and, once it is known, the RC pair. Rows of the samples, then of what is believed of all.
struct Reduced {
    Eigen::MatrixXd rows;
    Eigen::VectorXd target;
    Eigen::MatrixXd of_rests;     ///< a row a record, which tells its rest
    Eigen::VectorXd rest_target;  ///< of these
};

Reduced reduced(const WithoutRests& without, const Eigen::MatrixXd& curve, const Eigen::VectorXd& voltage_v,
                const FitWeights& weights, Eigen::Index flights) {
    const auto samples = curve.rows();
    const auto knots = curve.cols() - 1;
    const auto bends = bend_rows(knots, knots + 2, weights);
    Reduced problem{Eigen::MatrixXd::Zero(samples + 1 + bends.rows(), knots + 2),
                    Eigen::VectorXd::Zero(samples + 1 + bends.rows()),
                    Eigen::MatrixXd(flights, knots + 2),
                    {}};
    problem.rows.topLeftCorner(samples, knots + 1) = curve;
    for (Eigen::Index c = 0; c <= knots; ++c)
        problem.of_rests.col(c) = without.reflect(problem.rows.col(c).head(samples), without.nothing());
    problem.of_rests.col(knots + 1) =
        without.reflect(problem.rows.col(knots + 1).head(samples), without.of_common_rest());
    problem.rows(samples, knots + 1) = common_rest_weight(weights);
    problem.rows.bottomRows(bends.rows()) = bends;
    problem.target.head(samples) = voltage_v;
    problem.rest_target = without.reflect(problem.target.head(samples), without.nothing());
    return problem;
}

void add_rc(Reduced& problem, const WithoutRests& without, const Eigen::VectorXd& settled_a) {
    const auto width = problem.rows.cols();
    problem.rows.conservativeResize(Eigen::NoChange, width + 1);
    problem.of_rests.conservativeResize(Eigen::NoChange, width + 1);
    problem.rows.col(width).setZero();
    problem.rows.col(width).head(settled_a.size()) = -settled_a;
    problem.of_rests.col(width) = without.reflect(problem.rows.col(width).head(settled_a.size()), without.nothing());
}

/// Least squares once the linear columns are projected out, through their normal equations.
class Projection {
  public:
    Projection(std::span<const AlignedRecord> records, const WithoutRests& without, const Reduced& problem)
        : records_(records), without_(without), rows_(problem.rows) {
        normal_.compute(rows_.transpose() * rows_);
        const Eigen::VectorXd solution = normal_.solve(rows_.transpose() * problem.target);
        rest_v_ = problem.target - rows_ * solution;
        left_ = rest_v_.squaredNorm();
    }

    /// How much of the sum of squares an RC pair explains; its resistance is not negative.
    double explained(double log_time_constant) const {
        auto x = settled(records_, std::exp(log_time_constant));
        const double own = x.squaredNorm();
        const auto of_rests = without_.reflect(x, without_.nothing());
        const Eigen::VectorXd along = rows_.topRows(x.size()).transpose() * x;
        const double norm = own - of_rests.squaredNorm() - along.dot(normal_.solve(along));
        const double product = -x.dot(rest_v_.head(x.size()));
        return product > 0.0 && norm > 1e-9 * own ? product * product / norm : 0.0;
    }

    double left() const { return left_; }

  private:
    std::span<const AlignedRecord> records_;
    const WithoutRests& without_;
    const Eigen::MatrixXd& rows_;
    Eigen::LDLT<Eigen::MatrixXd> normal_;
    Eigen::VectorXd rest_v_;
    double left_ = 0.0;
};

/// The logarithm of the time constant that explains most; -infinity if none explains anything.
double best_time_constant(const Projection& projection, std::pair<double, double> range) {
    const double step = (range.second - range.first) / (grid_points - 1);
    double best = 0.0;
    double at = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < grid_points; ++i) {
        const double tried = range.first + step * i;
        const double explained = projection.explained(tried);
        if (explained > best) {
            best = explained;
            at = tried;
        }
    }
    if (best <= 1e-9 * projection.left()) return -std::numeric_limits<double>::infinity();
    constexpr int half_the_digits = std::numeric_limits<double>::digits / 2;
    return boost::math::tools::brent_find_minima([&](double x) { return -projection.explained(x); },
                                                 std::max(range.first, at - step), std::min(range.second, at + step),
                                                 half_the_digits)
        .first;
}

Eigen::VectorXd solved(const Reduced& problem) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(problem.rows);
    if (qr.rank() < problem.rows.cols())
        throw NoResultError("the flights do not determine the battery: charge and current vary too little");
    return qr.solve(problem.target);
}

}  // namespace

double rest_sd_v(const DischargeRecord& record, const FitWeights& weights) {
    const double lower_v = std::max(0.0, weights.fullest_rest_v - record.resting_voltage_v);
    return std::hypot(charged_rest_sd_v * weights.cells, lower_rest_fraction * lower_v);
}

FitColumns fit_columns(const CircuitFit& fit) {
    FitColumns columns;
    columns.resistance = static_cast<Eigen::Index>(fit.knots_ah.size());
    columns.rest = columns.resistance + 1;
    columns.common = columns.rest + static_cast<Eigen::Index>(fit.rest_offset_v.size());
    columns.rc = columns.common + 1;
    columns.width = columns.rc + (fit.rc_resistance_ohm > 0.0 ? 2 : 0);
    return columns;
}

CircuitFit fit_circuit(std::span<const AlignedRecord> records, const std::vector<double>& knots_ah,
                       const FitWeights& weights, std::optional<double> rc_time_constant_s) {
    const auto curve = curve_columns(records, knots_ah);
    const auto voltage_v = gathered(records, [](const AlignedRecord& a) { return a.record->voltage_v; });
    const auto knots = static_cast<Eigen::Index>(knots_ah.size());
    const auto flights = static_cast<Eigen::Index>(records.size());
    const WithoutRests without(records, weights);
    auto problem = reduced(without, curve, voltage_v, weights, flights);
    const auto rc = problem.rows.cols();
    double tau_s = rc_time_constant_s.value_or(0.0);
    if (!rc_time_constant_s) {
        const Projection projection(records, without, problem);
        tau_s = std::exp(best_time_constant(projection, time_constant_range(records)));
    }
    Eigen::VectorXd settled_a;
    if (tau_s > 0.0) {
        settled_a = settled(records, tau_s);
        add_rc(problem, without, settled_a);
    }
    const Eigen::VectorXd solution = solved(problem);
    if (tau_s > 0.0 && solution[rc] <= 0.0) return fit_circuit(records, knots_ah, weights, 0.0);
    CircuitFit fit;
    fit.knots_ah = knots_ah;
    fit.open_circuit_v.assign(solution.begin(), solution.begin() + knots);
    fit.resistance_ohm = solution[knots];
    fit.common_rest_offset_v = solution[knots + 1];
    fit.weights = weights;
    fit.residual_v = voltage_v - curve * solution.head(knots + 1);
    if (tau_s > 0.0) {
        fit.rc_resistance_ohm = solution[rc];
        fit.rc_time_constant_s = tau_s;
        fit.residual_v += solution[rc] * settled_a;
    }
    if (!(fit.resistance_ohm > 0.0))
        throw NoResultError("the voltage does not fall with the current: no series resistance is seen");
    const Eigen::VectorXd left = problem.rest_target - problem.of_rests * solution;
    double believed = (problem.rows.bottomRows(problem.rows.rows() - voltage_v.size()) * solution).squaredNorm();
    for (Eigen::Index f = 0; f < flights; ++f) {
        const auto& rest = without.at(f);
        const double rest_v = -left[f] / rest.length;
        fit.rest_offset_v.push_back(rest_v);
        fit.residual_v.segment(rest.first, rest.rows).array() -= rest_v;
        believed += std::pow(rest.believed * (rest_v - fit.common_rest_offset_v), 2);
    }
    fit.objective = fit.residual_v.squaredNorm() + believed;
    fit.rms_v = std::sqrt(fit.residual_v.squaredNorm() / static_cast<double>(fit.residual_v.size()));
    return fit;
}

Eigen::MatrixXd shared_jacobian(std::span<const AlignedRecord> records, const CircuitFit& fit) {
    auto columns = curve_columns(records, fit.knots_ah);
    if (fit.rc_resistance_ohm == 0.0) return columns;
    const auto width = columns.cols();
    columns.conservativeResize(Eigen::NoChange, width + 2);
    const double tau_s = fit.rc_time_constant_s;
    columns.col(width) = -settled(records, tau_s);
    constexpr double step = 1e-4;
    columns.col(width + 1) = -fit.rc_resistance_ohm *
                             (settled(records, tau_s * std::exp(step)) - settled(records, tau_s * std::exp(-step))) /
                             (2.0 * step);
    return columns;
}

Eigen::MatrixXd prior_rows(std::span<const AlignedRecord> records, const CircuitFit& fit) {
    const auto at = fit_columns(fit);
    const auto flights = static_cast<Eigen::Index>(records.size());
    const auto bends = bend_rows(at.resistance, at.width, fit.weights);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(flights + 1 + bends.rows(), at.width);
    for (Eigen::Index f = 0; f < flights; ++f) {
        const double rest_v = rest_sd_v(*records[static_cast<std::size_t>(f)].record, fit.weights);
        rows(f, at.rest + f) = fit.weights.sample_error_v / rest_v;
        rows(f, at.common) = -rows(f, at.rest + f);
    }
    rows(flights, at.common) = common_rest_weight(fit.weights);
    rows.bottomRows(bends.rows()) = bends;
    return rows;
}

Eigen::VectorXd slopes_v_per_ah(const AlignedRecord& aligned, const CircuitFit& fit) {
    const auto& record = *aligned.record;
    Eigen::VectorXd slopes(used_sample_count(record));
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < record.used.size(); ++i) {
        if (!record.used[i]) continue;
        const auto lower = find_knot_interval(fit.knots_ah, record.charge_ah[i] + aligned.initial_charge_ah).lower;
        slopes[row++] = (fit.open_circuit_v[lower + 1] - fit.open_circuit_v[lower]) /
                        (fit.knots_ah[lower + 1] - fit.knots_ah[lower]);
    }
    return slopes;
}

}  // namespace flightwatt::battery
