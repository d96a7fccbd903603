#include "battery/identification/circuit_fit.h"

#include "base/error.h"
#include "base/piecewise_linear.h"
#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

/// What is linear whatever the time constant: the knots' voltages, and the resistance.
Eigen::MatrixXd linear_columns(std::span<const AlignedRecord> records, const std::vector<double>& knots_ah) {
    const auto knots = static_cast<Eigen::Index>(knots_ah.size());
    const auto charge = gathered(records, [](const AlignedRecord& aligned) {
        auto values = aligned.record->charge_ah;
        for (auto& value : values) value += aligned.initial_charge_ah;
        return values;
    });
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(charge.size(), knots + 1);
    for (Eigen::Index row = 0; row < charge.size(); ++row) {
        const auto place = place_among(knots_ah, charge[row]);
        const auto lower = static_cast<Eigen::Index>(place.lower);
        columns(row, lower) = 1.0 - place.fraction;
        columns(row, lower + 1) = place.fraction;
    }
    columns.col(knots) = -gathered(records, [](const AlignedRecord& a) { return a.record->current_a; });
    return columns;
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

/// Least squares once the linear columns are projected out.
class Projection {
  public:
    Projection(std::span<const AlignedRecord> records, const Eigen::MatrixXd& columns, const Eigen::VectorXd& voltage_v)
        : records_(records) {
        const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
        basis_ = qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
        rest_v_ = voltage_v - basis_ * (basis_.transpose() * voltage_v);
    }

    /// How much of the sum of squares an RC pair explains; its resistance is not negative.
    double explained(double log_time_constant) const {
        const auto x = settled(records_, std::exp(log_time_constant));
        const Eigen::VectorXd rest = x - basis_ * (basis_.transpose() * x);
        const double norm = rest.squaredNorm();
        const double product = -rest.dot(rest_v_);
        return product > 0.0 && norm > 1e-12 * x.squaredNorm() ? product * product / norm : 0.0;
    }

    double left() const { return rest_v_.squaredNorm(); }

  private:
    std::span<const AlignedRecord> records_;
    Eigen::MatrixXd basis_;
    Eigen::VectorXd rest_v_;
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

}  // namespace

CircuitFit fit_circuit(std::span<const AlignedRecord> records, const std::vector<double>& knots_ah) {
    auto columns = linear_columns(records, knots_ah);
    const auto voltage_v = gathered(records, [](const AlignedRecord& a) { return a.record->voltage_v; });
    const auto knots = static_cast<Eigen::Index>(knots_ah.size());
    const Projection projection(records, columns, voltage_v);
    const double log_tau = best_time_constant(projection, time_constant_range(records));
    const bool has_rc = std::isfinite(log_tau);
    if (has_rc) {
        columns.conservativeResize(Eigen::NoChange, knots + 2);
        columns.col(knots + 1) = -settled(records, std::exp(log_tau));
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
    if (qr.rank() < columns.cols())
        throw NoAnswerError("the flights do not determine the battery: charge and current vary too little");
    const Eigen::VectorXd solution = qr.solve(voltage_v);
    CircuitFit fit;
    fit.knots_ah = knots_ah;
    fit.open_circuit_v.assign(solution.begin(), solution.begin() + knots);
    fit.resistance_ohm = solution[knots];
    if (has_rc) {
        fit.rc_resistance_ohm = solution[knots + 1];
        fit.rc_time_constant_s = std::exp(log_tau);
    }
    if (!(fit.resistance_ohm > 0.0))
        throw NoAnswerError("the voltage does not fall with the current: no series resistance is seen");
    fit.residual_v = voltage_v - columns * solution;
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

}  // namespace flightwatt::battery
