#include "report/document/flights_document.h"

#include "base/text.h"
#include "base/units.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "report/document/aircraft_panel.h"
#include "report/document/columns.h"
#include "report/document/track_document.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <iterator>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr double max_event_distance_s = 60.0;

/// Evidence of an edge.
std::string describe_edge(const flight::PhaseEdge& edge) {
    auto text = fmt::format("altitude {:.1f} m", edge.altitude_m);
    if (edge.throttle_percent) text += fmt::format(", throttle {:.0f} %", *edge.throttle_percent);
    if (edge.takeoff_after_s && std::abs(*edge.takeoff_after_s) < max_event_distance_s) {
        text += fmt::format(", nearest TAKEOFF message {:.1f} s {}", std::abs(*edge.takeoff_after_s),
                            *edge.takeoff_after_s < 0.0 ? "before" : "after");
    }
    if (edge.mode) text += fmt::format(", mode {}", *edge.mode);
    if (edge.block) text += fmt::format(", block {}", *edge.block);
    return text + fmt::format("; known within {:.1f} s", edge.gap_s);
}

std::string edge_name(const flight::PhaseSpan& span, bool begin) {
    if (span.phase == flight::Phase::takeoff) return begin ? "lift-off" : "end of take-off";
    if (span.phase == flight::Phase::landing) return begin ? "start of landing" : "touchdown";
    return begin ? "start of cruise" : "end of cruise, start of landing";
}

/// Whether an incomplete phase ends with the log.
bool is_end_of_log(const flight::Track& clock, double time_s) {
    constexpr double near_s = 2.0;  // altitude and power have clocks of their own
    return time_s - clock.time_s.front() < near_s || clock.time_s.back() - time_s < near_s;
}

/// A page of more flights compresses their details, which are of fewer pixel columns: it is small and opens as quickly.
constexpr std::size_t max_plain_flights = 20;
constexpr std::size_t plot_columns = 250;
constexpr std::size_t plot_columns_of_many = 90;
constexpr int time_decimals = 2;

/// Decimals with which the largest value has four digits.
int decimals_of(const std::vector<double>& values) {
    double largest = 0.0;
    for (const double value : values) largest = std::max(largest, std::abs(value));
    constexpr int max_decimals = 3;
    return largest < 1.0 ? max_decimals : std::max(0, max_decimals - static_cast<int>(std::log10(largest)));
}

Json chosen(const std::vector<double>& values, const std::vector<std::size_t>& rows, int decimals) {
    Json::array_t column;
    column.reserve(rows.size());
    for (const auto i : rows) column.push_back(rounded_json(values[i], decimals));
    return column;
}

/// The samples of a track that draw it, under the name of its values; null without any.
Json track_columns(const flight::Track& track, const char* key, std::size_t columns) {
    if (track.empty()) return nullptr;
    const auto rows = downsample_m4(track.time_s, track.value, columns);
    return {{"time_s", chosen(track.time_s, rows, time_decimals)},
            {key, chosen(track.value, rows, decimals_of(track.value))}};
}

/// The model's power at these times: of each complete phase its curve, scaled to the phase's duration.
Json model_power(const ReportFlight& flight, const mechanical::MechanicalModel& model,
                 const std::vector<double>& time_s) {
    Json::array_t power(time_s.size(), nullptr);
    for (const auto& sortie : flight.phases.sorties) {
        for (const auto& span : sortie.phases) {
            if (!span.complete || span.duration_s() <= 0.0) continue;
            const auto curve =
                time_scaled_model(model.phases[span.phase], span.duration_s(), mechanical::PhaseTimeScaling::scaled);
            for (std::size_t i = 0; i < time_s.size(); ++i)
                if (time_s[i] >= span.start.time_s && time_s[i] <= span.end.time_s)
                    power[i] =
                        rounded_json(power_w(curve, time_s[i] - span.start.time_s), decimals_of({power_w(curve, 0.0)}));
        }
    }
    return power;
}

Json power_columns(const ReportFlight& flight, const mechanical::MechanicalModel* model, std::size_t count) {
    auto columns = track_columns(flight.data.power_w, "power_w", count);
    if (columns.is_null()) return columns;
    columns["model_power_w"] =
        model == nullptr ? Json() : model_power(flight, *model, columns["time_s"].get<std::vector<double>>());
    return columns;
}

Json phases_of(const flight::FlightPhases& phases) {
    auto all = Json::array();
    for (const auto& sortie : phases.sorties)
        for (const auto& span : sortie.phases)
            all.push_back(
                {{"phase", to_string(span.phase)}, {"start_s", span.start.time_s}, {"end_s", span.end.time_s}});
    return all;
}

