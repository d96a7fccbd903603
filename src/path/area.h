#pragma once

#include "path/plan_files.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::path {

/// A part of an area's width, covered by lines of one spacing. The first line is half a spacing from its left edge.
struct SurveyStrip {
    double spacing_m = 0.0;
    double to = 1.0;  ///< where it ends, as a part of the width in the order of flight; it begins where another ends
    std::optional<double> airspeed_m_per_s = std::nullopt;  ///< absent: the path's

    bool operator==(const SurveyStrip&) const = default;
};

/// How an area is covered by lines.
struct SurveyLayout {
    double heading_deg = 0.0;         ///< course of the first line, or its reverse
    std::vector<SurveyStrip> strips;  ///< in the order of flight, the last one up to 1

    bool operator==(const SurveyLayout&) const = default;
};

/// What the lines of a strip cover.
struct StripCover {
    double area_m2 = 0.0;
    double lines_m = 0.0;  ///< length of its lines
};

/// The lines over an area.
struct SurveyPlan : PlanEntries {
    std::vector<double> line_to;     ///< part of the width up to which each line covers, in the order of flight
    std::vector<StripCover> strips;  ///< those of the layout
    bool is_divided = false;         ///< by notches, holes or zones, or into several polygons: lines of one spacing
    bool has_zones = false;          ///< holes or zones, which are not to be flown over
};

/// Plans lines over the polygons of a GeoJSON or KML file, on the course of the layout and back, with half circles between
/// them, around holes and polygons that are not to be flown over (docs/missions.md). The flight begins at `start`; without
/// one at the first line. Throws InputError, placed in the file, for an area without lines, one that these zones enclose,
/// and a layout of several strips over an area that notches, holes or zones divide.
SurveyPlan parse_area(std::string_view text, const std::string& file, const SurveyLayout& layout,
                      const std::optional<GeodeticPosition>& start = std::nullopt);

}  // namespace flightwatt::path
