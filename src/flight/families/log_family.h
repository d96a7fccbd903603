#pragma once

#include "flight/flight_series.h"
#include "telemetry/autopilot_log.h"

#include <limits>
#include <set>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// A field, with its unit where the log states none.
struct FamilySource {
    const char* field;
    const char* unit = "";                                     ///< "-1m" also turns the sign of a stated one
    const char* integer_unit = nullptr;                        ///< of versions that store whole numbers
    double absent = std::numeric_limits<double>::quiet_NaN();  ///< this value means that there is no sensor
};

/// A track of an autopilot's log, from fields of one message: of each instance that the log numbers.
struct FamilyTrack {
    using Compute = double (*)(const std::vector<double>& values);

    const char* track;
    const char* message;
    std::vector<FamilySource> sources;
    Merge merge = Merge::mean;
    Compute compute = nullptr;       ///< default: the value of the only source
    const char* firmware = nullptr;  ///< of these vehicles only
    const char* source = nullptr;    ///< its name; default: of the first field
    const char* device = nullptr;    ///< of a message that is of one device
};

/// A rule for the rows of a message: several instances, or rows that do not count.
struct FamilyMessage {
    const char* message;
    const char* instance = nullptr;  ///< field with the number of the instance
    const char* valid = nullptr;     ///< the row counts if this field has
    double min_valid = 0.0;          ///< at least this value
};

/// Lowest number of a receiver's 3D fix, in the logs of all families.
inline constexpr double min_fix = 3.0;

/// Track of Unix times, from which the series has its start_clock_s.
inline constexpr auto utc_track = "utc_s";

/// The logs of one autopilot: where the quantities are, by version.
struct LogFamily {
    std::vector<FamilyTrack> tracks;      ///< in the order of preference within each name
    std::vector<FamilyMessage> messages;  ///< those with rules, in order of preference of the instance field
    void (*describe)(const telemetry::AutopilotLog&,
                     FlightSeries&) = nullptr;         ///< id, name and firmware of the aircraft
    std::vector<telemetry::MessageRequest> more = {};  ///< further fields for `describe`
    /// Fields without a unit: they have none, their unit is assumed, or assumed with a note.
    enum class Unstated { unused, assumed, noted } unstated_units = Unstated::assumed;
};

/// Voltage times current, or any other two.
double product(const std::vector<double>& values);

/// A Unix time of a receiver, with 1024 weeks added while it is before 2010, when no such log was written: receivers
/// whose counter of weeks overflowed are 20 or 39 years late. NaN for one before GPS.
double correct_week_rollover(double utc_s);

/// Adds the tracks of a sender's messages. Returns the units that are assumed: "BAT.Volt is read in V".
std::set<std::string> add_family_tracks(const telemetry::SenderLog& sender, const LogFamily& family,
                                        const std::string& firmware, std::vector<Track>& tracks);

/// In the order of track_names(), of equal names in the order that they have.
void sort_tracks(std::vector<Track>& tracks);

/// The messages and fields of a family's series.
std::vector<telemetry::MessageRequest> family_messages(const LogFamily& family);

}  // namespace flightwatt::flight
