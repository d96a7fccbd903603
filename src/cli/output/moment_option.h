#pragma once

#include "cli/stage.h"
#include "flight/flight_series.h"
#include "flight/segmentation.h"

#include <cstddef>
#include <optional>
#include <vector>

/// The moment that predict is asked about: --until and --until-log-time.
namespace flightwatt::cli {

/// The moment that is asked for: since lift-off, on the log's clock, or (none of them) the end of the log.
struct RequestedTime {
    std::optional<double> since_lift_off_s;
    std::optional<double> log_time_s;
};

/// Throws UsageError for both, or for what is no time.
RequestedTime read_requested_time(const StageCall& call);

/// When it is, in the log's own seconds: of several aircraft, when the first has flown so long. `sortie` counts from 0.
/// Throws as mechanical::log_time_after_lift_off.
double resolve_log_time(const RequestedTime& moment, const std::vector<flight::FlightSeries>& candidates,
                        std::size_t sortie, const flight::SegmentationOptions& options);

}  // namespace flightwatt::cli
