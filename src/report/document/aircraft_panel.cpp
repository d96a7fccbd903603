#include "report/document/aircraft_panel.h"

#include "base/statistics.h"
#include "base/text.h"
#include "base/units.h"
#include "battery/battery.h"
#include "flight/flight_identity.h"
#include "report/document/columns.h"

#include <algorithm>
#include <map>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

using Flights = std::span<const ReportFlight>;

std::string plural(std::size_t number, std::string_view word) {
    return fmt::format("{} {}{}", number, word, number == 1 ? "" : "s");
}

std::tm utc(double clock_s) { return fmt::gmtime(static_cast<std::time_t>(clock_s)); }

/// "3 July 2020", of a Unix time.
std::string day_text(double clock_s) { return fmt::format("{} {:%B %Y}", utc(clock_s).tm_mday, utc(clock_s)); }

/// "3 July 2020", "3 to 10 July 2020", "28 June to 3 July 2020".
std::string dates_text(double first_s, double last_s) {
    const auto [first, last] = std::pair(utc(first_s), utc(last_s));
    const auto end = day_text(last_s);
    if (first.tm_year != last.tm_year) return fmt::format("{} to {}", day_text(first_s), end);
    if (first.tm_mon != last.tm_mon) return fmt::format("{} {:%B} to {}", first.tm_mday, first, end);
    return first.tm_mday == last.tm_mday ? end : fmt::format("{} to {}", first.tm_mday, end);
}

/// "3 flights, 3 to 10 July 2020".
std::string flights_text(std::span<const FlightSummary> flights) {
    std::vector<double> starts_s;
    for (const auto& flight : flights)
        if (flight.start_clock_s) starts_s.push_back(*flight.start_clock_s);
    auto text = plural(flights.size(), "flight");
    if (starts_s.empty()) return text;
    const auto [first, last] = std::ranges::minmax(starts_s);
    return fmt::format("{}, {}", text, dates_text(first, last));
}

std::string describe(std::span<const FlightSummary> flights) {
    double in_air_s = 0.0;
    double energy_wh = 0.0;
    std::size_t without_energy = 0;
    for (const auto& flight : flights) {
        in_air_s += flight.in_air_s;
        energy_wh += flight.energy_wh.value_or(0.0);
        if (!flight.energy_wh) ++without_energy;
    }
    auto text = fmt::format("{} \u00b7 {} in the air", flights_text(flights), duration_text(in_air_s));
    if (without_energy < flights.size()) text += fmt::format(" \u00b7 {:.1f} Wh", energy_wh);
    if (without_energy > 0) text += fmt::format(" ({} without measured power)", without_energy);
    return text;
}

std::map<std::string, std::vector<FlightSummary>> by_aircraft(Flights flights) {
    std::map<std::string, std::vector<FlightSummary>> of_aircraft;
    for (const auto& flight : flights)
        if (flight.rejected.empty())
            of_aircraft[flight::describe_aircraft(flight.data.aircraft_id, flight.data.aircraft_name)].push_back(
                flight.facts);
    return of_aircraft;
}

Json fact(std::string_view name, std::string_view value, std::string_view text) {
    return {{"name", name}, {"value", value}, {"text", text}};
}

Json phases_json(std::span<const FlightSummary> flown) {
    auto phases = Json::array();
    for (const auto phase : flight::all_phases) {
        std::vector<double> powers_w;
        for (const auto& flight : flown)
            if (flight.mean_power_w[phase]) powers_w.push_back(*flight.mean_power_w[phase]);
        if (powers_w.empty()) continue;
        const auto [low, high] = std::ranges::minmax(powers_w);
        phases.push_back({{"phase", to_string(phase)},
                          {"mean_power_w", rounded_json(mean(powers_w), 2)},
                          {"low_w", rounded_json(low, 2)},
                          {"high_w", rounded_json(high, 2)},
                          {"flights", powers_w.size()}});
    }
    return phases;
}

void add_cruise(Json& facts, std::span<const FlightSummary> flown) {
    std::vector<std::pair<double, const FlightSummary*>> energies_wh;  // of a minute
    double sum_wh = 0.0;
    for (const auto& flight : flown)
        if (const auto& power_w = flight.mean_power_w[flight::Phase::cruise]) {
            energies_wh.emplace_back(units::wh_from_joule(*power_w * units::seconds_per_minute), &flight);
            sum_wh += energies_wh.back().first;
        }
    if (energies_wh.empty()) return;
    const auto describe = [](const auto& one) {
        auto text = fmt::format("{:.2f} Wh", one.first);
        if (const auto& airspeed = one.second->cruise_airspeed_m_per_s)
            text += fmt::format(" at {:.1f} m/s", *airspeed);
        const auto& start_s = one.second->start_clock_s;
        return start_s ? fmt::format("{} ({})", text, day_text(*start_s)) : text;
    };
    const auto [low, high] = std::ranges::minmax_element(energies_wh);
    facts.push_back(fact("Energy for a minute of cruise",
                         fmt::format("{:.2f} Wh", sum_wh / static_cast<double>(energies_wh.size())),
                         low == high ? "" : fmt::format("from {} to {}", describe(*low), describe(*high))));
}