std::vector<SortieRow> sortie_rows(const ReportFlight& flight) {
    std::vector<SortieRow> rows;
    for (std::size_t s = 0; s < flight.phases.sorties.size(); ++s)
        rows.push_back(
            {flight.phases.sorties.size() > 1 ? fmt::format("{}, sortie {}", flight.name, s + 1) : flight.name, s + 1,
             summarize_flight(flight, s), fitted_part(flight)});
    return rows;
}

/// "20 Faulty, 2020-07-03 12:17, 23 min 55 s in the air, 19.52 km, up to 118 m".
std::string summary_of(const ReportFlight& flight, const std::string& aircraft) {
    const auto& facts = flight.facts;
    auto text = aircraft;
    if (!facts.date.empty()) text += ", " + facts.date;
    text += ", " + duration_text(facts.in_air_s) + " in the air";
    if (facts.distance_m) text += fmt::format(", {:.2f} km", *facts.distance_m / units::metre_per_kilometre);
    if (facts.height_m) text += fmt::format(", up to {:.0f} m", *facts.height_m);
    return text;
}

/// Why a log was rejected, without folders of this machine: the page is passed on.
std::string reason_of(const ReportFlight& flight) {
    const auto folder = std::filesystem::path(flight.log).parent_path().string() + "/";
    return boost::algorithm::replace_all_copy(flight.rejected, folder, "");
}

Json row_of(const ReportFlight& flight, const std::vector<SortieRow>& sorties) {
    const bool is_used = flight.rejected.empty();
    const auto aircraft =
        is_used ? flight::describe_aircraft(flight.data.aircraft_id, flight.data.aircraft_name) : std::string();
    return {{"name", flight.name},
            {"title", flight_title(flight)},
            {"aircraft", aircraft},
            {"date", flight.facts.date},
            {"rejected", reason_of(flight)},
            {"used", is_used ? fitted_part(flight) : "no"},
            {"text", is_used ? summary_of(flight, aircraft) : ""},
            {"sorties", json_list<SortieRow>(sorties)},
            {"warnings", flight.warnings},
            {"notes", flight.notes},
            {"detail", nullptr}};
}

std::vector<ExclusionGroup> excluded(std::span<const ReportFlight> flights) {
    std::vector<Exclusion> exclusions;
    for (const auto& flight : flights) {
        if (!flight.rejected.empty()) exclusions.push_back({flight.name, "at all", reason_of(flight)});
        const auto name = flight.name + ": ";
        for (const auto& text : flight.exclusions)
            exclusions.push_back(
                {flight.name, "for the model", text.starts_with(name) ? text.substr(name.size()) : text});
    }
    return group_exclusions(exclusions);
}

}  // namespace

Fields<SortieRow> record_fields(const SortieRow*) {
    using R = SortieRow;
    using S = FlightSummary;
    using enum flight::Phase;
    const auto closure_percent = [](const R& row) -> std::optional<double> {
        const auto& [energy_wh, counter_wh] = std::tie(row.facts.energy_wh, row.facts.counter_wh);
        if (!energy_wh || !counter_wh || *counter_wh <= 0.0) return std::nullopt;
        return units::percentage(*energy_wh - *counter_wh, *counter_wh);
    };
    const auto duration_s = [](const R& row) {
        Keyed<double> all;
        for (const auto phase : flight::all_phases) all.emplace_back(to_string(phase), row.facts.duration_s[phase]);
        return all;
    };
    const auto mean_power_w = [](const R& row) {
        Keyed<std::optional<double>> all;
        for (const auto phase : flight::all_phases) all.emplace_back(to_string(phase), row.facts.mean_power_w[phase]);
        return all;
    };
    const auto power_column = [](flight::Phase phase, const char* heading) {
        const auto get = [phase](const R& row) { return row.facts.mean_power_w[phase]; };
        return field(heading, get, "", column{heading, ".1f"}, not_in_json{});
    };
    const auto cruise_s = [](const R& row) { return row.facts.duration_s[cruise]; };
    const auto distance_km = [](const R& row) {
        const auto& distance_m = row.facts.distance_m;
        return distance_m ? std::optional(*distance_m / units::metre_per_kilometre) : std::nullopt;
    };
    const auto date = [](const R& row) { return row.facts.date.empty() ? std::string("-") : row.facts.date; };
    const auto used = [](const R& row) { return std::string(row.used); };
    return {field("flight", &R::flight, "", column{"Flight"}, not_in_json{}),
            field("date", date, "", column{"Date (UTC)"}, not_in_json{}),
            field("sortie", &R::sortie),
            field("in_air_s", at(&R::facts, &S::in_air_s)),
            field("cruise_s", cruise_s, "", column{"Cruise [s]", ".0f"}, not_in_json{}),
            field("distance_km", distance_km, "", column{"Distance [km]", ".2f"}, not_in_json{}),
            field("distance_m", at(&R::facts, &S::distance_m)),
            field("air_distance_m", at(&R::facts, &S::air_distance_m)),
            field("height_m", at(&R::facts, &S::height_m), "", column{"Height [m]", ".0f"}),
            power_column(takeoff, "Take\u2011off [W]"),
            power_column(cruise, "Cruise [W]"),
            power_column(landing, "Landing [W]"),
            field("energy_wh", at(&R::facts, &S::energy_wh), "", column{"Energy [Wh]", ".3f"}),
            field("counter_energy_wh", at(&R::facts, &S::counter_wh), "", column{"Counter [Wh]", ".3f"}),
            field("energy_closure_percent", closure_percent, "", column{"Closure [%]", "+.2f"}),
            field("used", used, "", column{"Fitted"}, not_in_json{}),
            field("cruise_airspeed_m_per_s", at(&R::facts, &S::cruise_airspeed_m_per_s)),
            field("duration_s", duration_s),
            field("mean_power_w", mean_power_w)};
}

