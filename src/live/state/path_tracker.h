#pragma once

#include "flight/flight_series.h"
#include "flight/selected_track.h"
#include "live/state/path_filter.h"
#include "live/turn_home.h"
#include "mission/remaining_path.h"

#include <cstddef>
#include <optional>

namespace flightwatt::live {

/// From where a path begins: what positions are off it, across it, as far as that is known better than beforehand.
class OriginEstimate {
  public:
    void add(const Displacement& off, const Displacement& course);
    Displacement value() const;

  private:
    static constexpr double sd_m = 60.0;  ///< beforehand: some seconds of the climb
    double ee_ = 1.0 / (sd_m * sd_m);
    double en_ = 0.0;
    double nn_ = 1.0 / (sd_m * sd_m);
    double e_ = 0.0;
    double n_ = 0.0;
};

/// Where a flight is on its path, by the positions of its cruise from its start until a moment: two forward filters
/// over places on the path (docs/methods.md, Flight along a path), the first for where the path begins. Nothing later
/// is taken into account. Both go on from moment to moment; where positions changed since, they begin anew, so that the
/// answers depend on the series alone.
class PathTracker {
  public:
    /// `path` takes some time.
    explicit PathTracker(const mission::PathForecast& path);
    PathTracker(const PathTracker&) = delete;
    PathTracker& operator=(const PathTracker&) = delete;

    /// The path begins where the cruise does. std::nullopt where no positions tell.
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

/// The same of one moment; std::nullopt of a path that takes no time, too.
std::optional<PathFix> locate_on_path(const mission::PathForecast& path, const flight::FlightSeries& series,
                                      double cruise_start_s, double until_s);

}  // namespace flightwatt::live
