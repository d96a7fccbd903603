#pragma once

#include "flight/flight_series.h"
#include "telemetry/autopilot_data.h"

#include <limits>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// A field of an autopilot's log that is a track.
struct FamilyField {
    enum class Stored { any, integer, real };

    const char* track;
    const char* message;
    const char* field;
    const char* unit;  ///< where the log states none; "-1m" also turns the sign of a stated one
    Merge merge = Merge::mean;
    Stored stored = Stored::any;                               ///< versions differ in it
    double absent = std::numeric_limits<double>::quiet_NaN();  ///< this value means that there is no sensor
};

/// A rule for the rows of a message: several instances, or rows that do not count.
struct FamilyMessage {
    const char* message;
    const char* instance = nullptr;  ///< field with the number of the instance
    const char* valid = nullptr;     ///< the row counts if this field has
    double min_valid = 0.0;          ///< at least this value
};

/// The rows of one instance of a message.
struct InstanceTable {
    telemetry::MessageTable table;
    std::string instance;  ///< "0"; empty if the log does not number them
};

/// The tables of a log by message and instance, and what else it states.
struct FamilyLog {
    std::vector<InstanceTable> tables;
    const telemetry::LogFacts& facts;

    /// The first instance of a message; nullptr without rows.
    const telemetry::MessageTable* table(std::string_view message) const;
};

/// The logs of one autopilot: where the quantities are, by version.
struct LogFamily {
    std::vector<FamilyField> fields;              ///< in the order of preference within each track
    std::vector<FamilyMessage> messages;          ///< those with rules, in order of preference of the instance field
    std::vector<FamilyField> power;               ///< voltage and current, whose product it is, in pairs
    std::vector<telemetry::MessageRequest> more;  ///< further ones for `add` and `describe`
    void (*add)(const FamilyLog&, std::vector<Track>&);
    void (*describe)(const FamilyLog&, FlightSeries&);
    bool notes_units = false;  ///< its logs state units, but older ones do not
};

const LogFamily& ardupilot_family();
const LogFamily& px4_family();

/// A track from a table and values of its rows.
void add_track(std::vector<Track>& tracks, const char* name, const std::string& source,
               const telemetry::MessageTable& table, const std::vector<double>& values, Merge merge = Merge::latest);

/// The series of an autopilot's log.
FlightSeries family_series(telemetry::AutopilotLog log, const LogFamily& family);

/// The messages and fields of a family's series.
std::vector<telemetry::MessageRequest> family_messages(const LogFamily& family);

}  // namespace flightwatt::flight
