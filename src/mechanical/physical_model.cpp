#include "mechanical/physical_model.h"

#include "base/units.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr std::array<std::string_view, power_term_count> power_term_names{
    "drag", "induced", "turn", "climb", "descent", "constant", "hover", "blade", "payload"};
constexpr std::array<std::string_view, power_term_count> power_term_units{
    "W s^3/m^3", "W m/s", "W m/s", "W s/m", "W s/m", "W", "W/W", "W s^2/m^2", "W/kg"};

}  // namespace

std::string_view to_string(PowerTerm term) { return power_term_names[static_cast<std::size_t>(term)]; }

std::optional<PowerTerm> power_term_from(std::string_view name) {
    for (const auto term : all_power_terms)
        if (to_string(term) == name) return term;
    return std::nullopt;
}

std::string_view unit_of(PowerTerm term) { return power_term_units[static_cast<std::size_t>(term)]; }

double induced_power_w(const AircraftLoad& load, double airspeed_m_per_s) {
    if (!load.rotors) return 0.0;
    constexpr double density_kg_per_m3 = 1.225;
    const double weight_n = (load.rotors->mass_kg + load.payload_kg) * units::standard_gravity_m_per_s2;
    const double hover_square = weight_n / (2.0 * density_kg_per_m3 * load.rotors->disc_area_m2);  // of its velocity
    const double half = 0.5 * airspeed_m_per_s * airspeed_m_per_s;
    return weight_n * hover_square / std::sqrt(half + std::hypot(half, hover_square));
}

TermValues term_values(const FlightState& motion, const AircraftLoad& load) {
    const double airspeed = motion.airspeed_m_per_s;
    const double load_factor = motion.load_factor;
    if (!(airspeed >= 0.0) || !std::isfinite(airspeed)) {
        throw std::invalid_argument(fmt::format("an airspeed of {} m/s: expected 0 or more", airspeed));
    }
    if (!(load_factor >= 0.0) || !std::isfinite(load_factor)) {
        throw std::invalid_argument(fmt::format("a load factor of {}: expected 0 or more", load_factor));
    }
    TermValues values;
    values[PowerTerm::drag] = airspeed * airspeed * airspeed;
    values[PowerTerm::induced] = 1.0 / std::max(airspeed, 1.0);
    values[PowerTerm::turn] = (load_factor * load_factor - 1.0) * values[PowerTerm::induced];
    values[PowerTerm::climb] = motion.climb_m_per_s;
    values[PowerTerm::descent] = std::min(motion.climb_m_per_s, 0.0);
    values[PowerTerm::constant] = 1.0;
    values[PowerTerm::hover] = induced_power_w(load, airspeed);
    values[PowerTerm::payload] = load.payload_kg;
    values[PowerTerm::blade] = airspeed * airspeed;
    return values;
}

double sum_of_terms_w(const PhysicalModel& model, const TermValues& values) {
    double power = 0.0;
    for (const auto term : model.terms) power += model.coefficients[term] * values[term];
    return power;
}

double coefficient_variance_w2(const PhysicalModel& model, const TermValues& values) {
    double variance_w2 = 0.0;
    for (std::size_t i = 0; i < model.terms.size(); ++i) {
        for (std::size_t j = 0; j < model.terms.size(); ++j) {
            variance_w2 += values[model.terms[i]] * model.covariance[i][j] * values[model.terms[j]];
        }
    }
    return std::max(variance_w2, 0.0);
}

double power_w(const PhysicalModel& model, const FlightState& motion) {
    return std::max(0.0, sum_of_terms_w(model, term_values(motion, model.load)));
}

double variance_of_mean_w2(const DriftProcess& drift, double duration_s) {
    const double x = duration_s / drift.correlation_s;
    const double variance = drift.sd_w * drift.sd_w;
    // The closed form cancels for short durations: 2 (x - 1 + exp(-x)) / x^2 = 1 - x/3 + ...
    if (x < 1e-4) return variance * (1.0 - x / 3.0);
    return variance * 2.0 * (x + std::expm1(-x)) / (x * x);
}

double covariance_of_means_w2(const DriftProcess& drift, double first_s, double second_s) {
    const auto part = [&](double duration_s) {
        const double x = duration_s / drift.correlation_s;
        return x < 1e-12 ? 1.0 : -std::expm1(-x) / x;
    };
    return drift.sd_w * drift.sd_w * part(first_s) * part(second_s);
}

