#include "report/sections/model_section.h"

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/output/fit_output.h"
#include "cli/output/physical_output.h"
#include "cli/output/prediction_output.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/physical_fit.h"
#include "report/figures/flight_figures.h"
#include "report/figures/model_figures.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::report {
Section model_section(const ReportModel& model, const std::string& id) {
    Section section{id, "Mechanical model: " + valid_utf8(model.model.name)};
    section.html += paragraph(model.origin, "soft");
    if (!model.model.description.empty()) section.html += paragraph(model.model.description);
    for (const auto& warning : model_warnings(model.model)) section.html += paragraph(warning, "warning");
    for (const auto& note : fit_notes(model.model)) section.html += paragraph(note);
    add_figure(section, model_figure(model.model, model.bands, id + "-curves"));
    if (model.table_one) {
        section.html += heading("Table I");
        add_table(section, {*model.table_one, "Coefficients of the model as the paper's Table I", ""});
        const bool has_intervals = !model.bands[flight::Phase::cruise].time_s.empty();
        section.html += paragraph(
            fmt::format("Coefficients in W{}. xi is the angular frequency on a time axis of 28 units a phase.",
                        has_intervals ? ", with the 95 % intervals of the mean of these flights" : ""),
            "soft");
    }
    return section;
}

Section validation_section(const std::vector<mechanical::ValidatedFlight>& flights, bool synthetic) {
    Section section{"validation",
                    std::string("Validation against the baselines") + (synthetic ? " (SYNTHETIC flights)" : "")};
    if (synthetic) {
        section.html +=
            paragraph("SYNTHETIC flights vary by their generator's model: these errors are not valid for real flights.",
                      "warning");
    }
    section.html += paragraph(
        "Leave-one-out: the model is fitted to all flights but one and predicts the energy of that one from its "
        "durations. Baselines: the mean power of each phase and, where airspeed was measured, power by airspeed and climb "
        "(physical).");
    add_figure(section, validation_figure(flights, "validation-errors"));
    auto scores = cli::scores_table(flights);
    std::stable_partition(scores.rows.begin(), scores.rows.end(),
                          [](const auto& row) { return row.front() == "total"; });
    add_table(section,
              {std::move(scores), "Errors of the models on flights that they were not fitted to", "tab:validation"},
              {.sortable = true});
    constexpr std::size_t few = 20;
    if (flights.size() < few)
        section.html +=
            paragraph(fmt::format("Coverage of {} flights is coarse: each counts for {:.0f} percent.", flights.size(),
                                  units::percentage(1.0, static_cast<double>(flights.size()))),
                      "soft");
    return section;
}

std::optional<Section> physical_section(std::span<const mechanical::MeasuredFlight> flights) {
    std::vector<mechanical::BinnedFlight> binned;
    for (const auto& flight : flights)
        if (!flight.motion.bins.empty()) binned.push_back(flight.motion);
    mechanical::PhysicalFit fit;
    try {
        fit = mechanical::fit_physical_model(binned);
    } catch (const NoResultError&) {
        return std::nullopt;
    }
    Section section{"physical", "Power from airspeed and climb"};
    section.html += paragraph(
        "Power as a sum of physical terms, fitted to the flights with airspeed and altitude, in bins of about 30 s.");
    add_figure(section, physical_figure(fit, binned, "physical-power"));
    if (fit.speeds) section.html += heading("Speed to fly") + list_html(cli::speed_lines(*fit.speeds));
    add_table(section, {cli::constants_table(fit.model), "Constants of the physical model", "tab:physical"});
    add_table(section,
              {cli::trials_table(fit), "Terms that were tried, with their hold-out error", "tab:physical-terms"});
    section.html += paragraph(
        fmt::format(
            "Hold-out RMS error [W] of {}, without and with the term: a term is kept if it falls by 2.5 % or more{}.",
            fit.phases_decided ? "the mean power of phases" : "bins",
            fit.phases_decided ? " and that of bins does not rise" : ""),
        "soft");
    return section;
}

}  // namespace flightwatt::report
