#include "path/path_tracker.h"

#include "path/tracking/path_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace flightwatt::path {
namespace {

// Chosen by what they mean; none was fitted to flights.
constexpr double off_path_m = 25.0;  // one deviation: satellite navigation, and a turn that cuts its corner
constexpr double min_on_path_s = 20.0;
constexpr double min_on_path_part = 0.5;
constexpr double moved_origin_m = 2.0;         // little beside `off_path_m`
constexpr std::size_t caught_up_at_once = 32;  // observations, with each that is new: a look is to take 5 ms at most

}  // namespace

class PathTracker::Filters {
  public:
    explicit Filters(const PathForecast& path);
    std::optional<PathFix> find(const flight::SelectedTracks& tracks, double cruise_start_s, double until_s);

  private:
    /// By the observations until one of them.
    struct FilterPasses {
        explicit FilterPasses(const PathGrid& places) : first(places), second(places), coming(places) {}

        PathFilter first;
        OriginEstimate origin = {};  ///< of the path, by the first
        PathFilter second;           ///< from the origin as it was known when it began
        PathFilter coming;           ///< takes the place of the second when it has caught up: from a newer origin
        bool has_coming = false;
    };

    static void begin(FilterPasses& passes);
    void forget_changed();
    void run_filters(std::size_t until, FilterPasses& passes) const;
    void renew_second(FilterPasses& passes) const;
    PathFix sighting(double cruise_start_s, double until_s) const;

    PathGrid places_;
    double duration_s_ = 0.0;
    Observations seen_;
    Observations seen_before_;
    FilterPasses settled_;  ///< by observations that are settled
    FilterPasses now_;      ///< by all
};

PathTracker::Filters::Filters(const PathForecast& path)
    : places_(make_path_grid(path)), duration_s_(path.flown().duration_s), settled_(places_), now_(places_) {
    begin(settled_);
}

void PathTracker::Filters::begin(FilterPasses& passes) {
    passes.first.begin(OriginEstimate::off_path_m, {});
    passes.origin = {};
    passes.second.begin(off_path_m, {});
    passes.has_coming = false;
}

std::optional<PathFix> PathTracker::Filters::find(const flight::SelectedTracks& tracks, double cruise_start_s,
                                                  double until_s) {
    if (!(until_s > cruise_start_s)) return std::nullopt;
    std::swap(seen_, seen_before_);
    collect_observations(tracks, cruise_start_s, until_s, places_.step_s, seen_);
    forget_changed();
    if (seen_.of.empty()) return std::nullopt;
    run_filters(seen_.settled, settled_);
    now_ = settled_;
    run_filters(seen_.of.size(), now_);
    return sighting(cruise_start_s, until_s);
}

/// What the filters took may have been changed since: rows were thinned, the log began anew, or it is another cruise.
void PathTracker::Filters::forget_changed() {
    const auto taken = settled_.first.taken();
    const bool is_as_before =
        taken <= seen_.settled &&
        std::equal(seen_.of.begin(), seen_.of.begin() + static_cast<std::ptrdiff_t>(taken), seen_before_.of.begin());
    if (!is_as_before) begin(settled_);
}

void PathTracker::Filters::run_filters(std::size_t until, FilterPasses& passes) const {
    auto& first = passes.first;
    while (first.taken() < until) {
        const auto& seen = seen_.of[first.taken()];
        first.add_observation(seen);
        passes.second.add_observation(seen);
        if (seen.is_known && first.is_on_path()) {
            const double place = first.median_position();
            const auto& point = first.point_of(place);
            if (!point.is_unconstrained) passes.origin.add(first.off(place), point.course);
        }
        renew_second(passes);
    }
}

/// With another origin all of it is likely elsewhere: the second filter begins anew, and goes through what was seen a
/// part at a time.
void PathTracker::Filters::renew_second(FilterPasses& passes) const {
    if (!passes.has_coming) {
        const auto moved = passes.origin.value() - passes.second.origin();
        if (std::hypot(moved.east_m, moved.north_m) <= moved_origin_m) return;
        passes.coming.begin(off_path_m, passes.origin.value());
        passes.has_coming = true;
    }
    auto& coming = passes.coming;
    const auto taken = passes.first.taken();
    for (const auto until = std::min(taken, coming.taken() + caught_up_at_once); coming.taken() < until;)
        coming.add_observation(seen_.of[coming.taken()]);
    if (coming.taken() < taken) return;
    std::swap(passes.second, passes.coming);
    passes.has_coming = false;
}

PathFix PathTracker::Filters::sighting(double cruise_start_s, double until_s) const {
    PathFix sighting;
    const auto& second = now_.second;
    if (second.seen_on_path_s() < std::max(min_on_path_s, min_on_path_part * second.known_s())) return sighting;
    sighting.is_on_path = second.is_on_path();
    const bool is_seen = seen_.of.back().is_known;
    const double place = sighting.is_on_path && is_seen ? second.nearest_position() : second.median_position();
    const double seen_s = cruise_start_s + static_cast<double>(seen_.of.size() - 1) * places_.step_s;
    sighting.path_time_s =
        std::clamp(place * places_.step_s + (sighting.is_on_path ? until_s - seen_s : 0.0), 0.0, duration_s_);
    if (is_seen) {
        const auto off = second.off(place);
        sighting.distance_m = std::hypot(off.east_m, off.north_m);
    }
    return sighting;
}

PathTracker::PathTracker(const PathForecast& path) : filters_(std::make_unique<Filters>(path)) {}

PathTracker::~PathTracker() = default;

std::optional<PathFix> PathTracker::find(const flight::SelectedTracks& tracks, double cruise_start_s, double until_s) {
    return filters_->find(tracks, cruise_start_s, until_s);
}

std::optional<PathFix> locate_on_path(const PathForecast& path, const flight::FlightSeries& series,
                                      double cruise_start_s, double until_s) {
    if (!(path.flown().duration_s > 0.0)) return std::nullopt;
    return PathTracker(path).find(flight::SelectedTracks(series), cruise_start_s, until_s);
}

}  // namespace flightwatt::path
