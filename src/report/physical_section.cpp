#include "base/error.h"
#include "cli/output/physical_output.h"
#include "mechanical/physical_fit.h"
#include "report/figures/flight_figures.h"
#include "report/model_section.h"

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

constexpr auto constants_caption = "Constants of the physical model";
constexpr auto trials_caption = "Terms that were tried, with the error held back";

}  // namespace

std::vector<CaptionedTable> physical_tables(std::span<const mechanical::MeasuredFlight> flights) {
    const auto fit = fitted_motion(motions_of(flights));
    if (!fit) return {};
    return {{cli::constants_table(fit->model), constants_caption, "tab:physical"},
            {cli::trials_table(*fit), trials_caption, "tab:physical-terms"}};
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
    section.html += table_html(cli::constants_table(fit->model), {constants_caption, false, {}});
    if (fit->model.level_sd) section.html += paragraph("+- is half the 95 % interval.", "soft");
    section.html += table_html(cli::trials_table(*fit), {trials_caption, false, {}});
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
