#include "answer/answer.h"

#include "answer/failsafe.h"
#include "base/error.h"
#include "base/statistics.h"
#include "base/text.h"
#include "base/units.h"
#include "mechanical/table_one.h"
#include "mission/feasibility_limits.h"
#include "mission/mission_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::answer {
namespace {

using flight::Phase;

constexpr double in_95_of_100 = 0.95;
/// A rotorcraft whose cruises are slower than this hovers; chosen with a Y6 in view that drifts with 2.2 m/s.
constexpr double max_hover_m_per_s = 3.0;

/// The airspeed at which a mission predicts the power: what is asked, or of a rotorcraft the wind that it holds against.
std::optional<double> mission_airspeed_m_per_s(const KnownAircraft& aircraft, const Question& question) {
    if (question.airspeed_m_per_s) return question.airspeed_m_per_s;
    if (!aircraft.model.is_rotorcraft || question.wind_m_per_s == 0.0) return std::nullopt;
    return std::max(question.wind_m_per_s, mean_ground_speed_m_per_s(aircraft.flights).value_or(0.0));
}

std::string flights_text(std::size_t flights) {
    return flights == 1 ? std::string("1 flight") : fmt::format("{} flights", flights);
}

/// What a power rests on: the flights' own mean, or the physical model or an assumption that changes it.
std::string power_basis(const KnownAircraft& aircraft, const Question& question) {
    const auto flights = aircraft.model.flights.size();
    if (!mission_airspeed_m_per_s(aircraft, question) && !question.payload_kg) {
        const auto whole = aircraft.model.phases[Phase::cruise].flights;  // 0: the file does not state it
        return fmt::format("measured on {}", flights_text(whole > 0 ? whole : flights));
    }
    auto basis = "physics, from power and motion measured on " + flights_text(flights);
    if (aircraft.model.is_rotorcraft && question.wind_m_per_s > 0.0)
        basis += "; assumed: those flights were in calm air";
    return basis;
}

/// What the pack's resistance rests on at the temperature that is asked for; empty without one.
std::string resistance_basis(const PackAnswer& pack) {
    if (!pack.resistance_at_ohm.value) return "";
    return fmt::format("; the pack's resistance at {:g} degC: {}", *pack.asked_temperature_c,
                       pack.resistance_at_ohm.basis);
}

/// What the flights' mean ground speed is, which none of them may have flown.
std::string ground_speed_basis(const std::vector<FlightFacts>& flights) {
    constexpr double max_ratio = 2.0;
    constexpr double max_difference_m_per_s = 3.0;
    double low = std::numeric_limits<double>::infinity();
    double high = 0.0;
    for (const auto& flight : flights) {
        low = std::min(low, flight.ground_speed_m_per_s.value_or(low));
        high = std::max(high, flight.ground_speed_m_per_s.value_or(high));
    }
    if (high <= max_ratio * low || high - low <= max_difference_m_per_s)
        return "assumed: the ground speed of the flights, as in calm air";
    return fmt::format(
        "assumed: the mean ground speed of flights at {:.1f} to {:.1f} m/s, as in calm air; --airspeed "
        "asks for one speed",
        low, high);
}

/// The airspeed of the cruise [m/s]: as asked, or as flown.
Answered cruise_airspeed(const KnownAircraft& aircraft, const Question& question) {
    if (const auto asked = mission_airspeed_m_per_s(aircraft, question)) return known(*asked, "as asked");
    const auto& physical = aircraft.model.physical;
    if (!aircraft.model.is_rotorcraft && physical && physical->mean_airspeed_m_per_s > 0.0)
        return known(physical->mean_airspeed_m_per_s, physical->airspeed_sd_m_per_s
                                                          ? "estimated of the cruise, from the ground velocity"
                                                          : "measured in cruise");
    if (const auto ground = mean_ground_speed_m_per_s(aircraft.flights))
        return known(*ground, ground_speed_basis(aircraft.flights));
    return unknown("the logs have neither airspeed nor position; a flight with GPS shows it");
}

/// The airspeed of the way home: that of the cruise; of a rotorcraft its speed over ground, against the wind.
Answered return_airspeed(const KnownAircraft& aircraft, const Question& question, const Answered& cruise) {
    if (question.airspeed_m_per_s || !aircraft.model.is_rotorcraft) return cruise;
    const double flown = mean_ground_speed_m_per_s(aircraft.flights).value_or(0.0);
    if (question.wind_m_per_s == 0.0 && flown >= least_return_m_per_s) return cruise;
    const double speed = std::max(flown, least_return_m_per_s) + question.wind_m_per_s;
    auto basis = flown >= least_return_m_per_s
                     ? fmt::format("assumed: {:.1f} m/s over ground as in the flights", flown)
                     : std::string("assumed, as slow as autopilots return; --airspeed states yours");
    const auto& physical = aircraft.model.physical;
    if (!physical)
        basis += ", at their power";
    else if (speed > max_predicted_airspeed_m_per_s(*physical))
        return unknown(
            fmt::format("{:.1f} m/s of airspeed are beyond what its flights show; --airspeed states a slower "
                        "way home",
                        speed));
    else if (!is_within_flown_range(*physical, {speed, 0.0, 1.0}))
        basis += "; its power is extrapolated";
    return known(speed, std::move(basis));
}

/// That a VTOL's cruises are not on its wing alone; empty where they are.
std::string hover_note(double wing_share) {
    constexpr double nearly_all = 0.98;
    if (wing_share >= nearly_all) return "";
    if (wing_share == 0.0) return "the flights never are on the wing: power and time are those of hover";
    return fmt::format(
        "{:.0f} % of the cruise are hover and transitions, as in the flights: power, time and distance are with them; "
        "--airspeed answers for flight on the wing",
        units::percent_per_whole * (1.0 - wing_share));
}

/// The distance over ground of a cruise along the wind, out and back.
Answered distance(const Answered& airspeed, double cruise_s, double wind_m_per_s) {
    if (!airspeed.value) return unknown(airspeed.unknown);
    const double speed = *airspeed.value;
    if (speed <= wind_m_per_s)
        return unknown(
            fmt::format("at {:.1f} m/s it makes no way against a wind of {:.1f} m/s; --airspeed answers for a speed",
                        speed, wind_m_per_s));
    return known(cruise_s * (speed * speed - wind_m_per_s * wind_m_per_s) / speed, airspeed.basis);
}

/// That other packs gave a part of the power; empty where none did.
std::string other_packs_note(const std::vector<FlightFacts>& flights) {
    double least_percent = units::percent_per_whole;
    for (const auto& flight : flights)
        least_percent = std::min(least_percent, flight.pack_percent.value_or(least_percent));
    constexpr double nearly_all_percent = 98.0;
    if (least_percent >= nearly_all_percent) return "";
    return fmt::format(
        "the pack is taken to give all of the power, of which packs of other circuits gave {:.0f} % in "
        "the flights: it lasts longer if theirs do",
        units::percent_per_whole - least_percent);
}

/// That flights with different payloads are averaged; empty where none, or all one, is known.
std::string payloads_note(const std::vector<FlightFacts>& flights) {
    std::vector<double> stated_kg;
    for (const auto& flight : flights)
        if (flight.payload_kg) stated_kg.push_back(*flight.payload_kg);
    if (stated_kg.empty()) return "";
    const auto [low, high] = std::ranges::minmax(stated_kg);
    const auto unstated = flights.size() - stated_kg.size();
    if (low == high && (unstated == 0 || high == 0.0)) return "";
    return fmt::format("the flights carried {}{:g} kg{}: power and time are of their mean; --payload answers for one",
                       low < high ? fmt::format("{:g} to ", low) : "", high,
                       unstated > 0 ? fmt::format(", and {} state no payload", unstated) : "");
}

/// The mission of the question with a given duration of its cruise.
mission::MissionVariation variation_of(const KnownAircraft& aircraft, const Question& question) {
    const auto mission_of =
        mission::mission_loader(mission_toml(aircraft, question), aircraft.model_file.parent_path() / mission_name);
    return [mission_of](double cruise_s) { return mission_of({.cruise_s = cruise_s}); };
}

/// The mission of the flights' own cruise; its error is why power and time are unknown.
std::optional<mission::MissionSetup> setup_of_question(const mission::MissionVariation& with_cruise_s,
                                                       const KnownAircraft& aircraft, Endurance& endurance) {
    try {
        return mission::setup_of(with_cruise_s(std::max(1.0, aircraft.model.phases[Phase::cruise].duration_s)));
    } catch (const InputError& error) {
        const auto reason =
            error.hint().empty() ? std::string(error.what()) : fmt::format("{}; {}", error.what(), error.hint());
        for (auto* quantity : {&endurance.power_w, &endurance.time_s, &endurance.time_95_s, &endurance.distance_m})
            *quantity = unknown(reason);
        return std::nullopt;
    }
}

double mean_cruise_power_w(const mission::MissionSetup& mission) {
    if (mission.cruise_level) return mission.cruise_level->mean_w;
    return mean_power_w(mission.mechanical->phases[Phase::cruise]);
}

/// Why no time is known with that probability; empty if it may be.
std::string no_variability(const KnownAircraft& aircraft, const Question& question) {
    if (!question.draws_flights) return "no flights were drawn";
    const auto flights = aircraft.model.flights.size();
    if (flights > 1) return {};
    return "one flight does not show how flights differ; two more would";
}

Answered longest(const mission::MissionVariation& with_cruise_s, double other_phases_s,
                 const std::optional<double>& probability, const std::string& basis) {
    try {
        const auto limit = mission::longest_cruise(with_cruise_s, probability);
        auto text = basis;
        if (limit.limited_by != mission::LimitingFactor::charge)
            text += fmt::format("; limited by the pack's {}", to_string(limit.limited_by));
        return known(limit.value + other_phases_s, std::move(text));
    } catch (const NoResultError& error) {
        return unknown(error.what());
    } catch (const InputError& error) {
        return unknown(error.what());
    }
}

}  // namespace

