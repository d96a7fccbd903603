#include "path/area.h"

#include "path/coverage/survey_cells.h"
#include "path/plan_blocks.h"
#include "path/plans/kml.h"
#include "path/waypoint_files.h"

#include <algorithm>
#include <regex>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

/// More would take minutes.
constexpr std::size_t max_closed_corners = 300;
constexpr const char* expected = "expected polygons, in GeoJSON or KML";

bool is_named_no_fly(const pugi::xml_node& polygon, const char* name) {
    static const std::regex no_fly(R"(\bno[ _-]?fly)", std::regex::icase);
    return std::regex_search(polygon.select_node(name).node().text().get(), no_fly);
}

/// Polygons of placemarks named "no-fly" are not flown over, nor those of such a folder, unless all are in it.
AreaOutlines kml_area(std::string_view text, const std::string& file) {
    constexpr auto folder = "ancestor::Folder[1]/name";
    const auto document = load_kml(text, file, expected);
    const auto polygons = document.select_nodes("//Polygon");
    const bool by_folder =
        std::ranges::any_of(polygons, [](const auto& polygon) { return !is_named_no_fly(polygon.node(), folder); });
    AreaOutlines found;
    for (const auto& polygon : polygons) {
        bool has_altitude = false;
        const auto ring = [&](const char* boundary, std::vector<Outline>& outlines) {
            const auto path = fmt::format("{}/LinearRing", boundary);
            for (const auto& node : polygon.node().select_nodes(path.c_str())) {
                auto& outline = outlines.emplace_back();
                for (const auto& corner : kml_places(node.node().child("coordinates"), file)) {
                    outline.push_back(corner.place);
                    has_altitude = has_altitude || corner.altitude_m.value_or(0.0) != 0.0;
                }
            }
        };
        if (is_named_no_fly(polygon.node(), "ancestor::Placemark[1]/name") ||
            (by_folder && is_named_no_fly(polygon.node(), folder))) {
            ring("outerBoundaryIs", found.closed);
            continue;
        }
        ring("outerBoundaryIs", found.areas);
        ring("innerBoundaryIs", found.closed);
        const std::string_view mode = polygon.node().child_value("altitudeMode");
        found.has_altitudes |= has_altitude && (mode == "absolute" || mode == "relativeToGround");
    }
    return found;
}

/// Reads the areas of a file, in metres from the first corner. Throws InputError.
SurveyedArea local_area(const AreaOutlines& outlines, const std::string& file) {
    if (outlines.areas.empty()) throw InputError({file}, "has no polygon to fly over", expected);
    std::size_t closed_corners = 0;
    for (const auto& polygon : outlines.closed) closed_corners += polygon.size();
    if (closed_corners > max_closed_corners)
        throw InputError({file}, fmt::format("its holes and no-fly zones have {} corners", closed_corners),
                         fmt::format("draw them with at most {}", max_closed_corners));
    const auto local = [&](const std::vector<Outline>& polygons) {
        std::vector<Polygon> found;
        for (const auto& polygon : polygons) {
            if (polygon.size() < 3)
                throw InputError({file}, fmt::format("a polygon has {} corners", polygon.size()), expected);
            found.emplace_back();
            for (const auto& corner : polygon) found.back().push_back(to_local(corner, outlines.areas.front().front()));
        }
        return found;
    };
    return {local(outlines.areas), local(outlines.closed)};
}

bool is_middle_within(const Polygon& inner, const Polygon& outer) {
    LocalPosition middle;
    for (const auto& corner : inner) middle = middle + corner;
    const auto count = static_cast<double>(inner.size());
    return std::ranges::any_of(parts_within(outer, 0.0, middle.east_m / count), [&](const LinePart& part) {
        return part.from_m < middle.north_m / count && middle.north_m / count < part.to_m;
    });
}

/// Notes polygons that overlap, as both are flown: one may be meant as a zone.
void note_overlaps(const std::vector<Polygon>& areas, SurveyPlan& survey) {
    for (std::size_t i = 0; i < areas.size(); ++i)
        for (std::size_t j = i + 1; j < areas.size(); ++j)
            if (is_middle_within(areas[i], areas[j]) || is_middle_within(areas[j], areas[i]))
                survey.not_flown.push_back(
                    fmt::format("polygons {} and {} overlap and both are flown: one that is not to be flown "
                                "over needs \"no_fly\": true (GeoJSON) or \"no-fly\" in its name (KML)",
                                i + 1, j + 1));
}

/// The layout's strips from left to right, with the lines of each.
struct LinedStrip {
    const SurveyStrip* strip = nullptr;
    double left_m = 0.0;
    double right_m = 0.0;
    std::vector<SurveyLine> lines = {};
};

constexpr double noted_part = 0.1;  // of the width

