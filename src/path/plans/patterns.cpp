#include "path/plans/patterns.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::path {

CourseAxes axes_of(double course_deg) { return {moved({}, 1.0, course_deg), moved({}, 1.0, course_deg + 90.0)}; }

CoursePosition along_and_across(const LocalPosition& place, const CourseAxes& axes) {
    return {scalar_product(place, axes.along), scalar_product(place, axes.right)};
}

CoursePosition along_and_across(const LocalPosition& place, double course_deg) {
    return along_and_across(place, axes_of(course_deg));
}

LocalPosition place_at(const CoursePosition& position, double course_deg) {
    const auto [along, right] = axes_of(course_deg);
    return {position.across_m * right.east_m + position.along_m * along.east_m,
            position.across_m * right.north_m + position.along_m * along.north_m};
}

std::vector<double> line_crossings(const Polygon& polygon, double course_deg, double offset_m) {
    const auto axes = axes_of(course_deg);
    std::vector<double> crossings;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto a = along_and_across(polygon[i], axes);
        const auto b = along_and_across(polygon[(i + 1) % polygon.size()], axes);
        if ((a.across_m <= offset_m) == (b.across_m <= offset_m)) continue;
        const double part = (offset_m - a.across_m) / (b.across_m - a.across_m);
        crossings.push_back(a.along_m + part * (b.along_m - a.along_m));
    }
    std::ranges::sort(crossings);
    return crossings;
}

LinedPolygon::LinedPolygon(const Polygon& polygon, double course_deg) : polygon_(polygon), course_deg_(course_deg) {
    const auto offset = [&](const LocalPosition& corner) { return along_and_across(corner, course_deg).across_m; };
    const auto [left, right] = std::ranges::minmax(polygon, {}, offset);
    left_m_ = offset(left);
    right_m_ = offset(right);
}

std::optional<SurveyLine> LinedPolygon::line_at(double x) const {
    const auto crossings = line_crossings(polygon_, course_deg_, x);
    if (crossings.size() < 2) return std::nullopt;
    return SurveyLine{place_at({crossings.front(), x}, course_deg_), place_at({crossings.back(), x}, course_deg_)};
}

std::vector<SurveyLine> LinedPolygon::lines_between(double left_m, double right_m, double spacing_m) const {
    std::vector<SurveyLine> lines;
    const double first = left_m + spacing_m / 2.0;
    const double count = std::floor((right_m + 1e-6 - first) / spacing_m) + 1.0;
    for (double line = 0.0; line < count && count <= max_survey_lines; line += 1.0)
        if (const auto fits = line_at(first + line * spacing_m)) lines.push_back(*fits);
    return lines;
}

std::vector<SurveyLine> survey_lines(const Polygon& polygon, double spacing_m, double course_deg,
                                     const Location& where) {
    const LinedPolygon lined(polygon, course_deg);
    auto lines = lined.lines_between(lined.left_m(), lined.right_m(), spacing_m);
    if (!lines.empty()) return lines;
    throw InputError(
        where,
        fmt::format("no lines {} m apart fit into the area, or more than 5000; state another spacing", spacing_m));
}

bool begins_with_last(const std::vector<SurveyLine>& lines, const LocalPosition& at) {
    const auto nearest_m = [&](const SurveyLine& line) {
        return std::min(distance_between_m(at, line.from), distance_between_m(at, line.to));
    };
    return nearest_m(lines.back()) < nearest_m(lines.front());
}

std::vector<SurveyLine> alternating(std::vector<SurveyLine> lines, const LocalPosition& at) {
    bool is_back = distance_between_m(at, lines.front().to) < distance_between_m(at, lines.front().from);
    for (auto& [from, to] : lines) {
        if (is_back) std::swap(from, to);
        is_back = !is_back;
    }
    return lines;
}

PathEntry with_circles(PathEntry entry, double turns, double radius_m) {
    entry.circles = turns;
    entry.radius_m = std::abs(radius_m);
    entry.to_right = radius_m > 0.0;
    return entry;
}

void PatternWriter::fly_to(const LocalPosition& place) const {
    entries.push_back(like);
    entries.back().place = place;
}

void PatternWriter::turn(double turns, double radius_m) const {
    entries.push_back(with_circles(like, turns, radius_m));
    entries.back().is_turn = true;
}

