#include "base/duration_text.h"
#include "base/parallel.h"
#include "base/units.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"
#include "report/batch_content.h"
#include "report/figures/flight_figures.h"
#include "report/html.h"
#include "report/sections/sections.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

std::string folders_of(const ReportFlight& flight) { return fmt::format("{}", fmt::join(flight.folders, ", ")); }

bool are_of_folders(std::span<const ReportFlight> flights) {
    return std::ranges::any_of(flights, [](const auto& flight) { return !flight.folders.empty(); });
}

std::vector<std::string> cells_of(const ReportFlight& flight, std::size_t sortie) {
    const auto& phases = flight.phases.sorties[sortie].phases;
    const flight::PowerStatistics power(flight.series);
    const auto whole = power.between(phases.front().start.time_s, phases.back().end.time_s);
    flight::PerPhase<std::string> durations{"-", "-", "-"};
    flight::PerPhase<std::string> means{"-", "-", "-"};
    for (const auto& span : phases) {
        durations[span.phase] = fixed(span.duration_s(), 0);
        if (power.has_power())
            means[span.phase] = fixed(power.between(span.start.time_s, span.end.time_s).mean_power_w, 1);
    }
    const auto facts = summarize_flight(flight, sortie);
    const auto& counter_wh = whole.counter_energy_wh;
    const bool has_closure = facts.energy_wh && counter_wh && *counter_wh > 0.0;
    // Few flights have several sorties: no column for them.
    std::vector<std::string> cells{
        flight.phases.sorties.size() > 1 ? fmt::format("{}, sortie {}", flight.name, sortie + 1) : flight.name,
        flight::describe_aircraft(flight.series.aircraft_id, flight.series.aircraft_name),
        facts.date.empty() ? "-" : facts.date, facts.distance_m ? fixed(*facts.distance_m / 1000.0, 2) : "-",
        fixed(facts.height_m, 0)};
    cells.insert(cells.end(), durations.values.begin(), durations.values.end());
    cells.insert(cells.end(), means.values.begin(), means.values.end());
    cells.insert(
        cells.end(),
        {fixed(facts.energy_wh, 3), fixed(counter_wh, 3),
         has_closure ? fmt::format("{:+.2f}", units::percentage(*facts.energy_wh - *counter_wh, *counter_wh)) : "-",
         power.has_power() ? fmt::format("{}", whole.gaps) : "-", fmt::format("{}", flight.warnings.size()),
         std::string(fitted_part(flight))});
    return cells;
}

