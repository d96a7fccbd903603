#include "path/path_tracker.h"

#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <variant>
#include <vector>

#include <Eigen/LU>

namespace flightwatt::path {
namespace {

// Chosen by their meaning; none was fitted to flights.
constexpr double min_on_path_s = 20.0;
constexpr double min_on_path_fraction = 0.5;
constexpr double finest_s = 1.0;       // between grid points
constexpr double max_points = 1200.0;  // of a path
constexpr double oldest_position_s = 5.0;
constexpr double off_path_m = 25.0;        // one deviation: satellite navigation, and turns that cut corners
constexpr double origin_sd_m = 60.0;       // of the path's offset beforehand (some seconds of the climb), and of a
                                           // cross-track error as its measurement
constexpr double likelihood_weight = 0.5;  // of a position: its error is correlated with the one before

struct PathPoint {
    LocalPosition at;
    LocalPosition course;  ///< of length 1, or 0 where it is not known
    bool is_unconstrained = false;
};

/// Points of a path, equidistant in its planned time.
struct PathGrid {
    std::vector<PathPoint> points;
    double step_s = 0.0;
};

/// A position of a flight, relative to the one at the start of its cruise.
struct Observation {
    LocalPosition at;
    LocalPosition course;  ///< of length 1, or 0 where it is not known
    bool is_known = false;
};

LocalPosition unit(const LocalPosition& of, double min_m) {
    const double length_m = std::hypot(of.east_m, of.north_m);
    return length_m < min_m ? LocalPosition{} : LocalPosition{of.east_m / length_m, of.north_m / length_m};
}

/// Positions of a log, in degrees or on a plane, as metres.
class Positions {
  public:
    explicit Positions(const flight::FlightData& data) {
        const bool is_plane = !data.east_m.empty() && !data.north_m.empty();
        east_ = is_plane ? &data.east_m : &data.longitude_deg;
        north_ = is_plane ? &data.north_m : &data.latitude_deg;
        if (is_plane || empty()) return;
        metre_per_north_ = units::metre_per_degree;
        metre_per_east_ = units::metre_per_degree * std::cos(north_->value.front() / units::degree_per_rad);
    }

    bool empty() const { return east_->empty() || north_->empty(); }
    /// Times must rise from call to call.
    Observation at(double time_s) {
        const auto& times_s = east_->time_s;
        while (sample_ < times_s.size() && times_s[sample_] < time_s) ++sample_;
        const bool is_between = sample_ > 0 && sample_ < times_s.size() &&
                                times_s[sample_] - times_s[sample_ - 1] <= 2.0 * oldest_position_s;
        const bool is_at = sample_ < times_s.size() && times_s[sample_] == time_s;
        if (!is_between && !is_at) return {};
        const LocalPosition at{value_at(*east_, time_s) * metre_per_east_,
                               value_at(*north_, time_s) * metre_per_north_};
        if (!std::isfinite(at.east_m) || !std::isfinite(at.north_m)) return {};
        return {at, {}, true};
    }

  private:
    const flight::Track* east_ = nullptr;
    const flight::Track* north_ = nullptr;
    double metre_per_east_ = 1.0;
    double metre_per_north_ = 1.0;
    std::size_t sample_ = 0;
};

constexpr double course_weight = 2.0;
constexpr double off_sds = 3.5;  // beyond, it is more likely that the path was left
constexpr double negligible = 1e-15;

struct Advance {
    std::ptrdiff_t points = 0;
    double probability = 0.0;
};
// Grid points advanced in one step; off the path a flight resumes where it left it, or elsewhere.
constexpr std::array advances_on_path{Advance{0, 0.25}, Advance{1, 0.45}, Advance{2, 0.22}, Advance{3, 0.08}};
constexpr std::array advances_off_path{Advance{0, 0.7},     Advance{1, 0.2},      Advance{2, 0.07},
                                       Advance{3, 0.029},   Advance{-30, 0.0002}, Advance{30, 0.0005},
                                       Advance{100, 0.0003}};
constexpr std::size_t max_back = 30;
constexpr std::size_t max_ahead = 100;
constexpr double leaves = 0.02;
constexpr double comes_back = 0.05;

Eigen::Vector2d vector_of(const LocalPosition& of) { return {of.east_m, of.north_m}; }

PathGrid make_path_grid(const PathForecast& path) {
    const auto& flown = path.flown();
    const auto& elements = path.plan().path.elements;
    PathGrid grid;
    const double steps = std::clamp(std::ceil(flown.duration_s / finest_s), 1.0, max_points);
    grid.step_s = flown.duration_s / steps;
    const auto count = static_cast<std::size_t>(steps) + 1;
    grid.points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double time_s = static_cast<double>(i) * grid.step_s;
        const auto here = position_at(flown, std::min(time_s, flown.duration_s));
        const auto before = position_at(flown, std::max(0.0, time_s - 0.1 * grid.step_s));
        const auto after = position_at(flown, std::min(flown.duration_s, time_s + 0.1 * grid.step_s));
        PathPoint point;
        point.at = local_position_at(path.plan().path, here);
        point.course =
            unit(local_position_at(path.plan().path, after) - local_position_at(path.plan().path, before), 1e-6);
        if (here.element < elements.size()) {
            const auto* hold = std::get_if<Hold>(&elements[here.element].shape);
            point.is_unconstrained = hold != nullptr && !hold->over_ground;
        }
        grid.points.push_back(point);
    }
    return grid;
}

/// Positions of the cruise at times `step_s` apart, from its start until a given time. Empty if the log has no positions,
/// or none at the start of the cruise.
std::vector<Observation> observations_of(const flight::FlightData& data, double start_s, double until_s,
                                         double step_s) {
    constexpr double min_m = 3.0;
    std::vector<Observation> all;
    Positions positions(data);
    if (positions.empty()) return all;
    std::optional<LocalPosition> origin;
    for (std::size_t k = 0; start_s + static_cast<double>(k) * step_s <= until_s; ++k) {
        const double time_s = start_s + static_cast<double>(k) * step_s;
        auto now = positions.at(time_s);
        if (now.is_known && !origin) {
            // Without a position at the start of the cruise the location of the path is unknown.
            if (time_s > start_s + oldest_position_s) return {};
            origin = now.at;
        }
        if (now.is_known) now.at = now.at - *origin;
        if (now.is_known && !all.empty() && all.back().is_known) now.course = unit(now.at - all.back().at, min_m);
        all.push_back(now);
    }
    return origin ? all : std::vector<Observation>();
}

/// Forward filter (docs/methods.md, Flight along a path): probability of each grid point, on the path and off it, and
/// the offset of the path from the first position, a least-squares estimate from cross-track errors.
class PathFilter {
  public:
    explicit PathFilter(const PathGrid& grid)
        : grid_(grid), on_(grid.points.size()), off_(on_), next_on_(on_), next_off_(max_back + on_.size() + max_ahead) {
        on_[0] = on_path_ = 1.0 - leaves;
        off_[0] = leaves;
        update_origin();
    }

