#pragma once

#include "flight/flight_phases.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace flightwatt::report {

/// A curve that was read off a published figure.
struct PublishedCurve {
    std::vector<double> time_s;
    std::vector<double> value;  ///< power_w or soc_percent
};

/// A cell of the published map of the state of charge over two qualities of service.
struct PublishedCell {
    double fps_low = 0.0;
    double fps_high = 0.0;
    double key_bits_low = 0.0;
    double key_bits_high = 0.0;
    double soc_percent = 0.0;
};

/// The digitised Figs. 2 (c-e), 3 (a, b) and 4 of the IRC 2020 paper.
struct PublishedFigures {
    flight::PerPhase<PublishedCurve> power;     ///< Fig. 2
    std::map<std::string, PublishedCurve> soc;  ///< Fig. 3, by the name of the mission in missions/paper
    std::vector<PublishedCell> soc_cells;       ///< Fig. 4
};

/// Reads fig2_PHASE.csv (time_s, power_w), fig3_MISSION.csv (time_s, soc_percent; '_' for '-') and
/// fig4_soc_cells.csv from a folder. Throws InputError for one that is missing or is no such table.
PublishedFigures read_published_figures(const std::filesystem::path& folder);

}  // namespace flightwatt::report
