#include "battery/identification/aligned_fit.h"

#include "base/error.h"
#include "base/piecewise_linear.h"
#include "base/units.h"
#include "flight/flight_identity.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>

namespace flightwatt::battery {
namespace {

constexpr int first_segments = 6;
constexpr int max_steps = 15;
constexpr int places_tried = 80;

constexpr double tied_ah = 0.001;  // the counter is believed before a voltage whose slow relaxation no circuit follows
constexpr double max_pause_s = 6.0 * units::seconds_per_hour;
constexpr double counter_error = 0.02;
constexpr double min_error_ah = 0.005;
constexpr double counted_ah = 0.01;         // a counter that begins above did not begin anew
constexpr double unreadable_cell_v = 0.01;  // a cell; a smaller fall tells nothing
constexpr double max_deviations = 2.5;      // of a resting voltage

/// From the last sample of one record to the first of another; negative if that one began before.
std::optional<double> pause_s(const DischargeRecord& earlier, const DischargeRecord& later) {
    const double length_s = earlier.time_s.back() - earlier.time_s.front();
    if (earlier.start_clock_s && later.start_clock_s) return *later.start_clock_s - *earlier.start_clock_s - length_s;
    const auto from = flight::start_in_name(earlier.flight);
    const auto to = flight::start_in_name(later.flight);
    if (!from || !to) return std::nullopt;
    const auto seconds = [](auto time) { return std::chrono::duration<double>(time.time_since_epoch()).count(); };
    return seconds(*to) + later.time_s.front() - seconds(*from) - earlier.time_s.back();
}

bool is_fallen_as_drawn(const DischargeRecord& later, const AlignedRecord& earlier, const CircuitFit& fit) {
    const double from_ah = earlier.initial_charge_ah;
    const double to_ah = from_ah + earlier.record->charge_ah.back();
    const double drawn_v = interpolate_clamped(fit.knots_ah, fit.open_circuit_v, from_ah) -
                           interpolate_clamped(fit.knots_ah, fit.open_circuit_v, to_ah);
    const double fallen_v = earlier.record->resting_voltage_v - later.resting_voltage_v;
    const double readable_v = std::max(unreadable_cell_v * fit.weights.cells, later.resolution_v);
    const double reach_v =
        max_deviations * std::hypot(charged_rest_sd_v * fit.weights.cells, lower_rest_fraction * drawn_v);
    return drawn_v > 2.0 * readable_v && fallen_v > drawn_v / 2.0 && fallen_v < drawn_v + reach_v;
}

bool falls_throughout(const CircuitFit& fit) {
    return std::ranges::adjacent_find(fit.open_circuit_v, std::less<>()) == fit.open_circuit_v.end();
}

/// What a sample counts for: residuals that follow each other are alike.
double effective_error_v(std::span<const AlignedRecord> records, const Eigen::VectorXd& residual_v) {
    double product = 0.0;
    double squares = 0.0;
    Eigen::Index row = 0;
    for (const auto& aligned : records) {
        const auto n = used_sample_count(*aligned.record);
        const auto part = residual_v.segment(row, n);
        if (n > 1) product += part.head(n - 1).dot(part.tail(n - 1));
        squares += part.squaredNorm();
        row += n;
    }
    constexpr double max_alike = 0.99;
    const double r = squares > 0.0 ? std::clamp(product / squares, 0.0, max_alike) : 0.0;
    constexpr double min_v = 1e-6;
    return std::max(min_v, std::sqrt(squares / static_cast<double>(residual_v.size()) * (1.0 + r) / (1.0 - r)));
}

/// Mean square of what is left of a record's voltage if it begins at `initial_ah` of the curve.
double misfit_v2(const DischargeRecord& record, const CircuitFit& fit, double initial_ah) {
    const auto settled_a = fit.rc_resistance_ohm > 0.0 ? rc_branch_current_a(record, fit.rc_time_constant_s)
                                                       : std::vector<double>(record.time_s.size(), 0.0);
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t i = record.rest_samples; i < record.used.size(); ++i) {
        if (!record.used[i]) continue;
        const double source_v =
            interpolate_extended(fit.knots_ah, fit.open_circuit_v, initial_ah + record.charge_ah[i]);
        const double left_v = record.voltage_v[i] - source_v + fit.resistance_ohm * record.current_a[i] +
                              fit.rc_resistance_ohm * settled_a[i];
        squares += left_v * left_v;
        count += 1.0;
    }
    return squares / std::max(1.0, count);
}

/// Where on the curve a record lies best.
double best_place_ah(const DischargeRecord& record, const CircuitFit& fit) {
    const double length_ah = fit.knots_ah.back() - fit.knots_ah.front();
    double best_ah = 0.0;
    double min_v2 = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= places_tried; ++i) {
        const double tried_ah = fit.knots_ah.front() + length_ah * (1.2 * i / places_tried - 0.1);
        const double left_v2 = misfit_v2(record, fit, tried_ah);
        if (left_v2 >= min_v2) continue;
        min_v2 = left_v2;
        best_ah = tried_ah;
    }
    return best_ah;
}

