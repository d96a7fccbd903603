#pragma once

#include "report/figure.h"
#include "report/report_flight.h"

#include <optional>

namespace flightwatt::report {

/// The ground track of a flight from above, coloured by phase, metres east and north on equal scales;
/// std::nullopt where the log has no position.
std::optional<Figure> track_figure(const ReportFlight& flight, const std::string& id);

}  // namespace flightwatt::report
