// Waypoints in GeoJSON, and areas in GeoJSON and KML (lines 500 m apart: they are fewer), flown in a wind.

#include "fuzz/flown_plan.h"
#include "fuzz/fuzz_target.h"
#include "path/area.h"
#include "path/waypoint_files.h"

void flightwatt::fuzz::run(std::string_view bytes) {
    const bool is_area = bytes.starts_with('<') || bytes.find("Polygon") != std::string_view::npos;
    if (is_area) return fly(path::parse_area(bytes, "fuzz.kml", {30.0, {{500.0}}}));
    fly({path::parse_geojson(bytes, "fuzz.geojson")});
}
