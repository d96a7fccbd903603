#include "flight/select/airspeed.h"

#include "base/statistics.h"
#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

constexpr double window_s = 600.0;        // of one wind: in the real flights it turned by 1 to 3 m/s in 20 minutes
constexpr double step_s = 2.0;            // between samples of the fit; airspeeds are correlated over longer times
constexpr double course_reach_s = 0.5;    // of a single course
constexpr double max_course_gap_s = 5.0;  // between two courses; a circle takes longer than 20 s
constexpr double min_moving_m_per_s = 3.0;
constexpr double independent_s = 30.0;  // airspeeds so far apart are nearly independent in real flights
constexpr double correlated_s = 60.0;   // no correlation beyond
constexpr double min_intervals = 6.0;   // of independent_s
constexpr double max_sd_part = 0.1;     // of the wind, relative to the airspeed
constexpr std::size_t sectors = 12;     // of headings
constexpr std::size_t max_empty_sectors = 4;
constexpr double min_sector_part = 0.01;  // of the samples
// Chosen with the five real flights of docs/validation.md in view.
constexpr double heading_sd_part = 0.03;  // of the airspeed, by which it may differ with the heading
constexpr double gust_sd_part = 0.1;      // of the wind, in means over 30 s; and independently
constexpr double calm_gust_sd = 0.4;      // in any wind
// A quarter of the airspeed is half of its pressure: thin air at 3,000 m and a sensor without calibration explain less.
constexpr double max_sensor_error_part = 0.25;
constexpr double max_sensor_error_sd = 3.0;  // of the mean estimate

struct GroundVelocity {
    double time_s = 0.0;
    Eigen::Vector2d m_per_s;  ///< east, north
};

using Velocities = std::vector<GroundVelocity>;

/// The course at a time [rad], between two near it or from one just before; NaN without.
double course_at(const Track& course, double time_s) {
    const auto i = first_after(course.time_s, time_s);
    if (i == 0) return std::nan("");
    const double since_s = time_s - course.time_s[i - 1];
    double course_deg = course.value[i - 1];
    const double gap_s = i < course.time_s.size() ? course.time_s[i] - course.time_s[i - 1] : 0.0;
    if (i < course.time_s.size() && gap_s <= max_course_gap_s)
        course_deg += since_s / gap_s * std::remainder(course.value[i] - course_deg, 360.0);
    else if (since_s > course_reach_s)
        return std::nan("");
    return course_deg / units::degree_per_rad;
}

/// The velocities while it moves.
Velocities ground_velocities(const FlightData& data) {
    Velocities velocities;
    const auto& speed = data.ground_speed_m_per_s;
    for (std::size_t i = 0; i < speed.time_s.size(); ++i) {
        const double course = course_at(data.course_deg, speed.time_s[i]);
        if (!(speed.value[i] >= min_moving_m_per_s) || std::isnan(course)) continue;
        velocities.push_back({speed.time_s[i], speed.value[i] * Eigen::Vector2d(std::sin(course), std::cos(course))});
    }
    return velocities;
}

Velocities thinned(std::span<const GroundVelocity> velocities) {
    Velocities thin;
    for (const auto& velocity : velocities)
        if (thin.empty() || velocity.time_s - thin.back().time_s >= 0.99 * step_s) thin.push_back(velocity);
    return thin;
}

/// Wind to the east and north, and airspeed.
using Circle = Eigen::Vector3d;

Eigen::Vector2d through_air(const Circle& circle, const GroundVelocity& velocity) {
    return velocity.m_per_s - circle.head<2>();
}

double residual(const Circle& circle, const GroundVelocity& velocity) {
    return through_air(circle, velocity).norm() - circle[2];
}

/// The circle by linear least squares of its equation (Kasa 1976).
Circle algebraic_circle(const Velocities& velocities) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const auto& [time_s, v] : velocities) {
        const Eigen::Vector3d row(2.0 * v[0], 2.0 * v[1], 1.0);
        normal += row * row.transpose();
        right += v.squaredNorm() * row;
    }
    Circle circle = normal.ldlt().solve(right);
    circle[2] = std::sqrt(std::max(circle[2] + circle.head<2>().squaredNorm(), 0.0));
    return circle;
}

