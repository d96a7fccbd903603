#include "mechanical/model_difference.h"

#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

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

/// Whether both are of one flight's phase, by what no way to fit it changes: names may be given twice.
bool is_of_one_flight(const PhaseContribution& a, const PhaseContribution& b) {
    constexpr double rounding = 1e-6;
    return a.samples == b.samples && std::abs(a.duration_s - b.duration_s) <= rounding * a.duration_s;
}

/// Of two weighted means of independent values: sum over the shared flights of w_a w_b v, over the root of both sums of
/// w^2 v. `variance` may be known up to a factor.
double correlation_of(const Contributions& a, const Contributions& b,
                      const std::function<double(const PhaseContribution&)>& variance) {
    const auto own = [&](const Contributions& flights) {
        double sum = 0.0;
        for (const auto& [name, flight] : flights) sum += flight.weight * flight.weight * variance(flight);
        return sum;
    };
    double shared = 0.0;
    for (const auto& [name, flight] : a) {
        const auto other = b.find(name);
        if (other == b.end() || !is_of_one_flight(flight, other->second)) continue;
        shared += flight.weight * other->second.weight * std::sqrt(variance(flight) * variance(other->second));
    }
    const auto both = std::sqrt(own(a) * own(b));
    return both > 0.0 ? std::clamp(shared / both, 0.0, 1.0) : 0.0;
}

/// Of a flight's coefficients by the noise of its samples, up to a factor that all flights share.
double noise_variance(const PhaseContribution& flight) {
    return flight.rms_w * flight.rms_w / static_cast<double>(std::max<std::size_t>(1, flight.samples));
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
    const auto half = student_t_half_width(1.0 / squares - 1.0) * std::sqrt(variance * squares);
    return {value, Interval{value - half, value + half}};
}

/// Two models' views of one phase.
struct PhasePair {
    const PhaseModel& a;
    const PhaseModel& b;
    Contributions flights_a;
    Contributions flights_b;
    std::string part;
};

void add_coefficients(std::vector<Difference>& all, const PhasePair& pair) {
    const auto correlation = correlation_of(pair.flights_a, pair.flights_b, noise_variance);
    const auto intervals = [](const PhaseModel& phase) {
        return phase.errors ? std::optional(coefficient_intervals(phase)) : std::nullopt;
    };
    const auto intervals_a = intervals(pair.a);
    const auto intervals_b = intervals(pair.b);
    const auto add = [&](std::string quantity, const char* unit, std::optional<Estimate> a, std::optional<Estimate> b) {
        Difference row{pair.part, std::move(quantity), unit, a, b};
        if (a && b) row.interval = interval_of_difference(*a, *b, correlation);
        if (row.interval) row.basis = DifferenceBasis::noise;
        all.push_back(row);
    };
    const auto a0 = [](const PhaseModel& phase, const auto& of) {
        return Estimate{phase.fourier.a0_w, of ? std::optional(of->a0_w) : std::nullopt};
    };
    const auto nth = [](const std::vector<double>& values, const std::vector<Interval>* of,
                        std::size_t n) -> std::optional<Estimate> {
        if (n >= values.size()) return std::nullopt;
        return Estimate{values[n], of != nullptr && n < of->size() ? std::optional((*of)[n]) : std::nullopt};
    };
    const auto omega = [](const PhaseModel& phase, const auto& of) {
        const bool is_known = of && !phase.errors->frequency_is_fixed;
        return Estimate{phase.fourier.omega_rad_per_s, is_known ? std::optional(of->omega_rad_per_s) : std::nullopt};
    };
    add("a0_w", "W", a0(pair.a, intervals_a), a0(pair.b, intervals_b));
    for (std::size_t n = 0; n < std::max(pair.a.fourier.cos_w.size(), pair.b.fourier.cos_w.size()); ++n) {
        add(fmt::format("a{}_w", n + 1), "W", nth(pair.a.fourier.cos_w, intervals_a ? &intervals_a->cos_w : nullptr, n),
            nth(pair.b.fourier.cos_w, intervals_b ? &intervals_b->cos_w : nullptr, n));
        add(fmt::format("b{}_w", n + 1), "W", nth(pair.a.fourier.sin_w, intervals_a ? &intervals_a->sin_w : nullptr, n),
            nth(pair.b.fourier.sin_w, intervals_b ? &intervals_b->sin_w : nullptr, n));
    }
    add("omega_rad_per_s", "rad/s", omega(pair.a, intervals_a), omega(pair.b, intervals_b));
}

