// Waypoints in a CSV, and plans of QGroundControl and ArduPilot, flown in a wind.

#include "fuzz/flown_plan.h"
#include "fuzz/fuzz_target.h"
#include "path/plans/mission_files.h"
#include "path/waypoint_files.h"

void flightwatt::fuzz::run(std::string_view bytes) {
    using namespace path;
    const AutopilotSettings settings{80.0, 13.0};
    if (bytes.starts_with('{')) return fly(parse_qgc_plan(bytes, "fuzz.plan", settings));
    if (bytes.starts_with("QGC")) return fly(parse_wpl(bytes, "fuzz.waypoints", settings));
    fly({parse_waypoint_csv(bytes, "fuzz.csv")});
}
