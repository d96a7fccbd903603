#pragma once

#include "cli/stage.h"
#include "cli/terminal_plot.h"
#include "flight/segmentation.h"
#include "flight/flight_series.h"
#include "mission/simulation.h"

#include <cstddef>
#include <optional>
#include <string>

/// Small pictures below the tables of stages, where the standard output is a terminal that can show them.
namespace flightwatt::cli {

/// A plot as wide as the terminal, or std::nullopt where the result goes elsewhere or the terminal cannot show it.
std::optional<TerminalPlot> terminal_plot(const StageCall& call, const std::string& title);

/// A mission's curve under its rank.
TerminalLine soc_line(const mission::SocCurve& curve, std::size_t rank);

/// Altitude over the log, and below it where the phases are.
std::string altitude_profile(TerminalPlot plot, const flight::FlightSeries& series,
                             const flight::FlightPhases& phases);

}  // namespace flightwatt::cli
