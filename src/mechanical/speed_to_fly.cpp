#include "mechanical/speed_to_fly.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mechanical {
namespace {

constexpr double min_search_fraction = 0.4;  // of the slowest airspeed flown
constexpr double max_search_fraction = 1.6;  // of the fastest

/// In standard errors; std::nullopt for a model of a single flight.
std::optional<double> half_width(const PhysicalModel& model) {
    return model.level_sd ? std::optional(student_t_half_width(model.degrees_of_freedom)) : std::nullopt;
}

TermValues level_terms(double airspeed_m_per_s) { return term_values({airspeed_m_per_s}); }

/// The derivative of a cost with respect to the airspeed, and its standard error.
struct Slope {
    double airspeed_m_per_s = 0.0;
    double value = 0.0;
    double standard_error = 0.0;
};

std::vector<Slope> slopes_of(const PhysicalModel& model, const CostTerms& cost) {
    constexpr int steps = 300;
    constexpr double relative_step = 1e-3;
    const double first = min_search_fraction * model.airspeed_m_per_s.low;
    const double last = max_search_fraction * model.airspeed_m_per_s.high;
    std::vector<Slope> slopes;
    for (int i = 0; i <= steps && first > 0.0; ++i) {
        const double airspeed = first + (last - first) * i / steps;
        const double step = relative_step * airspeed;
        const auto less = cost(airspeed - step);
        const auto more = cost(airspeed + step);
        if (!less || !more) continue;
        TermValues change;
        for (const auto term : model.terms) change[term] = ((*more)[term] - (*less)[term]) / (2.0 * step);
        slopes.push_back({airspeed, sum_of_terms_w(model, change), std::sqrt(coefficient_variance_w2(model, change))});
    }
    return slopes;
}

/// Where slope + standard_errors * its standard error first rises through 0.
std::optional<double> zero_of(const std::vector<Slope>& slopes, double standard_errors) {
    const auto at = [&](const Slope& slope) { return slope.value + standard_errors * slope.standard_error; };
    const auto rises = [&](const Slope& a, const Slope& b) { return at(a) < 0.0 && at(b) >= 0.0; };
    const auto found = std::ranges::adjacent_find(slopes, rises);
    if (found == slopes.end()) return std::nullopt;
    const auto& next = *std::next(found);
    const double part = at(*found) / (at(*found) - at(next));
    return std::lerp(found->airspeed_m_per_s, next.airspeed_m_per_s, part);
}

BestSpeed best_range(const PhysicalModel& model, double headwind_m_per_s) {
    constexpr double wh_per_km_from_j_per_m = 1000.0 / 3600.0;
    auto purpose = std::string("best range");
    if (headwind_m_per_s != 0.0)
        purpose += fmt::format(", {} {:.4g} m/s", headwind_m_per_s > 0.0 ? "headwind" : "tailwind",
                               std::abs(headwind_m_per_s));
    return best_speed(model, purpose, "Wh/km", [&](double airspeed) -> std::optional<TermValues> {
        if (airspeed <= headwind_m_per_s) return std::nullopt;
        auto terms = level_terms(airspeed);
        for (auto& value : terms.values) value *= wh_per_km_from_j_per_m / (airspeed - headwind_m_per_s);
        return terms;
    });
}

double induced_half_width(const PhysicalModel& model) {
    TermValues induced;
    induced[PowerTerm::induced] = 1.0;
    return half_width(model).value_or(0.0) * std::sqrt(coefficient_variance_w2(model, induced));
}

bool is_determined(const PhysicalModel& model) {
    return model.coefficients[PowerTerm::induced] > induced_half_width(model);
}

/// With a level leg, flown in a flight of its own, that confirms the coefficients (Bayes' rule for normal errors).
void add_leg(PhysicalModel& model, double airspeed_m_per_s, double leg_s) {
    const auto terms = level_terms(airspeed_m_per_s);
    const double power_sd_w = predicted_power(model, terms, leg_s).sd_w.value();
    std::vector<double> gain;  // the covariance of each coefficient with the leg's mean power
    for (const auto& row : model.covariance) {
        gain.push_back(0.0);
        for (std::size_t j = 0; j < row.size(); ++j) gain.back() += row[j] * terms[model.terms[j]];
    }
    for (std::size_t i = 0; i < gain.size(); ++i)
        for (std::size_t j = 0; j < gain.size(); ++j)
            model.covariance[i][j] -= gain[i] * gain[j] / (power_sd_w * power_sd_w);
}

BestSpeed best_endurance(const PhysicalModel& model) { return best_speed(model, "best endurance", "W", level_terms); }

SpeedTest speed_test(const PhysicalModel& model) {
    constexpr double leg_s = 120.0;
    constexpr int max_flights = 20;
    SpeedTest test{{}, leg_s, 0, induced_half_width(model), 0.0};
    for (const double part : {0.95, 0.875, 0.8}) test.airspeed_m_per_s.push_back(part * model.airspeed_m_per_s.low);
    auto after = model;
    while (test.flights < max_flights && !is_determined(after)) {
        ++test.flights;
        after.degrees_of_freedom += 1.0;
        for (const double airspeed : test.airspeed_m_per_s) add_leg(after, airspeed, leg_s);
    }
    test.induced_after = induced_half_width(after);
    test.endurance_after = best_endurance(after);
    return test;
}

}  // namespace

