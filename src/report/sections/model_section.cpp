#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/output/fit_output.h"
#include "cli/output/physical_output.h"
#include "cli/output/prediction_output.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/physical_fit.h"
#include "report/figures/flight_figures.h"
#include "report/sections/sections.h"

#include <vector>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

std::optional<mechanical::PhysicalFit> fitted_motion(std::span<const mechanical::BinnedFlight> flights) {
    try {
        return mechanical::fit_physical_model(flights);
    } catch (const NoResultError&) {
        return std::nullopt;
    }
}

std::vector<mechanical::BinnedFlight> motions_of(std::span<const mechanical::MeasuredFlight> flights) {
    std::vector<mechanical::BinnedFlight> motions;
    for (const auto& flight : flights)
        if (!flight.motion.bins.empty()) motions.push_back(flight.motion);
    return motions;
}

}  // namespace

ReportModel model_of(const batch::BatchFit& fit, const std::optional<mechanical::MechanicalModel>& published) {
    ReportModel model{fit.model, "Fitted by flightwatt batch to the flights above."};
    model.bands = fit.bands;
    model.table_one = cli::table_of(fit.model, published, mechanical::TableIntervals::present);
    return model;
}

Section model_section(const ReportModel& model, const PublishedFigures& published, const std::string& id) {
    Section section{id, "Mechanical model: " + valid_utf8(model.model.name)};
    section.html += paragraph(model.origin, "soft");
    if (!model.model.description.empty()) section.html += paragraph(model.model.description);
    for (const auto& warning : model_warnings(model.model)) section.html += paragraph(warning, "warning");
    for (const auto& note : fit_notes(model.model)) section.html += paragraph(note);
    add_figure(section, model_figure(model.model, model.bands, published, id + "-curves"));
    if (model.table_one) {
        section.html += "<h3>Table I</h3>\n";
        section.html += table_html(*model.table_one, {"Coefficients of the model as the paper's Table I", false, {}});
        std::string legend = "Coefficients in W. xi is the angular frequency on a time axis of 28 units a phase.";
        if (!model.bands[flight::Phase::cruise].time_s.empty()) {
            legend += " Beside them the 95 % intervals of the mean of these flights.";
        }
        section.html += paragraph(legend, "soft");
    }
    return section;
}

Section validation_section(const std::vector<mechanical::ValidatedFlight>& flights, bool synthetic,
                           const SectionScope& of) {
    Section section{of.id("validation"), of.title("Validation against the baselines") +
                                             std::string(synthetic ? " (SYNTHETIC flights)" : "")};
    if (synthetic) {
        section.html += paragraph(
            "SYNTHETIC flights differ as their maker's model says: how well they are predicted says nothing of real ones.",
            "warning");
    }
    section.html += paragraph(
        "Leave-one-out: the model is fitted to all flights but one and predicts the energy of that one from "
        "its durations alone; beside the constant mean power of each phase, the nearest flight's power, and, "
        "where it was measured, cruise power after the airspeed cubed and after airspeed and climb (physical).");
    add_figure(section, validation_figure(flights, of.id("validation-errors")));
    section.html += table_html(cli::scores_table(flights), {"Scores of the models on flights not fitted", true, {}});
    constexpr std::size_t few = 20;
    if (flights.size() < few) {
        section.html +=
            paragraph(fmt::format("Coverage over {} flights means little: each counts for {:.0f} points.",
                                  flights.size(), units::percentage(1.0, static_cast<double>(flights.size()))),
                      "soft");
    }
    return section;
}

std::optional<Section> physical_section(std::span<const mechanical::MeasuredFlight> flights, const SectionScope& of) {
    const auto motions = motions_of(flights);
    const auto fit = fitted_motion(motions);
    if (!fit) return std::nullopt;
    Section section{of.id("physical"), of.title("Power from airspeed and climb")};
    section.html += paragraph(
        "Power as a sum of physical terms of the motion through the air, fitted to the flights that measured airspeed and "
        "altitude, averaged over about 30 s.");
    add_figure(section, physical_figure(fit->model, motions, of.id("physical-power")));
    add_table(section, {cli::constants_table(fit->model), "Constants of the physical model", "tab:physical"});
    if (fit->model.level_sd) section.html += paragraph("+- is half the 95 % interval.", "soft");
    add_table(section,
              {cli::trials_table(*fit), "Terms that were tried, with the error held back", "tab:physical-terms"});
    section.html += paragraph(
        fmt::format(
            "RMS error in W of {} held back, without and with the term: a term is kept if it falls by 2.5 % or more"
            "{}.",
            fit->phases_decided ? "the mean power of phases" : "stretches",
            fit->phases_decided ? " and stretches are predicted no worse" : ""),
        "soft");
    return section;
}

}  // namespace flightwatt::report
