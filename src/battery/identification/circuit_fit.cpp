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
constexpr double longest_part = 0.25;  // of a record: what is slower looks like the open-circuit voltage

/// A channel of the used samples, one after the other.
template <typename Channel>
Eigen::VectorXd gathered(std::span<const AlignedRecord> records, const Channel& channel) {
    Eigen::Index samples = 0;
    for (const auto& aligned : records) samples += used_samples(*aligned.record);
    Eigen::VectorXd values(samples);
    Eigen::Index row = 0;
    for (const auto& aligned : records) {
        const auto& source = channel(aligned);
        for (std::size_t i = 0; i < source.size(); ++i)
            if (aligned.record->used[i]) values[row++] = source[i];
    }
    return values;
}

/// What is linear whatever the time constant, in the order of FitColumns.
Eigen::MatrixXd linear_columns(std::span<const AlignedRecord> records, const std::vector<double>& knots_ah) {
    const auto knots = static_cast<Eigen::Index>(knots_ah.size());
    const auto charge = gathered(records, [](const AlignedRecord& aligned) {
        auto values = aligned.record->charge_ah;
        for (auto& value : values) value += aligned.initial_charge_ah;
        return values;
    });
    const auto rests = static_cast<Eigen::Index>(records.size());
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(charge.size(), knots + 1 + rests + 1);
    for (Eigen::Index row = 0; row < charge.size(); ++row) {
        const auto place = place_among(knots_ah, charge[row]);
        const auto lower = static_cast<Eigen::Index>(place.lower);
        columns(row, lower) = 1.0 - place.fraction;
        columns(row, lower + 1) = place.fraction;
    }
    columns.col(knots) = -gathered(records, [](const AlignedRecord& a) { return a.record->current_a; });
    Eigen::Index row = 0;
    for (Eigen::Index f = 0; f < rests; ++f) {
        const auto& record = *records[static_cast<std::size_t>(f)].record;
        for (std::size_t i = 0; i < record.used.size(); ++i) {
            if (!record.used[i]) continue;
            if (i < record.rest_samples) columns(row, knots + 1 + f) = 1.0;
            ++row;
        }
    }
    return columns;
}

Eigen::MatrixXd belief(std::span<const AlignedRecord> records, Eigen::Index knots, Eigen::Index width,
                       const FitWeights& weights) {
    const auto weight = [&](double sd) { return weights.sample_error_v / sd; };
    const auto bends = std::max<Eigen::Index>(0, knots - 2);
    const auto flights = static_cast<Eigen::Index>(records.size());
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(flights + 1 + bends, width);
    const auto common = knots + 1 + flights;
    for (Eigen::Index f = 0; f < flights; ++f) {
        const double rest_v = rest_sd_v(*records[static_cast<std::size_t>(f)].record, weights);
        rows(f, knots + 1 + f) = weight(rest_v);
        rows(f, common) = -weight(rest_v);
    }
    rows(flights, common) = weight(common_rest_sd_v * weights.cells);
    for (Eigen::Index b = 0; b < bends; ++b) {
        const auto row = flights + 1 + b;
        rows(row, b) = weight(bend_sd_v * weights.cells);
        rows(row, b + 1) = -2.0 * weight(bend_sd_v * weights.cells);
        rows(row, b + 2) = weight(bend_sd_v * weights.cells);
    }
    return rows;
}

Eigen::VectorXd settled(std::span<const AlignedRecord> records, double time_constant_s) {
    return gathered(records,
                    [&](const AlignedRecord& aligned) { return settled_current_a(*aligned.record, time_constant_s); });
}

/// The time constants to search, as logarithms.
std::pair<double, double> time_constant_range(std::span<const AlignedRecord> records) {
    double longest_s = 0.0;
    std::vector<double> intervals;
    for (const auto& [record, charge] : records) {
        const auto& time_s = record->time_s;
        longest_s = std::max(longest_s, time_s.back() - time_s.front());
        for (std::size_t i = 1; i < time_s.size(); ++i) intervals.push_back(time_s[i] - time_s[i - 1]);
    }
    const double low_s = 2.0 * median(std::move(intervals));
    return {std::log(low_s), std::log(std::max(2.0 * low_s, longest_part * longest_s))};
}

/// Least squares once the linear columns are projected out, through their normal equations.
class Projection {
  public:
    Projection(std::span<const AlignedRecord> records, const Eigen::MatrixXd& columns, const Eigen::MatrixXd& believed,
               const Eigen::VectorXd& voltage_v)
        : records_(records), columns_(columns) {
        normal_.compute(columns.transpose() * columns + believed.transpose() * believed);
        const Eigen::VectorXd solution = normal_.solve(columns.transpose() * voltage_v);
        rest_v_ = voltage_v - columns * solution;
        left_ = rest_v_.squaredNorm() + (believed * solution).squaredNorm();
    }

    /// How much of the sum of squares an RC pair explains; its resistance is not negative.
    double explained(double log_time_constant) const {
        const auto x = settled(records_, std::exp(log_time_constant));
        const Eigen::VectorXd along = columns_.transpose() * x;
        const double norm = x.squaredNorm() - along.dot(normal_.solve(along));
        const double product = -x.dot(rest_v_);
        return product > 0.0 && norm > 1e-9 * x.squaredNorm() ? product * product / norm : 0.0;
    }

