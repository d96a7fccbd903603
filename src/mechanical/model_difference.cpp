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

/// Whether both are of one flight's phase, by quantities that no fit option changes: a name may be used twice.
bool is_of_one_flight(const PhaseContribution& a, const PhaseContribution& b) {
    constexpr double rounding = 1e-6;
    return a.samples == b.samples && std::abs(a.duration_s - b.duration_s) <= rounding * a.duration_s;
}

/// Correlation of two estimates that share flights, of equal weights.
double correlation_of(std::size_t shared, std::size_t flights_a, std::size_t flights_b) {
    if (shared == 0) return 0.0;
    return static_cast<double>(shared) / std::sqrt(static_cast<double>(flights_a * flights_b));
}

/// `value` with the interval that the flights' own values give their weighted mean; none from fewer than two.
Estimate mean_of_flights(double value, const Contributions& flights,
                         const std::function<std::optional<double>(const PhaseContribution&)>& own) {
    double mean = 0.0;
    double squares = 0.0;
    for (const auto& [name, flight] : flights) {
        const auto measured = own(flight);
        if (!measured) return {value, std::nullopt};
        mean += flight.weight * *measured;
        squares += flight.weight * flight.weight;
    }
    if (flights.size() < 2 || squares >= 1.0) return {value, std::nullopt};
    double variance = 0.0;
    for (const auto& [name, flight] : flights)
        variance += flight.weight * std::pow(*own(flight) - mean, 2) / (1.0 - squares);
    return {value, student_t_interval(value, std::sqrt(variance * squares), 1.0 / squares - 1.0)};
}

/// Two models' views of one phase.
struct PhasePair {
    const PhaseModel& a;
    const PhaseModel& b;
    Contributions flights_a;
    Contributions flights_b;
    std::string part;
    double correlation = 0.0;
};

/// Adds the row, with its interval if both estimates have theirs.
void add_row(std::vector<Difference>& all, Difference row, double correlation, DifferenceBasis basis) {
    if (row.a && row.b) row.interval = interval_of_difference(*row.a, *row.b, correlation);
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
        add_row(all, {pair.part, std::move(quantity), "W", a[i], b[i]}, pair.correlation, DifferenceBasis::noise);
    }
    add_row(all, {pair.part, "omega_rad_per_s", "rad/s", a.back(), b.back()}, pair.correlation, DifferenceBasis::noise);
}

void add_means(std::vector<Difference>& all, const PhasePair& pair) {
    const auto add = [&](const char* quantity, const char* unit, const auto& of_model, const auto& of_flight) {
        const auto a = mean_of_flights(of_model(pair.a), pair.flights_a, of_flight);
        const auto b = mean_of_flights(of_model(pair.b), pair.flights_b, of_flight);
        add_row(all, {pair.part, quantity, unit, a, b}, pair.correlation, DifferenceBasis::flights);
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

/// `shared` are the flights of both models.
void add_physical(std::vector<Difference>& all, const std::optional<PhysicalModel>& a,
                  const std::optional<PhysicalModel>& b, const std::vector<std::string>& shared) {
    double correlation = 0.0;
    if (a && b) {
        const auto is_in = [](const PhysicalModel& model, const std::string& name) {
            return std::ranges::find(model.flights, name) != model.flights.end();
        };
        const auto count =
            std::ranges::count_if(shared, [&](const auto& name) { return is_in(*a, name) && is_in(*b, name); });
        correlation = correlation_of(static_cast<std::size_t>(count), a->flights.size(), b->flights.size());
    }
    for (const auto term : all_power_terms) {
        const auto of_a = term_of(a, term);
        const auto of_b = term_of(b, term);
        if (!of_a && !of_b) continue;
        Difference row{"physical", std::string(to_string(term)), std::string(unit_of(term)), of_a, of_b};
        add_row(all, std::move(row), correlation, DifferenceBasis::flights);
    }
}

}  // namespace

std::optional<Interval> interval_of_difference(const Estimate& a, const Estimate& b, double correlation) {
    if (!a.interval || !b.interval) return std::nullopt;
    const auto reach = [&](double of_a, double of_b) {
        const auto x = std::max(0.0, of_a);  // a mean over frequencies may be outside its interval
        const auto y = std::max(0.0, of_b);
        return std::sqrt(std::max(0.0, x * x + y * y - 2.0 * correlation * x * y));
    };
    const auto difference = b.value - a.value;
    // The same estimate of the same flights: an asymmetric interval would leave a width at correlation 1.
    constexpr double rounding = 1e-12;
    const auto is_same =
        a.value == b.value && a.interval->low == b.interval->low && a.interval->high == b.interval->high;
    if (is_same && correlation >= 1.0 - rounding) return Interval{0.0, 0.0};
    return Interval{difference - reach(a.interval->high - a.value, b.value - b.interval->low),
                    difference + reach(a.value - a.interval->low, b.interval->high - b.value)};
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

std::vector<std::string> shared_flights(const MechanicalModel& a, const MechanicalModel& b) {
    std::vector<std::string> shared;
    for (const auto& flight : a.flights) {
        const auto other = std::ranges::find(b.flights, flight.flight, &FlightContribution::flight);
        if (other == b.flights.end()) continue;
        const bool is_same = std::ranges::all_of(flight::all_phases, [&](flight::Phase phase) {
            const auto& of_a = flight.phases[phase];
            const auto& of_b = other->phases[phase];
            return !of_a || !of_b || is_of_one_flight(*of_a, *of_b);
        });
        if (is_same) shared.push_back(flight.flight);
    }
    return shared;
}

std::vector<Difference> model_difference(const MechanicalModel& a, const MechanicalModel& b) {
    std::vector<Difference> all;
    const auto shared = shared_flights(a, b);
    for (const auto phase : flight::all_phases) {
        PhasePair pair{a.phases[phase], b.phases[phase], contributions_of(a, phase), contributions_of(b, phase),
                       std::string(to_string(phase))};
        const auto count = std::ranges::count_if(shared, [&](const std::string& name) {
            return pair.flights_a.contains(name) && pair.flights_b.contains(name);
        });
        pair.correlation =
            correlation_of(static_cast<std::size_t>(count), pair.flights_a.size(), pair.flights_b.size());
        add_coefficients(all, pair);
        add_means(all, pair);
        all.push_back(curve_difference(pair));
    }
    add_physical(all, a.physical, b.physical, shared);
    return all;
}

}  // namespace flightwatt::mechanical
