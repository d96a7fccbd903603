#include "report/sections/flights_section.h"

#include "base/parallel.h"
#include "base/text.h"
#include "base/units.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "report/batch_content.h"
#include "report/figures/flight_figures.h"
#include "report/html.h"
#include "report/sections/blocks.h"
#include "report/sections/exclusions.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

std::vector<std::string> cells_of(const ReportFlight& flight, std::size_t sortie) {
    using enum flight::Phase;
    const auto facts = summarize_flight(flight, sortie);
    const bool has_closure = facts.energy_wh && facts.counter_wh && *facts.counter_wh > 0.0;
    return {flight.phases.sorties.size() > 1 ? fmt::format("{}, sortie {}", flight.name, sortie + 1) : flight.name,
            facts.date.empty() ? "-" : facts.date,
            fixed(facts.duration_s[cruise], 0),
            facts.distance_m ? fixed(*facts.distance_m / 1000.0, 2) : "-",
            fixed(facts.height_m, 0),
            fixed(facts.mean_power_w[takeoff], 1),
            fixed(facts.mean_power_w[cruise], 1),
            fixed(facts.mean_power_w[landing], 1),
            fixed(facts.energy_wh, 3),
            fixed(facts.counter_wh, 3),
            has_closure
                ? fmt::format("{:+.2f}", units::percentage(*facts.energy_wh - *facts.counter_wh, *facts.counter_wh))
                : "-",
            std::string(fitted_part(flight))};
}

/// A row for each sortie, with links to the flights.
void add_flights_table(Section& section, std::span<const ReportFlight> flights, const std::vector<std::string>& ids) {
    TextTable table{{"Flight", "Date (UTC)", "Cruise [s]", "Distance [km]", "Height [m]", "Take\u2011off [W]",
                     "Cruise [W]", "Landing [W]", "Energy [Wh]", "Counter [Wh]", "Closure [%]", "Fitted"},
                    {}};
    HtmlTableOptions options{.sortable = true};
    std::vector<std::vector<std::vector<std::string>>> rows(flights.size());
    for_each_in_parallel(flights.size(), [&](std::size_t f) {
        if (!flights[f].rejected.empty()) return;
        for (std::size_t s = 0; s < flights[f].phases.sorties.size(); ++s) rows[f].push_back(cells_of(flights[f], s));
    });
    for (std::size_t f = 0; f < flights.size(); ++f) {
        options.links.insert(options.links.end(), rows[f].size(), ids[f]);
        std::ranges::move(rows[f], std::back_inserter(table.rows));
    }
    add_table(section, {std::move(table), "Flights", "tab:flights"}, options);
}

void add_excluded(Section& section, std::span<const ReportFlight> flights) {
    std::vector<Exclusion> exclusions;
    for (const auto& flight : flights) {
        // No folder of this machine: the page is passed on.
        const auto folder = std::filesystem::path(flight.log).parent_path().string() + "/";
        const auto reason = boost::algorithm::replace_all_copy(flight.rejected, folder, "");
        if (!reason.empty()) exclusions.push_back({flight.name, "at all", reason});
        const auto name = flight.name + ": ";
        for (const auto& text : flight.exclusions)
            exclusions.push_back(
                {flight.name, "for the model", text.starts_with(name) ? text.substr(name.size()) : text});
    }
    if (exclusions.empty()) return;
    section.html += "<h3 id=\"excluded\">Not used</h3>\n";
    add_table(section, {exclusions_table(exclusions), "Flights and phases that are not used", "tab:excluded"});
}

/// Edges of a flight's phases with their evidence.
std::string edges_html(const ReportFlight& flight) {
    TextTable table{{"edge", "time [s]", "evidence"}, {}};
    for (const auto& edge : name_edges(flight)) table.rows.push_back({edge.name, fixed(edge.time_s, 1), edge.evidence});
    return table_html(table, "Edges of the phases");
}

/// "20 Faulty, 2020-07-03 12:17, 23 min 55 s in the air, 19.52 km, up to 118 m".
std::string summary_of(const ReportFlight& flight) {
    const auto facts = summarize_flight(flight);
    auto text = flight::describe_aircraft(flight.data.aircraft_id, flight.data.aircraft_name);
    if (!facts.date.empty()) text += ", " + facts.date;
    text += ", " + duration_text(facts.in_air_s) + " in the air";
    if (facts.distance_m) text += fmt::format(", {:.2f} km", *facts.distance_m / 1000.0);
    if (facts.height_m) text += fmt::format(", up to {:.0f} m", *facts.height_m);
    return text;
}

