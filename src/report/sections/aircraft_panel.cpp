#include "report/sections/aircraft_panel.h"

#include "base/statistics.h"
#include "base/text.h"
#include "base/units.h"
#include "battery/battery.h"
#include "flight/flight_identity.h"
#include "report/batch_content.h"
#include "report/sections/flights_section.h"

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
                summarize_flight(flight));
    return of_aircraft;
}

std::string fact(std::string_view name, std::string_view value, std::string_view text) {
    return fmt::format("<dt>{}</dt><dd><b>{}</b> {}</dd>\n", name, html_escaped(value), html_escaped(text));
}

std::string phases_html(std::span<const FlightSummary> flown) {
    flight::PerPhase<std::vector<double>> powers_w;
    double max_w = 1.0;
    for (const auto& flight : flown)
        for (const auto phase : flight::all_phases)
            if (flight.mean_power_w[phase]) powers_w[phase].push_back(*flight.mean_power_w[phase]);
    for (const auto& powers : powers_w.values)
        if (!powers.empty()) max_w = std::max(max_w, std::ranges::max(powers));
    std::string html;
    for (const auto phase : flight::all_phases) {
        const auto& powers = powers_w[phase];
        if (powers.empty()) continue;
        const auto [low, high] = std::ranges::minmax(powers);
        html += fmt::format(
            "<li class=\"{}\"><span>{}</span> <b>{:.1f} W</b><i><i style=\"width:{:.0f}%\"></i></i> "
            "<small>{}</small></li>\n",
            to_string(phase), phase_word(phase), mean(powers),
            std::clamp(units::percentage(mean(powers), max_w), 1.0, 100.0),
            powers.size() > 1 ? fmt::format("{:.1f} to {:.1f} W", low, high) : "");
    }
    if (html.empty()) return html;
    return fmt::format("<h3>Mean power by phase <span>of {}</span></h3>\n<ul class=\"phases\">\n{}</ul>\n",
                       plural(flown.size(), "flight"), html);
}

std::string cruise_fact(std::span<const FlightSummary> flown) {
    std::vector<std::pair<double, const FlightSummary*>> energies_wh;  // of a minute
    double sum_wh = 0.0;
    for (const auto& flight : flown)
        if (const auto& power_w = flight.mean_power_w[flight::Phase::cruise]) {
            energies_wh.emplace_back(units::wh_from_joule(*power_w * units::seconds_per_minute), &flight);
            sum_wh += energies_wh.back().first;
        }
    if (energies_wh.empty()) return "";
    const auto describe = [](const auto& one) {
        auto text = fmt::format("{:.2f} Wh", one.first);
        if (const auto& airspeed = one.second->cruise_airspeed_m_per_s)
            text += fmt::format(" at {:.1f} m/s", *airspeed);
        const auto& start_s = one.second->start_clock_s;
        return start_s ? fmt::format("{} ({})", text, day_text(*start_s)) : text;
    };
    const auto [low, high] = std::ranges::minmax_element(energies_wh);
    return fact("Energy for a minute of cruise",
                fmt::format("{:.2f} Wh", sum_wh / static_cast<double>(energies_wh.size())),
                low == high ? "" : fmt::format("from {} to {}", describe(*low), describe(*high)));
}

std::string motion_fact(const mechanical::PhysicalModel& model) {
    const double airspeed = model.mean_airspeed_m_per_s;
    const double level_w = power_w(model, {.airspeed_m_per_s = airspeed});
    const double climb_w = power_w(model, {.airspeed_m_per_s = airspeed, .climb_m_per_s = 1.0}) - level_w;
    auto text = fmt::format("in level flight at {:.1f} m/s", airspeed);
    if (climb_w > 0.0) text += fmt::format(". A climb of 1 m/s adds {:.1f} W.", climb_w);
    return fact("Level flight and climb", fmt::format("{:.0f} W", level_w), text);
}

