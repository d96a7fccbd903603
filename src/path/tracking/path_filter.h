#pragma once

#include "flight/selected_track.h"
#include "path/remaining_path.h"

#include <cstddef>
#include <vector>

namespace flightwatt::path {

struct PathPoint {
    LocalPosition at;
    LocalPosition course;  ///< of length 1, or 0 where it is not known
    bool is_unconstrained = false;
};

/// Places along a path, evenly in its planned time.
struct PathGrid {
    std::vector<PathPoint> of;
    double step_s = 0.0;
};

/// Of a path that takes some time.
PathGrid make_path_grid(const PathForecast& path);

/// Where a flight was seen, from where its cruise began.
struct Observation {
    LocalPosition at;
    LocalPosition course;  ///< of length 1, or 0 where it is not known
    bool is_known = false;

    friend bool operator==(const Observation&, const Observation&) = default;
};

/// Positions of the cruise at times `step_s` apart, from its start until a moment.
struct Observations {
    std::vector<Observation> of;
    std::size_t settled = 0;  ///< the first of them: positions lie so far behind them that late ones change none
};

/// `observations` is filled anew. None where the log has no positions, or none where the cruise began.
void collect_observations(const flight::SelectedTracks& tracks, double start_s, double until_s, double step_s,
                          Observations& observations);

double dot(const LocalPosition& a, const LocalPosition& b);

/// How likely a flight at each place of a path is, on the path and off it, by its observations one after the other.
class PathFilter {
  public:
    static constexpr double likelihood_weight = 0.5;  ///< of a position: it is off as the one before was

    /// The path lasts as long as the filter.
    explicit PathFilter(const PathGrid& places);

    /// From the beginning of the path, which lies `origin` off the first observation. `off_path_m`: one deviation of
    /// positions from the path.
    void begin(double off_path_m, const LocalPosition& origin);
    void add_observation(const Observation& seen);

    const LocalPosition& origin() const { return origin_; }
    /// Observations since the beginning.
    std::size_t taken() const { return taken_; }
    /// Seconds of planned time that were seen, and those of them on the path.
    double known_s() const { return known_s_; }
    double seen_on_path_s() const { return seen_on_path_s_; }

    bool is_on_path() const { return on_path_ >= 0.5; }
    /// The middle of what is likely, in places.
    double median_position() const;
    /// The place nearest to the last position that was seen, of those about the middle: the filter lags behind a flight
    /// that is faster or slower than planned.
    double nearest_position() const;
    /// What the last position that was seen is off a place.
    LocalPosition off(double place) const;
    const PathPoint& point_of(double place) const;

  private:
    void predict_step();
    void update_step(const Observation& seen);
    double log_likelihood(std::size_t i) const;
    std::size_t index_of(double place) const;

    const PathGrid* places_;
    double off_path_m_ = 0.0;
    LocalPosition origin_;
    Observation last_seen_;
    std::size_t taken_ = 0;
    double known_s_ = 0.0;
    double seen_on_path_s_ = 0.0;
    std::vector<double> on_;
    std::vector<double> off_;
    double on_path_ = 0.0;          ///< sum of `on_`
    std::vector<double> next_on_;   ///< of go_on
    std::vector<double> next_off_;  ///< and what goes over an end of the path
};

/// From where a path begins: what positions are off it, across it, as far as that is known better than beforehand.
class OriginEstimate {
  public:
    static constexpr double off_path_m = 60.0;  ///< one deviation of positions while the origin is not known

    void add(const LocalPosition& off, const LocalPosition& course);
    LocalPosition value() const;

  private:
    static constexpr double sd_m = 60.0;  ///< beforehand: some seconds of the climb
    double ee_ = 1.0 / (sd_m * sd_m);
    double en_ = 0.0;
    double nn_ = 1.0 / (sd_m * sd_m);
    double e_ = 0.0;
    double n_ = 0.0;
};

}  // namespace flightwatt::path
