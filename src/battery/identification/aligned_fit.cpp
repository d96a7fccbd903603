#include "base/error.h"
#include "base/piecewise_linear.h"
#include "base/statistics.h"
#include "battery/identification/circuit_problem.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include <boost/math/tools/minima.hpp>

namespace flightwatt::battery {
namespace {

constexpr int max_segments = 6;
constexpr double min_segment_samples = 20.0;
constexpr double straight_cell_v = 0.01;  // a cell; a curve with smaller deviations has one segment
constexpr int time_constants_tried = 12;
/// The circuit is fitted again when an eighth more records are aligned, so that the cost is linear in them.
constexpr std::size_t growth_between_fits = 8;
constexpr double max_record_fraction = 0.25;  // a slower RC pair resembles the open-circuit voltage

/// Whether all knots are near the straight line between the first and the last one.
bool is_straight(const CircuitFit& fit) {
    const auto& curve_v = fit.open_circuit_v;
    double max_v = 0.0;
    for (std::size_t k = 0; k < curve_v.size(); ++k) {
        const double fraction = static_cast<double>(k) / static_cast<double>(curve_v.size() - 1);
        max_v = std::max(max_v, std::abs(curve_v[k] - std::lerp(curve_v.front(), curve_v.back(), fraction)));
    }
    return max_v < straight_cell_v * fit.weights.cells;
}

/// All free but capacities; of several flights each has a resistance of its own, as packs are cold or warm.
FreeParameters each_own(const JointCircuitFit& joint) { return {true, true, joint.records.size() > 1, false}; }

bool falls_throughout(const CircuitFit& fit) {
    return std::ranges::adjacent_find(fit.open_circuit_v, std::less<>()) == fit.open_circuit_v.end();
}

/// Sums over all records' residuals.
struct ResidualSums {
    double squares = 0.0;
    double products = 0.0;  ///< of neighbours
    double count = 0.0;
};

ResidualSums residual_sums(const JointCircuitFit& joint) {
    ResidualSums sums;
    for (std::size_t r = 0; r < joint.records.size(); ++r) {
        const auto residual = residual_v(joint, r);
        const auto n = residual.size();
        if (n > 1) sums.products += residual.head(n - 1).dot(residual.tail(n - 1));
        sums.squares += residual.squaredNorm();
        sums.count += static_cast<double>(n);
    }
    return sums;
}

/// The standard deviation of one sample as if samples were independent: neighbouring residuals are correlated.
double effective_error_v(const JointCircuitFit& joint) {
    const auto [squares, products, count] = residual_sums(joint);
    constexpr double max_correlation = 0.99;
    const double r = squares > 0.0 ? std::clamp(products / squares, 0.0, max_correlation) : 0.0;
    constexpr double min_v = 1e-6;
    return std::max(min_v, std::sqrt(squares / count * (1.0 + r) / (1.0 - r)));
}

/// The minimum of a function between two values: by a grid, then by Brent's method around its lowest point.
template <typename Function>
double grid_minimum(const Function& function, double low, double high) {
    constexpr int points = 50;
    const double step = (high - low) / points;
    double at = low;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= points; ++i) {
        const double value = function(low + step * i);
        if (value >= least) continue;
        least = value;
        at = low + step * i;
    }
    constexpr int half_the_digits = std::numeric_limits<double>::digits / 2;
    const auto [minimum_at, value] = boost::math::tools::brent_find_minima(function, std::max(low, at - step),
                                                                           std::min(high, at + step), half_the_digits);
    return value < least ? minimum_at : at;
}

/// The initial charge with which the last record's voltage under load fits the curve best.
double best_initial_charge_ah(JointCircuitFit joint) {
    const auto last = joint.records.size() - 1;
    auto& aligned = joint.records[last];
    const auto loaded = used_sample_count(*aligned.record) - rest_sample_count(*aligned.record);
    const double beyond_ah = 0.1 * (joint.fit.knots_ah.back() - joint.fit.knots_ah.front());
    const auto misfit = [&](double tried_ah) {
        aligned.initial_charge_ah = tried_ah;
        return residual_v(joint, last).tail(loaded).squaredNorm();
    };
    return grid_minimum(misfit, joint.fit.knots_ah.front() - beyond_ah, joint.fit.knots_ah.back() + beyond_ah);
}

/// Searches for the time constant, in which the least squares have several minima: given it and the initial charges,
/// all else is linear. There is no RC pair where none explains anything.
void search_time_constant(JointCircuitFit& joint) {
    double max_s = 0.0;
    std::vector<double> intervals_s;
    for (const auto& aligned : joint.records) {
        const auto& time_s = aligned.record->time_s;
        max_s = std::max(max_s, time_s.back() - time_s.front());
        for (std::size_t i = 1; i < time_s.size(); ++i) intervals_s.push_back(time_s[i] - time_s[i - 1]);
    }
    const double low_s = 2.0 * median(std::move(intervals_s));
    const double factor = std::max(2.0, max_record_fraction * max_s / low_s);
    joint.time_constants_s = {low_s, low_s * factor};
    constexpr double explains = 1.0 - 1e-9;
    double least = explains * least_squares(joint, linear_only).objective;
    auto best = joint;
    for (int i = 0; i < time_constants_tried; ++i) {
        auto tried = joint;
        constexpr double begin_ohm = 1e-3;
        tried.fit.rc_resistance_ohm = begin_ohm;
        tried.fit.rc_time_constant_s = low_s * std::pow(factor, static_cast<double>(i) / (time_constants_tried - 1));
        const auto problem = normal_equations(tried, linear_only);
        const auto step = step_of(problem);
        const double objective = problem.objective + step.objective_change;
        const auto knots = std::ssize(tried.fit.open_circuit_v);
        const double fall_v = tried.fit.open_circuit_v.front() + step.common[0] - tried.fit.open_circuit_v.back() -
                              step.common[knots - 1];
        // A slow RC pair and a curve that rises may resemble a curve that falls.
        if (begin_ohm + step.common[knots + rc_column] <= 0.0 || fall_v < 0.0 || objective >= least) continue;
        least = objective;
        best = std::move(tried);
    }
    joint = std::move(best);
    least_squares(joint, linear_only);
}

/// The records in the order of their packs' initial charge.
std::vector<std::size_t> fullest_first(std::span<const DischargeRecord> records) {
    std::vector<std::size_t> order(records.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return records[i].resting_voltage_v; });
    return order;
}

