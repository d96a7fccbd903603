#include "path/path_tracker.h"

#include "path/tracking/path_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace flightwatt::path {
namespace {

// Chosen by their meaning; none was fitted to flights.
constexpr double min_on_path_s = 20.0;
constexpr double min_on_path_fraction = 0.5;

}  // namespace

class PathTracker::State {
  public:
    explicit State(const PathForecast& path)
        : grid_(make_path_grid(path)), duration_s_(path.flown().duration_s), settled_(grid_), now_(grid_) {}

    std::optional<PathFix> find(const flight::SelectedTracks& tracks, double cruise_start_s, double until_s) {
        if (!(until_s > cruise_start_s)) return std::nullopt;
        std::swap(observations_, previous_);
        collect_observations(tracks, cruise_start_s, until_s, grid_.step_s, observations_);
        if (settled_part_changed()) settled_.restart();
        if (observations_.samples.empty()) return std::nullopt;
        run(settled_, observations_.settled);
        now_ = settled_;
        run(now_, observations_.samples.size());
        return make_fix(cruise_start_s, until_s);
    }

  private:
    /// Rows were thinned, the log restarted, or it is another cruise.
    bool settled_part_changed() const {
        const auto count = settled_.observation_count();
        return count > observations_.settled ||
               !std::equal(previous_.samples.begin(), previous_.samples.begin() + static_cast<std::ptrdiff_t>(count),
                           observations_.samples.begin());
    }

    void run(PathFilter& filter, std::size_t until) const {
        while (filter.observation_count() < until)
            filter.add_observation(observations_.samples[filter.observation_count()]);
    }

    PathFix make_fix(double cruise_start_s, double until_s) const {
        PathFix fix;
        if (now_.on_path_s() < std::max(min_on_path_s, min_on_path_fraction * now_.known_s())) return fix;
        fix.is_on_path = now_.is_on_path();
        const bool has_position = observations_.samples.back().is_known;
        const double position = fix.is_on_path && has_position ? now_.nearest_position() : now_.median_position();
        const double last_s = cruise_start_s + static_cast<double>(observations_.samples.size() - 1) * grid_.step_s;
        fix.path_time_s =
            std::clamp(position * grid_.step_s + (fix.is_on_path ? until_s - last_s : 0.0), 0.0, duration_s_);
        if (has_position) {
            const auto offset = now_.offset_from(position);
            fix.distance_m = std::hypot(offset.east_m, offset.north_m);
        }
        return fix;
    }

    PathGrid grid_;
    double duration_s_ = 0.0;
    Observations observations_;
    Observations previous_;
    PathFilter settled_;  ///< after the settled observations
    PathFilter now_;      ///< after all
};

PathTracker::PathTracker(const PathForecast& path) : state_(std::make_unique<State>(path)) {}

PathTracker::~PathTracker() = default;

std::optional<PathFix> PathTracker::find(const flight::SelectedTracks& tracks, double cruise_start_s, double until_s) {
    return state_->find(tracks, cruise_start_s, until_s);
}

std::optional<PathFix> locate_on_path(const PathForecast& path, const flight::FlightSeries& series,
                                      double cruise_start_s, double until_s) {
    if (!(path.flown().duration_s > 0.0)) return std::nullopt;
    return PathTracker(path).find(flight::SelectedTracks(series), cruise_start_s, until_s);
}

}  // namespace flightwatt::path