double area_between_m2(const LinedPolygon& polygon, double left_m, double right_m) {
    constexpr int slices = 400;
    double area_m2 = 0.0;
    const double width_m = (right_m - left_m) / slices;
    for (int i = 0; i < slices; ++i)
        if (const auto line = polygon.line_at(left_m + (i + 0.5) * width_m))
            area_m2 += width_m * distance_between_m(line->from, line->to);
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

/// The width of strips that is farther than half a spacing from each line.
double uncovered_width_m(const std::vector<LinedStrip>& strips) {
    double width_m = 0.0;
    for (const auto& strip : strips)
        width_m += std::max(
            0.0, strip.right_m - strip.left_m - static_cast<double>(strip.lines.size()) * strip.strip->spacing_m);
    return width_m;
}

/// Appends the lines of a layout over one polygon, in its strips.
void write_strips(const PatternWriter& writer, const Polygon& corners, const SurveyLayout& layout, SurveyPlan& survey) {
    const LinedPolygon polygon(corners, layout.heading_deg);
    const double width_m = polygon.right_m() - polygon.left_m();
    // The side to begin at is that of the first strip's spacing over all of the area, whatever the others are.
    const auto& first = layout.strips.front();
    const bool is_reversed = begins_with_last(
        survey_lines(corners, first.spacing_m, layout.heading_deg, writer.like.where), corners.front());
    std::vector<SurveyLine> lines;
    std::vector<const SurveyStrip*> strip_of;
    const auto strips = lined_strips(polygon, layout, is_reversed);
    for (const auto& strip : strips) {
        auto& cover = survey.strips.emplace_back();
        cover.area_m2 = area_between_m2(polygon, strip.left_m, strip.right_m);
        for (std::size_t i = 0; i < strip.lines.size(); ++i) {
            cover.lines_m += distance_between_m(strip.lines[i].from, strip.lines[i].to);
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
    if (const double uncovered_m = uncovered_width_m(strips); uncovered_m > noted_part * width_m)
        survey.not_flown.push_back(
            fmt::format("{:.0f} of the area's {:.0f} m of width are farther than half a spacing from a line: another "
                        "spacing fits better",
                        uncovered_m, width_m));
    if (lines.size() > static_cast<std::size_t>(max_survey_lines) || lines.empty())
        throw InputError(writer.like.where,
                         fmt::format("{} lines fit into the area, expected 1 to 5000", lines.size()));
    const auto spacing_m = layout.strips.size() == 1 ? std::optional(first.spacing_m) : std::nullopt;
    writer.lines_in_order(std::move(lines), spacing_m, corners.front());
    for (auto& entry : survey.entries)
        if (entry.survey_line > 0) entry.airspeed_m_per_s = strip_of[entry.survey_line - 1]->airspeed_m_per_s;
}

/// Appends the lines of one spacing over an area that is divided.
void write_cells(const PatternWriter& writer, const SurveyedArea& area, const SurveyLayout& layout,
                 const std::optional<LocalPosition>& start, SurveyPlan& survey) {
    if (layout.strips.size() > 1)
        throw InputError(writer.like.where,
                         "lines of several spacings do not fit an area of several polygons, or with notches or holes",
                         "give one spacing_m, or divide the area into simple ones");
    const auto& strip = layout.strips.front();
    const auto lines = write_area_survey(writer, area, strip.spacing_m, layout.heading_deg, start);
    const ClosedZones zones(area.closed, 0.0);
    if (start && zones.are_crossed(*start, *survey.entries.front().place))
        survey.not_flown.emplace_back("the straight way from the start crosses a zone that is not to be flown over");
    if (zones.are_crossed(lines.back().to, start.value_or(lines.front().from)))
        survey.not_flown.emplace_back("the straight way back to the start crosses a zone that is not to be flown over");
    auto& cover = survey.strips.emplace_back();
    cover.area_m2 = open_area_m2(area, layout.heading_deg);
    for (const auto& line : lines) {
        cover.lines_m += distance_between_m(line.from, line.to);
        survey.line_to.push_back(cover.lines_m);
    }
    for (double& to : survey.line_to) to /= cover.lines_m;
    for (auto& entry : survey.entries) entry.airspeed_m_per_s = strip.airspeed_m_per_s;
}

}  // namespace

SurveyPlan parse_area(std::string_view text, const std::string& file, const SurveyLayout& layout,
                      const std::optional<GeodeticPosition>& start) {
    const auto outlines =
        plan_format(text) == PlanFormat::flight_plan ? kml_area(text, file) : geojson_area(text, file);
    const auto area = local_area(outlines, file);
    PathEntry like;
    like.name = "the survey of the area";
    like.where = {file};
    SurveyPlan survey;
    survey.starts_at_first_place = true;
    const PatternWriter writer{like, survey.entries};
    const auto finest = std::ranges::min(layout.strips, {}, &SurveyStrip::spacing_m);
    survey.is_divided = is_divided(area, finest.spacing_m, layout.heading_deg, like.where);
    survey.has_zones = !area.closed.empty();
    note_overlaps(area.areas, survey);
    if (outlines.has_altitudes)
        survey.not_flown.emplace_back(
            "the altitudes of its polygons are not flown: altitude_m in [path] states that of the lines, "
            "ground_altitude_m that of home");
    const auto from =
        start ? std::optional(to_local(*start, outlines.areas.front().front())) : std::optional<LocalPosition>();
    if (survey.is_divided)
        write_cells(writer, area, layout, from, survey);
    else
        write_strips(writer, area.areas.front(), layout, survey);
    for (auto& entry : survey.entries) {
        if (!entry.place) continue;
        entry.geographic = to_geodetic(*entry.place, outlines.areas.front().front());
        entry.place.reset();
    }
    return survey;
}

}  // namespace flightwatt::path
