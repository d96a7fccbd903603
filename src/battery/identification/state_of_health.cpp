#include "battery/identification/state_of_health.h"

#include "base/piecewise_linear.h"
#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCore>

namespace flightwatt::battery {
namespace {

constexpr double shortest_part_s = 15.0;
constexpr double wanted_parts = 12.0;
constexpr std::size_t enough_parts = 4;
constexpr int max_wear_steps = 12;
// Wide, so that they pull at no flight that tells anything: of the fitted resistance, and of a capacity's logarithm.
constexpr double resistance_sd_fraction = 1.0;
constexpr double log_capacity_sd = 0.3;
constexpr double widest_ratio = 0.15;

/// Where parameters stand: those of all flights, then so many of each flight.
struct Places {
    Eigen::Index knots = 0;
    bool has_rc = false;
    bool has_capacity = false;
    Eigen::Index flights = 0;

    Eigen::Index common_rest() const { return knots; }
    Eigen::Index rc() const { return knots + 1; }
    Eigen::Index common() const { return knots + 1 + (has_rc ? 1 : 0); }
    Eigen::Index own() const { return has_capacity ? 4 : 3; }
    Eigen::Index rest(Eigen::Index f) const { return common() + own() * f; }
    Eigen::Index charge(Eigen::Index f) const { return rest(f) + 1; }
    Eigen::Index resistance(Eigen::Index f) const { return rest(f) + 2; }
    Eigen::Index log_capacity(Eigen::Index f) const { return rest(f) + 3; }
    Eigen::Index width() const { return common() + own() * flights; }

