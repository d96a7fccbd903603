#include "path/plans/patterns.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

double scalar_product(const LocalPosition& a, const LocalPosition& b) {
    return a.east_m * b.east_m + a.north_m * b.north_m;
}

double distance_m(const LocalPosition& a, const LocalPosition& b) {
    return std::hypot(a.east_m - b.east_m, a.north_m - b.north_m);
}

LocalPosition direction(double course_deg) { return moved({}, 1.0, course_deg); }

}  // namespace

LinedPolygon::LinedPolygon(const std::vector<LocalPosition>& polygon, double course_deg)
    : polygon_(polygon), along_(direction(course_deg)), across_(direction(course_deg + 90.0)) {
    const auto offset = [&](const LocalPosition& corner) { return right_of(corner); };
    const auto [left, right] = std::ranges::minmax(polygon, {}, offset);
    left_m_ = offset(left);
    right_m_ = offset(right);
}

double LinedPolygon::right_of(const LocalPosition& place) const { return scalar_product(place, across_); }

std::optional<SurveyLine> LinedPolygon::line_at(double x) const {
    std::vector<double> crossings;
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
        const auto& a = polygon_[i];
        const auto& b = polygon_[(i + 1) % polygon_.size()];
        const double xa = right_of(a), xb = right_of(b);
        if ((xa <= x) == (xb <= x)) continue;
        const double part = (x - xa) / (xb - xa);
        crossings.push_back(scalar_product(a, along_) + part * (scalar_product(b, along_) - scalar_product(a, along_)));
    }
    if (crossings.size() < 2) return std::nullopt;
    const auto [low, high] = std::ranges::minmax(crossings);
    const auto place = [&](double y) {
        return LocalPosition{x * across_.east_m + y * along_.east_m, x * across_.north_m + y * along_.north_m};
    };
    return SurveyLine{place(low), place(high)};
}

std::vector<SurveyLine> LinedPolygon::lines_between(double left_m, double right_m, double spacing_m) const {
    std::vector<SurveyLine> lines;
    const double first = left_m + spacing_m / 2.0;
    const double count = std::floor((right_m + 1e-6 - first) / spacing_m) + 1.0;
    for (double line = 0.0; line < count && count <= max_survey_lines; line += 1.0)
        if (const auto fits = line_at(first + line * spacing_m)) lines.push_back(*fits);
    return lines;
}

std::vector<SurveyLine> survey_lines(const std::vector<LocalPosition>& polygon, double spacing_m, double course_deg,
                                     const Location& where) {
    const LinedPolygon lined(polygon, course_deg);
    auto lines = lined.lines_between(lined.left_m(), lined.right_m(), spacing_m);
    if (!lines.empty()) return lines;
    throw InputError(where, fmt::format("no lines {} m apart fit into the area, or more than 5000", spacing_m));
}

bool begins_with_last(const std::vector<SurveyLine>& lines, const LocalPosition& at) {
    const auto nearest_m = [&](const SurveyLine& line) {
        return std::min(distance_m(at, line.from), distance_m(at, line.to));
    };
    return nearest_m(lines.back()) < nearest_m(lines.front());
}

double length_m(const SurveyLine& line) { return distance_m(line.from, line.to); }

double course_between(const LocalPosition& from, const LocalPosition& to) {
    const auto way = to - from;
    return std::atan2(way.east_m, way.north_m) * units::degree_per_rad;
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
    const double offset_m = std::clamp(distance_m(centre, around), 1.0, 2.0 * std::abs(radius_m));
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

void PatternWriter::survey(std::vector<SurveyLine> lines, double spacing_m, const LocalPosition& at) const {
    if (begins_with_last(lines, at)) std::ranges::reverse(lines);
    lines_in_order(std::move(lines), spacing_m, at);
}

void PatternWriter::lines_in_order(std::vector<SurveyLine> lines, const std::optional<double>& spacing_m,
                                   const LocalPosition& at) const {
    bool is_back = distance_m(at, lines.front().to) < distance_m(at, lines.front().from);
    auto named = entries.size();  // the entries of a line and of the turn before it have its number
    for (std::size_t i = 0; i < lines.size(); ++i) {
        auto& [from, to] = lines[i];
        if (is_back) std::swap(from, to);
        is_back = !is_back;
        if (i > 0) {
            const auto& before = lines[i - 1];
            const double course_deg = course_between(before.from, before.to);
            const auto next = from - before.to;
            const double ahead_m = scalar_product(next, direction(course_deg));
            if (ahead_m > 0.0) fly_to(moved(before.to, ahead_m, course_deg));
            const double aside_m = scalar_product(next, direction(course_deg + 90.0));
            turn(0.5, std::copysign(spacing_m.value_or(std::abs(aside_m)), aside_m) / 2.0);
        }
        fly_to(from);
        fly_to(to);
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
