#include "path/trajectory/ground_track.h"

#include "path/trajectory.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::path {
namespace {

/// The time from one place of a circle to another and the mean square of the load factor, by the middle of many small
/// parts: there the wind triangle and the bank.
struct Summed {
    double time_s = 0.0;
    double load_factor_squared = 0.0;
};
Summed summed(const Circles& circles, const Wind& wind, double from_m, double to_m, double airspeed_m_per_s) {
    constexpr int parts = 20000;
    constexpr double g = 9.80665;
    const double part_m = (to_m - from_m) / parts;
    Summed sum;
    for (int k = 0; k < parts; ++k) {
        const double along_m = from_m + (k + 0.5) * part_m;
        const double turned_rad = along_m / circles.radius_m * (circles.to_right ? 1.0 : -1.0);
        const double course_deg = circles.start_course_deg + turned_rad * 180.0 / std::acos(-1.0);
        PathElement element;
        element.airspeed_m_per_s = airspeed_m_per_s;
        const double ground_m_per_s = ground_speed_m_per_s(element, 0.0, course_deg, wind).value();
        const double drift_rad = std::asin(
            wind.speed_m_per_s * std::sin((wind.from_deg - course_deg) * std::acos(-1.0) / 180.0) / airspeed_m_per_s);
        const double tangent = ground_m_per_s * ground_m_per_s / (g * circles.radius_m * std::cos(drift_rad));
        sum.time_s += part_m / ground_m_per_s;
        sum.load_factor_squared += (1.0 + tangent * tangent) * part_m / ground_m_per_s;
    }
    sum.load_factor_squared /= sum.time_s;
    return sum;
}

TEST(GroundTrack, OfCirclesIsTheSumOfItsParts) {
    std::mt19937_64 random(77);
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < 40; ++i) {
        Circles circles{.radius_m = 40.0 + 100.0 * unit(random), .turns = 0.1 + 3.0 * unit(random)};
        circles.to_right = i % 2 == 0;
        circles.start_course_deg = 360.0 * unit(random);
        const double airspeed_m_per_s = 10.0 + 10.0 * unit(random);
        const Wind wind{airspeed_m_per_s * 0.9 * unit(random), 360.0 * unit(random)};
        const GroundTrack track(circles, wind);
        const double from_m = track.length_m() * 0.5 * unit(random);
        const double to_m = from_m + (track.length_m() - from_m) * unit(random);
        const auto expected = summed(circles, wind, from_m, to_m, airspeed_m_per_s);
        EXPECT_NEAR(track.time_s(from_m, to_m, airspeed_m_per_s), expected.time_s, 1e-6 * expected.time_s) << i;
        EXPECT_NEAR(track.load_factor_squared(from_m, to_m, airspeed_m_per_s), expected.load_factor_squared, 1e-5) << i;
    }
}

/// Where a circle goes straight with the wind, against it or across, the integrals have their corners.
TEST(GroundTrack, HasNoGapsAtTheCoursesOfTheWind) {
    const Wind wind{5.0, 30.0};
    const Circles circles{.radius_m = 60.0, .turns = 2.0, .to_right = true};
    const GroundTrack track(circles, wind);
    double sum_s = 0.0;
    for (int k = 0; k < 24; ++k) {
        const double part_s = track.time_s(track.length_m() / 24.0 * k, track.length_m() / 24.0 * (k + 1), 13.0);
        EXPECT_GT(part_s, 0.0) << k;
        sum_s += part_s;
    }
    EXPECT_NEAR(sum_s, track.time_s(0.0, track.length_m(), 13.0), 1e-9);
}

}  // namespace
}  // namespace flightwatt::path
