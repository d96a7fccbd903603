#include "path/plans/patterns.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::path {
namespace {

double scalar_product(const LocalPosition& a, const LocalPosition& b) {
    return a.east_m * b.east_m + a.north_m * b.north_m;
}

double distance_m(const LocalPosition& a, const LocalPosition& b) {
    return std::hypot(a.east_m - b.east_m, a.north_m - b.north_m);
}

LocalPosition direction(double course_deg) {
    const double course_rad = course_deg / units::degree_per_rad;
    return {std::sin(course_rad), std::cos(course_rad)};
}

}  // namespace

std::vector<SurveyLine> survey_lines(const std::vector<LocalPosition>& polygon, double spacing_m, double course_deg) {
    const auto along = direction(course_deg);
    const auto across = direction(course_deg + 90.0);
    const auto offset = [&](const LocalPosition& corner) { return scalar_product(corner, across); };
    const auto [left, right] = std::ranges::minmax(polygon, {}, offset);
    std::vector<SurveyLine> lines;
    const double first = offset(left) + spacing_m / 2.0;
    const double count = std::floor((offset(right) + 1e-6 - first) / spacing_m) + 1.0;
    if (!(count <= max_survey_lines)) return lines;
    for (double line = 0.0; line < count; line += 1.0) {
        const double x = first + line * spacing_m;
        std::vector<double> crossings;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const auto& a = polygon[i];
            const auto& b = polygon[(i + 1) % polygon.size()];
            const double xa = offset(a), xb = offset(b);
            if ((xa <= x) == (xb <= x)) continue;
            const double part = (x - xa) / (xb - xa);
            crossings.push_back(scalar_product(a, along) +
                                part * (scalar_product(b, along) - scalar_product(a, along)));
        }
        if (crossings.size() < 2) continue;
        const auto [low, high] = std::ranges::minmax(crossings);
        const auto place = [&](double y) {
            return LocalPosition{x * across.east_m + y * along.east_m, x * across.north_m + y * along.north_m};
        };
        lines.push_back({place(low), place(high)});
    }
    return lines;
}

double course_between(const LocalPosition& from, const LocalPosition& to) {
    const auto way = to - from;
    return std::atan2(way.east_m, way.north_m) * units::degree_per_rad;
}

PathEntry leg_to(const LocalPosition& place, const PathEntry& like) {
    auto entry = like;
    entry.place = place;
    return entry;
}

PathEntry arc(double turns, double radius_m, const PathEntry& like) {
    auto entry = like;
    entry.circles = turns;
    entry.radius_m = std::abs(radius_m);
    entry.to_right = radius_m > 0.0;
    entry.is_turn = true;
    return entry;
}

void add_survey(const std::vector<SurveyLine>& lines, double spacing_m, const LocalPosition& at, const PathEntry& like,
                std::vector<PathEntry>& entries) {
    if (lines.empty()) return;
    auto flown = lines;
    const auto nearest_m = [&](const SurveyLine& line) {
        return std::min(distance_m(at, line.from), distance_m(at, line.to));
    };
    if (nearest_m(flown.back()) < nearest_m(flown.front())) std::ranges::reverse(flown);
    bool is_back = distance_m(at, flown.front().to) < distance_m(at, flown.front().from);
    for (auto& line : flown) {
        if (is_back) std::swap(line.from, line.to);
        is_back = !is_back;
    }
    for (std::size_t i = 0; i < flown.size(); ++i) {
        entries.push_back(leg_to(flown[i].from, like));
        entries.push_back(leg_to(flown[i].to, like));
        if (i + 1 == flown.size()) break;
        const double course_deg = course_between(flown[i].from, flown[i].to);
        const auto next = flown[i + 1].from - flown[i].to;
        const double ahead_m = scalar_product(next, direction(course_deg));
        if (ahead_m > 0.0) entries.push_back(leg_to(moved(flown[i].to, ahead_m, course_deg), like));
        const double side = scalar_product(next, direction(course_deg + 90.0)) > 0.0 ? 1.0 : -1.0;
        entries.push_back(arc(0.5, side * spacing_m / 2.0, like));
    }
}

