#include "base/duration_text.h"
#include "flight/flight_identity.h"
#include "report/batch_content.h"
#include "report/sections/sections.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// How a verdict looks, and what it says of missions with and without a reserve.
struct VerdictWords {
    const char* css_class;
    const char* of_reserve;
    const char* of_battery;
};

/// In the order of ReserveStatus.
constexpr std::array<VerdictWords, 3> words_of_verdicts{
    {{"good", "keeps its reserve", "the battery lasts"},
     {"unsure", "may not keep its reserve", "the battery may not last"},
     {"bad", "does not keep its reserve", "the battery does not last"}}};

std::string card_html(const SimulatedMission& simulated, const MissionAssessment& answer) {
    const auto& words = words_of_verdicts.at(static_cast<std::size_t>(verdict_of(simulated)));
    const bool has_reserve = simulated.simulation.summary.reserve_soc_percent > 0.0;
    auto html = fmt::format("<article class=\"card {}\">\n<h3>{}</h3>\n<p class=\"verdict\">{}</p>\n", words.css_class,
                            html_escaped(simulated.title), has_reserve ? words.of_reserve : words.of_battery);
    const auto lines = card_lines(simulated, answer);
    html += fmt::format("<p class=\"lead\">{}</p>\n", html_escaped(lines.front()));
    for (std::size_t i = 1; i < lines.size(); ++i)
        html += paragraph(lines[i], lines[i].starts_with("Warning: ") ? "warning" : "");
    return html + "</article>\n";
}

/// What is known of one aircraft's flights.
struct AircraftSums {
    std::size_t flights = 0;
    double in_air_s = 0.0;
    double energy_wh = 0.0;
    std::size_t without_energy = 0;
    std::string first;
    std::string last;
};

void add_flight(AircraftSums& sums, const ReportFlight& flight) {
    const auto facts = summarize_flight(flight);
    ++sums.flights;
    sums.in_air_s += facts.in_air_s;
    sums.energy_wh += facts.energy_wh.value_or(0.0);
    if (!facts.energy_wh) ++sums.without_energy;
    const auto day = facts.date.substr(0, facts.date.find(' '));
    if (day.empty()) return;
    sums.first = sums.first.empty() ? day : std::min(sums.first, day);
    sums.last = std::max(sums.last, day);
}

std::string plural(std::size_t number, std::string_view word) {
    return fmt::format("{} {}{}", number, word, number == 1 ? "" : "s");
}

std::string describe(const std::string& aircraft, const AircraftSums& sums) {
    auto text = fmt::format("{}: {}", aircraft, plural(sums.flights, "flight"));
    if (!sums.first.empty())
        text += sums.first == sums.last ? " on " + sums.first : fmt::format(" from {} to {}", sums.first, sums.last);
    text += ", " + duration_text(sums.in_air_s) + " in the air";
    if (sums.without_energy < sums.flights) text += fmt::format(", {:.1f} Wh", sums.energy_wh);
    if (sums.without_energy > 0) text += fmt::format(" ({} without measured power)", sums.without_energy);
    return text;
}

/// The flights that have warnings, in a line.
std::string warned_line(std::span<const ReportFlight> flights) {
    std::size_t warned = 0;
    std::size_t warnings = 0;
    std::size_t rejected = 0;
    for (const auto& flight : flights) {
        if (!flight.rejected.empty()) ++rejected;
        if (!flight.rejected.empty() || flight.warnings.empty()) continue;
        ++warned;
        warnings += flight.warnings.size();
    }
    std::string text;
    if (warned > 0)
        text = fmt::format("{} of {} ({})", plural(warned, "flight"), flights.size(), plural(warnings, "warning"));
    if (rejected > 0) text += fmt::format("{}{} rejected", text.empty() ? "" : "; ", plural(rejected, "log"));
    return text;
}

}  // namespace

std::vector<std::string> aircraft_lines(std::span<const ReportFlight> flights) {
    std::map<std::string, AircraftSums> of_aircraft;
    for (const auto& flight : flights) {
        if (!flight.rejected.empty()) continue;
        add_flight(of_aircraft[flight::describe_aircraft(flight.series.aircraft_id, flight.series.aircraft_name)],
                   flight);
    }
    std::vector<std::string> lines;
    lines.reserve(of_aircraft.size());
    for (const auto& [aircraft, sums] : of_aircraft) lines.push_back(describe(aircraft, sums));
    return lines;
}

bool all_synthetic(std::span<const ReportFlight> flights) {
    return std::ranges::all_of(flights, [](const ReportFlight& flight) {
        return !flight.rejected.empty() || flight::is_synthetic(flight.series.aircraft_name);
    });
}

bool any_synthetic(std::span<const ReportFlight> flights) {
    return std::ranges::any_of(flights, [](const ReportFlight& flight) {
        return flight.rejected.empty() && flight::is_synthetic(flight.series.aircraft_name);
    });
}

std::string prediction_line(std::span<const mechanical::ValidatedFlight> flights) {
    std::vector<std::pair<double, std::string>> errors;
    std::size_t number = 0;
    for (const auto& model : mechanical::model_names(flights)) {
        const auto score = score_of(flights, model, std::nullopt);
        if (!score || !score->mean_absolute_error_percent) continue;
        errors.emplace_back(*score->mean_absolute_error_percent, model);
        number = std::max(number, score->flights);
    }
    if (errors.empty()) return "";
    std::ranges::stable_sort(errors, {}, &std::pair<double, std::string>::first);
    auto line = fmt::format("The energy of a flight that is not in the fit is off by");
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const auto& [error_percent, model] = errors[i];
        line += fmt::format("{} {:.1f} % ({}{})", i == 0 ? "" : ",", error_percent, model,
                            model == "physical" ? ", airspeed known" : "");
    }
    return line + fmt::format(", on average over {} left out in turn", plural(number, "flight"));
}

std::vector<std::string> prediction_lines(std::span<const ValidatedBatch> batches) {
    std::vector<std::string> lines;
    for (const auto& batch : batches) {
        const auto line = prediction_line(batch.flights);
        if (!line.empty()) lines.push_back(batch.folder.empty() ? line : batch.folder + ": " + line);
    }
    return lines;
}

Section summary_section(const PageSummary& answers, std::span<const ReportFlight> flights) {
    Section section{"answers", "Answers"};
    if (!answers.missions.empty()) {
        section.html += "<div class=\"cards\">\n";
        for (std::size_t i = 0; i < answers.missions.size(); ++i)
            section.html += card_html(answers.missions[i], answers.answers[i]);
        section.html += "</div>\n";
    }
    std::string facts;
    const auto add = [&](std::string_view name, const std::string& text) {
        if (!text.empty()) facts += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, html_escaped(text));
    };
    for (const auto& line : aircraft_lines(flights)) add("Aircraft", line);
    for (const auto& batch : answers.validated) {
        for (const auto& line : prediction_lines(std::span(&batch, 1)))
            add("Prediction", line + (batch.has_synthetic ? " (SYNTHETIC flights)" : ""));
    }
    add("Warnings", warned_line(flights));
    if (!facts.empty()) section.html += "<dl>\n" + facts + "</dl>\n";
    auto warnings = answers.warnings;
    warnings.insert(warnings.end(), answers.notes.begin(), answers.notes.end());
    if (!warnings.empty()) section.html += "<div class=\"warning\">" + list_html(warnings) + "</div>\n";
    return section;
}

}  // namespace flightwatt::report