struct CircleResidual {
    const Eigen::Vector2d velocity;
    template <typename T>
    bool operator()(const T* circle, T* residual) const {
        const T east = velocity[0] - circle[0];
        const T north = velocity[1] - circle[1];
        *residual = ceres::sqrt(east * east + north * north + 1e-6) - circle[2];
        return true;
    }
};

/// Twice the residuals' robust standard deviation about a circle, at least half a metre a second.
double loss_scale(const Velocities& velocities, const Circle& circle) {
    std::vector<double> sizes;
    for (const auto& velocity : velocities) sizes.push_back(std::abs(residual(circle, velocity)));
    constexpr double sd_of_median = 1.4826;
    constexpr double min_m_per_s = 0.5;
    return std::max(2.0 * sd_of_median * median(sizes), min_m_per_s);
}

struct WindFit {
    Circle circle;
    Eigen::Matrix2d covariance;  ///< of the wind
    std::string unknown;         ///< why the wind is not determined
    bool is_usable() const { return unknown.empty(); }
};

/// The covariance of the wind from the residuals, whose correlation fades over correlated_s (Newey and West 1987), and
/// from airspeeds that differ with the heading.
Eigen::Matrix2d wind_covariance(const Velocities& velocities, const Circle& circle, double scale, double intervals) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    std::vector<Eigen::Vector3d> scores;
    for (const auto& velocity : velocities) {
        const double off = residual(circle, velocity);
        Eigen::Vector3d slope;
        slope << -through_air(circle, velocity).normalized(), -1.0;
        const double weight = 1.0 / (1.0 + off * off / (scale * scale));
        information += weight * slope * slope.transpose();
        scores.emplace_back(weight * off * slope);
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < scores.size(); ++i) {
        spread += scores[i] * scores[i].transpose();
        for (std::size_t j = i + 1; j < scores.size(); ++j) {
            const double lag = (velocities[j].time_s - velocities[i].time_s) / correlated_s;
            if (lag >= 1.0) break;
            const Eigen::Matrix3d product = scores[i] * scores[j].transpose();
            spread += (1.0 - lag) * (product + product.transpose());
        }
    }
    const double by_heading = std::pow(heading_sd_part * circle[2], 2);
    spread += by_heading * independent_s / step_s * information;  // where residuals are too few to show it
    const Eigen::Matrix3d inverse = information.ldlt().solve(Eigen::Matrix3d::Identity());
    const Eigen::Matrix3d covariance = intervals / (intervals - 3.0) * inverse * spread * inverse;
    return covariance.topLeftCorner<2, 2>() + by_heading * Eigen::Matrix2d::Identity();
}

/// The widest run of sectors without headings.
std::size_t empty_sectors(const Velocities& velocities, const Circle& circle) {
    std::array<double, sectors> counts{};
    for (const auto& velocity : velocities) {
        const auto air = through_air(circle, velocity);
        const double turns = std::atan2(air[0], air[1]) / (360.0 / units::degree_per_rad) + 1.0;
        ++counts[static_cast<std::size_t>(std::lround(turns * sectors)) % sectors];
    }
    std::size_t widest = 0;
    std::size_t empty = 0;
    for (std::size_t i = 0; i < 2 * sectors; ++i) {
        const bool is_empty = counts[i % sectors] <= min_sector_part * static_cast<double>(velocities.size());
        empty = is_empty ? empty + 1 : 0;
        widest = std::max(widest, empty);
    }
    return widest;
}

