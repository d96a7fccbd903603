#pragma once

#include "flight/load_flight.h"

#include <string>
#include <string_view>
#include <vector>

/// Parts of a log as logs of their own.
namespace flightwatt::exchange {

/// What a sortie's own log holds of the ground before and after it, where there is as much before the next one [s].
inline constexpr double ground_margin_s = 60.0;

/// The lines of a log with these times.
struct LogSlice {
    std::string name;  ///< "sortie1", "sortie1_cruise"
    flight::TimeInterval time;
};

/// Each sortie with the ground beside it, up to half-way to its neighbours: as much as the segmentation looks at. It
/// begins 30 to 60 s before lift-off, where that looks at times next to those at which it looked in the whole log, as
/// its edges depend on these. `phases` are of all sorties of the series.
std::vector<LogSlice> sortie_slices(const flight::FlightSeries& series, const flight::FlightPhases& phases);

/// Each phase from edge to edge.
std::vector<LogSlice> phase_slices(const flight::FlightPhases& phases);

/// The log as text; a binary one as flightwatt convert writes it, without messages that have no time. Throws InputError
/// for a series, which has no lines of telemetry.
std::string text_of_log(const flight::FlightFile& file);

/// The lines as they stand. One without a time goes with the line before it. The first line of a synthetic log, which
/// says that it is one, is kept in any case.
std::string lines_in_slice(std::string_view text, const LogSlice& piece);

}  // namespace flightwatt::exchange
