#pragma once

#include "report/batch_content.h"

#include <optional>
#include <string>

namespace flightwatt::report {

/// What people know a flight by.
struct FlightSummary {
    std::optional<double> start_clock_s;  ///< Unix time, UTC where the .log has its clock, else as its name has it
    std::string date;                     ///< the same as "2020-07-03 12:17"; empty if unknown
    double in_air_s = 0.0;
    std::optional<double> distance_m;      ///< over ground, in the air; of position's samples joined by lines
    std::optional<double> air_distance_m;  ///< through the air; of logs that measured airspeed
    std::optional<double> height_m;        ///< the greatest above the ground at lift-off
    std::optional<double> energy_wh;       ///< in the air
    std::optional<double> cruise_power_w;  ///< the mean of its cruises
};

/// `flight` was not rejected. Only the sortie counted from 0, or all of them.
FlightSummary summarize_flight(const ReportFlight& flight, std::optional<std::size_t> sortie = std::nullopt);

}  // namespace flightwatt::report
