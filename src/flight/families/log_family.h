#pragma once

#include "flight/flight_series.h"
#include "telemetry/autopilot_log.h"

#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// A field of a message, with its unit in case the log states none.
struct FamilySource {
    const char* field;
    const char* unit = "";               ///< "-1m" also inverts the sign of a field with a stated unit
    const char* integer_unit = nullptr;  ///< unit in versions that store whole numbers
    double absent = std::numeric_limits<double>::quiet_NaN();  ///< value that means that there is no sensor
};

/// A track of an autopilot's log from fields of one message; one track for each instance that the log numbers.
struct FamilyTrack {
    using Compute = double (*)(const std::vector<double>& values);

    const char* track;
    const char* message;
    std::vector<FamilySource> sources;
    Merge merge = Merge::mean;
    Compute compute = nullptr;       ///< default: the value of the only source
    const char* firmware = nullptr;  ///< only for vehicles with this firmware
    const char* source = nullptr;    ///< source of the track; default: the first field
    const char* device = nullptr;    ///< id of the device, for a message of a single device
};

/// A rule for the rows of a message that has several instances, or rows that are not valid. A row needs all rules.
struct FamilyMessage {
    const char* message;
    const char* instance = nullptr;  ///< field with the number of the instance
    const char* valid = nullptr;     ///< a row is valid if this field has
    double min_valid = 0.0;          ///< at least this value
};

/// Lowest type of a receiver's fix that is a 3D fix, in the logs of all families.
inline constexpr double min_fix = 3.0;

/// Name of the track of Unix times, from which start_clock_s of the series follows.
inline constexpr auto utc_track = "utc_s";

/// The messages and fields of one autopilot's logs that have the quantities of a flight, in all versions.
struct LogFamily {
    std::vector<FamilyTrack> tracks;      ///< in the order of preference within each name
    std::vector<FamilyMessage> messages;  ///< messages with rules, in order of preference of the instance field
    void (*describe)(const telemetry::AutopilotLog&,
                     FlightSeries&) = nullptr;         ///< sets id, name and firmware of the aircraft
    std::vector<telemetry::MessageRequest> more = {};  ///< further fields for `describe`
    /// Treatment of fields without a unit: they have none, their unit is assumed, or assumed with a note.
    enum class Unstated { unused, assumed, noted } unstated_units = Unstated::assumed;
};

/// Returns the product of two values, such as voltage and current.
double product(const std::vector<double>& values);

/// Returns a battery's temperature [degC]; NaN for exactly 0 or -1, with which autopilots state that nothing measures it.
double if_stated_temperature(const std::vector<double>& row);

/// Returns a VTOL's state; NaN for 0, with which autopilots of other aircraft state that they have none.
double if_vtol_state(const std::vector<double>& row);
/// Returns the VtolState by whether it is a VTOL, flies as a rotorcraft (1), is in a transition, and in one to its wing;
/// NaN for other aircraft.
double if_vtol_status(const std::vector<double>& row);

/// Returns that the lift motors of a VTOL run, as ArduPilot logs QTUN only then.
double lift_motors_run(const std::vector<double>& row);

/// Returns the kind of vehicle by MAVLink's number of its type, as FlightInfo::firmware; empty for others, as VTOLs.
std::string firmware_of_type(double mav_type);

/// Returns the speed of a velocity to the north and east.
double speed_of(const std::vector<double>& north_east);

/// Returns a receiver's Unix time with 1024 weeks added while it is before 2010, when no such log was written:
/// receivers whose counter of weeks overflowed are 20 or 39 years late. NaN for a time before the GPS epoch.
double correct_week_rollover(double utc_s);

/// Returns parameters of battery monitors by their ids "0", "1" ...: of the first monitor by any of the names `first`,
/// of the monitor N by `others`, whose first "N" is the number. Values that are not above 0 mean unknown.
std::map<std::string, double> monitor_parameters(const std::map<std::string, double>& parameters,
                                                 const std::vector<std::string>& first, const std::string& others);

/// Returns the same of capacities in mAh [Ah].
std::map<std::string, double> monitor_capacities_ah(const std::map<std::string, double>& parameters,
                                                    const std::vector<std::string>& first, const std::string& others);

/// Adds the tracks of a sender's messages. Returns the units that are assumed: "BAT.Volt is read in V".
std::set<std::string> add_family_tracks(const telemetry::SenderLog& sender, const LogFamily& family,
                                        const std::string& firmware, std::vector<Track>& tracks);

/// Returns whether a smart battery states this number: 0, -1 and 65535 mean "unknown".
bool is_stated(double number);

/// Returns the serial numbers of packs as text, joined by "+", without unknown ones.
std::string joined_serials(const std::vector<double>& serials);

/// Sorts tracks in the order of track_names(); those of equal names keep their order.
void sort_tracks(std::vector<Track>& tracks);

/// Returns the messages and fields to read for a family's series.
std::vector<telemetry::MessageRequest> family_messages(const LogFamily& family);

}  // namespace flightwatt::flight
