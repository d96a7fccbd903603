#include "mission/file/payload_toml.h"

// payload_kg of a mission: what a payload adds to the power, as the flights show it or by an assumption.

#include "base/statistics.h"
#include "mechanical/mechanical_model.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

using namespace mechanical;

/// Standard deviation of an assumed change of power, as a part of it: of a rotorcraft up to 40 % of the power (computer,
/// drag) does not grow with its weight.
constexpr double assumed_change_sd = 0.2;

bool has_term(const PhysicalModel& model, PowerTerm term) {
    return std::ranges::find(model.terms, term) != model.terms.end();
}

bool knows_payload(const PhysicalModel& model) {
    return has_term(model, PowerTerm::payload) || (has_term(model, PowerTerm::hover) && model.load.rotors);
}

FlightState usual_motion(const PhysicalModel& model) {
    return {model.cubic_mean_airspeed_m_per_s.value_or(model.airspeed_m_per_s.high)};
}

void note_payload_range(double payload_kg, const PhysicalModel& model, MissionSetup& mission) {
    const auto flown = model.payload_kg.value_or(Interval{});
    if (flown.contains(payload_kg)) return;
    mission.notes.push_back(
        fmt::format("payload_kg = {} is beyond that of the model's flights ({:.4g} to {:.4g} kg): its power is "
                    "extrapolated",
                    payload_kg, flown.low, flown.high));
}

/// Sets the payload of which the model predicts power. What a payload adds in proportion (W/kg) is, of a rotorcraft, the
/// tangent of power ~ mass^1.5 at the flights' mean payload; beyond their payloads that power decides.
void set_payload(double payload_kg, bool is_rotorcraft, PhysicalModel& model) {
    const double flown_kg = std::exchange(model.load.payload_kg, payload_kg);
    const double w_per_kg = model.coefficients[PowerTerm::payload];
    if (!is_rotorcraft || !model.payload_kg || payload_kg <= model.payload_kg->high || !(w_per_kg > 0.0)) return;
    auto flown = model;
    flown.load.payload_kg = flown_kg;
    const double flown_w = power_w(flown, usual_motion(model));
    const double mass_kg = hover_exponent * flown_w / w_per_kg;  // with the flights' mean payload
    const double rise_w = flown_w * (std::pow(1.0 + (payload_kg - flown_kg) / mass_kg, hover_exponent) - 1.0);
    model.load.payload_kg = flown_kg + rise_w / w_per_kg;
}

/// The power with a payload that the flights do not determine, by that of the flights; without a reason unknown.
struct AssumedPower {
    double factor = 1.0;
    std::string reason = {};
};

void scale_term(PowerTerm term, double factor, PhysicalModel& model) {
    model.coefficients[term] *= factor;
    const auto i = static_cast<std::size_t>(std::ranges::find(model.terms, term) - model.terms.begin());
    if (i == model.terms.size()) return;
    for (double& value : model.covariance[i]) value *= factor;
    for (auto& row : model.covariance) row[i] *= factor;
}

/// Changes the physical model, if there is one. Of rotors all power grows as in hover, by momentum theory; of a wing the
/// induced drag grows with mass^2, and the climb with the mass.
AssumedPower assume_payload(double payload_kg, std::optional<double> mass_kg, MechanicalModel& model) {
    using enum PowerTerm;
    auto* physical = model.physical ? &*model.physical : nullptr;
    if (!mass_kg && physical != nullptr && physical->load.rotors)
        mass_kg = physical->load.rotors->mass_kg + physical->load.payload_kg;
    if (!mass_kg) return {};
    const double flown_kg = physical != nullptr ? physical->load.payload_kg : 0.0;
    const double ratio = (*mass_kg + payload_kg - flown_kg) / *mass_kg;
    if (!(ratio > 0.0)) return {};
    if (model.is_rotorcraft) {
        const double factor = std::pow(ratio, hover_exponent);
        if (physical != nullptr)
            for (const auto term : physical->terms) scale_term(term, factor, *physical);
        return {factor, "its power is assumed to be proportional to mass^1.5, as in hover"};
    }
    if (physical == nullptr || !has_term(*physical, induced)) return {};
    const auto usual = usual_motion(*physical);
    const double flown_w = power_w(*physical, usual);
    for (const auto term : {induced, turn}) scale_term(term, ratio * ratio, *physical);
    for (const auto term : {climb, descent}) scale_term(term, ratio, *physical);
    return {flown_w > 0.0 ? power_w(*physical, usual) / flown_w : 1.0,
            "its induced drag is assumed to be proportional to mass^2"};
}

/// The power of all phases and of their flights in proportion.
void scale_phases(double factor, MechanicalModel& model) {
    for (auto& phase : model.phases.values) {
        phase.fourier.a0_w *= factor;
        for (auto* coefficients : {&phase.fourier.cos_w, &phase.fourier.sin_w})
            for (auto& value : *coefficients) value *= factor;
        if (!phase.level_spread) continue;
        phase.level_spread->between_flight_sd_w *= factor;
        phase.level_spread->drift_sd_w *= factor;
    }
    for (auto& flight : model.flights)
        for (auto& part : flight.phases.values)
            if (part && part->mean_power_w) *part->mean_power_w *= factor;
}

