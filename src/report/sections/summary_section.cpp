#include "base/duration_text.h"
#include "flight/flight_identity.h"
#include "report/batch_content.h"
#include "report/sections/sections.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

/// Style and text of a status, for missions with and without a reserve.
struct StatusText {
    const char* css_class;
    const char* of_reserve;
    const char* of_battery;
};

/// In the order of ReserveStatus.
constexpr std::array<StatusText, 3> status_texts{{{"good", "keeps its reserve", "the battery lasts"},
                                                  {"unsure", "may not keep its reserve", "the battery may not last"},
                                                  {"bad", "does not keep its reserve", "the battery does not last"}}};

std::string card_html(const SimulatedMission& simulated, const MissionAssessment& answer) {
    const auto& text = status_texts.at(static_cast<std::size_t>(reserve_status(simulated)));
    const bool has_reserve = simulated.simulation.summary.reserve_soc_percent > 0.0;
    auto html = fmt::format("<article class=\"card {}\">\n<h3>{}</h3>\n<p class=\"status\">{}</p>\n", text.css_class,
                            html_escaped(simulated.title), has_reserve ? text.of_reserve : text.of_battery);
    const auto lines = card_lines(simulated, answer);
    html += fmt::format("<p class=\"lead\">{}</p>\n", html_escaped(lines.front()));
    for (std::size_t i = 1; i < lines.size(); ++i)
        html += paragraph(lines[i], lines[i].starts_with("Warning: ") ? "warning" : "");
    return html + "</article>\n";
}

std::string plural(std::size_t number, std::string_view word) {
    return fmt::format("{} {}{}", number, word, number == 1 ? "" : "s");
}

std::string describe(const std::string& aircraft, const std::vector<FlightSummary>& flights) {
    double in_air_s = 0.0;
    double energy_wh = 0.0;
    std::size_t without_energy = 0;
    std::set<std::string> days;
    for (const auto& flight : flights) {
        in_air_s += flight.in_air_s;
        energy_wh += flight.energy_wh.value_or(0.0);
        if (!flight.energy_wh) ++without_energy;
        if (!flight.date.empty()) days.insert(flight.date.substr(0, flight.date.find(' ')));
    }
    auto text = fmt::format("{}: {}", aircraft, plural(flights.size(), "flight"));
    if (days.size() == 1) text += " on " + *days.begin();
    if (days.size() > 1) text += fmt::format(" from {} to {}", *days.begin(), *days.rbegin());
    text += ", " + duration_text(in_air_s) + " in the air";
    if (without_energy < flights.size()) text += fmt::format(", {:.1f} Wh", energy_wh);
    if (without_energy > 0) text += fmt::format(" ({} without measured power)", without_energy);
    return text;
}

/// "2 flights of 6 (3 warnings); 1 log rejected".
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
    std::map<std::string, std::vector<FlightSummary>> of_aircraft;
    for (const auto& flight : flights)
        if (flight.rejected.empty())
            of_aircraft[flight::describe_aircraft(flight.series.aircraft_id, flight.series.aircraft_name)].push_back(
                summarize_flight(flight));
    std::vector<std::string> lines;
    for (const auto& [aircraft, summaries] : of_aircraft) lines.push_back(describe(aircraft, summaries));
    return lines;
}

bool any_synthetic(std::span<const ReportFlight> flights) {
    return std::ranges::any_of(flights, [](const ReportFlight& flight) {
        return flight.rejected.empty() && flight::is_synthetic(flight.series.aircraft_name);
    });
}

std::string prediction_line(std::span<const mechanical::ValidatedFlight> validated, bool synthetic) {
    std::vector<std::pair<double, std::string>> errors;
    std::size_t flights = 0;
    for (const auto& model : mechanical::model_names(validated)) {
        const auto score = score_of(validated, model, std::nullopt);
        if (!score || !score->mean_absolute_error_percent) continue;
        const double error_percent = *score->mean_absolute_error_percent;
        errors.emplace_back(error_percent, fmt::format("{:.1f} % ({}{})", error_percent, model,
                                                       model == "physical" ? ", airspeed known" : ""));
        flights = std::max(flights, score->flights);
    }
    if (errors.empty()) return "";
    std::ranges::stable_sort(errors, {}, &std::pair<double, std::string>::first);
    std::vector<std::string> texts;
    texts.reserve(errors.size());
    for (const auto& [error_percent, text] : errors) texts.push_back(text);
    return fmt::format(
        "Mean error of the energy of a flight that is not in the fit: {}; over {}, each left out in turn{}",
        fmt::join(texts, ", "), plural(flights, "flight"), synthetic ? " (SYNTHETIC flights)" : "");
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
    add("Prediction", prediction_line(answers.validated, any_synthetic(flights)));
    add("Warnings", warned_line(flights));
    if (!facts.empty()) section.html += "<dl>\n" + facts + "</dl>\n";
    auto warnings = answers.warnings;
    warnings.insert(warnings.end(), answers.notes.begin(), answers.notes.end());
    section.html += list_html(warnings, "warning");
    return section;
}

}  // namespace flightwatt::report