/// The sum of squares that the joint fit makes least.
double objective_of(const JointCircuitFit& aligned) {
    double sum = aligned.fit.objective;
    const double sample_v = aligned.fit.weights.sample_error_v;
    for (std::size_t f = 0; f < aligned.links.size(); ++f) {
        const auto& link = aligned.links[f];
        if (!link) continue;
        const double apart_ah =
            aligned.records[f].initial_charge_ah - aligned.records[link->earlier].initial_charge_ah - link->charge_ah;
        sum += std::pow(sample_v * apart_ah / tied_ah, 2);
    }
    return sum;
}

/// The fit anew, at the initial charges that stand there; with the time constant that it has if `keep_rc`.
void refit(JointCircuitFit& aligned, int segments, bool keep_rc) {
    std::optional<double> tau_s;
    if (keep_rc) tau_s = aligned.fit.rc_time_constant_s;
    aligned.fit = fit_circuit(aligned.records, uniform_knots(aligned.records, segments), aligned.fit.weights, tau_s);
}

/// Steps until they no longer help.
void step_to_optimum(JointCircuitFit& aligned, int segments) {
    if (aligned.records.size() < 2) return;
    const auto flights = static_cast<Eigen::Index>(aligned.records.size());
    for (int i = 0; i < max_steps; ++i) {
        const double length_ah = aligned.fit.knots_ah.back() - aligned.fit.knots_ah.front();
        const Eigen::VectorXd step = gauss_newton_step(aligned).tail(flights);
        double part = std::min(1.0, 0.1 * length_ah / std::max(1e-12, step.cwiseAbs().maxCoeff()));
        const double before = objective_of(aligned);
        auto tried = aligned;
        bool helps = false;
        for (int halved = 0; halved < 4 && !helps; ++halved, part /= 2.0) {
            tried = aligned;
            for (Eigen::Index f = 0; f < flights; ++f)
                tried.records[static_cast<std::size_t>(f)].initial_charge_ah += part * step[f];
            refit(tried, segments, true);
            helps = objective_of(tried) < before;
        }
        if (!helps) break;
        aligned = std::move(tried);
        if (step.cwiseAbs().maxCoeff() < 1e-4 * length_ah) break;
    }
    refit(aligned, segments, false);
}

/// The records in the order of how full their packs were.
std::vector<std::size_t> fullest_first(std::span<const DischargeRecord> records) {
    std::vector<std::size_t> order(records.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return records[i].resting_voltage_v; });
    return order;
}

FitWeights first_weights(const DischargeRecord& fullest, int cells) {
    FitWeights weights;
    weights.cells = cells;
    weights.fullest_rest_v = fullest.resting_voltage_v;
    return weights;
}

/// Initial charges of records that are laid onto each other one by one, the fullest first.
std::vector<double> laid_one_by_one(std::span<const DischargeRecord> records, int cells, const PackLinks& links) {
    const auto order = fullest_first(records);
    JointCircuitFit growing;
    growing.fit.weights = first_weights(records[order.front()], cells);
    std::vector<double> initial_ah(records.size(), 0.0);
    for (const auto at : order) {
        const auto& link = links[at];
        if (at == order.front()) {
            initial_ah[at] = 0.0;
        } else if (link && records[link->earlier].resting_voltage_v >= records[at].resting_voltage_v) {
            initial_ah[at] = initial_ah[link->earlier] + link->charge_ah;
        } else {
            initial_ah[at] = best_place_ah(records[at], growing.fit);
        }
        growing.records.push_back({&records[at], initial_ah[at]});
        // The time constant is searched for anew with every doubling: it is known about from then on.
        if (at != order.back()) refit(growing, first_segments, !std::has_single_bit(growing.records.size()));
    }
    return initial_ah;
}

