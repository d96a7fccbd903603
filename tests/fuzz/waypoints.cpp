// Waypoints of any format, flown in a wind.

#include "fuzz/fuzz_target.h"
#include "path/trajectory.h"
#include "path/waypoint_files.h"

void flightwatt::fuzz::run(std::string_view bytes) {
    using namespace path;
    const auto entries = bytes.starts_with('<')   ? parse_flight_plan(bytes, "fuzz.xml", {"1", "2"})
                         : bytes.starts_with('{') ? parse_geojson(bytes, "fuzz.geojson")
                                                  : parse_waypoint_csv(bytes, "fuzz.csv");
    PathDefaults defaults;
    defaults.airspeed_m_per_s = 13.0;
    defaults.altitude_m = 100.0;
    compute_trajectory(path_of(entries, defaults), {4.0, 250.0});
}