void add_means(std::vector<Difference>& all, const PhasePair& pair) {
    const auto correlation = correlation_of(pair.flights_a, pair.flights_b, [](const auto&) { return 1.0; });
    const auto add = [&](const char* quantity, const char* unit, const auto& of_model, const auto& of_flight) {
        const auto a = mean_of_flights(of_model(pair.a), pair.flights_a, of_flight);
        const auto b = mean_of_flights(of_model(pair.b), pair.flights_b, of_flight);
        Difference row{pair.part, quantity, unit, a, b};
        row.interval = interval_of_difference(a, b, correlation);
        if (row.interval) row.basis = DifferenceBasis::flights;
        all.push_back(row);
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
        [&](const PhaseContribution& flight) -> std::optional<double> {
            if (!flight.mean_power_w) return std::nullopt;
            return units::wh_from_joule(*flight.mean_power_w * flight.duration_s);
        });
}

/// The curves at equal parts of the phase, where they are furthest apart. Files hold no error of one place of a curve.
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
    if (!model->level_sd) return Estimate{value, std::nullopt};  // a single flight's covariance tells too little
    const auto half = student_t_half_width(model->degrees_of_freedom) * std::sqrt(model->covariance[i][i]);
    return Estimate{value, Interval{value - half, value + half}};
}

/// `both` are the flights that both models rest on.
void add_physical(std::vector<Difference>& all, const std::optional<PhysicalModel>& a,
                  const std::optional<PhysicalModel>& b, const std::vector<std::string>& both) {
    double correlation = 0.0;
    if (a && b && !a->flights.empty() && !b->flights.empty()) {
        const auto rests_on = [](const PhysicalModel& model, const std::string& name) {
            return std::ranges::find(model.flights, name) != model.flights.end();
        };
        const auto shared =
            std::ranges::count_if(both, [&](const auto& name) { return rests_on(*a, name) && rests_on(*b, name); });
        correlation =
            static_cast<double>(shared) / std::sqrt(static_cast<double>(a->flights.size() * b->flights.size()));
    }
    for (const auto term : all_power_terms) {
        const auto of_a = term_of(a, term);
        const auto of_b = term_of(b, term);
        if (!of_a && !of_b) continue;
        Difference row{"physical", std::string(to_string(term)), std::string(unit_of(term)), of_a, of_b};
        if (of_a && of_b) row.interval = interval_of_difference(*of_a, *of_b, correlation);
        if (row.interval) row.basis = DifferenceBasis::flights;
        all.push_back(row);
    }
}

}  // namespace

std::optional<Interval> interval_of_difference(const Estimate& a, const Estimate& b, double correlation) {
    if (!a.interval || !b.interval) return std::nullopt;
    const auto reach = [&](double of_a, double of_b) {
        const auto x = std::max(0.0, of_a);  // a mean over frequencies may lie beside its interval
        const auto y = std::max(0.0, of_b);
        return std::sqrt(std::max(0.0, x * x + y * y - 2.0 * correlation * x * y));
    };
    const auto difference = b.value - a.value;
    // The same estimate of the same flights: sides that differ would leave a width at correlation 1.
    constexpr double rounding = 1e-12;
    const auto is_same =
        a.value == b.value && a.interval->low == b.interval->low && a.interval->high == b.interval->high;
    if (is_same && correlation >= 1.0 - rounding) return Interval{0.0, 0.0};
    return Interval{difference - reach(a.interval->high - a.value, b.value - b.interval->low),
                    difference + reach(a.value - a.interval->low, b.interval->high - b.value)};
}

std::string to_string(DifferenceBasis basis) {
    switch (basis) {
        case DifferenceBasis::noise:
            return "noise";
        case DifferenceBasis::flights:
            return "flights";
        case DifferenceBasis::none:
            return "";
    }
    return "";
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
    for (const auto phase : flight::all_phases) {
        const PhasePair pair{a.phases[phase], b.phases[phase], contributions_of(a, phase), contributions_of(b, phase),
                             std::string(to_string(phase))};
        add_coefficients(all, pair);
        add_means(all, pair);
        all.push_back(curve_difference(pair));
    }
    add_physical(all, a.physical, b.physical, shared_flights(a, b));
    return all;
}

}  // namespace flightwatt::mechanical