/// With the initial charges that are about right.
JointCircuitFit laid_out(std::span<const DischargeRecord> records, int cells, const PackLinks& links,
                         std::span<const double> initial_ah) {
    JointCircuitFit aligned;
    for (std::size_t i = 0; i < records.size(); ++i) aligned.records.push_back({&records[i], initial_ah[i]});
    aligned.links = links;
    aligned.reference = fullest_first(records).front();
    aligned.fit.weights = first_weights(records[aligned.reference], cells);
    refit(aligned, first_segments, false);
    aligned.fit.weights.sample_error_v = effective_error_v(aligned.records, aligned.fit.residual_v);
    refit(aligned, first_segments, false);
    return aligned;
}

/// Moves all so that the curve begins at charge 0.
void begin_at_zero(JointCircuitFit& aligned) {
    const double low_ah = aligned.fit.knots_ah.front();
    for (auto& knot : aligned.fit.knots_ah) knot -= low_ah;
    for (auto& record : aligned.records) record.initial_charge_ah -= low_ah;
}

}  // namespace

std::optional<PackLink> find_pack_link(const DischargeRecord& later, std::span<const AlignedRecord> known,
                                       const CircuitFit& fit) {
    if (later.is_other_pack) return std::nullopt;
    PackLink link;
    link.pause_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < known.size(); ++i) {
        if (known[i].record == &later) continue;
        const auto pause = pause_s(*known[i].record, later);
        if (!pause || *pause < 0.0 || *pause >= link.pause_s) continue;
        link.pause_s = *pause;
        link.earlier = i;
    }
    if (!(link.pause_s <= max_pause_s)) return std::nullopt;
    const auto& earlier = known[link.earlier];
    if (earlier.record->counter_ah && later.counter_ah && later.counter_ah->low > counted_ah) {
        const double apart_ah = later.counter_ah->low - earlier.record->counter_ah->high;
        if (std::abs(apart_ah) > 2.0 * counted_ah) return std::nullopt;
        link.counter_continues = true;
    }
    if (!is_fallen_as_drawn(later, earlier, fit)) return std::nullopt;
    link.charge_ah = earlier.record->charge_ah.back();
    link.error_ah = std::hypot(min_error_ah, counter_error * link.charge_ah);
    return link;
}

std::vector<double> uniform_knots(std::span<const AlignedRecord> records, int segments) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const auto& [record, initial] : records) {
        const auto [least, most] = std::ranges::minmax_element(record->charge_ah);
        low = std::min(low, std::max(0.0, *least) + initial);  // a counter that falls has drifted
        high = std::max(high, *most + initial);
    }
    std::vector<double> knots;
    for (int i = 0; i <= segments; ++i) knots.push_back(std::lerp(low, high, static_cast<double>(i) / segments));
    return knots;
}

Eigen::Index parameter_count(const JointCircuitFit& aligned) {
    return fit_columns(aligned.fit).width + static_cast<Eigen::Index>(aligned.records.size());
}

std::vector<RecordJacobian> joint_jacobian(const JointCircuitFit& aligned) {
    const auto at = fit_columns(aligned.fit);
    const auto shared = shared_jacobian(aligned.records, aligned.fit);
    std::vector<RecordJacobian> records;
    Eigen::Index first = 0;
    for (std::size_t f = 0; f < aligned.records.size(); ++f) {
        const auto& record = *aligned.records[f].record;
        const auto flight = static_cast<Eigen::Index>(f);
        const auto rows = used_sample_count(record);
        RecordJacobian own{first, {}, Eigen::MatrixXd::Zero(rows, shared.cols() + 2)};
        for (Eigen::Index c = 0; c < at.rest; ++c) own.parameter_indices.push_back(c);
        for (Eigen::Index c = at.rc; c < at.width; ++c) own.parameter_indices.push_back(c);
        own.parameter_indices.insert(own.parameter_indices.end(), {at.rest + flight, at.width + flight});
        own.columns.leftCols(shared.cols()) = shared.middleRows(first, rows);
        own.columns.col(shared.cols()).head(rest_sample_count(record)).setOnes();
        if (f != aligned.reference)
            own.columns.col(shared.cols() + 1) = slopes_v_per_ah(aligned.records[f], aligned.fit);
        first += rows;
        records.push_back(std::move(own));
    }
    return records;
}