Json motion_fact(const mechanical::PhysicalModel& model) {
    const double airspeed = model.mean_airspeed_m_per_s;
    const double level_w = power_w(model, {.airspeed_m_per_s = airspeed});
    const double climb_w = power_w(model, {.airspeed_m_per_s = airspeed, .climb_m_per_s = 1.0}) - level_w;
    auto text = fmt::format("in level flight at {:.1f} m/s", airspeed);
    if (climb_w > 0.0) text += fmt::format(". A climb of 1 m/s adds {:.1f} W.", climb_w);
    return fact("Level flight and climb", fmt::format("{:.0f} W", level_w), text);
}

/// The pack of the missions, or else of the flights, and what the flights indicate.
void add_pack(Json& facts, const Findings& answers) {
    const auto& pack = answers.pack;
    if (answers.missions.empty() && !pack) return;
    const bool is_given = pack && pack->capacity.origin == battery::CapacityOrigin::given;
    const double capacity_ah = answers.missions.empty() ? pack->battery.capacity_ah
                                                        : answers.missions.front().mission.setup.battery.capacity_ah;
    std::string text = !answers.missions.empty() ? "in the missions." : is_given ? "as given." : "by the flights.";
    const auto add = [&](double indicated_ah, const Interval& interval_ah) {
        text += fmt::format(" The flights indicate {:.2g} Ah, and allow {:.2g} to {:.2g} Ah.", indicated_ah,
                            interval_ah.low, interval_ah.high);
    };
    if (pack && pack->battery.flight_estimate)
        add(pack->battery.flight_estimate->capacity_ah, pack->battery.flight_estimate->capacity_interval_ah);
    else if (pack && pack->capacity.interval_ah)
        add(pack->capacity.value_ah, *pack->capacity.interval_ah);
    facts.push_back(fact("Pack", fmt::format("{:.3g} Ah", capacity_ah), text));
}

/// The number of each flight with warnings, with the first of them.
Json warned_flights(Flights flights) {
    auto warned = Json::array();
    for (std::size_t f = 0; f < flights.size(); ++f)
        if (const auto& warnings = flights[f].warnings; flights[f].rejected.empty() && !warnings.empty())
            warned.push_back({{"flight", f}, {"text", warnings.front()}, {"warnings", warnings.size()}});
    return warned;
}

}  // namespace

std::string flight_title(const ReportFlight& flight) {
    const auto& start_s = flight.facts.start_clock_s;
    return start_s ? fmt::format("{}, {:%H:%M}", day_text(*start_s), utc(*start_s)) : flight.name;
}

Fields<AircraftLine> record_fields(const AircraftLine*) {
    return {field("name", &AircraftLine::name), field("text", &AircraftLine::text)};
}

std::vector<AircraftLine> aircraft_lines(Flights flights) {
    std::vector<AircraftLine> lines;
    for (const auto& [aircraft, summaries] : by_aircraft(flights)) lines.push_back({aircraft, describe(summaries)});
    return lines;
}

bool any_synthetic(Flights flights) {
    return std::ranges::any_of(flights, [](const ReportFlight& flight) {
        return flight.rejected.empty() && flight::is_synthetic(flight.data.aircraft_name);
    });
}

std::string prediction_line(const Findings& answers, bool synthetic) {
    const auto error_of = [&](std::string_view model) -> std::optional<double> {
        const auto score = score_of(answers.validated, std::string(model), std::nullopt);
        return score ? score->mean_absolute_error_percent : std::nullopt;
    };
    const auto known = error_of("physical");
    auto unknown = error_of("constant_mean");
    if (answers.model && answers.model->validation)
        for (const auto& score : answers.model->validation->scores)
            if (score.model == answers.model->validation->default_model) unknown = score.mean_absolute_error_percent;
    if (!known && !unknown) return "";
    return fmt::format("{:.0f} % off in total energy{}. Each flight is predicted from the others{}.",
                       known ? *known : *unknown,
                       known && unknown ? fmt::format(" if the airspeed is known, {:.0f} % if not", *unknown) : "",
                       synthetic ? " (SYNTHETIC flights)" : "");
}

std::string page_title(Flights flights, std::size_t missions) {
    std::vector<std::string> parts;
    for (const auto& [aircraft, summaries] : by_aircraft(flights))
        parts.push_back(fmt::format("{}: {}", aircraft, flights_text(summaries)));
    if (missions > 0) parts.push_back(plural(missions, "mission"));
    return parts.empty() ? "FlightWatt report" : fmt::format("{}", fmt::join(parts, "; "));
}

Json aircraft_panel(const Findings& answers, Flights flights) {
    std::vector<FlightSummary> flown;
    for (const auto& flight : flights)
        if (flight.rejected.empty() && flight.unusable_power.empty() && flight.is_fitted) flown.push_back(flight.facts);
    const bool is_one = by_aircraft(flights).size() == 1;
    auto facts = Json::array();
    if (is_one) add_cruise(facts, flown);
    if (answers.model && answers.model->physical) facts.push_back(motion_fact(*answers.model->physical));
    if (const auto line = prediction_line(answers, any_synthetic(flights)); !line.empty()) {
        const auto end = line.find(" in ");
        facts.push_back(fact("How well are new flights predicted?", line.substr(0, end), line.substr(end + 1)));
    }
    add_pack(facts, answers);
    if (flights.empty() && facts.empty()) return nullptr;
    const auto is_rejected = [](const ReportFlight& flight) { return !flight.rejected.empty(); };
    return {{"phases", is_one ? phases_json(flown) : Json::array()},
            {"facts", facts},
            {"warned_flights", warned_flights(flights)},
            {"rejected_logs", std::ranges::count_if(flights, is_rejected)}};
}

}  // namespace flightwatt::report