std::optional<PhysicalModel> speed_model(PhysicalModel model) {
    if (const auto speed = std::exchange(model.speed_terms, std::nullopt)) {
        model.terms = speed->terms;
        model.coefficients = speed->coefficients;
        model.covariance = speed->covariance;
        model.degrees_of_freedom = speed->degrees_of_freedom;
    }
    const bool is_complete =
        std::ranges::count(model.terms, PowerTerm::drag) > 0 && std::ranges::count(model.terms, PowerTerm::induced) > 0;
    return is_complete ? std::optional(std::move(model)) : std::nullopt;
}

PhysicalModel with_cost_of_airspeed(PhysicalModel model) {
    if (knows_cost_of_airspeed(model) || !model.speed_terms) return model;
    const auto by_speed = speed_model(model);
    const auto width = by_speed ? half_width(*by_speed) : std::nullopt;
    if (!width) return model;
    TermValues drag;
    drag[PowerTerm::drag] = 1.0;
    const bool is_shown =
        by_speed->coefficients[PowerTerm::drag] > *width * std::sqrt(coefficient_variance_w2(*by_speed, drag)) &&
        by_speed->coefficients[PowerTerm::induced] >= 0.0;
    return is_shown ? *by_speed : model;
}

BestSpeed best_speed(const PhysicalModel& model, const std::string& purpose, const std::string& unit,
                     const CostTerms& cost) {
    const auto slopes = slopes_of(model, cost);
    BestSpeed best{purpose, unit, zero_of(slopes, 0.0), {}, {}, {}};
    if (const auto width = half_width(model)) {
        best.low_m_per_s = zero_of(slopes, *width);
        best.high_m_per_s = zero_of(slopes, -*width);
    }
    if (best.airspeed_m_per_s) best.cost = sum_of_terms_w(model, cost(*best.airspeed_m_per_s).value());
    const bool rises = !slopes.empty() && slopes.front().value >= 0.0;
    const double at = best.airspeed_m_per_s.value_or(rises ? 0.0 : max_search_fraction * model.airspeed_m_per_s.high);
    best.below_flown = at < model.airspeed_m_per_s.low;
    best.above_flown = at > model.airspeed_m_per_s.high;
    return best;
}

std::optional<SpeedToFly> speed_to_fly(const PhysicalModel& of, double headwind_m_per_s) {
    const auto model = speed_model(of);
    if (!model) return std::nullopt;
    SpeedToFly speeds{*model, {best_endurance(*model), best_range(*model, 0.0)}, std::nullopt};
    if (headwind_m_per_s != 0.0) speeds.best.push_back(best_range(*model, headwind_m_per_s));
    if (model->level_sd && !is_determined(*model)) speeds.test = speed_test(*model);
    return speeds;
}

std::string describe(const BestSpeed& best, const Interval& flown) {
    const auto speed = [&](double airspeed) {
        return fmt::format("{:.1f}{}", airspeed, flown.contains(airspeed) ? "" : "*");
    };
    const auto& low = best.low_m_per_s;
    const auto& high = best.high_m_per_s;
    const bool is_beyond = best.below_flown || best.above_flown;
    std::string text = is_beyond ? fmt::format("{} the range flown ({:.1f} to {:.1f} m/s)",
                                               best.below_flown ? "below" : "above", flown.low, flown.high)
                                 : speed(*best.airspeed_m_per_s) + " m/s";
    text += low && high ? fmt::format(" (95 %: {} to {} m/s)", speed(*low), speed(*high))
            : high      ? fmt::format(", at most {} m/s (95 %)", speed(*high))
            : low       ? fmt::format(", at least {} m/s (95 %)", speed(*low))
                        : ", without a bound";
    return is_beyond ? text : text + fmt::format(", {:.4g} {}", *best.cost, best.unit);
}

std::string describe(const SpeedTest& test) {
    std::vector<std::string> airspeeds;
    for (const double airspeed : test.airspeed_m_per_s) airspeeds.push_back(fmt::format("{:.1f}", airspeed));
    const auto& high = test.endurance_after.high_m_per_s;
    return fmt::format(
        "The flights do not determine the induced drag (95 % interval ±{:.3g} W m/s). {} flight{} in calm air, each with "
        "level legs of {:.0f} min at {} m/s, if the aircraft is safe so slowly, would narrow it to ±{:.3g} W m/s{}.",
        test.induced_now, test.flights, test.flights == 1 ? "" : "s", test.leg_s / 60.0, fmt::join(airspeeds, ", "),
        test.induced_after, high ? fmt::format(", and best endurance to at most {:.1f} m/s", *high) : "");
}

}  // namespace flightwatt::mechanical