JointPrior joint_prior(const JointCircuitFit& aligned) {
    const auto& fit = aligned.fit;
    const auto at = fit_columns(fit);
    const auto circuit = prior_rows(aligned.records, fit);
    const auto flights = static_cast<Eigen::Index>(aligned.records.size());
    const auto links = std::ranges::count_if(aligned.links, [](const auto& link) { return link.has_value(); });
    JointPrior belief;
    belief.rows = Eigen::MatrixXd::Zero(circuit.rows() + links, at.width + flights);
    belief.rows.topLeftCorner(circuit.rows(), at.width) = circuit;
    Eigen::VectorXd now = Eigen::VectorXd::Zero(at.width + flights);
    for (Eigen::Index k = 0; k < at.resistance; ++k) now[k] = fit.open_circuit_v[static_cast<std::size_t>(k)];
    for (Eigen::Index f = 0; f < flights; ++f) now[at.rest + f] = fit.rest_offset_v[static_cast<std::size_t>(f)];
    now[at.common] = fit.common_rest_offset_v;
    belief.residual = -belief.rows * now;
    auto row = circuit.rows();
    for (std::size_t f = 0; f < aligned.links.size(); ++f) {
        const auto& link = aligned.links[f];
        if (!link) continue;
        const double weight = fit.weights.sample_error_v / tied_ah;
        belief.rows(row, at.width + static_cast<Eigen::Index>(f)) = weight;
        belief.rows(row, at.width + static_cast<Eigen::Index>(link->earlier)) = -weight;
        belief.residual[row++] = weight * (link->charge_ah - aligned.records[f].initial_charge_ah +
                                           aligned.records[link->earlier].initial_charge_ah);
    }
    const auto reference = at.width + static_cast<Eigen::Index>(aligned.reference);
    belief.rows.col(reference).setZero();
    return belief;
}

Eigen::MatrixXd normal_matrix(std::span<const RecordJacobian> records, const JointPrior& belief) {
    const Eigen::SparseMatrix<double> believed = belief.rows.sparseView();
    Eigen::MatrixXd normal = believed.transpose() * believed;
    for (const auto& record : records)
        normal(record.parameter_indices, record.parameter_indices) += record.columns.transpose() * record.columns;
    return normal;
}

Eigen::VectorXd gauss_newton_step(const JointCircuitFit& aligned) {
    const auto records = joint_jacobian(aligned);
    const auto belief = joint_prior(aligned);
    auto normal = normal_matrix(records, belief);
    Eigen::VectorXd pull = belief.rows.transpose() * belief.residual;
    for (const auto& [first, places, columns] : records)
        pull(places) += columns.transpose() * aligned.fit.residual_v.segment(first, columns.rows());
    // Parameters have their own units: each is scaled to length 1 first, and what nothing tells stays where it is.
    const Eigen::VectorXd length = normal.diagonal().cwiseSqrt().cwiseMax(1e-12);
    normal = length.cwiseInverse().asDiagonal() * normal * length.cwiseInverse().asDiagonal();
    constexpr double ridge = 1e-10;
    normal.diagonal().array() += ridge;
    const Eigen::VectorXd scaled = normal.ldlt().solve(pull.cwiseQuotient(length));
    return scaled.cwiseQuotient(length);
}

JointCircuitFit fit_circuit_jointly(std::span<const DischargeRecord> records, int cells, PackLinks links,
                                    std::span<const double> begin_ah) {
    links.resize(records.size());
    auto rough = begin_ah.empty() ? laid_out(records, cells, links, laid_one_by_one(records, cells, links))
                                  : laid_out(records, cells, links, begin_ah);
    step_to_optimum(rough, first_segments);
    for (const int segments : rank_segment_counts(rough.records, rough.fit)) {
        auto aligned = rough;
        refit(aligned, segments, false);
        if (segments != first_segments) step_to_optimum(aligned, segments);
        if (!falls_throughout(aligned.fit)) continue;
        begin_at_zero(aligned);
        return aligned;
    }
    throw NoResultError("the open-circuit voltage does not fall as charge is drawn");
}

}  // namespace flightwatt::battery