/// The pack of the missions, or else of the flights, and what the flights indicate.
std::string pack_fact(const PageSummary& answers) {
    const auto& pack = answers.pack;
    if (answers.missions.empty() && !pack) return "";
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
    return fact("Pack", fmt::format("{:.3g} Ah", capacity_ah), text);
}

/// The flights with warnings, and the rejected logs, each with a link.
std::string flight_notes_html(Flights flights) {
    constexpr std::size_t max_shown = 3;
    std::vector<std::string> notes;
    const auto ids = flight_ids(flights);
    std::size_t rejected = 0;
    for (std::size_t f = 0; f < flights.size(); ++f) {
        if (!flights[f].rejected.empty()) ++rejected;
        if (!flights[f].rejected.empty() || flights[f].warnings.empty()) continue;
        const auto& warnings = flights[f].warnings;
        const auto more = warnings.size() > 1 ? fmt::format(" (and {} more)", warnings.size() - 1) : "";
        notes.push_back(fmt::format("<a href=\"#{}\">{} on {}</a>: {}{}", ids[f], plural(warnings.size(), "warning"),
                                    html_escaped(flight_title(flights[f])), html_escaped(warnings.front()), more));
    }
    if (notes.size() > max_shown) {
        const auto more = notes.size() - max_shown;
        notes.resize(max_shown);
        notes.push_back(fmt::format("<a href=\"#flights\">Warnings on {}</a>", plural(more, "more flight")));
    }
    if (rejected > 0) notes.push_back(fmt::format("<a href=\"#excluded\">{}</a> not used", plural(rejected, "log")));
    std::string html;
    for (const auto& note : notes) html += fmt::format("<p class=\"note\">{}</p>\n", note);
    return html;
}

}  // namespace

std::string day_text(double clock_s) { return fmt::format("{} {:%B %Y}", utc(clock_s).tm_mday, utc(clock_s)); }

std::string flight_title(const ReportFlight& flight) {
    const auto start_s = summarize_flight(flight).start_clock_s;
    return start_s ? fmt::format("{}, {:%H:%M}", day_text(*start_s), utc(*start_s)) : flight.name;
}

std::vector<std::string> aircraft_lines(Flights flights) {
    std::vector<std::string> lines;
    for (const auto& [aircraft, summaries] : by_aircraft(flights))
        lines.push_back(fmt::format("{}: {}", aircraft, describe(summaries)));
    return lines;
}

bool any_synthetic(Flights flights) {
    return std::ranges::any_of(flights, [](const ReportFlight& flight) {
        return flight.rejected.empty() && flight::is_synthetic(flight.data.aircraft_name);
    });
}

std::string prediction_line(const PageSummary& answers, bool synthetic) {
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

std::string aircraft_panel(const PageSummary& answers, Flights flights) {
    std::vector<FlightSummary> flown;
    for (const auto& flight : flights)
        if (flight.rejected.empty() && flight.unusable_power.empty()) flown.push_back(summarize_flight(flight));
    auto html = by_aircraft(flights).size() == 1 ? phases_html(flown) : "";
    std::string facts = html.empty() ? "" : cruise_fact(flown);
    if (answers.model && answers.model->physical) facts += motion_fact(*answers.model->physical);
    if (const auto line = prediction_line(answers, any_synthetic(flights)); !line.empty()) {
        const auto end = line.find(" in ");
        facts += fact("How well are new flights predicted?", line.substr(0, end), line.substr(end + 1));
    }
    facts += pack_fact(answers);
    if (!facts.empty()) html += "<dl>\n" + facts + "</dl>\n";
    html += flight_notes_html(flights);
    if (const auto count = answers.warnings.size() + answers.notes.size(); count > 0)
        html += fmt::format("<p class=\"note\"><a href=\"#notes\">{}</a> on models and contents</p>\n",
                            plural(count, "note"));
    return html;
}

}  // namespace flightwatt::report