WindFit fit_wind(std::span<const GroundVelocity> all) {
    const auto velocities = thinned(all);
    const double intervals = static_cast<double>(velocities.size()) * step_s / independent_s;
    WindFit fit;
    if (intervals < min_intervals) {
        fit.unknown = fmt::format("it moves for {:.0f} s with a course over ground: {:.0f} s are needed",
                                  intervals * independent_s, min_intervals * independent_s);
        return fit;
    }
    fit.circle = algebraic_circle(velocities);
    const double scale = loss_scale(velocities, fit.circle);
    ceres::Problem problem;
    for (const auto& velocity : velocities)
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<CircleResidual, 1, 3>(new CircleResidual{velocity.m_per_s}),
            new ceres::CauchyLoss(scale), fit.circle.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable() || !fit.circle.allFinite()) {
        fit.unknown = "its velocities over ground are on no circle";
        return fit;
    }
    if (const auto empty = empty_sectors(velocities, fit.circle); empty > max_empty_sectors) {
        fit.unknown = fmt::format("no heading within {:.0f} degrees: circles or legs in three directions show the wind",
                                  360.0 * static_cast<double>(empty) / sectors);
        return fit;
    }
    fit.covariance = wind_covariance(velocities, fit.circle, scale, intervals);
    const double difference = fit.covariance(0, 0) - fit.covariance(1, 1);
    const double sd = std::sqrt(0.5 * (fit.covariance.trace() + std::hypot(difference, 2.0 * fit.covariance(0, 1))));
    if (!(sd <= max_sd_part * fit.circle[2]))
        fit.unknown = fmt::format("the wind is only known within {:.1f} m/s (1 sd) by its headings", sd);
    return fit;
}

/// Consecutive velocities with one wind.
struct WindWindow {
    std::span<const GroundVelocity> velocities;
    WindFit fit;
};

/// The most windows of equal duration, each of window_s or more, of which each shows its wind; else all in one.
std::vector<WindWindow> fit_windows(const Velocities& velocities) {
    const double start_s = velocities.empty() ? 0.0 : velocities.front().time_s;
    const double duration_s = velocities.empty() ? 0.0 : velocities.back().time_s - start_s;
    for (auto count = std::max<std::size_t>(1, static_cast<std::size_t>(duration_s / window_s));; --count) {
        std::vector<WindWindow> windows;
        auto first = velocities.begin();
        for (std::size_t i = 1; i <= count; ++i) {
            const double end_s = start_s + duration_s * static_cast<double>(i) / static_cast<double>(count);
            const auto last =
                i == count ? velocities.end()
                           : std::ranges::upper_bound(first, velocities.end(), end_s, {}, &GroundVelocity::time_s);
            windows.push_back({{first, last}, fit_wind({first, last})});
            if (count > 1 && !windows.back().fit.is_usable()) break;
            first = last;
        }
        if (count == 1 || windows.back().fit.is_usable()) return windows;
    }
}

/// The estimate with the error of means over 30 s, and of the mean of all: that of the wind along the mean heading, and
/// gusts.
AirspeedEstimate estimate_of(const std::vector<WindWindow>& windows) {
    AirspeedEstimate estimate;
    double bins = 0.0;
    double bins_variance = 0.0;
    double mean_variance = 0.0;
    for (const auto& [velocities, fit] : windows) {
        const double gusts =
            fit.circle.head<2>().squaredNorm() * gust_sd_part * gust_sd_part + calm_gust_sd * calm_gust_sd;
        Eigen::Vector2d along = Eigen::Vector2d::Zero();
        Eigen::Vector2d along_all = Eigen::Vector2d::Zero();
        double count = 0.0;
        for (std::size_t i = 0; i < velocities.size(); ++i) {
            const Eigen::Vector2d heading = through_air(fit.circle, velocities[i]).normalized();
            along += heading;
            along_all += heading;
            ++count;
            const bool is_last = i + 1 == velocities.size() || std::floor(velocities[i + 1].time_s / independent_s) !=
                                                                   std::floor(velocities[i].time_s / independent_s);
            if (!is_last) continue;
            along /= count;
            bins_variance += along.dot(fit.covariance * along) + gusts;
            mean_variance += gusts;
            ++bins;
            along.setZero();
            count = 0.0;
        }
        const double part_of_bins = bins;
        along_all /= static_cast<double>(velocities.size());
        mean_variance += part_of_bins * part_of_bins * along_all.dot(fit.covariance * along_all);
    }
    estimate.sd_m_per_s = std::sqrt(bins_variance / bins);
    estimate.mean_sd_m_per_s = std::sqrt(mean_variance) / bins;
    return estimate;
}

std::string describe(const EstimatedWind& wind) {
    const double from_deg = std::atan2(-wind.east_m_per_s, -wind.north_m_per_s) * units::degree_per_rad;
    return fmt::format("{:.1f} m/s from {:.0f} degrees (within {:.1f} m/s)",
                       std::hypot(wind.east_m_per_s, wind.north_m_per_s), from_deg < 0.0 ? from_deg + 360.0 : from_deg,
                       std::sqrt(0.5 * (wind.east_variance + wind.north_variance)));
}

