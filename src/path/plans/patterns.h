#pragma once

#include "path/path_entries.h"

#include <optional>
#include <vector>

namespace flightwatt::path {

/// Maximum number of lines of a survey.
inline constexpr double max_survey_lines = 5000.0;

/// A straight line of a survey, from one end to the other.
struct SurveyLine {
    LocalPosition from;
    LocalPosition to;
};

/// Corners of a polygon, each once.
using Polygon = std::vector<LocalPosition>;

/// A position along a course from the origin, and across it to the right.
struct CoursePosition {
    double along_m = 0.0;
    double across_m = 0.0;
};

/// The directions of a course and to its right, of length 1.
struct CourseAxes {
    LocalPosition along;
    LocalPosition right;
};

CourseAxes axes_of(double course_deg);
CoursePosition along_and_across(const LocalPosition& place, const CourseAxes& axes);
CoursePosition along_and_across(const LocalPosition& place, double course_deg);
LocalPosition place_at(const CoursePosition& position, double course_deg);

/// Returns where a line crosses a polygon, by the distances along it, in their order: it has the course `course_deg` and
/// passes the origin `offset_m` to its right.
std::vector<double> line_crossings(const Polygon& polygon, double course_deg, double offset_m);

/// Lines over a polygon, all in one direction, from left to right. In a concave polygon a line may cross the outside.
class LinedPolygon {
  public:
    LinedPolygon(const Polygon& polygon, double course_deg);

    double left_m() const { return left_m_; }
    double right_m() const { return right_m_; }
    /// Returns the line at a distance to the right of the origin; std::nullopt outside of the polygon.
    std::optional<SurveyLine> line_at(double right_m) const;
    /// Returns the lines between two distances, the first one half of the spacing from the left one; none if there would
    /// be more than 5000.
    std::vector<SurveyLine> lines_between(double left_m, double right_m, double spacing_m) const;

  private:
    const Polygon& polygon_;
    double course_deg_;
    double left_m_ = 0.0;
    double right_m_ = 0.0;
};

/// Returns parallel lines over a polygon, all in the direction `course_deg`, from left to right. The first is half of
/// the spacing within the polygon. Throws InputError at `where` if
/// no line fits, or more than 5000.
std::vector<SurveyLine> survey_lines(const Polygon& polygon, double spacing_m, double course_deg,
                                     const Location& where);

/// Returns whether the last line of a survey is nearer to a place than the first, and is flown first.
bool begins_with_last(const std::vector<SurveyLine>& lines, const LocalPosition& at);

/// Returns lines in alternating directions, the first one from the end that is nearer to `at`.
std::vector<SurveyLine> alternating(std::vector<SurveyLine> lines, const LocalPosition& at);

/// Returns the entry with circles: radii above 0 are to the right.
PathEntry with_circles(PathEntry entry, double turns, double radius_m);

/// A Zamboni survey: half of the lines are flown on the way there and half on the way back, in rounds that move by the
/// spacing.
struct Zamboni {
    LocalPosition centre;
    double course_deg = 0.0;
    double length_m = 0.0;
    double spacing_m = 0.0;
    double rounds = 0.0;  ///< number of rounds, of two lines each
};

/// Appends the patterns of Paparazzi's autopilots (sw/airborne/modules/nav) to a path; radii and spacings more than 0
/// are to the right in arcs and ovals, to the left for Zamboni surveys.
struct PatternWriter {
    PathEntry like;  ///< name, location and altitude of the appended entries
    std::vector<PathEntry>& entries;

    /// Appends a straight line to a place.
    void fly_to(const LocalPosition& place) const;
    /// Appends a part of a circle from the aircraft's position.
    void turn(double turns, double radius_m) const;

    /// Appends an oval: from `second` to `first`, half a circle, back on a parallel, half a circle; `rounds` times, the
    /// last one whole.
    void oval(const LocalPosition& first, const LocalPosition& second, double radius_m, double rounds) const;

    /// Appends an eight that crosses the centre twice, with half a circle around `around` (moved to within two radii)
    /// and its mirror image.
    void eight(const LocalPosition& centre, const LocalPosition& around, double radius_m) const;

    /// Appends a line from `second` to `first` and back, with 420 degrees of arcs at each end that lead back onto it.
    void line(const LocalPosition& first, const LocalPosition& second, double radius_m) const;

    /// Appends a Zamboni survey.
    void zamboni(const Zamboni& survey) const;

    /// Appends half a circle from the end of a line towards the beginning of the next one, as wide as the spacing, or
    /// without one as the lines are apart. Before it the aircraft continues until that is abeam.
    void turn_onto(const SurveyLine& before, const LocalPosition& next, const std::optional<double>& spacing_m) const;

    /// Appends the lines, beginning with the line that is nearest to `at`, as lines_in_order.
    void survey(std::vector<SurveyLine> lines, double spacing_m, const LocalPosition& at) const;

    /// Appends the lines in this order, in alternating directions, beginning with the end that is nearest to `at`.
    /// Before a turn the aircraft continues until the beginning of the next line is abeam. Without `spacing_m` each turn
    /// is as wide as its lines are apart.
    void lines_in_order(std::vector<SurveyLine> lines, const std::optional<double>& spacing_m,
                        const LocalPosition& at) const;

    /// Appends the lines in the same direction: after each half a circle to the left, the way back, and a wider half
    /// circle.
    void one_way_survey(const std::vector<SurveyLine>& lines, double spacing_m, double radius_m) const;
};

}  // namespace flightwatt::path
