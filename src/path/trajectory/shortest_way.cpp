#include "path/trajectory/shortest_way.h"

#include "base/units.h"

#include <array>
#include <cmath>
#include <limits>

namespace flightwatt::path {
namespace {

/// Three parts, their lengths in radii. A turn to the right is 1, to the left -1, straight 0.
struct Word {
    std::array<int, 3> turns{};
    std::array<double, 3> lengths{};
    double length = std::numeric_limits<double>::infinity();
};

/// An angle from 0 to below a turn.
double wrapped(double angle_rad) {
    constexpr double rounding_rad = 1e-9;
    const double angle =
        std::fmod(std::fmod(angle_rad, units::rad_per_turn) + units::rad_per_turn, units::rad_per_turn);
    return units::rad_per_turn - angle < rounding_rad ? 0.0 : angle;
}

/// Keeps the shorter word; `side` is that of its first turn.
void keep_shorter(Word& best, int side, int middle, int last, const std::array<double, 3>& lengths) {
    const double length = lengths[0] + lengths[1] + lengths[2];
    if (length < best.length) best = {{side, middle * side, last * side}, lengths, length};
}

/// The shortest word that begins with a turn to one side, over a distance [radii] along the x axis. Courses are angles
/// from it, which turns to this side increase.
void shorten(Word& best, int side, double distance, double from_rad, double to_rad) {
    const double sin_from = std::sin(from_rad), cos_from = std::cos(from_rad);
    const double sin_to = std::sin(to_rad), cos_to = std::cos(to_rad);
    const double square = distance * distance, cosine = std::cos(from_rad - to_rad);
    const double x = distance + sin_from - sin_to, y = cos_to - cos_from;  // between the circles of the same side
    {
        const double course = std::atan2(y, x);
        keep_shorter(best, side, 0, 1, {wrapped(course - from_rad), std::hypot(x, y), wrapped(to_rad - course)});
    }
    const double across = square - 2.0 + 2.0 * cosine + 2.0 * distance * (sin_from + sin_to);
    if (across >= 0.0) {
        const double length = std::sqrt(across);
        const double course = std::atan2(-cos_from - cos_to, distance + sin_from + sin_to) - std::atan2(-2.0, length);
        keep_shorter(best, side, 0, -1, {wrapped(course - from_rad), length, wrapped(course - to_rad)});
    }
    const double between = (6.0 - square + 2.0 * cosine + 2.0 * distance * (sin_to - sin_from)) / 8.0;
    if (std::abs(between) <= 1.0) {
        const double middle = wrapped(units::rad_per_turn - std::acos(between));
        const double first = wrapped(-from_rad - std::atan2(-y, x) + middle / 2.0);
        keep_shorter(best, side, -1, 1, {first, middle, wrapped(to_rad - from_rad - first + middle)});
    }
}

}  // namespace

std::vector<std::variant<Leg, Circles, Hold>> shortest_way(const Pose& from, const Pose& to, double radius_m) {
    const auto way = to.place - from.place;
    const double straight_rad = std::atan2(way.east_m, way.north_m);
    const double from_rad = from.course_deg / units::degree_per_rad - straight_rad;
    const double to_rad = to.course_deg / units::degree_per_rad - straight_rad;
    const double distance = std::hypot(way.east_m, way.north_m) / radius_m;
    Word best;
    for (const int side : {1, -1}) shorten(best, side, distance, side * from_rad, side * to_rad);
    std::vector<std::variant<Leg, Circles, Hold>> shapes;
    double course_deg = from.course_deg;
    for (std::size_t i = 0; i < best.turns.size(); ++i) {
        constexpr double negligible = 1e-9;
        if (best.lengths[i] < negligible) continue;
        if (best.turns[i] == 0) {
            shapes.emplace_back(Leg{best.lengths[i] * radius_m, course_deg});
            continue;
        }
        shapes.emplace_back(Circles{radius_m, best.lengths[i] / units::rad_per_turn, best.turns[i] > 0, course_deg});
        course_deg += best.turns[i] * best.lengths[i] * units::degree_per_rad;
        course_deg = std::fmod(course_deg + 360.0, 360.0);
    }
    return shapes;
}

}  // namespace flightwatt::path