void PatternWriter::oval(const LocalPosition& first, const LocalPosition& second, double radius_m,
                         double rounds) const {
    const auto opposite = moved(second, 2.0 * radius_m, course_between(second, first) + 90.0);
    for (double round = 0.0; round < rounds; round += 1.0) {
        fly_to(second);
        fly_to(first);
        turn(0.5, radius_m);
        fly_to(opposite);
        turn(0.5, radius_m);
    }
}

void PatternWriter::eight(const LocalPosition& centre, const LocalPosition& around, double radius_m) const {
    const double course_deg = course_between(centre, around);
    const double offset_m = std::clamp(distance_between_m(centre, around), 1.0, 2.0 * std::abs(radius_m));
    const auto fly_beside = [&](const LocalPosition& middle) { fly_to(moved(middle, radius_m, course_deg - 90.0)); };
    for (const double side : {1.0, -1.0}) {
        const auto middle = moved(centre, side * offset_m, course_deg);
        fly_beside(middle);
        turn(0.5, side * radius_m);
        entries.back().place = middle;
    }
    fly_beside(moved(centre, offset_m, course_deg));
}

void PatternWriter::line(const LocalPosition& first, const LocalPosition& second, double radius_m) const {
    for (const auto& [from, to] : {SurveyLine{second, first}, SurveyLine{first, second}}) {
        fly_to(from);
        fly_to(to);
        turn(1.0 / 6.0, radius_m);
        turn(5.0 / 6.0, -radius_m);
        turn(1.0 / 6.0, radius_m);
    }
}

void PatternWriter::zamboni(const Zamboni& survey) const {
    const auto fly = [&](double along_m, double left_m) {
        fly_to(moved(moved(survey.centre, along_m, survey.course_deg), left_m, survey.course_deg - 90.0));
    };
    const double half_m = survey.length_m / 2.0;
    const double across_m = (survey.rounds - 1.0) * survey.spacing_m;
    const auto turn_half = [&](double radius_m) {
        if (std::abs(radius_m) >= min_radius_m) turn(0.5, radius_m);
    };
    fly(0.0, 0.0);
    fly(half_m, 0.0);
    for (double round = 0.0; round < survey.rounds; round += 1.0) {
        turn_half(across_m / 2.0);
        fly(half_m, round * survey.spacing_m - across_m);
        fly(-half_m, round * survey.spacing_m - across_m);
        if (round + 1.0 == survey.rounds) break;
        turn_half((across_m + survey.spacing_m) / 2.0);
        fly(-half_m, (round + 1.0) * survey.spacing_m);
        fly(half_m, (round + 1.0) * survey.spacing_m);
    }
}

void PatternWriter::turn_onto(const SurveyLine& before, const LocalPosition& next,
                              const std::optional<double>& spacing_m) const {
    const double course_deg = course_between(before.from, before.to);
    const auto [ahead_m, right_m] = along_and_across(next - before.to, course_deg);
    if (ahead_m > 0.0) fly_to(moved(before.to, ahead_m, course_deg));
    turn(0.5, std::copysign(spacing_m.value_or(std::abs(right_m)), right_m) / 2.0);
}

void PatternWriter::survey(std::vector<SurveyLine> lines, double spacing_m, const LocalPosition& at) const {
    if (begins_with_last(lines, at)) std::ranges::reverse(lines);
    lines_in_order(std::move(lines), spacing_m, at);
}

void PatternWriter::lines_in_order(std::vector<SurveyLine> lines, const std::optional<double>& spacing_m,
                                   const LocalPosition& at) const {
    lines = alternating(std::move(lines), at);
    auto named = entries.size();  // the entries of a line and of the turn before it have its number
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (i > 0) turn_onto(lines[i - 1], lines[i].from, spacing_m);
        fly_to(lines[i].from);
        fly_to(lines[i].to);
        for (; named < entries.size(); ++named) {
            entries[named].name += fmt::format(" (line {})", i + 1);
            entries[named].survey_line = i + 1;
        }
    }
}

void PatternWriter::one_way_survey(const std::vector<SurveyLine>& lines, double spacing_m, double radius_m) const {
    for (std::size_t i = 0; i < lines.size(); ++i) {
        fly_to(lines[i].from);
        fly_to(lines[i].to);
        if (i + 1 == lines.size()) break;
        const double right_deg = course_between(lines[i].from, lines[i].to) + 90.0;
        turn(0.5, -radius_m);
        fly_to(moved(lines[i + 1].from, -2.0 * radius_m - spacing_m, right_deg));
        turn(0.5, -(radius_m + spacing_m / 2.0));
    }
}

}  // namespace flightwatt::path