/// Initial charges of records that are aligned one by one, the fullest first.
std::vector<double> aligned_one_by_one(std::span<const DischargeRecord> records, const FitWeights& weights) {
    JointCircuitFit growing;
    growing.fit.weights = weights;
    std::vector<double> initial_ah(records.size(), 0.0);
    std::size_t next_fit = 0;
    for (const auto at : fullest_first(records)) {
        auto& aligned = growing.records.emplace_back(AlignedRecord{&records[at], 0.0, 0.0, 0.0, 0.0});
        aligned.resistance_ohm = growing.fit.resistance_ohm;
        if (growing.records.size() > 1) aligned.initial_charge_ah = best_initial_charge_ah(growing);
        initial_ah[at] = aligned.initial_charge_ah;
        place_knots(growing, max_segments);
        const auto count = growing.records.size();
        // The time constant is searched for again at every doubling; in between it is known well enough.
        if (std::has_single_bit(count))
            search_time_constant(growing);
        else if (count >= next_fit)
            least_squares(growing, linear_only);
        else
            continue;
        next_fit = count + (count + growth_between_fits - 1) / growth_between_fits;
    }
    return initial_ah;
}

/// Moves all so that the curve begins at charge 0.
void begin_at_zero(JointCircuitFit& joint) {
    const double low_ah = joint.fit.knots_ah.front();
    for (auto& knot : joint.fit.knots_ah) knot -= low_ah;
    for (auto& aligned : joint.records) aligned.initial_charge_ah -= low_ah;
}

/// The last fit, with so many segments, or fewer where the curve would rise.
JointCircuitFit fit_falling_curve(const JointCircuitFit& rough, int segments, bool with_search) {
    double samples = 0.0;
    for (const auto& aligned : rough.records) samples += static_cast<double>(used_sample_count(*aligned.record));
    for (; segments > 0; --segments) {
        if (segments > 1 && samples < min_segment_samples * segments) continue;
        auto joint = rough;
        place_knots(joint, segments);
        if (with_search) search_time_constant(joint);
        least_squares(joint, each_own(joint));
        if (!(joint.fit.resistance_ohm > 0.0)) {  // noise hides it from a fast RC pair: one resistance for both
            joint = rough;
            joint.fit.rc_resistance_ohm = joint.fit.rc_time_constant_s = 0.0;
            place_knots(joint, segments);
            least_squares(joint, linear_only);
        }
        if (!(joint.fit.resistance_ohm > 0.0))
            throw NoResultError("the voltage does not fall as current rises: no series resistance can be identified");
        if (!falls_throughout(joint.fit)) continue;
        begin_at_zero(joint);
        const auto sums = residual_sums(joint);
        joint.fit.rms_v = std::sqrt(sums.squares / sums.count);
        return joint;
    }
    throw NoResultError("the open-circuit voltage does not fall as charge is drawn");
}

}  // namespace

JointCircuitFit fit_circuit_jointly(std::span<const DischargeRecord> records, int cells) {
    JointCircuitFit rough;
    rough.reference = fullest_first(records).front();
    rough.fit.weights.cells = cells;
    rough.fit.weights.fullest_rest_v = records[rough.reference].resting_voltage_v;
    const auto initial_ah = aligned_one_by_one(records, rough.fit.weights);
    for (std::size_t r = 0; r < records.size(); ++r)
        rough.records.push_back({&records[r], initial_ah[r], 0.0, 0.0, 0.0});
    place_knots(rough, max_segments);
    search_time_constant(rough);
    rough.fit.weights.sample_error_v = effective_error_v(rough);
    least_squares(rough, each_own(rough));
    rough.fit.weights.sample_error_v = effective_error_v(rough);
    return fit_falling_curve(rough, is_straight(rough.fit) ? 1 : max_segments, true);
}

JointCircuitFit fit_without(const JointCircuitFit& joint, std::span<const std::size_t> excluded) {
    auto others = joint;
    others.records.clear();
    for (std::size_t r = 0; r < joint.records.size(); ++r)
        if (!std::ranges::binary_search(excluded, r)) others.records.push_back(joint.records[r]);
    const auto rest_v = [](const AlignedRecord& aligned) { return aligned.record->resting_voltage_v; };
    const auto fullest = std::ranges::max_element(others.records, {}, rest_v);
    others.reference = static_cast<std::size_t>(fullest - others.records.begin());
    others.fit.weights.fullest_rest_v = rest_v(*fullest);
    return fit_falling_curve(others, static_cast<int>(joint.fit.knots_ah.size()) - 1, false);
}

}  // namespace flightwatt::battery
