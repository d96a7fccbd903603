#include "mechanical/model_difference.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

using Contributions = std::map<std::string, PhaseContribution>;

/// The flights that count in a phase, by name.
Contributions contributions_of(const MechanicalModel& model, flight::Phase phase) {
    Contributions found;
    for (const auto& flight : model.flights) {
        const auto& of_phase = flight.phases[phase];
        if (of_phase && of_phase->weight > 0.0) found.emplace(flight.flight, *of_phase);
    }
    return found;
}

/// The weighted mean of the flights' own values with its interval; without interval from fewer than two. Returns
/// `otherwise` where the model has no values of its flights.
Estimate mean_of_flights(double otherwise, const Contributions& flights,
                         const std::function<std::optional<double>(const PhaseContribution&)>& own) {
    double mean = 0.0;
    double squares = 0.0;
    for (const auto& [name, flight] : flights) {
        const auto measured = own(flight);
        if (!measured) return {otherwise, std::nullopt};
        mean += flight.weight * *measured;
        squares += flight.weight * flight.weight;
    }
    if (flights.empty()) return {otherwise, std::nullopt};
    if (flights.size() < 2 || squares >= 1.0) return {mean, std::nullopt};
    double variance = 0.0;
    for (const auto& [name, flight] : flights)
        variance += flight.weight * std::pow(*own(flight) - mean, 2) / (1.0 - squares);
    return {mean, student_t_interval(mean, std::sqrt(variance * squares), 1.0 / squares - 1.0)};
}

/// Two models' views of one phase.
struct PhasePair {
    const PhaseModel& a;
    const PhaseModel& b;
    Contributions flights_a;
    Contributions flights_b;
    std::string part;
};

/// Adds the row, with its interval if both estimates have theirs.
void add_row(std::vector<Difference>& all, Difference row, DifferenceBasis basis) {
    if (row.a && row.b) row.interval = interval_of_difference(*row.a, *row.b);
    if (row.interval) row.basis = basis;
    all.push_back(std::move(row));
}

/// a0, a1, b1, ... to that order, absent beyond the phase's own, and the frequency.
std::vector<std::optional<Estimate>> coefficients_of(const PhaseModel& phase, std::size_t order) {
    const auto& fourier = phase.fourier;
    std::optional<CoefficientIntervals> intervals;
    if (phase.errors) intervals = coefficient_intervals(phase);
    const auto estimate = [&](double value, const auto& interval_of) {
        return Estimate{value, intervals ? std::optional(interval_of(*intervals)) : std::nullopt};
    };
    std::vector<std::optional<Estimate>> found{estimate(fourier.a0_w, [](const auto& of) { return of.a0_w; })};
    found.resize(2 * order + 2);
    for (std::size_t n = 0; n < fourier.cos_w.size(); ++n) {
        found[2 * n + 1] = estimate(fourier.cos_w[n], [n](const auto& of) { return of.cos_w[n]; });
        found[2 * n + 2] = estimate(fourier.sin_w[n], [n](const auto& of) { return of.sin_w[n]; });
    }
    found.back() = estimate(fourier.omega_rad_per_s, [](const auto& of) { return of.omega_rad_per_s; });
    if (phase.errors && phase.errors->frequency_is_fixed) found.back()->interval.reset();
    return found;
}

void add_coefficients(std::vector<Difference>& all, const PhasePair& pair) {
    const auto order = std::max(pair.a.fourier.cos_w.size(), pair.b.fourier.cos_w.size());
    const auto a = coefficients_of(pair.a, order);
    const auto b = coefficients_of(pair.b, order);
    for (std::size_t i = 0; i + 1 < a.size(); ++i) {
        auto quantity = fmt::format("{}{}_w", i > 0 && i % 2 == 0 ? 'b' : 'a', (i + 1) / 2);
        add_row(all, {pair.part, std::move(quantity), "W", a[i], b[i]}, DifferenceBasis::noise);
    }
    add_row(all, {pair.part, "omega_rad_per_s", "rad/s", a.back(), b.back()}, DifferenceBasis::noise);
}