/// More flights are compressed until they are opened; others can be searched, and their tables need no JavaScript.
constexpr std::size_t max_plain_flights = 20;

struct FlightPart {
    std::string id;
    bool is_open = false;
    bool is_compressed = false;
};

/// Contents of a flight below its summary.
Section contents_of(const ReportFlight& flight, const mechanical::MechanicalModel* model, const FlightPart& part) {
    Section section;
    const auto add = [&](Figure figure) {
        const auto spec = figure.spec;
        if (part.is_compressed) figure.spec = packed_tables(spec);
        add_figure(section, std::move(figure));
        section.figures.back().spec = spec;  // of its file
    };
    const auto log = std::filesystem::path(flight.log).filename().string();  // the page goes to others
    section.html +=
        paragraph("From " + log, "soft") + list_html(flight.warnings, "warning") + list_html(flight.notes, "soft");
    if (const auto shares = circuit_shares(flight.data, flight.phases); shares.size() > 1)
        for (const auto& [name, energy_wh, percent] : shares)
            section.html +=
                paragraph(fmt::format("Circuit of {}: {:.2f} Wh, {:.0f} %", name, energy_wh, percent), "soft");
    const bool has_power = !flight.data.power_w.empty();
    if (has_power) add(flight_figure(flight, model, part.id + "-power"));
    section.html +=
        "<details class=\"more\"><summary>How the phases were found</summary>\n" + edges_html(flight) + "</details>\n";
    return section;
}

Section flight_section(const ReportFlight& flight, const mechanical::MechanicalModel* model, const FlightPart& part) {
    auto section = contents_of(flight, model, part);
    if (part.is_compressed)
        section.html = "<script type=\"text/plain\" class=\"block\">" + compressed_block(section.html) + "</script>\n";
    section.html = fmt::format(
        "<details class=\"flight\" id=\"{}\"{}><summary>{} <span>{}</span></summary>\n{}</details>\n", part.id,
        part.is_open ? " open" : "", html_escaped(flight.name), html_escaped(summary_of(flight)), section.html);
    return section;
}

/// The accepted flights; the first one is open.
std::vector<Section> flight_sections(const BatchContent& batch, const std::vector<std::string>& ids,
                                     const Progress& progress) {
    const auto& flights = batch.flights;
    const auto* model = batch.fit ? &batch.fit->model : nullptr;
    std::vector<Section> sections(flights.size());
    const auto first = static_cast<std::size_t>(
        std::ranges::find_if(flights, [](const auto& flight) { return flight.rejected.empty(); }) - flights.begin());
    const bool are_many = flights.size() > max_plain_flights;
    std::atomic<std::size_t> done = 0;
    for_each_in_parallel(flights.size(), [&](std::size_t f) {
        if (progress) progress(done++, flights.size());
        if (!flights[f].rejected.empty()) return;
        sections[f] = flight_section(flights[f], model, {ids[f], f == first, are_many && f != first});
    });
    return sections;
}

}  // namespace

std::vector<std::string> flight_ids(std::span<const ReportFlight> flights) {
    constexpr std::size_t max_chars = 60;
    static const std::regex other_chars("[^0-9A-Za-z_]+");
    std::vector<std::string> ids;
    std::set<std::string> taken;
    for (const auto& flight : flights) {
        auto id = "flight-" + std::regex_replace(flight.name.substr(0, max_chars), other_chars, "-");
        if (!taken.insert(id).second) id += fmt::format("-{}", ids.size() + 1);
        ids.push_back(std::move(id));
    }
    return ids;
}

Section flights_section(const BatchContent& batch, const Progress& progress) {
    const auto& flights = batch.flights;
    Section section{"flights", "Flights"};
    const auto rejected =
        std::ranges::count_if(flights, [](const ReportFlight& flight) { return !flight.rejected.empty(); });
    section.html += paragraph(
        fmt::format("{} logs{}. Mean power of each phase; distance over ground, height above the ground at lift-off. "
                    "Closure: energy less that of the autopilot's counter.",
                    flights.size(), rejected > 0 ? fmt::format(", {} of them not used", rejected) : ""),
        "soft");
    const auto ids = flight_ids(flights);
    add_flights_table(section, flights, ids);
    add_excluded(section, flights);
    section.html += heading("Each flight");
    if (flights.size() > max_plain_flights)
        section.html +=
            "<noscript><p class=\"warning\">The flights below are compressed: they open with JavaScript "
            "only.</p></noscript>\n";
    for (auto& part : flight_sections(batch, ids, progress)) {
        section.html += part.html;
        std::ranges::move(part.figures, std::back_inserter(section.figures));
    }
    return section;
}

}  // namespace flightwatt::report
