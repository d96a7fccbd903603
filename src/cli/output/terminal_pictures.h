#pragma once

#include "cli/stage.h"
#include "cli/terminal.h"
#include "cli/terminal_plot.h"
#include "flight/segmentation.h"
#include "mission/simulation.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

/// Small pictures below the tables of stages, where the standard output is a terminal that can show them.
namespace flightwatt::cli {

/// What to draw for, or std::nullopt where the result goes elsewhere or the terminal cannot show it.
inline std::optional<TerminalPlot> terminal_plot(const cli::StageCall& call, const std::string& title) {
    const auto ability = cli::standard_output_ability();
    if (!ability.draws || call.output || call.json) return std::nullopt;
    constexpr std::size_t most_columns = 100;
    TerminalPlot plot;
    plot.title = "\n" + title;
    plot.x_label = "s";
    plot.columns = std::min(ability.columns, most_columns);
    plot.colors = ability.colors;
    return plot;
}

/// A mission's curve under its rank.
inline TerminalLine soc_line(const mission::SocCurve& curve, std::size_t rank) {
    TerminalLine line;
    line.label = fmt::format("{}", rank);
    for (const auto& row : curve.rows) {
        line.x.push_back(row.time_s);
        line.y.push_back(row.soc_percent);
    }
    return line;
}

/// Altitude over the log, and below it where the phases are.
inline std::string altitude_profile(TerminalPlot plot, const flight::FlightSeries& series,
                                    const flight::FlightPhases& phases) {
    if (series.altitude_m.empty()) return "";
    const auto [low, high] = std::minmax_element(series.altitude_m.begin(), series.altitude_m.end());
    if (*high - *low < 1.0) return "";
    plot.rows = 7;
    plot.y_low = *low;
    plot.y_high = *high;
    auto text = draw(plot, std::vector<TerminalLine>{{series.time_s, series.altitude_m, ""}});
    for (const auto& sortie : phases.sorties) {
        for (const auto& span : sortie.phases) {
            text += fmt::format("       {} {:.0f} to {:.0f} s\n", to_string(span.phase), span.start.time_s,
                                span.end.time_s);
        }
    }
    return text;
}

}  // namespace flightwatt::cli