void add_means(std::vector<Difference>& all, const PhasePair& pair) {
    const auto add = [&](const char* quantity, const char* unit, const auto& of_model, const auto& of_flight) {
        const auto a = mean_of_flights(of_model(pair.a), pair.flights_a, of_flight);
        const auto b = mean_of_flights(of_model(pair.b), pair.flights_b, of_flight);
        add_row(all, {pair.part, quantity, unit, a, b}, DifferenceBasis::flights);
    };
    const auto energy = [](const PhaseModel& phase) { return energy_j(phase.fourier, phase.duration_s); };
    add(
        "duration_s", "s", [](const PhaseModel& phase) { return phase.duration_s; },
        [](const PhaseContribution& flight) { return std::optional(flight.duration_s); });
    add(
        "mean_power_w", "W", [&](const PhaseModel& phase) { return energy(phase) / phase.duration_s; },
        [](const PhaseContribution& flight) { return flight.mean_power_w; });
    add(
        "energy_wh", "Wh", [&](const PhaseModel& phase) { return units::wh_from_joule(energy(phase)); },
        [](const PhaseContribution& flight) -> std::optional<double> {
            if (!flight.mean_power_w) return std::nullopt;
            return units::wh_from_joule(*flight.mean_power_w * flight.duration_s);
        });
}

/// The curves at equal parts of the phase, where they are furthest apart; without interval, as files have no error
/// there.
Difference curve_difference(const PhasePair& pair) {
    const auto points = std::max(curve_point_count(pair.a.fourier, pair.a.duration_s),
                                 curve_point_count(pair.b.fourier, pair.b.duration_s));
    const auto a = curve_w(pair.a.fourier, pair.a.duration_s, points);
    const auto b = curve_w(pair.b.fourier, pair.b.duration_s, points);
    std::size_t furthest = 0;
    for (std::size_t i = 0; i < points; ++i)
        if (std::abs(b[i] - a[i]) > std::abs(b[furthest] - a[furthest])) furthest = i;
    Difference row{pair.part, "curve_w", "W", Estimate{a[furthest], {}}, Estimate{b[furthest], {}}};
    row.at_s = (static_cast<double>(furthest) + 0.5) / static_cast<double>(points) * pair.a.duration_s;
    return row;
}

std::optional<Estimate> term_of(const std::optional<PhysicalModel>& model, PowerTerm term) {
    if (!model) return std::nullopt;
    const auto found = std::ranges::find(model->terms, term);
    if (found == model->terms.end()) return std::nullopt;
    const auto i = static_cast<std::size_t>(found - model->terms.begin());
    const auto value = model->coefficients[term];
    if (!model->level_sd) return Estimate{value, std::nullopt};  // a single flight has no variability
    return Estimate{value, student_t_interval(value, std::sqrt(model->covariance[i][i]), model->degrees_of_freedom)};
}

void add_physical(std::vector<Difference>& all, const std::optional<PhysicalModel>& a,
                  const std::optional<PhysicalModel>& b) {
    for (const auto term : all_power_terms) {
        const auto of_a = term_of(a, term);
        const auto of_b = term_of(b, term);
        if (!of_a && !of_b) continue;
        Difference row{"physical", std::string(to_string(term)), std::string(unit_of(term)), of_a, of_b};
        add_row(all, std::move(row), DifferenceBasis::flights);
    }
}

}  // namespace

std::optional<Interval> interval_of_difference(const Estimate& a, const Estimate& b) {
    if (!a.interval || !b.interval) return std::nullopt;
    const auto difference = b.value - a.value;
    return Interval{difference - std::hypot(a.interval->high - a.value, b.value - b.interval->low),
                    difference + std::hypot(a.value - a.interval->low, b.interval->high - b.value)};
}

std::string to_string(DifferenceBasis basis) {
    return basis == DifferenceBasis::noise ? "noise" : basis == DifferenceBasis::flights ? "flights" : "";
}

std::optional<double> difference_of(const Difference& difference) {
    if (!difference.a || !difference.b) return std::nullopt;
    return difference.b->value - difference.a->value;
}

std::optional<bool> is_significant(const Difference& difference) {
    if (!difference.interval) return std::nullopt;
    return difference.interval->low > 0.0 || difference.interval->high < 0.0;
}

std::vector<Difference> model_difference(const MechanicalModel& a, const MechanicalModel& b) {
    std::vector<Difference> all;
    for (const auto phase : flight::all_phases) {
        const PhasePair pair{a.phases[phase], b.phases[phase], contributions_of(a, phase), contributions_of(b, phase),
                             std::string(to_string(phase))};
        add_coefficients(all, pair);
        add_means(all, pair);
        all.push_back(curve_difference(pair));
    }
    add_physical(all, a.physical, b.physical);
    return all;
}

}  // namespace flightwatt::mechanical