    void add_observation(const Observation& observation);

    /// Planned time [s] with a known position, and the part of it on the path.
    double known_s() const { return known_s_; }
    double on_path_s() const { return on_path_s_; }

    bool is_on_path() const { return on_path_ >= 0.5; }
    /// Median of the probability over grid points.
    double median_position() const;
    /// The grid point nearest to the last position, of those around the median: corrects the lag of the filter behind
    /// flights that are faster or slower than planned.
    double nearest_position() const;
    /// The last position, from the start of the path.
    LocalPosition last_position() const { return last_.at - origin_; }

  private:
    void predict_step();
    void update_step();
    void update_origin();
    double log_likelihood(std::size_t i) const;
    std::size_t index_of(double position) const {
        return static_cast<std::size_t>(std::clamp(std::round(position), 0.0, static_cast<double>(on_.size()) - 1.0));
    }
    const PathPoint& point_at(double position) const { return grid_.points[index_of(position)]; }

    const PathGrid& grid_;
    Eigen::Matrix2d origin_information_ = Eigen::Matrix2d::Identity() / (origin_sd_m * origin_sd_m);
    Eigen::Vector2d origin_sum_ = Eigen::Vector2d::Zero();
    LocalPosition origin_;
    Eigen::Matrix2d offset_information_;  ///< inverse covariance of a position's offset from its grid point
    Observation last_;
    bool has_begun_ = false;
    double known_s_ = 0.0;
    double on_path_s_ = 0.0;
    std::vector<double> on_;
    std::vector<double> off_;
    double on_path_ = 0.0;          ///< sum of `on_`
    std::vector<double> next_on_;   ///< of predict_step
    std::vector<double> next_off_;  ///< with the overflow at both ends of the path
};

void PathFilter::add_observation(const Observation& observation) {
    if (has_begun_) predict_step();
    has_begun_ = true;
    if (!observation.is_known) return;
    last_ = observation;
    update_step();
    known_s_ += grid_.step_s;
    if (!is_on_path()) return;
    on_path_s_ += grid_.step_s;
    const auto& point = point_at(median_position());
    if (point.is_unconstrained) return;
    const Eigen::Vector2d across(-point.course.north_m, point.course.east_m);
    constexpr double weight = likelihood_weight / (origin_sd_m * origin_sd_m);
    origin_information_ += weight * across * across.transpose();
    origin_sum_ += weight * across.dot(vector_of(last_.at - point.at)) * across;
    update_origin();
}

void PathFilter::update_origin() {
    const Eigen::Matrix2d covariance = origin_information_.inverse();
    const Eigen::Vector2d origin = covariance * origin_sum_;
    origin_ = {origin.x(), origin.y()};
    const Eigen::Matrix2d of_positions = off_path_m * off_path_m * Eigen::Matrix2d::Identity();
    offset_information_ = (of_positions + covariance).inverse();
}

void PathFilter::predict_step() {
    std::ranges::fill(next_on_, 0.0);
    std::ranges::fill(next_off_, 0.0);
    const auto count = on_.size();
    double* const next_off = next_off_.data() + max_back;
    for (std::size_t i = 0; i < count; ++i) {
        if (off_[i] <= negligible) off_[i] = 0.0;
        next_on_[i] += off_[i] * comes_back;
        if (!(on_[i] > negligible)) continue;
        for (const auto& [points, probability] : advances_on_path) {
            const auto to = i + static_cast<std::size_t>(grid_.points[i].is_unconstrained ? 1 : points);
            next_on_[std::min(to, count - 1)] += on_[i] * probability * (1.0 - leaves);
        }
        next_off[i] += on_[i] * leaves;
    }
    for (const auto& [points, probability] : advances_off_path) {
        const double weight = probability * (1.0 - comes_back);
        double* const to = next_off + points;
        for (std::size_t i = 0; i < count; ++i) to[i] += off_[i] * weight;
    }
    on_.swap(next_on_);
    std::copy_n(next_off, count, off_.begin());
    off_.front() += std::accumulate(next_off_.data(), next_off, 0.0);
    off_.back() += std::accumulate(next_off + count, next_off + count + max_ahead, 0.0);
    on_path_ = std::accumulate(on_.begin(), on_.end(), 0.0);
}

void PathFilter::update_step() {
    const double off_likelihood = std::exp(-likelihood_weight * 0.5 * off_sds * off_sds);
    double on_path = 0.0;
    double off_path = 0.0;
    for (std::size_t i = 0; i < on_.size(); ++i) {
        if (on_[i] > negligible) on_[i] *= std::exp(likelihood_weight * log_likelihood(i));
        off_[i] *= off_likelihood;
        on_path += on_[i];
        off_path += off_[i];
    }
    const double scale = 1.0 / (on_path + off_path);
    for (std::size_t i = 0; i < on_.size(); ++i) {
        on_[i] *= scale;
        off_[i] *= scale;
    }
    on_path_ = on_path * scale;
}

double PathFilter::log_likelihood(std::size_t i) const {
    constexpr double anywhere = -0.5;
    const auto& point = grid_.points[i];
    if (point.is_unconstrained) return anywhere;
    const Eigen::Vector2d offset = vector_of(last_.at - origin_ - point.at);
    const bool have_courses =
        scalar_product(point.course, point.course) > 0.0 && scalar_product(last_.course, last_.course) > 0.0;
    const double turned = have_courses ? 1.0 - scalar_product(point.course, last_.course) : 0.0;
    return -0.5 * offset.dot(offset_information_ * offset) - course_weight * turned;
}

double PathFilter::median_position() const {
    const auto& of = is_on_path() ? on_ : off_;
    const double half = 0.5 * std::accumulate(of.begin(), of.end(), 0.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < of.size(); ++i) {
        if (sum + of[i] >= half && of[i] > 0.0) return static_cast<double>(i) - 0.5 + (half - sum) / of[i];
        sum += of[i];
    }
    return static_cast<double>(of.size()) - 1.0;
}

double PathFilter::nearest_position() const {
    constexpr double about = 4.0;
    constexpr double prior_fraction = 0.1;
    const double middle = median_position();
    double best = -std::numeric_limits<double>::infinity();
    auto nearest = index_of(middle);
    for (std::size_t i = 0; i < on_.size(); ++i) {
        if (!(on_[i] > negligible) || std::abs(static_cast<double>(i) - middle) > about) continue;
        const double score = log_likelihood(i) + prior_fraction * std::log(on_[i]);
        if (score <= best) continue;
        best = score;
        nearest = i;
    }
    const auto& point = grid_.points[nearest];
    if (point.is_unconstrained) return middle;
    const double ahead_m = scalar_product(last_.at - origin_ - point.at, point.course);
    const auto& next = grid_.points[std::min(nearest + 1, on_.size() - 1)];
    const double step_m = std::max(1.0, distance_between_m(point.at, next.at));
    return static_cast<double>(nearest) + std::clamp(ahead_m / step_m, -0.5, 0.5);
}

}  // namespace

std::optional<PathFix> locate_on_path(const PathForecast& path, const flight::FlightData& data, double cruise_start_s,
                                      double until_s) {
    const double duration_s = path.flown().duration_s;
    if (!(duration_s > 0.0) || !(until_s > cruise_start_s)) return std::nullopt;
    const auto grid = make_path_grid(path);
    const auto observations = observations_of(data, cruise_start_s, until_s, grid.step_s);
    if (observations.empty()) return std::nullopt;
    PathFilter filter(grid);
    for (const auto& observation : observations) filter.add_observation(observation);
    const bool has_position = observations.back().is_known;
    PathFix fix;
    if (has_position) fix.at = filter.last_position();
    if (filter.on_path_s() < std::max(min_on_path_s, min_on_path_fraction * filter.known_s())) return fix;
    fix.is_on_path = filter.is_on_path();
    const double position = fix.is_on_path && has_position ? filter.nearest_position() : filter.median_position();
    const double last_s = cruise_start_s + static_cast<double>(observations.size() - 1) * grid.step_s;
    fix.path_time_s = std::clamp(position * grid.step_s + (fix.is_on_path ? until_s - last_s : 0.0), 0.0, duration_s);
    return fix;
}

}  // namespace flightwatt::path
