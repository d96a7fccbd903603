// Waypoints and plans of any format, flown in a wind.

#include "fuzz/fuzz_target.h"
#include "path/plan_files.h"
#include "path/trajectory.h"

namespace {

using namespace flightwatt::path;

PlanEntries entries_of(std::string_view bytes) {
    const AutopilotSettings settings{80.0, 13.0};
    const bool is_area = bytes.find("Polygon") != std::string_view::npos;
    if (is_area) return parse_area(bytes, "fuzz.kml", 50.0, 30.0);
    if (bytes.starts_with('<')) {
        parse_plan(bytes, "fuzz.xml", settings);
        if (bytes.find("<block") == std::string_view::npos) return {parse_flight_plan(bytes, "fuzz.xml", {"1", "2"})};
        return parse_plan_blocks(bytes, "fuzz.xml", {"1", "2"}, settings);
    }
    if (bytes.find("fileType") != std::string_view::npos) return parse_qgc_plan(bytes, "fuzz.plan", settings);
    if (bytes.starts_with("QGC")) return parse_wpl(bytes, "fuzz.waypoints", settings);
    return {bytes.starts_with('{') ? parse_geojson(bytes, "fuzz.geojson") : parse_waypoint_csv(bytes, "fuzz.csv")};
}

}  // namespace

void flightwatt::fuzz::run(std::string_view bytes) {
    const auto plan = entries_of(bytes);
    PathDefaults defaults;
    defaults.airspeed_m_per_s = 13.0;
    defaults.altitude_m = 100.0;
    defaults.starts_at_first_place = plan.starts_at_first_place;
    compute_trajectory(path_of(plan.entries, defaults), {4.0, 250.0});
}