    /// Of one flight's derivatives, among all.
    std::vector<Eigen::Index> columns(Eigen::Index f) const {
        std::vector<Eigen::Index> places(static_cast<std::size_t>(common() + own()));
        std::iota(places.begin(), places.begin() + common(), Eigen::Index{0});
        std::iota(places.begin() + common(), places.end(), rest(f));
        return places;
    }
};

/// All that is fitted, where it stands.
struct HealthFit {
    JointCircuitFit aligned;
    std::vector<double> resistance_ohm;
    std::vector<double> log_capacity;
};

/// Of one flight: derivatives and what is left, at its used samples.
struct FlightRows {
    Eigen::MatrixXd columns;
    Eigen::VectorXd residual_v;
};

FlightRows rows_of(const HealthFit& worn, const Places& places, std::size_t f, const std::vector<double>& settled_a) {
    const auto& [record, initial_ah] = worn.aligned.records[f];
    const auto& fit = worn.aligned.fit;
    const double scale = std::exp(-worn.log_capacity[f]);
    const auto own = places.common();
    FlightRows rows{Eigen::MatrixXd::Zero(used_sample_count(*record), own + places.own()),
                    Eigen::VectorXd(used_sample_count(*record))};
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < record->used.size(); ++i) {
        if (!record->used[i]) continue;
        const double charge_ah = scale * record->charge_ah[i];
        const auto [lower, fraction] = find_knot_interval(fit.knots_ah, initial_ah + charge_ah);
        const double from_v = fit.open_circuit_v[lower];
        const double to_v = fit.open_circuit_v[lower + 1];
        const double slope = (to_v - from_v) / (fit.knots_ah[lower + 1] - fit.knots_ah[lower]);
        const bool rests = i < record->rest_samples;
        auto columns = rows.columns.row(row);
        columns[static_cast<Eigen::Index>(lower)] = 1.0 - fraction;
        columns[static_cast<Eigen::Index>(lower) + 1] = fraction;
        if (places.has_rc) columns[places.rc()] = -settled_a[i];
        if (rests) columns[own] = 1.0;
        if (f != worn.aligned.reference) columns[own + 1] = slope;
        columns[own + 2] = -record->current_a[i];
        if (places.has_capacity) columns[own + 3] = -slope * charge_ah;
        rows.residual_v[row++] = record->voltage_v[i] - std::lerp(from_v, to_v, fraction) +
                                 worn.resistance_ohm[f] * record->current_a[i] + fit.rc_resistance_ohm * settled_a[i] -
                                 (rests ? fit.rest_offset_v[f] : 0.0);
    }
    return rows;
}

/// What is believed: of the common fit (aligned_fit.h), and that flights' resistances and capacities are not absurd.
JointPrior worn_belief(const HealthFit& worn, const Places& places, double fitted_ohm) {
    const auto of_fit = joint_prior(worn.aligned);
    const auto at = fit_columns(worn.aligned.fit);
    const auto first = of_fit.rows.rows();
    const auto each = places.has_capacity ? 2 : 1;
    JointPrior belief;
    belief.rows = Eigen::MatrixXd::Zero(first + each * places.flights + (places.has_capacity ? 1 : 0), places.width());
    belief.residual = Eigen::VectorXd::Zero(belief.rows.rows());
    belief.residual.head(first) = of_fit.residual;
    belief.rows.topLeftCorner(first, places.knots) = of_fit.rows.leftCols(places.knots);
    belief.rows.col(places.common_rest()).head(first) = of_fit.rows.col(at.common);
    const double sample_v = worn.aligned.fit.weights.sample_error_v;
    const double per_ohm = sample_v / (resistance_sd_fraction * fitted_ohm);
    const double per_log = sample_v / log_capacity_sd;
    double sum = 0.0;
    for (Eigen::Index f = 0; f < places.flights; ++f) {
        const auto flight = static_cast<std::size_t>(f);
        belief.rows.col(places.rest(f)).head(first) = of_fit.rows.col(at.rest + f);
        belief.rows.col(places.charge(f)).head(first) = of_fit.rows.col(at.width + f);
        const auto row = first + each * f;
        belief.rows(row, places.resistance(f)) = per_ohm;
        belief.residual[row] = per_ohm * (fitted_ohm - worn.resistance_ohm[flight]);
        if (!places.has_capacity) continue;
        belief.rows(row + 1, places.log_capacity(f)) = per_log;
        belief.residual[row + 1] = -per_log * worn.log_capacity[flight];
        // The curve belongs to the mean flight.
        constexpr double firmly = 1000.0;
        belief.rows(belief.rows.rows() - 1, places.log_capacity(f)) = firmly * per_log;
        sum += worn.log_capacity[flight];
        belief.residual[belief.rows.rows() - 1] = -firmly * per_log * sum;
    }
    return belief;
}

/// A block of one flight's time: its part of the normal equations, in the flight's columns.
struct HealthBlock {
    std::size_t flight = 0;
    Eigen::MatrixXd normal;
    Eigen::VectorXd score;
};

/// The samples where blocks of a flight's time end; they are counted as they are used.
std::vector<Eigen::Index> part_ends(const DischargeRecord& record) {
    const double length_s = record.time_s.back() - record.time_s.front();
    const double part_s = std::max(shortest_part_s, length_s / wanted_parts);
    std::vector<Eigen::Index> ends;
    double end_s = record.time_s.front() + part_s;
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < record.used.size(); ++i) {
        if (!record.used[i]) continue;
        if (record.time_s[i] >= end_s) {
            if (row > (ends.empty() ? 0 : ends.back())) ends.push_back(row);
            end_s += part_s * std::ceil((record.time_s[i] - end_s) / part_s + 1e-9);
        }
        ++row;
    }
    if (row > (ends.empty() ? 0 : ends.back())) ends.push_back(row);
    return ends;
}

/// The normal equations at a fit.
struct HealthProblem {
    std::vector<HealthBlock> parts;
    Eigen::MatrixXd normal;
    Eigen::VectorXd pull;
    double objective = 0.0;  ///< sum of squares [V^2], with what is believed
};

