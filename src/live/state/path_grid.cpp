#include "live/state/path_grid.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace flightwatt::live {
namespace {

// Chosen by what they mean; none was fitted to flights.
constexpr double finest_s = 1.0;       // between places
constexpr double max_places = 1200.0;  // on a path
constexpr double oldest_position_s = 5.0;
constexpr double settled_after_s = 10.0;  // a link hands on late messages within seconds

Displacement unit(const Displacement& of, double min_m) {
    const double length_m = std::hypot(of.east_m, of.north_m);
    return length_m < min_m ? Displacement{} : Displacement{of.east_m / length_m, of.north_m / length_m};
}

/// Positions of a log, in degrees or on a plane, as metres.
class Positions {
  public:
    explicit Positions(const flight::SelectedTracks& tracks) {
        const bool is_plane = !tracks["east_m"].empty() && !tracks["north_m"].empty();
        east_ = &tracks[is_plane ? "east_m" : "longitude_deg"];
        north_ = &tracks[is_plane ? "north_m" : "latitude_deg"];
        if (is_plane || empty()) return;
        metre_per_north_ = units::metre_per_degree;
        metre_per_east_ = units::metre_per_degree * std::cos(north_->value.front() / units::degree_per_rad);
    }

    bool empty() const { return east_->empty() || north_->empty(); }
    double last_s() const { return std::min(east_->time_s.back(), north_->time_s.back()); }
    /// Times must rise from call to call.
    Observation at(double time_s) {
        const auto& times_s = east_->time_s;
        while (sample_ < times_s.size() && times_s[sample_] < time_s) ++sample_;
        const bool is_between = sample_ > 0 && sample_ < times_s.size() &&
                                times_s[sample_] - times_s[sample_ - 1] <= 2.0 * oldest_position_s;
        const bool is_at = sample_ < times_s.size() && times_s[sample_] == time_s;
        if (!is_between && !is_at) return {};
        const Displacement at{value_at(*east_, time_s) * metre_per_east_, value_at(*north_, time_s) * metre_per_north_};
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

}  // namespace

Displacement minus(const Displacement& a, const Displacement& b) {
    return {a.east_m - b.east_m, a.north_m - b.north_m};
}

double dot(const Displacement& a, const Displacement& b) { return a.east_m * b.east_m + a.north_m * b.north_m; }

PathGrid make_path_grid(const mission::PathForecast& path) {
    const auto& flown = path.flown();
    const auto& elements = path.plan().path.elements;
    PathGrid places;
    const double steps = std::clamp(std::ceil(flown.duration_s / finest_s), 1.0, max_places);
    places.step_s = flown.duration_s / steps;
    const auto count = static_cast<std::size_t>(steps) + 1;
    places.of.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double time_s = static_cast<double>(i) * places.step_s;
        const auto here = position_at(flown, std::min(time_s, flown.duration_s));
        const auto before = position_at(flown, std::max(0.0, time_s - 0.1 * places.step_s));
        const auto after = position_at(flown, std::min(flown.duration_s, time_s + 0.1 * places.step_s));
        PathPoint place;
        place.at = displacement_at(path.plan().path, here);
        place.course =
            unit(minus(displacement_at(path.plan().path, after), displacement_at(path.plan().path, before)), 1e-6);
        if (here.element < elements.size()) {
            const auto* hold = std::get_if<mission::Hold>(&elements[here.element].shape);
            place.is_unconstrained = hold != nullptr && !hold->over_ground;
        }
        places.of.push_back(place);
    }
    return places;
}

void collect_observations(const flight::SelectedTracks& tracks, double start_s, double until_s, double step_s,
                          Observations& observations) {
    auto& all = observations.of;
    all.clear();
    observations.settled = 0;
    Positions positions(tracks);
    if (positions.empty()) return;
    const double settled_until_s = std::min(until_s, positions.last_s()) - settled_after_s;
    Displacement origin;
    bool has_origin = false;
    std::size_t settled = 0;
    for (std::size_t k = 0; start_s + static_cast<double>(k) * step_s <= until_s; ++k) {
        const double time_s = start_s + static_cast<double>(k) * step_s;
        auto now = positions.at(time_s);
        if (now.is_known && !has_origin) {
            // Without a position where the cruise began nothing tells where the path is.
            if (time_s > start_s + oldest_position_s) return all.clear();
            origin = now.at;
            has_origin = true;
        }
        constexpr double min_m = 3.0;
        if (now.is_known) now.at = minus(now.at, origin);
        if (now.is_known && !all.empty() && all.back().is_known) now.course = unit(minus(now.at, all.back().at), min_m);
        all.push_back(now);
        if (time_s <= settled_until_s) settled = all.size();
    }
    if (!has_origin) return all.clear();
    observations.settled = settled;
}

}  // namespace flightwatt::live
