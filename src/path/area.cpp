#include "path/area.h"

#include "path/plan_blocks.h"
#include "path/plans/kml.h"
#include "path/plans/patterns.h"
#include "path/waypoint_files.h"

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

constexpr const char* one_polygon = "expected one polygon, in GeoJSON or KML";

Outline kml_outline(std::string_view text, const std::string& file) {
    const auto document = load_kml(text, file, one_polygon);
    const auto outlines = document.select_nodes("//outerBoundaryIs");
    if (outlines.size() != 1) throw InputError({file}, fmt::format("has {} polygons", outlines.size()), one_polygon);
    return {kml_places(document.select_nodes("//outerBoundaryIs/LinearRing/coordinates"), file).places,
            !document.select_nodes("//innerBoundaryIs").empty()};
}

}  // namespace

PlanEntries parse_area(std::string_view text, const std::string& file, double spacing_m, double heading_deg) {
    const auto outline =
        plan_format(text) == PlanFormat::flight_plan ? kml_outline(text, file) : geojson_outline(text, file);
    if (outline.corners.size() < 3)
        throw InputError({file}, fmt::format("its polygon has {} corners", outline.corners.size()), one_polygon);
    const auto& origin = outline.corners.front();
    std::vector<LocalPosition> corners;
    for (const auto& corner : outline.corners) corners.push_back(to_local(corner, origin));
    PathEntry like;
    like.name = "the survey of the area";
    like.where = {file};
    PlanEntries survey;
    survey.starts_at_first_place = true;
    if (outline.has_holes) survey.not_flown.emplace_back("the holes of the area are flown over");
    PatternWriter{like, survey.entries}.survey(survey_lines(corners, spacing_m, heading_deg, {file}), spacing_m,
                                               corners.front());
    for (auto& entry : survey.entries) {
        if (!entry.place) continue;
        entry.geographic = to_geodetic(*entry.place, origin);
        entry.place.reset();
    }
    return survey;
}

}  // namespace flightwatt::path
