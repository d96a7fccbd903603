#include "path/path.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace flightwatt::path {
namespace {

/// A leg flown the other way.
PathElement reversed(PathElement element, const ClimbRates& back) {
    auto& leg = std::get<Leg>(element.shape);
    leg.course_deg = std::fmod(leg.course_deg + 180.0, 360.0);
    element.altitude_change_m = -element.altitude_change_m;
    element.climb_rate_m_per_s = element.altitude_change_m < 0.0 ? back.descent_m_per_s : back.climb_m_per_s;
    element.name += " on the way back";
    return element;
}

PathElement part_of(PathElement element, double start, double end) {
    const double part = end - start;
    if (part == 1.0) return element;
    constexpr double turn_deg = 360.0;
    element.altitude_change_m *= part;
    element.climb_rate_m_per_s.reset();
    if (auto* circles = std::get_if<Circles>(&element.shape)) {
        circles->start_course_deg += (circles->to_right ? turn_deg : -turn_deg) * circles->turns * start;
        circles->turns *= part;
    } else if (auto* hold = std::get_if<Hold>(&element.shape)) {
        hold->time_s *= part;
        if (hold->over_ground) hold->over_ground->length_m *= part;
    } else {
        std::get<Leg>(element.shape).length_m *= part;
    }
    return element;
}

LocalPosition after_part(const LocalPosition& at, const PathElement& element, double part) {
    if (const auto* circles = std::get_if<Circles>(&element.shape)) {
        constexpr double quarter_deg = 90.0;
        constexpr double turn_deg = 360.0;
        const double side = circles->to_right ? 1.0 : -1.0;
        const double turned_deg = turn_deg * circles->turns * part;
        const auto centre = moved(at, circles->radius_m, circles->start_course_deg + side * quarter_deg);
        return moved(centre, circles->radius_m, circles->start_course_deg + side * (turned_deg - quarter_deg));
    }
    const auto* leg = std::get_if<Leg>(&element.shape);
    if (const auto* hold = std::get_if<Hold>(&element.shape); hold != nullptr && hold->over_ground)
        leg = &*hold->over_ground;
    return leg != nullptr ? moved(at, leg->length_m * part, leg->course_deg) : at;
}

}  // namespace

FlightPath out_and_back(const FlightPath& path, double return_after_m, const ClimbRates& back) {
    FlightPath result;
    std::vector<PathElement> way_back;
    double left_m = return_after_m;
    const double rounding_m = 1e-9 * return_after_m;  // of the sum of the legs
    for (auto element : path.elements) {
        if ((left_m <= rounding_m && !result.elements.empty()) || element.is_return_leg) break;
        if (auto* leg = std::get_if<Leg>(&element.shape)) {
            const double part = std::min(1.0, left_m / leg->length_m);
            leg->length_m *= part;
            element.altitude_change_m *= part;
            left_m -= leg->length_m;
            way_back.push_back(reversed(element, back));
        } else if (element.altitude_change_m != 0.0 && !way_back.empty()) {
            way_back.back().altitude_change_m -= element.altitude_change_m;
            way_back.back().climb_rate_m_per_s.reset();
        }
        result.elements.push_back(std::move(element));
    }
    std::move(way_back.rbegin(), way_back.rend(), std::back_inserter(result.elements));
    return result;
}

double length_of_legs_m(const FlightPath& path) {
    double length_m = 0.0;
    for (const auto& element : path.elements)
        if (const auto* leg = std::get_if<Leg>(&element.shape); leg && !element.is_return_leg)
            length_m += leg->length_m;
    return length_m;
}

FlightPath path_between(const FlightPath& path, const PathPosition& from, const PathPosition& to) {
    FlightPath between;
    for (auto i = from.element; i < path.elements.size() && i <= to.element; ++i) {
        const double start = i == from.element ? from.part : 0.0;
        const double end = i == to.element ? to.part : 1.0;
        if (end > start) between.elements.push_back(part_of(path.elements[i], start, end));
    }
    return between;
}

double distance_between_m(const LocalPosition& a, const LocalPosition& b) {
    return std::hypot(a.east_m - b.east_m, a.north_m - b.north_m);
}

double course_between(const LocalPosition& from, const LocalPosition& to) {
    const auto way = to - from;
    return std::atan2(way.east_m, way.north_m) * units::degree_per_rad;
}

LocalPosition moved(const LocalPosition& from, double length_m, double course_deg) {
    const double course_rad = course_deg / units::degree_per_rad;
    return {from.east_m + length_m * std::sin(course_rad), from.north_m + length_m * std::cos(course_rad)};
}

LocalPosition local_position_at(const FlightPath& path, const PathPosition& place) {
    LocalPosition at;
    for (std::size_t i = 0; i < path.elements.size() && i <= place.element; ++i)
        at = after_part(at, path.elements[i], i < place.element ? 1.0 : place.part);
    return at;
}

}  // namespace flightwatt::path
