#include "flight/flight_series.h"

namespace flightwatt::flight {

std::string_view to_string(CurrentOrigin origin) {
    switch (origin) {
        case CurrentOrigin::sensor:
            return "measured by a sensor";
        case CurrentOrigin::throttle:
            return "computed from throttle";
        case CurrentOrigin::unknown:
            break;
    }
    return "unknown";
}

const std::vector<std::string>& track_names() {
    static const std::vector<std::string> names{"altitude_m",
                                                "throttle_percent",
                                                "voltage_v",
                                                "current_a",
                                                "power_w",
                                                "charge_ah",
                                                "energy_wh",
                                                "east_m",
                                                "north_m",
                                                "ground_speed_m_per_s",
                                                "airspeed_m_per_s",
                                                "wind_speed_m_per_s",
                                                "wind_east_m_per_s",
                                                "wind_north_m_per_s",
                                                "latitude_deg",
                                                "longitude_deg",
                                                "heading_deg",
                                                "course_deg",
                                                "climb_m_per_s",
                                                "roll_deg",
                                                "mode",
                                                "block",
                                                "takeoff",
                                                "ground_altitude_m"};
    return names;
}

}  // namespace flightwatt::flight
