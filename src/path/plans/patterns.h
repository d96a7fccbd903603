#pragma once

#include "path/path_entries.h"

#include <vector>

namespace flightwatt::path {

inline constexpr double max_survey_lines = 5000.0;

/// A straight line of a survey.
struct SurveyLine {
    LocalPosition from;
    LocalPosition to;
};

/// Parallel lines over a polygon, all in the direction `course_deg`, from left to right. The first is half of the
/// spacing within the polygon. Where the polygon is concave a line crosses what is outside. Throws InputError at `where`
/// if no line fits, or more than 5000.
std::vector<SurveyLine> survey_lines(const std::vector<LocalPosition>& polygon, double spacing_m, double course_deg,
                                     const Location& where);

/// Course [degrees] from one place to another.
double course_between(const LocalPosition& from, const LocalPosition& to);

/// An entry with circles: radii above 0 are to the right.
PathEntry with_circles(PathEntry entry, double turns, double radius_m);

/// Half the lines on the way there and half on the way back, in rounds that move by the spacing.
struct Zamboni {
    LocalPosition centre;
    double course_deg = 0.0;
    double length_m = 0.0;
    double spacing_m = 0.0;
    double rounds = 0.0;  ///< of two lines each
};

/// Appends the patterns of Paparazzi's autopilots (sw/airborne/modules/nav) to a path; radii and spacings more than 0
/// are to the right in arcs and ovals, to the left for Zamboni surveys.
struct PatternWriter {
    PathEntry like;  ///< has name, location and altitude of the entries
    std::vector<PathEntry>& entries;

    void fly_to(const LocalPosition& place) const;
    /// A part of a circle from where the aircraft is.
    void turn(double turns, double radius_m) const;

    /// From `second` to `first`, half a circle, back on a parallel, half a circle; `rounds` times, the last one whole.
    void oval(const LocalPosition& first, const LocalPosition& second, double radius_m, double rounds) const;

    /// Crossing the centre twice, with half a circle around `around` (moved to within two radii) and its mirror image.
    void eight(const LocalPosition& centre, const LocalPosition& around, double radius_m) const;

    /// From `second` to `first` and back, with 420 degrees of arcs at each end that lead back onto the line.
    void line(const LocalPosition& first, const LocalPosition& second, double radius_m) const;

    void zamboni(const Zamboni& survey) const;

    /// The lines there and back, beginning with the one and the end that are nearest to `at`. Before a turn the
    /// aircraft flies on until the next line's beginning is abeam.
    void survey(std::vector<SurveyLine> lines, double spacing_m, const LocalPosition& at) const;

    /// Every line in the same direction: after each half a circle to the left, the way back, and a wider half circle.
    void one_way_survey(const std::vector<SurveyLine>& lines, double spacing_m, double radius_m) const;
};

}  // namespace flightwatt::path