HealthProblem problem_of(const HealthFit& worn, const Places& places, const std::vector<std::vector<double>>& settled_a,
                         double fitted_ohm) {
    const auto belief = worn_belief(worn, places, fitted_ohm);
    HealthProblem problem;
    const Eigen::SparseMatrix<double> believed = belief.rows.sparseView();
    problem.normal = believed.transpose() * believed;
    problem.pull = belief.rows.transpose() * belief.residual;
    problem.objective = belief.residual.squaredNorm();
    for (std::size_t f = 0; f < worn.aligned.records.size(); ++f) {
        const auto rows = rows_of(worn, places, f, settled_a[f]);
        const auto columns = places.columns(static_cast<Eigen::Index>(f));
        problem.objective += rows.residual_v.squaredNorm();
        Eigen::Index first = 0;
        for (const auto end : part_ends(*worn.aligned.records[f].record)) {
            const auto of_part = rows.columns.middleRows(first, end - first);
            HealthBlock part{f, of_part.transpose() * of_part,
                             of_part.transpose() * rows.residual_v.segment(first, end - first)};
            problem.normal(columns, columns) += part.normal;
            problem.pull(columns) += part.score;
            problem.parts.push_back(std::move(part));
            first = end;
        }
    }
    return problem;
}

/// The inverse of the normal matrix times this, each parameter scaled to length 1 first: what nothing tells moves
/// nothing.
Eigen::MatrixXd solved(const Eigen::MatrixXd& normal, const Eigen::MatrixXd& right) {
    const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
    Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
    constexpr double ridge = 1e-10;
    scaled.diagonal().array() += ridge;
    return scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * right);
}

HealthFit moved(HealthFit worn, const Places& places, const Eigen::VectorXd& step) {
    auto& fit = worn.aligned.fit;
    for (Eigen::Index k = 0; k < places.knots; ++k) fit.open_circuit_v[static_cast<std::size_t>(k)] += step[k];
    fit.common_rest_offset_v += step[places.common_rest()];
    if (places.has_rc) fit.rc_resistance_ohm += step[places.rc()];
    for (Eigen::Index f = 0; f < places.flights; ++f) {
        const auto flight = static_cast<std::size_t>(f);
        fit.rest_offset_v[flight] += step[places.rest(f)];
        if (flight != worn.aligned.reference) worn.aligned.records[flight].initial_charge_ah += step[places.charge(f)];
        worn.resistance_ohm[flight] += step[places.resistance(f)];
        if (places.has_capacity) worn.log_capacity[flight] += step[places.log_capacity(f)];
    }
    return worn;
}

/// Gauss-Newton steps until they no longer help; the problem where they end.
std::pair<HealthFit, HealthProblem> fitted_wear(HealthFit worn, const Places& places,
                                                const std::vector<std::vector<double>>& settled_a) {
    const double fitted_ohm = worn.resistance_ohm.front();
    auto problem = problem_of(worn, places, settled_a, fitted_ohm);
    for (int i = 0; i < max_wear_steps; ++i) {
        Eigen::VectorXd step = solved(problem.normal, problem.pull);
        bool helps = false;
        double gained = 0.0;
        for (int halved = 0; halved < 4 && !helps; ++halved, step /= 2.0) {
            auto tried = moved(worn, places, step);
            auto there = problem_of(tried, places, settled_a, fitted_ohm);
            if (!(there.objective < problem.objective)) continue;
            helps = true;
            gained = 1.0 - there.objective / problem.objective;
            worn = std::move(tried);
            problem = std::move(there);
        }
        constexpr double little = 1e-7;
        if (!helps || gained < little) break;
    }
    return {std::move(worn), std::move(problem)};
}