double drift_variance_w2(const PhysicalModel& model, double duration_s) {
    return variance_of_mean_w2({model.drift_sd_w, model.correlation_s}, duration_s) / weight_of_bin(duration_s);
}

ConstantPower predicted_power(const PhysicalModel& model, const TermValues& mean_values, double duration_s) {
    const double sum_w = sum_of_terms_w(model, mean_values);
    ConstantPower power{std::max(sum_w, 0.0), std::nullopt, model.degrees_of_freedom};
    if (!model.level_sd) return power;
    const double between_w2 = std::pow(*model.level_sd * sum_w, 2) + coefficient_variance_w2(model, mean_values);
    const double drift_w2 = drift_variance_w2(model, duration_s);
    const double variance_w2 = between_w2 + drift_w2;
    power.sd_w = std::sqrt(variance_w2);
    if (variance_w2 > 0.0)
        power.degrees_of_freedom =
            variance_w2 * variance_w2 /
            (between_w2 * between_w2 / model.degrees_of_freedom + drift_w2 * drift_w2 / model.drift_degrees_of_freedom);
    return power;
}

void add_constant_power(double power_w, PhysicalModel& model) {
    model.coefficients[PowerTerm::constant] += power_w;
    if (std::ranges::find(model.terms, PowerTerm::constant) != model.terms.end()) return;
    model.terms.push_back(PowerTerm::constant);
    for (auto& row : model.covariance) row.push_back(0.0);
    model.covariance.emplace_back(model.terms.size(), 0.0);
}

void add_turns_of_induced_drag(PhysicalModel& model) {
    const auto induced = std::ranges::find(model.terms, PowerTerm::induced);
    if (induced == model.terms.end() || std::ranges::count(model.terms, PowerTerm::turn) > 0) return;
    const auto i = static_cast<std::size_t>(induced - model.terms.begin());
    for (auto& row : model.covariance) row.push_back(row[i]);
    if (!model.covariance.empty()) model.covariance.push_back(std::vector<double>(model.covariance[i]));
    model.terms.push_back(PowerTerm::turn);
    model.coefficients[PowerTerm::turn] = model.coefficients[PowerTerm::induced];
}

bool knows_cost_of_airspeed(const PhysicalModel& model) {
    return std::ranges::any_of(model.terms,
                               [](PowerTerm term) { return term == PowerTerm::drag || term == PowerTerm::blade; });
}

double max_predicted_airspeed_m_per_s(const PhysicalModel& model) {
    constexpr double beyond_flown = 1.25;
    constexpr double like_hover_m_per_s = 8.0;
    if (std::ranges::find(model.terms, PowerTerm::drag) != model.terms.end())
        return std::numeric_limits<double>::infinity();
    return std::max(beyond_flown * model.airspeed_m_per_s.high, like_hover_m_per_s);
}

double min_predicted_airspeed_m_per_s(const PhysicalModel& model, bool is_rotorcraft) {
    const bool knows_lift = std::ranges::find(model.terms, PowerTerm::induced) != model.terms.end();
    return knows_lift || is_rotorcraft ? 0.0 : model.airspeed_m_per_s.low;
}

bool is_near_flown_climb(const PhysicalModel& model, double climb_m_per_s) {
    constexpr double times_more = 1.5;
    constexpr double level_m_per_s = 0.5;
    const auto& [sink, climb] = model.climb_m_per_s;
    return climb_m_per_s >= std::min(times_more * sink, -level_m_per_s) &&
           climb_m_per_s <= std::max(times_more * climb, level_m_per_s);
}

bool may_predict_power(const PhysicalModel& model, const FlightState& motion, bool is_rotorcraft) {
    constexpr double max_power_ratio = 2.0;
    const auto& [low, high] = model.airspeed_m_per_s;
    const double speed = motion.airspeed_m_per_s;
    const double level_w = power_w(model, {speed});
    return speed >= min_predicted_airspeed_m_per_s(model, is_rotorcraft) &&
           speed <= max_predicted_airspeed_m_per_s(model) && level_w <= max_power_ratio * power_w(model, {high}) &&
           level_w * max_power_ratio >= power_w(model, {low}) && is_near_flown_climb(model, motion.climb_m_per_s);
}

bool is_within_flown_range(const PhysicalModel& model, const FlightState& motion) {
    return model.airspeed_m_per_s.contains(motion.airspeed_m_per_s) &&
           model.climb_m_per_s.contains(motion.climb_m_per_s);
}

}  // namespace flightwatt::mechanical