void add_oval(const LocalPosition& first, const LocalPosition& second, double radius_m, double rounds,
              const PathEntry& like, std::vector<PathEntry>& entries) {
    const auto opposite = moved(second, 2.0 * radius_m, course_between(second, first) + 90.0);
    for (double round = 0.0; round < rounds; round += 1.0) {
        entries.push_back(leg_to(second, like));
        entries.push_back(leg_to(first, like));
        entries.push_back(arc(0.5, radius_m, like));
        entries.push_back(leg_to(opposite, like));
        entries.push_back(arc(0.5, radius_m, like));
    }
}

void add_eight(const LocalPosition& centre, const LocalPosition& turn, double radius_m, const PathEntry& like,
               std::vector<PathEntry>& entries) {
    const double course_deg = course_between(centre, turn);
    const double offset_m = std::clamp(distance_m(centre, turn), 1.0, 2.0 * std::abs(radius_m));
    const auto half_circle = [&](double along_m, double side) {
        const auto around = moved(centre, along_m, course_deg);
        entries.push_back(leg_to(moved(around, radius_m, course_deg - 90.0), like));
        entries.push_back(arc(0.5, side * radius_m, leg_to(around, like)));
    };
    half_circle(offset_m, 1.0);
    half_circle(-offset_m, -1.0);
    entries.push_back(leg_to(moved(moved(centre, offset_m, course_deg), radius_m, course_deg - 90.0), like));
}

void add_line(const LocalPosition& first, const LocalPosition& second, double radius_m, const PathEntry& like,
              std::vector<PathEntry>& entries) {
    const auto fly = [&](const LocalPosition& from, const LocalPosition& to) {
        entries.push_back(leg_to(from, like));
        entries.push_back(leg_to(to, like));
        for (const auto& [turns, side] : {std::pair{1.0 / 6.0, 1.0}, {5.0 / 6.0, -1.0}, {1.0 / 6.0, 1.0}})
            entries.push_back(arc(turns, side * radius_m, like));
    };
    fly(second, first);
    fly(first, second);
}

void add_zamboni(const Zamboni& survey, const PathEntry& like, std::vector<PathEntry>& entries) {
    const auto fly_to = [&](double along_m, double left_m) {
        const auto along = moved(survey.centre, along_m, survey.course_deg);
        entries.push_back(leg_to(moved(along, left_m, survey.course_deg - 90.0), like));
    };
    const double half_m = survey.length_m / 2.0;
    const double across_m = (survey.rounds - 1.0) * survey.spacing_m;
    const auto turn = [&](double radius_m) {
        if (std::abs(radius_m) >= min_radius_m) entries.push_back(arc(0.5, radius_m, like));
    };
    fly_to(0.0, 0.0);
    fly_to(half_m, 0.0);
    for (double round = 0.0; round < survey.rounds; round += 1.0) {
        turn(across_m / 2.0);
        fly_to(half_m, round * survey.spacing_m - across_m);
        fly_to(-half_m, round * survey.spacing_m - across_m);
        if (round + 1.0 == survey.rounds) break;
        turn((across_m + survey.spacing_m) / 2.0);
        fly_to(-half_m, (round + 1.0) * survey.spacing_m);
        fly_to(half_m, (round + 1.0) * survey.spacing_m);
    }
}

void add_one_way_survey(const std::vector<SurveyLine>& lines, double spacing_m, double radius_m, const PathEntry& like,
                        std::vector<PathEntry>& entries) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
        entries.push_back(leg_to(lines[i].from, like));
        entries.push_back(leg_to(lines[i].to, like));
        if (i + 1 == lines.size()) break;
        const double right_deg = course_between(lines[i].from, lines[i].to) + 90.0;
        entries.push_back(arc(0.5, -radius_m, like));
        entries.push_back(leg_to(moved(lines[i + 1].from, -2.0 * radius_m - spacing_m, right_deg), like));
        entries.push_back(arc(0.5, -(radius_m + spacing_m / 2.0), like));
    }
}

}  // namespace flightwatt::path
