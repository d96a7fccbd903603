#include "mission/path/ground_track.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <boost/math/quadrature/gauss_kronrod.hpp>

namespace flightwatt::mission {
namespace {

constexpr double standard_gravity_m_per_s2 = 9.80665;
constexpr double pieces_a_turn = 12.0;
constexpr double most_pieces = 240.0;  // of one element: longer ones have longer pieces, with exact means

double rad_of(double deg) { return deg / units::degree_per_rad; }

/// Few nodes are exact to rounding over a part of a turn, unless the wind is near the airspeed.
double smooth_integral(const std::function<double(double)>& of, double from, double to) {
    constexpr unsigned most_halvings = 12;
    constexpr double accuracy = 1e-12;
    return boost::math::quadrature::gauss_kronrod<double, 15>::integrate(of, from, to, most_halvings, accuracy);
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

std::optional<Drift> drift_of(double horizontal_m_per_s, double course_rad, const WindVelocity& wind) {
    const auto [along, across] = wind_along(course_rad, wind);
    const double squared = horizontal_m_per_s * horizontal_m_per_s - across * across;
    if (!(squared > 0.0)) return std::nullopt;
    const double headway = std::sqrt(squared);
    if (!(headway + along > 0.0)) return std::nullopt;
    return Drift{headway + along, headway / horizontal_m_per_s};
}

std::optional<double> ground_speed_m_per_s(double airspeed_m_per_s, double course_deg, const Wind& wind) {
    const auto drift = drift_of(airspeed_m_per_s, rad_of(course_deg), velocity_of(wind));
    return drift ? std::optional(drift->ground_speed_m_per_s) : std::nullopt;
}

GroundTrack::GroundTrack(const Leg& leg, const Wind& wind)
    : length_m_(leg.length_m), course_rad_(rad_of(leg.course_deg)), wind_(velocity_of(wind)) {}

GroundTrack::GroundTrack(const Circles& circles, const Wind& wind)
    : length_m_(units::rad_from_turns(circles.turns) * circles.radius_m),
      course_rad_(rad_of(circles.start_course_deg)),
      curvature_rad_m_((circles.to_right ? 1.0 : -1.0) / circles.radius_m),
      wind_(velocity_of(wind)) {}

double GroundTrack::least_horizontal_m_per_s() const {
    const double wind_m_per_s = std::hypot(wind_.east_m_per_s, wind_.north_m_per_s);
    if (curvature_rad_m_ != 0.0) return wind_m_per_s;
    const auto [along, across] = wind_along(course_rad_, wind_);
    return along < 0.0 ? wind_m_per_s : std::abs(across);
}

Drift GroundTrack::drift_at(double along_m, double horizontal_m_per_s) const {
    // Above the least airspeed there is one, but for rounding.
    return drift_of(horizontal_m_per_s, course_rad_ + curvature_rad_m_ * along_m, wind_)
        .value_or(Drift{1e-12 * horizontal_m_per_s, 1e-12});
}

double GroundTrack::integral_over(double from_m, double to_m, const std::function<double(double)>& of) const {
    if (!(to_m > from_m)) return 0.0;
    if (is_steady()) return (to_m - from_m) * of(from_m);
    const double turn_m = units::rad_per_turn / std::abs(curvature_rad_m_);
    const double turns = std::floor((to_m - from_m) / turn_m);
    const double rest_m = from_m + turns * turn_m;
    double sum = turns > 0.0 ? turns * smooth_integral(of, 0.0, turn_m) : 0.0;
    if (to_m > rest_m) sum += smooth_integral(of, rest_m, to_m);
    return sum;
}

double GroundTrack::time_s(double from_m, double to_m, double horizontal_m_per_s) const {
    return integral_over(
        from_m, to_m, [&](double along_m) { return 1.0 / drift_at(along_m, horizontal_m_per_s).ground_speed_m_per_s; });
}

double GroundTrack::load_factor_squared(double from_m, double to_m, double horizontal_m_per_s) const {
    if (curvature_rad_m_ == 0.0 || !(to_m > from_m)) return 1.0;
    // Of a coordinated turn: tan(bank) = ground speed^2 / (g radius cos(drift)), and n^2 = 1 + tan^2.
    const double tangent_squared_s = integral_over(from_m, to_m, [&](double along_m) {
        const auto drift = drift_at(along_m, horizontal_m_per_s);
        const double speed = drift.ground_speed_m_per_s;
        const double tangent = speed * speed * std::abs(curvature_rad_m_) / (standard_gravity_m_per_s2 * drift.cosine);
        return tangent * tangent / speed;
    });
    return 1.0 + tangent_squared_s / time_s(from_m, to_m, horizontal_m_per_s);
}

std::size_t GroundTrack::pieces_a_period() const {
    const bool is_part_of_a_turn = !is_steady() && piece_m() * std::abs(curvature_rad_m_) < units::rad_per_turn / 2.0;
    return is_part_of_a_turn ? static_cast<std::size_t>(pieces_a_turn) : 1;
}

double GroundTrack::piece_m() const {
    if (is_steady()) return length_m_;
    const double turn_m = units::rad_per_turn / std::abs(curvature_rad_m_);
    const double part_m = turn_m / pieces_a_turn;
    if (length_m_ <= most_pieces * part_m) return part_m;
    return std::ceil(length_m_ / turn_m / most_pieces) * turn_m;
}

}  // namespace flightwatt::mission
