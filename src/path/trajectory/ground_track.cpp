#include "path/trajectory/ground_track.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>

namespace flightwatt::path {
namespace {

constexpr double pieces_a_turn = 12.0;
constexpr double max_pieces = 240.0;  // of one element: longer ones have longer pieces, with exact means

double rad_of(double deg) { return deg / units::degree_per_rad; }

using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

/// Incomplete elliptic integrals of the first and second kind, of one modulus.
struct EllipticIntegrals {
    double first = 0.0;
    double second = 0.0;
};
EllipticIntegrals elliptic_integrals(double modulus, double angle_rad) {
    constexpr double half_turn_rad = units::rad_per_turn / 2.0;
    constexpr double small_rad = 1e-9;  // both are the angle to rounding, and Boost's divide by its sine
    const double half_turns = std::round(angle_rad / half_turn_rad);
    const double rest_rad = angle_rad - half_turns * half_turn_rad;
    EllipticIntegrals integrals{rest_rad, rest_rad};
    if (std::abs(rest_rad) > small_rad)
        integrals = {boost::math::ellint_1(modulus, rest_rad, Policy()),
                     boost::math::ellint_2(modulus, rest_rad, Policy())};
    if (half_turns != 0.0) {
        integrals.first += 2.0 * half_turns * boost::math::ellint_1(modulus, Policy());
        integrals.second += 2.0 * half_turns * boost::math::ellint_2(modulus, Policy());
    }
    return integrals;
}

/// The wind [m/s] along a course and across it.
struct WindAlong {
    double along = 0.0;
    double across = 0.0;
};
WindAlong wind_along(double course_rad, const WindVelocity& wind) {
    const double east = std::sin(course_rad);
    const double north = std::cos(course_rad);
    return {wind.east_m_per_s * east + wind.north_m_per_s * north,
            wind.east_m_per_s * north - wind.north_m_per_s * east};
}

}  // namespace

WindVelocity velocity_of(const Wind& wind) {
    const double from_rad = rad_of(wind.from_deg);
    return {-wind.speed_m_per_s * std::sin(from_rad), -wind.speed_m_per_s * std::cos(from_rad)};
}

std::optional<WindTriangle> solve_wind_triangle(double horizontal_m_per_s, double course_rad,
                                                const WindVelocity& wind) {
    const auto [along, across] = wind_along(course_rad, wind);
    const double squared = horizontal_m_per_s * horizontal_m_per_s - across * across;
    if (!(squared > 0.0)) return std::nullopt;
    const double headway = std::sqrt(squared);
    if (!(headway + along > 0.0)) return std::nullopt;
    return WindTriangle{headway + along, headway / horizontal_m_per_s};
}

GroundTrack::GroundTrack(const Leg& leg, const Wind& wind, bool keeps_ground_speed)
    : length_m_(leg.length_m),
      course_rad_(rad_of(leg.course_deg)),
      wind_(velocity_of(wind)),
      keeps_ground_speed_(keeps_ground_speed) {}

GroundTrack::GroundTrack(const Circles& circles, const Wind& wind, bool keeps_ground_speed)
    : length_m_(units::rad_from_turns(circles.turns) * circles.radius_m),
      course_rad_(rad_of(circles.start_course_deg)),
      curvature_rad_m_((circles.to_right ? 1.0 : -1.0) / circles.radius_m),
      wind_(velocity_of(wind)),
      keeps_ground_speed_(keeps_ground_speed) {}

double GroundTrack::min_horizontal_m_per_s() const {
    if (keeps_ground_speed_) return 0.0;
    const double wind_m_per_s = std::hypot(wind_.east_m_per_s, wind_.north_m_per_s);
    if (curvature_rad_m_ != 0.0) return wind_m_per_s;
    const auto [along, across] = wind_along(course_rad_, wind_);
    return along < 0.0 ? wind_m_per_s : std::abs(across);
}

double GroundTrack::time_s(double from_m, double to_m, double horizontal_m_per_s) const {
    if (!(to_m > from_m)) return 0.0;
    if (keeps_ground_speed_) return (to_m - from_m) / horizontal_m_per_s;
    if (is_steady()) return (to_m - from_m) / steady_drift(horizontal_m_per_s).ground_speed_m_per_s;
    return turned(from_m, to_m, horizontal_m_per_s).time_s;
}

double GroundTrack::airspeed_m_per_s(double from_m, double to_m, double horizontal_m_per_s) const {
    const double wind_m_per_s = std::hypot(wind_.east_m_per_s, wind_.north_m_per_s);
    if (!keeps_ground_speed_ || wind_m_per_s == 0.0) return horizontal_m_per_s;
    const double wind_rad = std::atan2(wind_.east_m_per_s, wind_.north_m_per_s);
    const double from_rad = course_rad_ + curvature_rad_m_ * from_m - wind_rad;
    const double turned_rad = curvature_rad_m_ * (to_m - from_m);
    const double mean_cosine =
        turned_rad == 0.0 ? std::cos(from_rad) : (std::sin(from_rad + turned_rad) - std::sin(from_rad)) / turned_rad;
    const double square = horizontal_m_per_s * horizontal_m_per_s + wind_m_per_s * wind_m_per_s -
                          2.0 * horizontal_m_per_s * wind_m_per_s * mean_cosine;
    return std::sqrt(std::max(square, 0.0));
}

double GroundTrack::load_factor_squared(double from_m, double to_m, double horizontal_m_per_s) const {
    if (curvature_rad_m_ == 0.0 || !(to_m > from_m)) return 1.0;
    // Of a coordinated turn: tan(bank) = ground speed^2 / (g radius cos(drift)), and n^2 = 1 + tan^2.
    const double curvature_per_g = curvature_rad_m_ / units::standard_gravity_m_per_s2;
    if (is_steady() || keeps_ground_speed_) {
        const double tangent = horizontal_m_per_s * horizontal_m_per_s * curvature_per_g;
        return 1.0 + tangent * tangent;
    }
    const auto [time_s, speed_fourth_m4_per_s3] = turned(from_m, to_m, horizontal_m_per_s);
    return 1.0 + curvature_per_g * curvature_per_g * speed_fourth_m4_per_s3 / time_s;
}

WindTriangle GroundTrack::steady_drift(double horizontal_m_per_s) const {
    // Above the least airspeed there is one, but for rounding.
    return solve_wind_triangle(horizontal_m_per_s, course_rad_, wind_)
        .value_or(WindTriangle{1e-12 * horizontal_m_per_s, 1e-12});
}

GroundTrack::Turned GroundTrack::turned(double from_m, double to_m, double horizontal_m_per_s) const {
    const auto from = turned_until(from_m, horizontal_m_per_s);
    const auto to = turned_until(to_m, horizontal_m_per_s);
    return {to.time_s - from.time_s, to.speed_fourth_m4_per_s3 - from.speed_fourth_m4_per_s3};
}

GroundTrack::Turned GroundTrack::turned_until(double along_m, double horizontal_m_per_s) const {
    // With the course a against the wind's, the headway h = sqrt(V^2 - W^2 sin^2 a) and c = W cos a, ground speed is
    // h + c = D / (h - c), where D = V^2 - W^2 = h^2 - c^2: its powers are sums of elliptic integrals.
    const double wind_rad = std::atan2(wind_.east_m_per_s, wind_.north_m_per_s);
    const double wind_m_per_s = std::hypot(wind_.east_m_per_s, wind_.north_m_per_s);
    const double angle_rad = course_rad_ + curvature_rad_m_ * along_m - wind_rad;
    const double speed = horizontal_m_per_s;
    const double modulus = std::min(wind_m_per_s / speed, 1.0 - 1e-15);
    const double difference = speed * speed * (1.0 - modulus) * (1.0 + modulus);
    const double across = modulus * std::sin(angle_rad);
    const auto integrals = elliptic_integrals(modulus, angle_rad);
    const double headway = speed * integrals.second;
    const double fourth =
        4.0 * (headway + speed * across) - difference / speed * (3.0 * integrals.first + std::atanh(across));
    return {(headway - speed * across) / difference / curvature_rad_m_, speed * speed * fourth / curvature_rad_m_};
}

std::size_t GroundTrack::segments_per_turn() const {
    const bool is_part_of_a_turn =
        !is_steady() && segment_length_m() * std::abs(curvature_rad_m_) < units::rad_per_turn / 2.0;
    return is_part_of_a_turn ? static_cast<std::size_t>(pieces_a_turn) : 1;
}

double GroundTrack::segment_length_m() const {
    if (is_steady()) return length_m_;
    const double turn_m = units::rad_per_turn / std::abs(curvature_rad_m_);
    const double part_m = turn_m / pieces_a_turn;
    if (length_m_ <= max_pieces * part_m) return part_m;
    return std::ceil(length_m_ / turn_m / max_pieces) * turn_m;
}

}  // namespace flightwatt::path
