#include "path/area.h"

#include "path/plan_blocks.h"
#include "path/plans/kml.h"
#include "path/plans/patterns.h"
#include "path/waypoint_files.h"

#include <algorithm>
#include <utility>

#include <GeographicLib/LocalCartesian.hpp>
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

/// The layout's strips from left to right, with the lines of each.
struct LinedStrip {
    const SurveyStrip* strip = nullptr;
    double left_m = 0.0;
    double right_m = 0.0;
    std::vector<SurveyLine> lines = {};
};

double area_between_m2(const LinedPolygon& polygon, double left_m, double right_m) {
    constexpr int slices = 400;
    double area_m2 = 0.0;
    const double width_m = (right_m - left_m) / slices;
    for (int i = 0; i < slices; ++i)
        if (const auto line = polygon.line_at(left_m + (i + 0.5) * width_m)) area_m2 += width_m * length_m(*line);
    return area_m2;
}

/// The strips in the order of flight, from the right if `is_reversed`.
std::vector<LinedStrip> lined_strips(const LinedPolygon& polygon, const SurveyLayout& layout, bool is_reversed) {
    const double width_m = polygon.right_m() - polygon.left_m();
    std::vector<LinedStrip> strips;
    double from_m = is_reversed ? polygon.right_m() : polygon.left_m();
    for (const auto& strip : layout.strips) {
        double to_m = is_reversed ? polygon.right_m() - strip.to * width_m : polygon.left_m() + strip.to * width_m;
        if (strip.to >= 1.0) to_m = is_reversed ? polygon.left_m() : polygon.right_m();
        LinedStrip lined{&strip, std::min(from_m, to_m), std::max(from_m, to_m)};
        lined.lines = polygon.lines_between(lined.left_m, lined.right_m, strip.spacing_m);
        if (is_reversed) std::ranges::reverse(lined.lines);
        strips.push_back(std::move(lined));
        from_m = to_m;
    }
    return strips;
}

}  // namespace

SurveyPlan parse_area(std::string_view text, const std::string& file, const SurveyLayout& layout) {
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
    SurveyPlan survey;
    survey.starts_at_first_place = true;
    if (outline.has_holes) survey.not_flown.emplace_back("the holes of the area are flown over");
    const LinedPolygon polygon(corners, layout.heading_deg);
    const double width_m = polygon.right_m() - polygon.left_m();
    // The side to begin at is that of the first strip's spacing over all of the area, whatever the others are.
    const auto& first = layout.strips.front();
    const bool is_reversed =
        begins_with_last(survey_lines(corners, first.spacing_m, layout.heading_deg, {file}), corners.front());
    std::vector<SurveyLine> lines;
    std::vector<const SurveyStrip*> strip_of;
    for (const auto& strip : lined_strips(polygon, layout, is_reversed)) {
        auto& cover = survey.strips.emplace_back();
        cover.area_m2 = area_between_m2(polygon, strip.left_m, strip.right_m);
        for (std::size_t i = 0; i < strip.lines.size(); ++i) {
            cover.lines_m += length_m(strip.lines[i]);
            lines.push_back(strip.lines[i]);
            strip_of.push_back(strip.strip);
            // The lines are at whole spacings from the left edge.
            const double k = static_cast<double>(is_reversed ? strip.lines.size() - 1 - i : i + 1);
            const double edge_m = strip.left_m + k * strip.strip->spacing_m;
            const double to =
                is_reversed ? (polygon.right_m() - edge_m) / width_m : (edge_m - polygon.left_m()) / width_m;
            survey.line_to.push_back(i + 1 == strip.lines.size() ? strip.strip->to : to);
        }
    }
    if (lines.size() > static_cast<std::size_t>(max_survey_lines) || lines.empty())
        throw InputError({file}, fmt::format("{} lines fit into the area, expected 1 to 5000", lines.size()));
    const auto spacing_m = layout.strips.size() == 1 ? std::optional(first.spacing_m) : std::nullopt;
    PatternWriter{like, survey.entries}.lines_in_order(std::move(lines), spacing_m, corners.front());
    const GeographicLib::LocalCartesian plane(origin.latitude_deg, origin.longitude_deg);
    for (auto& entry : survey.entries) {
        if (entry.survey_line > 0) entry.airspeed_m_per_s = strip_of[entry.survey_line - 1]->airspeed_m_per_s;
        if (!entry.place) continue;
        double above_m = 0.0;
        auto& place = entry.geographic.emplace();
        plane.Reverse(entry.place->east_m, entry.place->north_m, 0.0, place.latitude_deg, place.longitude_deg, above_m);
        entry.place.reset();
    }
    return survey;
}

}  // namespace flightwatt::path