Fields<NamedEdge> record_fields(const NamedEdge*) {
    return {field("time_s", &NamedEdge::time_s), field("name", &NamedEdge::name),
            field("evidence", &NamedEdge::evidence)};
}

std::vector<NamedEdge> name_edges(const ReportFlight& flight) {
    std::vector<NamedEdge> edges;
    if (flight.phases.sorties.empty()) return edges;
    const auto& clock = flight.data.power_w.empty() ? flight.data.altitude_m : flight.data.power_w;
    for (const auto& sortie : flight.phases.sorties) {
        for (std::size_t i = 0; i < sortie.phases.size(); ++i) {
            const auto& span = sortie.phases[i];
            const bool continues = i > 0 && sortie.phases[i - 1].end.time_s == span.start.time_s;
            const auto add = [&](const flight::PhaseEdge& edge, bool begin) {
                const bool cut = !span.complete && is_end_of_log(clock, edge.time_s);
                edges.push_back({edge.time_s,
                                 cut ? (begin ? "the log begins" : "the log ends") : edge_name(span, begin),
                                 describe_edge(edge)});
            };
            if (!continues) add(span.start, true);
            add(span.end, false);
        }
    }
    return edges;
}

Json flight_detail(const ReportFlight& flight, const mechanical::MechanicalModel* model, const ReportBattery* battery,
                   std::size_t columns) {
    const auto& data = flight.data;
    return {{"log", std::filesystem::path(flight.log).filename().string()},  // the page goes to others
            {"power_source", data.power_w.source},
            {"circuits", json_list<flight::CircuitShare>(circuit_shares(data, flight.phases))},
            {"phases", phases_of(flight.phases)},
            {"edges", json_list<NamedEdge>(name_edges(flight))},
            {"power", power_columns(flight, model, columns)},
            {"altitude", track_columns(data.altitude_m, "altitude_m", columns)},
            {"throttle", track_columns(data.throttle_percent, "throttle_percent", columns)},
            {"voltage", track_columns(data.voltage_v, "voltage_v", columns)},
            {"current", track_columns(data.current_a, "current_a", columns)},
            {"airspeed", track_columns(data.airspeed_m_per_s, "airspeed_m_per_s", columns)},
            {"track", track_json(flight, battery)}};
}

FlightsDocument make_flights(const BatchContent& batch, const ReportBattery* battery, bool for_figures,
                             LatexTables& tables, const Progress& progress) {
    const bool are_many = batch.flights.size() > max_plain_flights;
    const auto columns = are_many && !for_figures ? plot_columns_of_many : plot_columns;
    const auto& flights = batch.flights;
    const auto* model = batch.fit ? &batch.fit->model : nullptr;
    std::vector<std::vector<SortieRow>> sorties(flights.size());
    Json::array_t rows(flights.size());
    std::atomic<std::size_t> done = 0;
    for_each_in_parallel(flights.size(), [&](std::size_t f) {
        if (progress) progress(done++, flights.size());
        const auto& flight = flights[f];
        if (flight.rejected.empty()) sorties[f] = sortie_rows(flight);
        rows[f] = row_of(flight, sorties[f]);
        if (!flight.rejected.empty()) return;
        auto detail = flight_detail(flight, model, battery, columns);
        if (are_many) detail = deflated_base64(detail.dump(-1, ' ', false, Json::error_handler_t::replace));
        rows[f]["detail"] = std::move(detail);
    });
    FlightsDocument document{std::move(rows)};
    std::vector<SortieRow> table;
    for (auto& of_flight : sorties) std::ranges::move(of_flight, std::back_inserter(table));
    tables.add({table_of(table), "Flights", "tab:flights"});
    const auto exclusions = excluded(flights);
    tables.add({table_of(exclusions), "Flights and phases that are not used", "tab:excluded"});
    document.exclusions = json_list<ExclusionGroup>(exclusions);
    return document;
}

}  // namespace flightwatt::report
