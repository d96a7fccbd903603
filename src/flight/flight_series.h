#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// A value that is known at some times, in order.
struct Track {
    std::vector<double> time_s;
    std::vector<double> value;
    bool empty() const { return time_s.empty(); }
};

/// What the autopilot said of the flight's state: witnesses for the segmentation, never its answer.
struct FlightWitnesses {
    std::vector<double> takeoff_s;  ///< times of TAKEOFF messages, in the log's seconds
    Track mode;                     ///< PPRZ_MODE.ap_mode: 0 manual, 1 auto1, 2 auto2
    Track block;                    ///< NAVIGATION.cur_block
    std::map<int, std::string> block_names;
};

/// The physical channels of one aircraft in one log, on the clock of its power samples: `time_s` rises
/// strictly, and every channel is as long as it or empty (the log has none).
struct FlightSeries {
    std::string file;           ///< it was read from, for errors
    std::string flight;         ///< the log's name without folder and ending
    std::string aircraft_id;    ///< as the log writes it; empty if unknown (a series CSV)
    std::string aircraft_name;  ///< from the .log; may be empty

    std::vector<double> time_s;  ///< the log's own seconds
    std::vector<double> altitude_m;
    std::vector<double> throttle_percent;
    std::vector<double> voltage_v;
    std::vector<double> current_a;
    std::vector<double> power_w;
    std::vector<double> charge_ah;
    std::vector<double> energy_wh;
    std::vector<double> east_m;
    std::vector<double> north_m;
    std::vector<double> ground_speed_m_per_s;

    std::map<std::string, std::string> sources;  ///< channel name to the message and field it came from
    std::string current_origin =
        "unknown";             ///< "measured by a sensor", "computed from throttle" or "unknown"
    std::string power_source;  ///< "ENERGY.power", "ENERGY.voltage * ENERGY.current", ...

    /// Altitude and speed on their own, faster clocks; empty in a series read from CSV.
    Track altitude_track;
    Track ground_speed_track;
    Track airspeed_track;                     ///< [m/s] as measured; empty without a sensor
    Track wind_speed_track;                   ///< [m/s] as the aircraft estimates it
    std::optional<double> ground_altitude_m;  ///< from the flight plan or NAVIGATION_REF
    FlightWitnesses witnesses;

    std::vector<std::string> warnings;  ///< what a user should know: skipped lines, assumed definitions
};

}  // namespace flightwatt::flight
