#pragma once

#include "cli/stage.h"
#include "flight/flight_series.h"
#include "live/prediction.h"
#include "live/sources.h"
#include "mission/mission.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Options of predict and watch: what a flight in the air is predicted from and at which time, and the source of its
/// telemetry.
namespace flightwatt::cli {

/// --model, --remaining, --airspeed, --climb, --mission, --plan, --battery, --initial-soc.
struct BasisArguments {
    bool uses_missions_battery = false;  ///< and its state of charge, where none are given
    std::optional<std::string> model;
    std::optional<double> remaining_s;
    std::optional<double> airspeed_m_per_s;
    std::optional<double> climb_m_per_s;
    std::optional<std::string> mission;
    std::optional<std::string> plan;
    std::optional<std::string> battery;
    std::optional<double> initial_soc_percent;
};

void add_basis_options(Options& options, BasisArguments& arguments);

/// The input of predictions, with warnings of the model or the mission. Without a path a mission's cruise has the
/// duration that it states. `mission` becomes the one of --mission. Throws UsageError for options that exclude each other, and as
/// live::require_spread and live::require_physical.
live::PredictionInput read_basis(const StageCall& call, const BasisArguments& arguments,
                                 std::optional<mission::MissionVariant>* mission = nullptr);

/// The time that is asked for: since lift-off, on the log's clock, or (none of them) the end of the log.
struct RequestedTime {
    std::optional<double> since_lift_off_s;
    std::optional<double> log_time_s;
};

/// --at and --at-log-time.
void add_time_options(Options& options, RequestedTime& time);

/// When it is, in the log's own seconds: of several aircraft, when the first has flown so long. `sortie` counts from 0.
/// Throws as mechanical::log_time_after_lift_off.
double resolve_log_time(const RequestedTime& time, const std::vector<flight::FlightSeries>& candidates,
                        std::size_t sortie, const flight::SegmentationOptions& options);

/// --follow, --mavlink, --udp, --serial, --ivy, --clock-factor, --log, --messages.
struct SourceArguments {
    std::optional<std::string> follow;
    std::optional<std::string> mavlink;
    std::optional<std::string> udp;
    std::optional<std::string> serial;
    std::optional<std::string> ivy;
    std::optional<double> clock_factor;
    std::optional<std::string> log;
    std::optional<std::string> messages;
};

void add_source_options(Options& options, SourceArguments& arguments);

/// Whether the source is MAVLink: a link, or a .tlog that is followed.
bool is_mavlink_source(const SourceArguments& arguments);

/// The file of definitions: of --messages or --log, or the .log next to the file that is followed.
std::optional<std::string> definitions_of_source(const SourceArguments& arguments);

/// The one source that was named, opened: by these options, or - as the standard input.
std::unique_ptr<live::MessageSource> open_source(const StageCall& call, const SourceArguments& arguments);

}  // namespace flightwatt::cli