/// "flight-20_07_03__12_17_45": what of a flight's name may stand in names of files and in links, each once.
std::vector<std::string> flight_ids(std::span<const ReportFlight> flights) {
    constexpr std::size_t longest = 60;
    std::vector<std::string> ids;
    std::set<std::string> taken;
    ids.reserve(flights.size());
    for (const auto& flight : flights) {
        std::string id;
        for (const char c : flight.name.substr(0, longest)) {
            const bool is_plain =
                (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
            if (is_plain || (!id.empty() && id.back() != '-')) id += is_plain ? c : '-';
        }
        if (id.empty() || !taken.insert(id).second) id += fmt::format("-{}", ids.size() + 1);
        ids.push_back("flight-" + id);
    }
    return ids;
}

std::string flights_table_html(std::span<const ReportFlight> flights, const std::vector<std::string>& ids) {
    HtmlTableOptions options{"Flights: durations, mean power, energy, closure, gaps and warnings", true};
    options.minor = {"sortie",      "gaps",          "counter [Wh]",      "closure [%]", "fitted",
                     "height [m]",  "distance [km]", "take\u2011off [W]", "landing [W]", "take\u2011off [s]",
                     "landing [s]", "date",          "aircraft",          "warnings"};
    for (std::size_t f = 0; f < flights.size(); ++f) {
        if (!flights[f].rejected.empty()) continue;
        options.links.insert(options.links.end(), flights[f].phases.sorties.size(), ids[f]);
    }
    return table_html(flights_table(flights), options);
}

/// Every reason once, with the flights that it holds for, in their order.
TextTable excluded_table(std::span<const ReportFlight> flights) {
    TextTable table{{"flights", "excluded", "reason"}, {}};
    const auto add = [&](const std::string& flight, const std::string& what, const std::string& reason) {
        const auto same =
            std::ranges::find_if(table.rows, [&](const auto& row) { return row[1] == what && row[2] == reason; });
        if (same == table.rows.end()) {
            table.rows.push_back({flight, what, reason});
        } else {
            same->front() += ", " + flight;
        }
    };
    for (const auto& flight : flights) {
        if (!flight.rejected.empty()) add(flight.name, "rejected", flight.rejected);
        for (const auto& reason : flight.exclusions) {
            const auto name = flight.name + ": ";
            add(flight.name, "from the model", reason.starts_with(name) ? reason.substr(name.size()) : reason);
        }
    }
    return table;
}

constexpr auto excluded_caption = "What was excluded, and why";

std::string excluded_html(std::span<const ReportFlight> flights) {
    const auto table = excluded_table(flights);
    if (table.rows.empty()) return paragraph("Nothing was excluded.");
    return "<h3>Excluded, and why</h3>\n" + table_html(table, {excluded_caption, false, {}});
}

/// The edges of a flight's phases with what was seen there and what the autopilot says of them.
std::string edges_html(const ReportFlight& flight) {
    TextTable table{{"edge", "time [s]", "evidence", "the autopilot"}, {}};
    for (const auto& edge : edges_of(flight)) {
        table.rows.push_back({edge.name, fixed(edge.time_s, 1), edge.evidence, edge.verdict});
    }
    return table_html(table, {"Where the phases end, and what was seen there", false, {}});
}

/// "20 Faulty, 2020-07-03 12:17, 23 min 55 s in the air, 19.52 km, up to 118 m".
std::string summary_of(const ReportFlight& flight) {
    const auto facts = summarize_flight(flight);
    auto text = flight::describe_aircraft(flight.series.aircraft_id, flight.series.aircraft_name);
    if (!facts.date.empty()) text += ", " + facts.date;
    text += ", " + duration_text(facts.in_air_s) + " in the air";
    if (facts.distance_m) text += fmt::format(", {:.2f} km", *facts.distance_m / 1000.0);
    if (facts.height_m) text += fmt::format(", up to {:.0f} m", *facts.height_m);
    if (!flight.folders.empty()) text += ", in " + folders_of(flight);
    return text;
}

/// So many flights stand in the page as they are: text to search, and tables without JavaScript. More are opened one by
/// one, and are compressed until then.
constexpr std::size_t max_plain_flights = 20;

struct PartOptions {
    std::string id;
    bool is_open = false;
    bool compressed = false;
};

/// A figure whose tables are packed where all is compressed.
void add_to_part(Section& part, Figure figure, const PartOptions& options) {
    part.html += options.compressed ? figure_html(figure, packed_tables(figure.spec)) : figure_html(figure);
    part.figures.push_back(std::move(figure));
}

/// What is seen of an open flight, below its summary.
Section inside_of(const ReportFlight& flight, const std::optional<mechanical::MechanicalModel>& model,
                  const PredictedFlight* predicted, const PartOptions& options) {
    Section part;
    part.html += paragraph("From " + flight.log, "soft");
    if (!flight.warnings.empty()) part.html += "<div class=\"warning\">" + list_html(flight.warnings) + "</div>\n";
    if (power_track(flight.series).empty()) {
        part.html += edges_html(flight);
    } else {
        add_to_part(part, flight_figure(flight, model, options.id + "-power"), options);
        part.html += edges_html(flight);
        if (auto track = track_figure(flight, options.id + "-track")) add_to_part(part, std::move(*track), options);
    }
    if (predicted != nullptr)
        add_to_part(part, in_flight_figure(flight.name, *predicted, options.id + "-predicted"), options);
    return part;
}

Section flight_part(const ReportFlight& flight, const std::optional<mechanical::MechanicalModel>& model,
                    const PredictedFlight* predicted, const PartOptions& options) {
    auto part = inside_of(flight, model, predicted, options);
    if (options.compressed)
        part.html = "<script type=\"text/plain\" class=\"block\">" + compressed_block(part.html) + "</script>\n";
    part.html = fmt::format(
        "<details class=\"flight\" id=\"{}\"{}><summary>{} <span>{}</span></summary>\n{}</details>\n", options.id,
        options.is_open ? " open" : "", html_escaped(flight.name), html_escaped(summary_of(flight)), part.html);
    return part;
}

/// The parts of the flights that were not rejected; the first one is open.
std::vector<Section> flight_parts(std::span<const ReportFlight> flights,
                                  std::span<const std::optional<mechanical::MechanicalModel>> models,
                                  const std::map<std::string, PredictedFlight>& predicted,
                                  const std::vector<std::string>& ids, const Progress& progress) {
    std::vector<Section> parts(flights.size());
    const auto is_shown = [](const ReportFlight& flight) { return flight.rejected.empty(); };
    const auto first = static_cast<std::size_t>(std::ranges::find_if(flights, is_shown) - flights.begin());
    const bool are_many = flights.size() > max_plain_flights;
    std::atomic<std::size_t> done = 0;
    const std::optional<mechanical::MechanicalModel> no_model;
    for_each_in_parallel(flights.size(), [&](std::size_t f) {
        if (progress) progress(done++, flights.size());
        if (!is_shown(flights[f])) return;
        const auto found = predicted.find(flights[f].name);
        const auto batch = flights[f].batch;
        const auto& model = batch < models.size() ? models[batch] : no_model;
        parts[f] = flight_part(flights[f], model, found == predicted.end() ? nullptr : &found->second,
                               {ids[f], f == first, are_many && f != first});
    });
    return parts;
}

}  // namespace