std::string mission_toml(const KnownAircraft& aircraft, const Question& question,
                         const std::optional<double>& cruise_s) {
    auto text = fmt::format("name = {}\nmechanical = {}\nbattery = {}\nreserve_soc_percent = {}\n",
                            toml_string(cruise_s ? "longest flight" : "flight as flown"),
                            toml_string(aircraft.model_file.filename().string()),
                            toml_string(aircraft.battery_file.filename().string()), question.reserve_soc_percent);
    const auto add = [&](const char* key, const std::optional<double>& value) {
        if (value) text += fmt::format("{} = {}\n", key, *value);
    };
    if (cruise_s) text += fmt::format("duration_s = {{ cruise = {:.0f} }}\n", std::floor(*cruise_s));
    add("payload_kg", question.payload_kg);
    add("takeoff_mass_kg", question.takeoff_mass_kg);
    add("airspeed_m_per_s", mission_airspeed_m_per_s(aircraft, question));
    return text;
}

Endurance answer_endurance(const KnownAircraft& aircraft, const Question& question) {
    Endurance endurance;
    const auto speed = mean_ground_speed_m_per_s(aircraft.flights);
    const double on_wing = mission_airspeed_m_per_s(aircraft, question) ? 1.0 : wing_share(aircraft.flights);
    endurance.is_hover = on_wing == 0.0 || (aircraft.model.is_rotorcraft && !question.airspeed_m_per_s &&
                                            (question.wind_m_per_s > 0.0 || (speed && *speed < max_hover_m_per_s)));
    const auto basis = power_basis(aircraft, question);
    const auto with_cruise_s = variation_of(aircraft, question);
    const auto setup = setup_of_question(with_cruise_s, aircraft, endurance);
    endurance.airspeed_m_per_s = cruise_airspeed(aircraft, question);
    endurance.return_airspeed_m_per_s = return_airspeed(aircraft, question, endurance.airspeed_m_per_s);
    if (!setup) return endurance;
    endurance.notes = setup->notes;
    endurance.power_w = known(mean_cruise_power_w(*setup), basis);
    const double other_s = setup->duration_s[Phase::takeoff] + setup->duration_s[Phase::landing];
    const auto& missing = missing_of(aircraft.pack);
    const auto time_basis = basis + resistance_basis(aircraft.pack);
    if (aircraft.pack.resistance_at_ohm.value)
        endurance.notes.push_back(
            fmt::format("the capacity is assumed to be unchanged at {:g} degC; a cold pack gives less",
                        *aircraft.pack.asked_temperature_c));
    if (auto note = other_packs_note(aircraft.flights); !note.empty()) endurance.notes.push_back(std::move(note));
    if (auto note = payloads_note(aircraft.flights); !note.empty() && !question.payload_kg)
        endurance.notes.push_back(std::move(note));
    if (auto note = hover_note(on_wing); !note.empty()) endurance.notes.push_back(std::move(note));
    const auto& physical = aircraft.model.physical;
    const bool is_mean_speed = !physical || !(physical->mean_airspeed_m_per_s > 0.0);  // with that of the hover
    const double at_speed = is_mean_speed ? 1.0 : on_wing;
    const auto no_95 = no_variability(aircraft, question);
    endurance.time_s = missing.empty() ? longest(with_cruise_s, other_s, std::nullopt, time_basis) : unknown(missing);
    endurance.time_95_s = !endurance.time_s.value ? unknown(endurance.time_s.unknown)
                          : !no_95.empty()        ? unknown(no_95)
                                                  : longest(with_cruise_s, other_s, in_95_of_100, time_basis);
    const bool holds_place = aircraft.model.is_rotorcraft && !question.airspeed_m_per_s && question.wind_m_per_s > 0.0;
    const double cruise_s = endurance.time_s.value.value_or(0.0) - other_s;
    if (endurance.time_s.value)
        endurance.cruise_s = std::max(1.0, endurance.time_95_s.value.value_or(*endurance.time_s.value) - other_s);
    if (!endurance.time_s.value)
        endurance.distance_m = unknown(endurance.time_s.unknown);
    else if (holds_place)
        endurance.distance_m = unknown("it holds its place against the wind; --airspeed answers for a speed");
    else if (endurance.is_hover)
        endurance.distance_m = unknown("it hovered in all flights; a flight along a way, or --airspeed, answers it");
    else
        endurance.distance_m = distance(endurance.airspeed_m_per_s, at_speed * cruise_s, question.wind_m_per_s);
    if (endurance.distance_m.value && question.wind_m_per_s > 0.0)
        endurance.distance_across_m =
            at_speed * cruise_s *
            std::sqrt(std::pow(*endurance.airspeed_m_per_s.value, 2) - std::pow(question.wind_m_per_s, 2));
    constexpr std::size_t enough_flights = 3;  // that distinguish the terms of the power
    if (aircraft.model.physical && !aircraft.model.is_rotorcraft && aircraft.model.flights.size() >= enough_flights)
        if (auto speeds = speed_to_fly(*aircraft.model.physical, question.wind_m_per_s))
            endurance.best_speeds = std::move(speeds->best);
    return endurance;
}

}  // namespace flightwatt::answer