/// Throws InputError for a mass that the power cannot carry, and a payload of more than twice the mass: grams.
void require_plausible_mass(const TomlTable& table, double mass_kg, double payload_kg, const MechanicalModel& model) {
    constexpr double max_payload_ratio = 2.0;
    const double least_w_per_kg = model.is_rotorcraft ? 10.0 : 1.0;  // helicopters take 50 or more, sailplanes 5
    const double power_w = mean_power_w(model.phases[flight::Phase::cruise]);
    if (power_w < least_w_per_kg * mass_kg)
        throw InputError(table.where("takeoff_mass_kg"),
                         fmt::format("{} kg cannot fly with the {:.0f} W of the model's cruise", mass_kg, power_w),
                         "give the mass in kilograms");
    if (payload_kg > max_payload_ratio * mass_kg)
        throw InputError(table.where("payload_kg"),
                         fmt::format("a payload of {} kg on an aircraft of {} kg", payload_kg, mass_kg),
                         "give it in kilograms");
}

/// Where all flights state different payloads, the powers of their cruises differ above all by these, which a stated payload
/// leaves nothing of: what remains is at most the physical model's level, with the same 95 % interval, and its error.
void leave_out_spread_of_payloads(MechanicalModel& model) {
    const auto& physical = *model.physical;
    auto& cruise = model.phases[flight::Phase::cruise];
    const bool differ = physical.payload_kg && physical.payload_kg->high > physical.payload_kg->low;
    if (!differ || !physical.level_sd || !cruise.level_spread || cruise.level_spread->flights < 2) return;
    const auto terms = term_values(usual_motion(physical), physical.load);
    const double power_w = sum_of_terms_w(physical, terms);
    if (!(power_w > 0.0)) return;
    const double relative_sd =
        std::hypot(*physical.level_sd, std::sqrt(coefficient_variance_w2(physical, terms)) / power_w);
    const double mean_w = mean_power_w(cruise);
    auto& sd_w = cruise.level_spread->between_flight_sd_w;
    const double remaining_w = relative_sd * mean_w * student_t_half_width(physical.degrees_of_freedom) /
                               student_t_half_width(static_cast<double>(cruise.level_spread->flights - 1));
    if (remaining_w >= sd_w) return;
    for (auto& flight : model.flights)
        if (auto& part = flight.phases[flight::Phase::cruise]; part && part->mean_power_w)
            part->mean_power_w = mean_w + (*part->mean_power_w - mean_w) * remaining_w / sd_w;
    sd_w = remaining_w;
}

/// Adds an independent standard deviation to that between flights; both relative to the power.
void widen(double sd, MechanicalModel& model) {
    for (auto& phase : model.phases.values) {
        if (!phase.level_spread) continue;
        auto& sd_w = phase.level_spread->between_flight_sd_w;
        sd_w = std::hypot(sd_w, sd * mean_power_w(phase));
    }
    if (model.physical && model.physical->level_sd)
        model.physical->level_sd = std::hypot(*model.physical->level_sd, sd);
}

}  // namespace

void apply_payload(const TomlTable& mission_table, MissionSetup& mission) {
    const auto payload_kg = optional_number_in(between(0.0, 1e3), mission_table, "payload_kg");
    const auto mass_kg = optional_number_in(more_than_up_to(0.0, 1e4), mission_table, "takeoff_mass_kg");
    if (!payload_kg && mass_kg)
        throw InputError(mission_table.where("takeoff_mass_kg"), "takeoff_mass_kg belongs to payload_kg",
                         "add it, or leave this out");
    if (!payload_kg) return;
    const auto where = mission_table.where("payload_kg");
    if (!mission.mechanical)
        throw InputError(where, "payload_kg has no meaning with mechanical = \"none\"", "leave it out");
    auto& model = *mission.mechanical;
    if (model.physical && knows_payload(*model.physical)) {
        note_payload_range(*payload_kg, *model.physical, mission);
        if (mass_kg) mission.notes.emplace_back("takeoff_mass_kg is not used: the model knows what a payload takes");
        const auto usual = usual_motion(*model.physical);
        const double flown_w = power_w(*model.physical, usual);
        set_payload(*payload_kg, model.is_rotorcraft, *model.physical);
        const double factor = flown_w > 0.0 ? power_w(*model.physical, usual) / flown_w : 1.0;
        if (factor != 1.0)
            mission.payload = {*payload_kg, false, "its power is by the physical model, as the flights show it"};
        scale_phases(factor, model);
        return leave_out_spread_of_payloads(model);
    }
    if (mass_kg) require_plausible_mass(mission_table, *mass_kg, *payload_kg, model);
    const auto assumed = assume_payload(*payload_kg, mass_kg, model);
    if (assumed.reason.empty())
        throw InputError(
            where, "the mechanical model does not know the effect of payload: its flights do not determine it",
            !mass_kg ? "add takeoff_mass_kg (option --mass), the mass of the aircraft as its flights were flown; for "
                       "wings, whose flights must determine the induced drag too, fit flights that state their payload"
            : model.is_rotorcraft
                ? "fit flights that state their payload, or fit without --model-kind fourier"
                : "its mass does not help, as the flights of this wing do not show its induced drag: fit flights at "
                  "several airspeeds, or that state their payload");
    mission.notes.push_back(fmt::format("payload_kg = {}: {}; its interval is wider", *payload_kg, assumed.reason));
    if (assumed.factor != 1.0) mission.payload = {*payload_kg, true, assumed.reason};
    scale_phases(assumed.factor, model);
    widen(std::abs(1.0 - 1.0 / assumed.factor) * assumed_change_sd, model);
}

}  // namespace flightwatt::mission
