#pragma once

#include "path/path.h"

#include <optional>

namespace flightwatt::path {

/// The wind as a velocity [m/s], towards east and north.
struct WindVelocity {
    double east_m_per_s = 0.0;
    double north_m_per_s = 0.0;
};
/// Returns the velocity of a wind.
WindVelocity velocity_of(const Wind& wind);

/// The wind triangle of one course.
struct WindTriangle {
    double ground_speed_m_per_s = 0.0;
    double cosine = 1.0;  ///< cosine of the angle between heading and course
};

/// Solves the wind triangle for the horizontal part of the airspeed; std::nullopt if it has no solution.
std::optional<WindTriangle> solve_wind_triangle(double horizontal_m_per_s, double course_rad, const WindVelocity& wind);

/// A leg or circles as lines over ground, measured in metres from their start, flown at a horizontal speed: an airspeed,
/// or one that is kept over ground.
class GroundTrack {
  public:
    GroundTrack(const Leg& leg, const Wind& wind, bool keeps_ground_speed = false);
    GroundTrack(const Circles& circles, const Wind& wind, bool keeps_ground_speed = false);

    double length_m() const { return length_m_; }

    /// Returns the horizontal speed above which the whole track can be flown.
    double min_horizontal_m_per_s() const;

    /// Returns the duration of the track between two distances from its start, at a horizontal speed above the minimum.
    double time_s(double from_m, double to_m, double horizontal_m_per_s) const;

    /// Returns the root of the mean square of the horizontal airspeed over that time.
    double airspeed_m_per_s(double from_m, double to_m, double horizontal_m_per_s) const;

    /// Returns the mean square of the load factor over that time.
    double load_factor_squared(double from_m, double to_m, double horizontal_m_per_s) const;

    /// Returns the length of a segment over which the motion counts as constant: the whole track if straight or without
    /// wind.
    double segment_length_m() const;

    /// Returns the number of segments after which the motion repeats.
    std::size_t segments_per_turn() const;

  private:
    bool is_steady() const {
        return curvature_rad_m_ == 0.0 || (wind_.east_m_per_s == 0.0 && wind_.north_m_per_s == 0.0);
    }
    WindTriangle steady_drift(double horizontal_m_per_s) const;

    /// A part of a turn in wind: its time, and the integral over that of (ground speed^2 / cos(drift))^2.
    struct Turned {
        double time_s = 0.0;
        double speed_fourth_m4_per_s3 = 0.0;
    };
    Turned turned(double from_m, double to_m, double horizontal_m_per_s) const;
    /// Returns the same from the course that is downwind to the course at a place.
    Turned turned_until(double along_m, double horizontal_m_per_s) const;

    double length_m_ = 0.0;
    double course_rad_ = 0.0;       ///< course at its start
    double curvature_rad_m_ = 0.0;  ///< change of the course per metre; 0: straight
    WindVelocity wind_;
    bool keeps_ground_speed_ = false;
};

}  // namespace flightwatt::path