void add_point(ChosenTrack& track, double time_s, double value) {
    track.time_s.push_back(time_s);
    track.value.push_back(value);
}

/// The finding against a sensor whose mean is far from that of the estimate; empty if they agree or share no time.
std::string disproof(const Track& sensor, const std::vector<WindWindow>& windows, const AirspeedEstimate& estimate) {
    double sensor_sum = 0.0;
    double estimate_sum = 0.0;
    double count = 0.0;
    for (const auto& [velocities, fit] : windows) {
        for (const auto& velocity : velocities) {
            if (velocity.time_s < sensor.time_s.front() || velocity.time_s > sensor.time_s.back()) continue;
            sensor_sum += value_at(sensor, velocity.time_s);
            estimate_sum += through_air(fit.circle, velocity).norm();
            ++count;
        }
    }
    const double error = std::abs(sensor_sum - estimate_sum);
    const double explained =
        std::max(max_sensor_error_part * estimate_sum, max_sensor_error_sd * estimate.mean_sd_m_per_s * count);
    if (!(error > explained)) return "";
    return fmt::format(
        "airspeed: the sensor ({}) reads {:.1f} m/s on average where the velocity over ground on all headings shows {:.1f} m/s: "
        "the latter is used",
        sensor.source, sensor_sum / count, estimate_sum / count);
}

/// Sets airspeed and wind.
void set_estimate(const std::vector<WindWindow>& windows, AirspeedEstimate estimate, FlightData& data) {
    const auto source = fmt::format("{} less the wind of its headings", data.ground_speed_m_per_s.source);
    ChosenTrack east{{"wind_east_m_per_s", source}};
    ChosenTrack north{{"wind_north_m_per_s", source}};
    auto& airspeed = data.airspeed_m_per_s;
    airspeed.name = "airspeed_m_per_s";
    airspeed.source = source;
    std::vector<std::string> winds;
    for (const auto& [velocities, fit] : windows) {
        const double start_s = velocities.front().time_s;
        const double end_s = velocities.back().time_s;
        const auto& of = fit.covariance;
        estimate.winds.push_back({start_s, end_s, fit.circle[0], fit.circle[1], of(0, 0), of(0, 1), of(1, 1)});
        winds.push_back(describe(estimate.winds.back()));
        for (const double time_s : {start_s, end_s}) {
            add_point(east, time_s, fit.circle[0]);
            add_point(north, time_s, fit.circle[1]);
        }
        for (const auto& velocity : velocities)
            add_point(airspeed, velocity.time_s, through_air(fit.circle, velocity).norm());
    }
    airspeed.notes.push_back(fmt::format(
        "the airspeed is estimated within {:.1f} m/s (1 sd, means over 30 s) from {} and course: wind {}; an "
        "airspeed that differs with the heading would be wind",
        estimate.sd_m_per_s, data.ground_speed_m_per_s.source, fmt::join(winds, ", then ")));
    if (data.wind_east_m_per_s.empty() && data.wind_north_m_per_s.empty()) {
        data.wind_east_m_per_s = std::move(east);
        data.wind_north_m_per_s = std::move(north);
    }
    data.airspeed_estimate = std::move(estimate);
}

}  // namespace

void estimate_airspeed(FlightData& data) {
    if (data.firmware != "fixedwing") return;
    const auto velocities = ground_velocities(data);
    const auto windows = fit_windows(velocities);
    auto& airspeed = data.airspeed_m_per_s;
    if (const auto& fit = windows.back().fit; !fit.is_usable()) {
        if (airspeed.empty()) airspeed.not_chosen.push_back(fit.unknown);
        return;
    }
    auto estimate = estimate_of(windows);
    if (!airspeed.empty()) {
        auto reason = disproof(airspeed, windows, estimate);
        if (reason.empty()) return;
        airspeed = {{}, {}, {std::move(reason)}};
        data.wind_east_m_per_s = data.wind_north_m_per_s = {};  // autopilots derive theirs from the sensor
    }
    set_estimate(windows, std::move(estimate), data);
}

}  // namespace flightwatt::flight
