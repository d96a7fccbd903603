#pragma once

#include "flight/selected_track.h"
#include "path/remaining_path.h"

#include <cstddef>
#include <vector>

#include <Eigen/LU>

namespace flightwatt::path {

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

/// Of a path that takes some time.
PathGrid make_path_grid(const PathForecast& path);

/// A position of a flight, relative to the one at the start of its cruise.
struct Observation {
    LocalPosition at;
    LocalPosition course;  ///< of length 1, or 0 where it is not known
    bool is_known = false;

    friend bool operator==(const Observation&, const Observation&) = default;
};

/// Positions of the cruise at times `step_s` apart, from its start until a given time.
struct Observations {
    std::vector<Observation> samples;
    std::size_t settled = 0;  ///< number of leading samples that are too old for a late message to change
};

/// Replaces `observations`. Empty if the log has no positions, or none at the start of the cruise.
void collect_observations(const flight::SelectedTracks& tracks, double start_s, double until_s, double step_s,
                          Observations& observations);

/// Recursive estimate of the offset of the path from the first position, from cross-track errors.
class OriginEstimate {
  public:
    void add(const LocalPosition& offset, const LocalPosition& course);
    LocalPosition value() const;
    Eigen::Matrix2d covariance() const { return information_.inverse(); }

  private:
    static constexpr double sd_m = 60.0;  ///< prior: some seconds of the climb
    Eigen::Matrix2d information_ = Eigen::Matrix2d::Identity() / (sd_m * sd_m);
    Eigen::Vector2d weighted_sum_ = Eigen::Vector2d::Zero();
};

/// Forward filter (docs/methods.md, Flight along a path): probability of each grid point, on the path and off it, and
/// the offset of the path.
class PathFilter {
  public:
    explicit PathFilter(const PathGrid& grid);

    /// At the start of the path, without observations.
    void restart();
    void add_observation(const Observation& observation);

    std::size_t observation_count() const { return observation_count_; }
    /// Planned time [s] with a known position, and the part of it on the path.
    double known_s() const { return known_s_; }
    double on_path_s() const { return on_path_s_; }

    bool is_on_path() const { return on_path_ >= 0.5; }
    /// Median of the probability over grid points.
    double median_position() const;
    /// The grid point nearest to the last position, of those around the median: corrects the lag of the filter behind
    /// flights that are faster or slower than planned.
    double nearest_position() const;
    /// The last position relative to a grid point.
    LocalPosition offset_from(double position) const;

  private:
    void predict_step();
    void update_step();
    void update_origin();
    double log_likelihood(std::size_t i) const;
    const PathPoint& point_at(double position) const { return grid_->points[index_of(position)]; }
    std::size_t index_of(double position) const;

    const PathGrid* grid_;
    OriginEstimate origin_estimate_;
    LocalPosition origin_;
    Eigen::Matrix2d offset_information_;  ///< inverse covariance of a position's offset from its grid point
    Observation last_;
    std::size_t observation_count_ = 0;
    double known_s_ = 0.0;
    double on_path_s_ = 0.0;
    std::vector<double> on_;
    std::vector<double> off_;
    double on_path_ = 0.0;          ///< sum of `on_`
    std::vector<double> next_on_;   ///< of predict_step
    std::vector<double> next_off_;  ///< with the overflow at both ends of the path
};

}  // namespace flightwatt::path
