#pragma once

#include "cli/stage.h"
#include "flight/flight_series.h"
#include "flight/segmentation.h"
#include "live/prediction.h"
#include "live/sources.h"
#include "mission/mission.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

/// Options of predict and watch: what a flight in the air is predicted from and at which time, and the source of its
/// telemetry.
namespace flightwatt::cli {

/// Whether a mission has to say where it flies.
enum class PathNeed { required, optional };

/// --remaining, --airspeed, --climb, --mission, --battery, --initial-soc; --model is the stage's own.
void add_basis_options(boost::program_options::options_description& options, PathNeed need);

/// What the options say, with warnings of the model or the mission. Without a path a mission's cruise takes as long as
/// it says. Where the path is optional, battery and state of charge are the mission's unless they are given. `mission`
/// becomes what --mission names. Throws UsageError for what does not fit together, and as live::require_spread and
/// live::require_physical.
live::PredictionInput read_basis(const StageCall& call, PathNeed need,
                                 std::optional<mission::MissionVariant>* mission = nullptr);

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

/// --follow, --udp, --serial, --ivy, --clock-factor, --log, --messages.
void add_source_options(boost::program_options::options_description& options);

/// The file of definitions: of --messages or --log, or the .log beside the file that is followed.
std::optional<std::string> definitions_of_source(const StageCall& call);

/// The one source that was named, opened: by these options, or - as the standard input.
std::unique_ptr<live::MessageSource> open_source(const StageCall& call);

}  // namespace flightwatt::cli