/// Standard errors of all parameters by the jackknife over the parts, but not less than those of independent samples.
Eigen::VectorXd standard_errors(const HealthProblem& problem, const Places& places, double sample_error_v) {
    const Eigen::MatrixXd inverse = solved(problem.normal, Eigen::MatrixXd::Identity(places.width(), places.width()));
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(places.width());
    for (const auto& part : problem.parts) {
        const auto columns = places.columns(static_cast<Eigen::Index>(part.flight));
        const Eigen::MatrixXd own = inverse(columns, columns);
        // (N - P)^-1 s with the inverse of N alone, as P has the flight's columns only (Woodbury).
        const Eigen::MatrixXd without = Eigen::MatrixXd::Identity(own.rows(), own.cols()) - part.normal * own;
        const Eigen::VectorXd change = inverse(Eigen::all, columns) * without.partialPivLu().solve(part.score);
        squares += change.cwiseAbs2();
    }
    const auto count = static_cast<double>(problem.parts.size());
    squares *= (count - 1.0) / count;
    return squares.cwiseMax(inverse.diagonal().cwiseMax(0.0) * sample_error_v * sample_error_v).cwiseSqrt();
}

/// What the flight's samples under load say of current and charge alone.
struct FlightLoad {
    double charge_ah_per_ohm = 0.0;
    bool tells_resistance = false;
};

FlightLoad load_of(const FlightRows& rows, const Places& places, Eigen::Index rest_rows) {
    const auto under_load = rows.columns.bottomRows(rows.columns.rows() - rest_rows);
    // The reference has no derivative by its initial charge: the slope of the curve is taken from its knots.
    const Eigen::VectorXd current = under_load.col(places.common() + 2);
    const Eigen::VectorXd slope = under_load.col(places.common() + 1);
    const double squares = slope.squaredNorm();
    const double products = slope.dot(current);
    if (squares == 0.0) return {0.0, current.size() > 1};
    constexpr double nearly_one = 1.0 - 1e-6;
    return {-products / squares, products * products < nearly_one * squares * current.squaredNorm()};
}

/// The error of a capacity's logarithm by what no model follows: a voltage beside the curve by as much as charged packs
/// rest beside it, over the voltage that the flight falls by on the curve.
double unlike_others(const HealthFit& worn, std::size_t f) {
    const auto& [record, initial_ah] = worn.aligned.records[f];
    const auto& fit = worn.aligned.fit;
    const auto voltage_v = [&](double at_ah) { return interpolate_extended(fit.knots_ah, fit.open_circuit_v, at_ah); };
    const double drawn_ah = std::exp(-worn.log_capacity[f]) * record->charge_ah.back();
    const double fall_v = voltage_v(initial_ah) - voltage_v(initial_ah + drawn_ah);
    constexpr double min_v = 1e-3;
    return charged_rest_sd_v * fit.weights.cells / std::max(min_v, fall_v);
}

}  // namespace

double resistance_scatter_ohm(std::span<const std::optional<FlightResistance>> resistances, double fitted_ohm) {
    std::vector<double> values_ohm;
    double error_ohm2 = 0.0;
    for (const auto& own : resistances) {
        if (!own) continue;
        values_ohm.push_back(own->value_ohm);
        error_ohm2 += std::pow(own->standard_error_ohm, 2);
    }
    double sum_ohm2 = std::pow(default_scatter_fraction * fitted_ohm, 2);
    if (values_ohm.size() < 2) return std::sqrt(sum_ohm2);
    const auto n = static_cast<double>(values_ohm.size());
    sum_ohm2 += (n - 1.0) * std::max(0.0, sample_variance(values_ohm) - error_ohm2 / n);
    return std::sqrt(sum_ohm2 / n);
}

std::optional<ResistanceScatter> resistance_scatter(std::span<const std::optional<FlightResistance>> resistances,
                                                    double fitted_ohm) {
    const auto flights =
        static_cast<std::size_t>(std::ranges::count_if(resistances, [](const auto& own) { return own.has_value(); }));
    if (flights < 2) return std::nullopt;
    return ResistanceScatter{resistance_scatter_ohm(resistances, fitted_ohm), flights};
}

