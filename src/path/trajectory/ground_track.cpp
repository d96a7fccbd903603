#include "path/trajectory/ground_track.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <boost/math/quadrature/gauss_kronrod.hpp>

namespace flightwatt::path {
namespace {

constexpr double pieces_a_turn = 12.0;
constexpr double max_pieces = 240.0;  // of one element: longer ones have longer pieces, with exact means

double rad_of(double deg) { return deg / units::degree_per_rad; }

/// Integral along a circle of a function with the period `turn_m`.
template <typename Function>
double integral(const Function& function, double from_m, double to_m, double turn_m) {
    constexpr unsigned max_depth = 15;
    constexpr double tolerance = 1e-11;
    using Quadrature = boost::math::quadrature::gauss_kronrod<double, 15>;
    const double turns = std::floor((to_m - from_m) / turn_m);
    const double of_turns =
        turns > 0.0 ? turns * Quadrature::integrate(function, 0.0, turn_m, max_depth, tolerance) : 0.0;
    const double rest_from_m = from_m + turns * turn_m;
    return of_turns +
           (rest_from_m < to_m ? Quadrature::integrate(function, rest_from_m, to_m, max_depth, tolerance) : 0.0);
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

GroundTrack::GroundTrack(const Leg& leg, const Wind& wind)
    : length_m_(leg.length_m), course_rad_(rad_of(leg.course_deg)), wind_(velocity_of(wind)) {}

GroundTrack::GroundTrack(const Circles& circles, const Wind& wind)
    : length_m_(units::rad_from_turns(circles.turns) * circles.radius_m),
      course_rad_(rad_of(circles.start_course_deg)),
      curvature_rad_m_((circles.to_right ? 1.0 : -1.0) / circles.radius_m),
      wind_(velocity_of(wind)) {}

double GroundTrack::min_horizontal_m_per_s() const {
    const double wind_m_per_s = std::hypot(wind_.east_m_per_s, wind_.north_m_per_s);
    if (curvature_rad_m_ != 0.0) return wind_m_per_s;
    const auto [along, across] = wind_along(course_rad_, wind_);
    return along < 0.0 ? wind_m_per_s : std::abs(across);
}

double GroundTrack::time_s(double from_m, double to_m, double horizontal_m_per_s) const {
    if (!(to_m > from_m)) return 0.0;
    const auto time_per_m = [&](double along_m) {
        return 1.0 / triangle_at(along_m, horizontal_m_per_s).ground_speed_m_per_s;
    };
    if (is_steady()) return (to_m - from_m) * time_per_m(0.0);
    return integral(time_per_m, from_m, to_m, units::rad_per_turn / std::abs(curvature_rad_m_));
}

double GroundTrack::load_factor_squared(double from_m, double to_m, double horizontal_m_per_s) const {
    if (curvature_rad_m_ == 0.0 || !(to_m > from_m)) return 1.0;
    // Of a coordinated turn: tan(bank) = ground speed^2 / (g radius cos(drift)), and n^2 = 1 + tan^2.
    const auto tangent_squared = [&](const WindTriangle& triangle) {
        const double tangent = triangle.ground_speed_m_per_s * triangle.ground_speed_m_per_s * curvature_rad_m_ /
                               (units::standard_gravity_m_per_s2 * triangle.cosine);
        return tangent * tangent;
    };
    if (is_steady()) return 1.0 + tangent_squared({horizontal_m_per_s, 1.0});
    const auto per_m = [&](double along_m) {
        const auto triangle = triangle_at(along_m, horizontal_m_per_s);
        return tangent_squared(triangle) / triangle.ground_speed_m_per_s;
    };
    return 1.0 + integral(per_m, from_m, to_m, units::rad_per_turn / std::abs(curvature_rad_m_)) /
                     time_s(from_m, to_m, horizontal_m_per_s);
}

WindTriangle GroundTrack::triangle_at(double along_m, double horizontal_m_per_s) const {
    // Above the minimum airspeed there is one, except for rounding.
    return solve_wind_triangle(horizontal_m_per_s, course_rad_ + curvature_rad_m_ * along_m, wind_)
        .value_or(WindTriangle{1e-12 * horizontal_m_per_s, 1e-12});
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
