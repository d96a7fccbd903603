#pragma once

#include "path/path_entries.h"

#include <string>
#include <vector>

namespace flightwatt::path {

inline constexpr double max_survey_lines = 5000.0;

/// A straight line of a survey.
struct SurveyLine {
    LocalPosition from;
    LocalPosition to;
};

/// Parallel lines over a polygon, all in the direction `course_deg`, from left to right. The first is half of the
/// spacing within the polygon. Where the polygon is concave a line crosses what is outside. Empty if no
/// line fits, or more than 5000.
std::vector<SurveyLine> survey_lines(const std::vector<LocalPosition>& polygon, double spacing_m, double course_deg);

/// The lines there and back, beginning with the one and the end that are nearest to `at`. Before a turn the aircraft
/// flies on until the next line's beginning is abeam. `like` has name, location and altitude of the entries.
void add_survey(const std::vector<SurveyLine>& lines, double spacing_m, const LocalPosition& at, const PathEntry& like,
                std::vector<PathEntry>& entries);

/// Patterns of Paparazzi's autopilots (sw/airborne/modules/nav), appended to `entries`; radii and spacings more than 0
/// are to the right in arcs and ovals, to the left for Zamboni surveys.

/// From `second` to `first`, half a circle, back on a parallel, half a circle; `rounds` times, the last one whole.
void add_oval(const LocalPosition& first, const LocalPosition& second, double radius_m, double rounds,
              const PathEntry& like, std::vector<PathEntry>& entries);

/// Crossing the centre twice, with half a circle around `turn` (moved to within two radii) and its mirror image.
void add_eight(const LocalPosition& centre, const LocalPosition& turn, double radius_m, const PathEntry& like,
               std::vector<PathEntry>& entries);

/// From `second` to `first` and back, with 420 degrees of arcs at each end that lead back onto the line.
void add_line(const LocalPosition& first, const LocalPosition& second, double radius_m, const PathEntry& like,
              std::vector<PathEntry>& entries);

/// Half the lines on the way there and half on the way back, in rounds that move by the spacing.
struct Zamboni {
    LocalPosition centre;
    double course_deg = 0.0;
    double length_m = 0.0;
    double spacing_m = 0.0;
    double rounds = 0.0;  ///< of two lines each
};
void add_zamboni(const Zamboni& survey, const PathEntry& like, std::vector<PathEntry>& entries);

/// Every line in the same direction: after each half a circle to the left, the way back, and a wider half circle.
void add_one_way_survey(const std::vector<SurveyLine>& lines, double spacing_m, double radius_m, const PathEntry& like,
                        std::vector<PathEntry>& entries);

/// Course [degrees] from one place to another.
double course_between(const LocalPosition& from, const LocalPosition& to);

/// An entry like `like` that flies straight to a place.
PathEntry leg_to(const LocalPosition& place, const PathEntry& like);

/// A part of a circle from where the aircraft is; positive radii turn right.
PathEntry arc(double turns, double radius_m, const PathEntry& like);

}  // namespace flightwatt::path