std::optional<ResistanceTrend> resistance_trend(std::span<const std::optional<FlightResistance>> in_order) {
    std::vector<double> number;
    std::vector<double> value_ohm;
    for (std::size_t i = 0; i < in_order.size(); ++i) {
        if (!in_order[i]) continue;
        number.push_back(static_cast<double>(i));
        value_ohm.push_back(in_order[i]->value_ohm);
    }
    constexpr std::size_t min_flights = 3;
    if (number.size() < min_flights) return std::nullopt;
    const double middle = mean(number);
    const double level_ohm = mean(value_ohm);
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = 0; i < number.size(); ++i) {
        squares += std::pow(number[i] - middle, 2);
        products += (number[i] - middle) * (value_ohm[i] - level_ohm);
    }
    ResistanceTrend trend{number.size(), products / squares, {}};
    double left = 0.0;
    for (std::size_t i = 0; i < number.size(); ++i)
        left += std::pow(value_ohm[i] - level_ohm - trend.ohm_per_flight * (number[i] - middle), 2);
    const double degrees_of_freedom = static_cast<double>(number.size()) - 2.0;
    const double half = student_t_half_width(degrees_of_freedom) * std::sqrt(left / degrees_of_freedom / squares);
    trend.interval_ohm_a_flight = {trend.ohm_per_flight - half, trend.ohm_per_flight + half};
    return trend;
}

std::vector<FlightHealth> estimate_state_of_health(const JointCircuitFit& aligned, bool with_capacity) {
    const auto flights = aligned.records.size();
    const Places places{static_cast<Eigen::Index>(aligned.fit.knots_ah.size()), aligned.fit.rc_resistance_ohm > 0.0,
                        with_capacity && flights > 1, static_cast<Eigen::Index>(flights)};
    std::vector<std::vector<double>> settled_a;
    for (const auto& [record, initial_ah] : aligned.records)
        settled_a.push_back(places.has_rc ? rc_branch_current_a(*record, aligned.fit.rc_time_constant_s)
                                          : std::vector<double>(record->time_s.size(), 0.0));
    const auto [worn, problem] = fitted_wear(
        {aligned, std::vector<double>(flights, aligned.fit.resistance_ohm), std::vector<double>(flights, 0.0)}, places,
        settled_a);
    const auto errors = standard_errors(problem, places, aligned.fit.weights.sample_error_v);
    auto as_others = worn;  // with a slope by its initial charge for the reference too
    as_others.aligned.reference = flights;
    std::vector<FlightHealth> wear(flights);
    for (std::size_t f = 0; f < flights; ++f) {
        const auto& record = *aligned.records[f].record;
        const auto load = load_of(rows_of(as_others, places, f, settled_a[f]), places, rest_sample_count(record));
        const auto parts = part_ends(record).size();
        if (parts < enough_parts || !load.tells_resistance) continue;
        const auto at = static_cast<Eigen::Index>(f);
        const double degrees_of_freedom = static_cast<double>(parts) - static_cast<double>(places.own() - 1);
        const double t = student_t_half_width(std::max(1.0, degrees_of_freedom));
        FlightResistance found;
        found.value_ohm = worn.resistance_ohm[f];
        found.standard_error_ohm = errors[places.resistance(at)];
        found.degrees_of_freedom = std::max(1.0, degrees_of_freedom);
        found.charge_ah_per_ohm = load.charge_ah_per_ohm;
        const double half_ohm = t * found.standard_error_ohm;
        found.interval_ohm = {std::max(0.0, found.value_ohm - half_ohm), found.value_ohm + half_ohm};
        if (std::isfinite(half_ohm) && found.value_ohm > 0.0) wear[f].resistance = found;
        if (!places.has_capacity) continue;
        const double half_log = t * std::hypot(errors[places.log_capacity(at)], unlike_others(worn, f));
        const double ratio = std::exp(worn.log_capacity[f]);
        if (half_log <= std::log1p(widest_ratio))
            wear[f].capacity = FlightCapacity{ratio, {ratio * std::exp(-half_log), ratio * std::exp(half_log)}};
    }
    return wear;
}

}  // namespace flightwatt::battery