    double left() const { return left_; }

  private:
    std::span<const AlignedRecord> records_;
    const Eigen::MatrixXd& columns_;
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

/// Parts of least squares: rows of samples, rows of what is believed.
struct Rows {
    Eigen::MatrixXd columns;
    Eigen::MatrixXd believed;
};

Eigen::VectorXd solved(const Rows& rows, const Eigen::VectorXd& voltage_v) {
    const auto samples = rows.columns.rows();
    Eigen::MatrixXd all(samples + rows.believed.rows(), rows.columns.cols());
    all << rows.columns, rows.believed;
    Eigen::VectorXd target = Eigen::VectorXd::Zero(all.rows());
    target.head(samples) = voltage_v;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(all);
    if (qr.rank() < all.cols())
        throw NoAnswerError("the flights do not determine the battery: charge and current vary too little");
    return qr.solve(target);
}

}  // namespace

double rest_sd_v(const DischargeRecord& record, const FitWeights& weights) {
    const double lower_v = std::max(0.0, weights.fullest_rest_v - record.resting_voltage_v);
    return std::hypot(charged_rest_sd_v * weights.cells, lower_rest_part * lower_v);
}

FitColumns columns_of(const CircuitFit& fit) {
    FitColumns columns;
    columns.resistance = static_cast<Eigen::Index>(fit.knots_ah.size());
    columns.rest = columns.resistance + 1;
    columns.rc = columns.rest + static_cast<Eigen::Index>(fit.rest_offset_v.size()) + 1;
    columns.width = columns.rc + (fit.rc_resistance_ohm > 0.0 ? 2 : 0);
    return columns;
}

CircuitFit fit_circuit(std::span<const AlignedRecord> records, const std::vector<double>& knots_ah,
                       const FitWeights& weights, std::optional<double> rc_time_constant_s) {
    Rows rows{linear_columns(records, knots_ah), {}};
    const auto voltage_v = gathered(records, [](const AlignedRecord& a) { return a.record->voltage_v; });
    const auto knots = static_cast<Eigen::Index>(knots_ah.size());
    const auto flights = static_cast<Eigen::Index>(records.size());
    const auto linear = rows.columns.cols();
    rows.believed = belief(records, knots, linear, weights);
    double tau_s = rc_time_constant_s.value_or(0.0);
    if (!rc_time_constant_s) {
        const Projection projection(records, rows.columns, rows.believed, voltage_v);
        tau_s = std::exp(best_time_constant(projection, time_constant_range(records)));
    }
    if (tau_s > 0.0) {
        rows.columns.conservativeResize(Eigen::NoChange, linear + 1);
        rows.columns.col(linear) = -settled(records, tau_s);
        rows.believed = belief(records, knots, linear + 1, weights);
    }
    const Eigen::VectorXd solution = solved(rows, voltage_v);
    if (tau_s > 0.0 && solution[linear] <= 0.0) return fit_circuit(records, knots_ah, weights, 0.0);
    CircuitFit fit;
    fit.knots_ah = knots_ah;
    fit.open_circuit_v.assign(solution.begin(), solution.begin() + knots);
    fit.resistance_ohm = solution[knots];
    fit.rest_offset_v.assign(solution.begin() + knots + 1, solution.begin() + knots + 1 + flights);
    fit.common_rest_offset_v = solution[knots + 1 + flights];
    fit.weights = weights;
    if (tau_s > 0.0) {
        fit.rc_resistance_ohm = solution[linear];
        fit.rc_time_constant_s = tau_s;
    }
    if (!(fit.resistance_ohm > 0.0))
        throw NoAnswerError("the voltage does not fall with the current: no series resistance is seen");
    fit.residual_v = voltage_v - rows.columns * solution;
    fit.objective = fit.residual_v.squaredNorm() + (rows.believed * solution).squaredNorm();
    fit.rms_v = std::sqrt(fit.residual_v.squaredNorm() / static_cast<double>(fit.residual_v.size()));
    return fit;
}

Eigen::MatrixXd voltage_derivatives(std::span<const AlignedRecord> records, const CircuitFit& fit) {
    auto columns = linear_columns(records, fit.knots_ah);
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

Eigen::MatrixXd believed_rows(std::span<const AlignedRecord> records, const CircuitFit& fit) {
    return belief(records, static_cast<Eigen::Index>(fit.knots_ah.size()), columns_of(fit).width, fit.weights);
}

Eigen::VectorXd slopes_v_per_ah(const AlignedRecord& aligned, const CircuitFit& fit) {
    const auto& record = *aligned.record;
    Eigen::VectorXd slopes(used_samples(record));
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < record.used.size(); ++i) {
        if (!record.used[i]) continue;
        const auto lower = place_among(fit.knots_ah, record.charge_ah[i] + aligned.initial_charge_ah).lower;
        slopes[row++] = (fit.open_circuit_v[lower + 1] - fit.open_circuit_v[lower]) /
                        (fit.knots_ah[lower + 1] - fit.knots_ah[lower]);
    }
    return slopes;
}

}  // namespace flightwatt::battery