TextTable flights_table(std::span<const ReportFlight> flights) {
    TextTable table{{"flight", "aircraft", "date", "distance [km]", "height [m]", "take\u2011off [s]", "cruise [s]",
                     "landing [s]", "take\u2011off [W]", "cruise [W]", "landing [W]", "energy [Wh]", "counter [Wh]",
                     "closure [%]", "gaps", "warnings", "fitted"},
                    {}};
    const bool has_folders = are_of_folders(flights);
    if (has_folders) table.header.insert(table.header.begin() + 1, "folder");
    std::vector<std::vector<std::vector<std::string>>> rows(flights.size());
    for_each_in_parallel(flights.size(), [&](std::size_t f) {
        if (!flights[f].rejected.empty()) return;
        for (std::size_t s = 0; s < flights[f].phases.sorties.size(); ++s) {
            rows[f].push_back(cells_of(flights[f], s));
            if (has_folders) rows[f].back().insert(rows[f].back().begin() + 1, folders_of(flights[f]));
        }
    });
    for (auto& of_flight : rows) std::ranges::move(of_flight, std::back_inserter(table.rows));
    return table;
}

std::vector<CaptionedTable> flights_tables(std::span<const ReportFlight> flights) {
    return {{flights_table(flights), "Flights", "tab:flights"},
            {excluded_table(flights), excluded_caption, "tab:excluded"}};
}

Section flights_section(std::span<const ReportFlight> flights,
                        std::span<const std::optional<mechanical::MechanicalModel>> models,
                        const std::map<std::string, PredictedFlight>& predicted, const Progress& progress) {
    Section section{"flights", "Flights"};
    const auto rejected =
        std::ranges::count_if(flights, [](const ReportFlight& flight) { return !flight.rejected.empty(); });
    section.html += paragraph(
        fmt::format("{} logs, {} of them rejected. Distance is over ground, height above the ground at lift-off, "
                    "dates are UTC. Durations, mean power and energy are those of "
                    "the power samples between lift-off and touchdown; counter is the autopilot's "
                    "own energy counter over the same time, closure how much the integral lies "
                    "above it. A click on a column sorts.",
                    flights.size(), rejected));
    const auto ids = flight_ids(flights);
    section.html += flights_table_html(flights, ids);
    section.html += excluded_html(flights);
    section.html += "<h3>Each flight</h3>\n";
    if (flights.size() > max_plain_flights)
        section.html +=
            "<noscript><p class=\"warning\">The flights below are compressed: they open with JavaScript "
            "only.</p></noscript>\n";
    for (auto& part : flight_parts(flights, models, predicted, ids, progress)) {
        section.html += part.html;
        std::ranges::move(part.figures, std::back_inserter(section.figures));
    }
    return section;
}

}  // namespace flightwatt::report
