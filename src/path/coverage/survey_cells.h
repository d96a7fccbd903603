#pragma once

#include "path/coverage/closed_zones.h"

#include <optional>
#include <vector>

namespace flightwatt::path {

/// Areas to be covered by lines, and zones that are not flown over.
struct SurveyedArea {
    std::vector<Polygon> areas;
    std::vector<Polygon> closed;
};

/// Lines of a survey that are flown one after another, each next to the one before.
using SurveyCell = std::vector<SurveyLine>;

// Problem: a line that a gap of the area or a closed zone divides is not flown in one piece, and flying each piece in the
// order of the lines would cross the gap once a line.
//
// Cells: from line to line, a piece belongs to the cell of the piece next to it if no other piece is next to
// either; where the area divides or joins, new cells begin (the boustrophedon decomposition of Choset). Each cell is
// flown by itself, the nearest next.
//
// Limits: the order of cells is the nearest neighbour's, not the shortest one. Pieces shorter than 1 m are left out. The
// strip along a closed zone in which the aircraft turns is flown by no line.

/// Returns the cells of the areas, in their order, with lines `spacing_m` apart on the course `course_deg`: the first one
/// half of that within the area. Throws InputError at `where` if no line fits into an area, or more than 5000.
std::vector<SurveyCell> survey_cells(const std::vector<Polygon>& areas, const ClosedZones& closed, double spacing_m,
                                     double course_deg, const Location& where);

/// Returns whether zones, notches or several polygons divide an area. Throws InputError as survey_cells.
bool is_divided(const SurveyedArea& area, double spacing_m, double course_deg, const Location& where);

/// Returns what of the areas is in no closed zone, by 400 slices along the course of each.
double open_area_m2(const SurveyedArea& area, double course_deg);

/// Appends the lines of the areas, with turns between them as PatternWriter::survey, and ways around closed zones; returns
/// them as they are flown. They end half of the spacing, in which the aircraft turns, before a closed zone. The way to the
/// first line leads around them from `start`, straight where there is no such way; without a start the flight begins at
/// that line. Throws InputError as survey_cells, and where there is no way to a cell.
std::vector<SurveyLine> write_area_survey(const PatternWriter& writer, const SurveyedArea& area, double spacing_m,
                                          double course_deg, const std::optional<LocalPosition>& start);

}  // namespace flightwatt::path
