#include "path/area.h"

#include "path/coverage/survey_cells.h"
#include "path/plan_blocks.h"
#include "path/plans/kml.h"
#include "path/waypoint_files.h"

#include <regex>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

/// More would take minutes.
constexpr std::size_t max_closed_corners = 300;
constexpr const char* expected = "expected polygons, in GeoJSON or KML";

/// Polygons of a placemark whose name says "no-fly" are not flown over.
AreaOutlines kml_area(std::string_view text, const std::string& file) {
    const auto document = load_kml(text, file, expected);
    AreaOutlines found;
    for (const auto& polygon : document.select_nodes("//Polygon")) {
        const auto ring = [&](const char* boundary, std::vector<Outline>& outlines) {
            const auto path = fmt::format("{}/LinearRing", boundary);
            for (const auto& node : polygon.node().select_nodes(path.c_str()))
                outlines.push_back(kml_places(node.node().select_nodes("coordinates"), file).places);
        };
        static const std::regex no_fly("no[ _-]?fly", std::regex::icase);
        const auto placemark = polygon.node().select_node("ancestor::Placemark[1]/name");
        if (std::regex_search(placemark.node().text().get(), no_fly)) {
            ring("outerBoundaryIs", found.closed);
            continue;
        }
        ring("outerBoundaryIs", found.areas);
        ring("innerBoundaryIs", found.closed);
    }
    return found;
}

}  // namespace

PlanEntries parse_area(std::string_view text, const std::string& file, double spacing_m, double heading_deg) {
    const auto outlines =
        plan_format(text) == PlanFormat::flight_plan ? kml_area(text, file) : geojson_area(text, file);
    if (outlines.areas.empty()) throw InputError({file}, "has no polygon to fly over", expected);
    for (const auto* polygons : {&outlines.areas, &outlines.closed})
        for (const auto& polygon : *polygons)
            if (polygon.size() < 3)
                throw InputError({file}, fmt::format("a polygon has {} corners", polygon.size()), expected);
    std::size_t closed_corners = 0;
    for (const auto& polygon : outlines.closed) closed_corners += polygon.size();
    if (closed_corners > max_closed_corners)
        throw InputError({file}, fmt::format("its holes and no-fly zones have {} corners", closed_corners),
                         fmt::format("draw them with at most {}", max_closed_corners));
    const auto& origin = outlines.areas.front().front();
    const auto local = [&](const std::vector<Outline>& polygons) {
        std::vector<Polygon> found;
        for (const auto& polygon : polygons) {
            found.emplace_back();
            for (const auto& corner : polygon) found.back().push_back(to_local(corner, origin));
        }
        return found;
    };
    PathEntry like;
    like.name = "the survey of the area";
    like.where = {file};
    PlanEntries survey;
    survey.starts_at_first_place = true;
    const SurveyedArea area{local(outlines.areas), local(outlines.closed)};
    if (!write_area_survey({like, survey.entries}, area, spacing_m, heading_deg))
        survey.not_flown.emplace_back("the straight way back to the start crosses a zone that is not to be flown over");
    for (auto& entry : survey.entries) {
        if (!entry.place) continue;
        entry.geographic = to_geodetic(*entry.place, origin);
        entry.place.reset();
    }
    return survey;
}

}  // namespace flightwatt::path
