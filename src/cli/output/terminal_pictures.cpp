#include "cli/output/terminal_pictures.h"

#include "cli/terminal.h"
#include "flight/chosen_track.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::cli {

std::optional<TerminalPlot> terminal_plot(const StageCall& call, const std::string& title) {
    const auto ability = standard_output_ability();
    if (!ability.draws || call.output || call.json) return std::nullopt;
    constexpr std::size_t most_columns = 100;
    TerminalPlot plot;
    plot.title = "\n" + title;
    plot.x_label = "s";
    plot.columns = std::min(ability.columns, most_columns);
    plot.colors = ability.colors;
    return plot;
}

TerminalLine soc_line(const mission::SocCurve& curve, std::size_t rank) {
    TerminalLine line;
    line.label = fmt::format("{}", rank);
    for (const auto& row : curve.rows) {
        line.x.push_back(row.time_s);
        line.y.push_back(row.soc_percent);
    }
    return line;
}

std::string altitude_profile(TerminalPlot plot, const flight::FlightSeries& series,
                             const flight::FlightPhases& phases) {
    const auto time_s = power_track(series).time_s;
    const auto altitude_m = chosen_at(series, "altitude_m", time_s);
    if (altitude_m.empty()) return "";
    const auto [low, high] = std::minmax_element(altitude_m.begin(), altitude_m.end());
    if (*high - *low < 1.0) return "";
    plot.rows = 7;
    plot.y_low = *low;
    plot.y_high = *high;
    auto text = draw(plot, std::vector<TerminalLine>{{time_s, altitude_m, ""}});
    for (const auto& sortie : phases.sorties) {
        for (const auto& span : sortie.phases) {
            text += fmt::format("       {} {:.0f} to {:.0f} s\n", to_string(span.phase), span.start.time_s,
                                span.end.time_s);
        }
    }
    return text;
}

}  // namespace flightwatt::cli
