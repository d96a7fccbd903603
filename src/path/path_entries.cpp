#include "path/path_entries.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <GeographicLib/LocalCartesian.hpp>
#include <fmt/format.h>

namespace flightwatt::path {
namespace {

constexpr double max_m = 300e3;        // of a place from the start: beyond, coordinates were mistaken
constexpr double same_place_m = 1e-3;  // of places in a file, which are rounded

/// Of the plane in which a geographic path is flown.
std::optional<GeodeticPosition> origin_of(const std::vector<PathEntry>& entries, const PathDefaults& defaults) {
    if (defaults.geographic_start || defaults.start) return defaults.geographic_start;
    for (const auto& entry : entries) {
        if (entry.geographic) return entry.geographic;
        if (entry.place) break;
    }
    return std::nullopt;
}

/// Follows the aircraft from entry to entry.
class PathBuilder {
  public:
    PathBuilder(const PathDefaults& defaults, const std::vector<PathEntry>& entries)
        : defaults_(defaults), origin_(origin_of(entries, defaults)), altitude_m_(defaults.altitude_m) {
        if (defaults.start) place_ = *defaults.start;
        if (defaults.starts_at_first_place && !defaults.start && !defaults.geographic_start && !entries.empty()) {
            const auto& first = entries.front();
            if (first.place) place_ = *first.place;
            if (first.circles && !first.is_turn) place_ = moved(place_, *first.radius_m, 0.0);
        }
        start_ = place_;
        start_altitude_m_ = altitude_m_;
    }

    void add(const PathEntry& entry) {
        require_one_meaning(entry);
        change_m_ = altitude_change_m(entry);
        const double there_m = height_there_m(entry);
        change_m_ -= there_m;
        if (const auto there = place_of(entry)) {
            entry.circles ? fly_to_circle(entry, *there) : fly_to(entry, *there);
        } else if (entry.length_m) {
            fly_leg(entry, *entry.length_m, *entry.course_deg);
        }
        if (entry.circles) circle(entry, place_of(entry));
        if (entry.hold_s) add_element(entry, Hold{*entry.hold_s});
        change_m_ += there_m;
        if (change_m_ != 0.0) change_height(entry);
    }

    std::optional<PathOrigin> origin() const {
        const auto place = origin_ ? origin_ : defaults_.local_origin;
        if (!place) return std::nullopt;
        PathOrigin origin{*place, start_, defaults_.ground_m, start_altitude_m_, defaults_.is_above_sea};
        if (origin.altitude_m) *origin.altitude_m -= origin.ground_m;
        return origin;
    }

    std::optional<double> start_above_ground_m() const {
        if (!start_altitude_m_ || !defaults_.is_above_ground) return std::nullopt;
        return *start_altitude_m_ - defaults_.ground_m;
    }

    FlightPath finish() {
        if (defaults_.return_to_start && !path_.elements.empty()) {
            PathEntry home;
            home.name = "return to start";
            home.where = defaults_.where;
            home.altitude_m = start_altitude_m_;
            home.place = start_;
            change_m_ = altitude_change_m(home);
            const bool is_too_steep = is_too_steep_for_return(home);
            const double above_start_m = is_too_steep ? std::exchange(change_m_, 0.0) : 0.0;
            fly_to(home, start_);
            if (!path_.elements.empty() && path_.elements.back().name == home.name)
                path_.elements.back().is_return_leg = true;
            change_m_ += above_start_m;
            // Without a rate the height above the start is left to the landing.
            if (change_m_ != 0.0 && (rate_of(home) || is_too_steep)) {
                change_height(home);
                path_.elements.back().is_return_leg = true;
            }
        }
        return std::move(path_);
    }

  private:
    [[noreturn]] static void refuse(const PathEntry& entry, const std::string& message, const std::string& hint) {
        throw InputError(entry.where, entry.name + ": " + message, hint);
    }

    static void require_one_meaning(const PathEntry& entry) {
        const bool has_place = entry.place || entry.geographic;
        if (entry.length_m.has_value() != entry.course_deg.has_value())
            refuse(entry, "length_m and course_deg belong together", "give both");
        if (has_place && entry.length_m)
            refuse(entry, "has a place and a length", "a leg goes to a place, or so far on a course: give one of them");
        if (entry.circles && entry.length_m)
            refuse(entry, "has a length and circles", "write the circles as the next entry");
        if (entry.circles.has_value() != entry.radius_m.has_value())
            refuse(entry, "circles and radius_m belong together", "give both");
        if (entry.duration_s && (!has_place || entry.circles)) {
            refuse(
                entry, "duration_s is how long the way to a place took",
                "give the place and no circles; hold_s waits, and circles are timed by their radius and the airspeed");
        }
        if (!has_place && !entry.length_m && !entry.circles && !entry.hold_s) {
            refuse(entry, "is empty",
                   "give a place (east_m and north_m, or latitude_deg and longitude_deg), length_m and course_deg, "
                   "circles and radius_m, or hold_s");
        }
    }

    double altitude_change_m(const PathEntry& entry) {
        if (!entry.altitude_m) return 0.0;
        if (is_at_start(entry)) start_altitude_m_ = altitude_m_ = entry.altitude_m;
        if (!altitude_m_) {
            refuse(entry, "states an altitude, and the path has none at its start",
                   "add altitude_m to [path]: that of the cruise as it begins");
        }
        const double change_m = *entry.altitude_m - *altitude_m_;
        altitude_m_ = entry.altitude_m;
        return change_m;
    }

    /// A first waypoint at the start defines its altitude, unless the aircraft has a rate or a time to change it.
    bool is_at_start(const PathEntry& entry) const {
        if (!path_.elements.empty() || entry.circles || entry.length_m) return false;
        if (altitude_m_ && (entry.hold_s || entry.duration_s || rate(entry, *entry.altitude_m > *altitude_m_)))
            return false;
        const auto place = place_of(entry);
        return place && distance_between_m(*place, place_) <= same_place_m;
    }

    std::optional<LocalPosition> place_of(const PathEntry& entry) const {
        if (entry.place && origin_)
            refuse(entry, "is in metres, on a path that has latitudes", "give all places in the same coordinates");
        if (entry.geographic && !origin_)
            refuse(entry, "has a latitude, on a path in metres", "give all places in the same coordinates");
        if (!entry.place && !entry.geographic) return std::nullopt;
        const auto place = entry.place ? *entry.place : to_local(*entry.geographic, *origin_);
        const double distance_m = distance_between_m(place, start_);
        if (!(distance_m < max_m)) {
            refuse(entry, fmt::format("is {:.4g} km from the start", distance_m / 1000.0),
                   fmt::format("expected less than {:.0f} km: are latitude and longitude the right way round?",
                               max_m / 1000.0));
        }
        return place;
    }

    void fly_to(const PathEntry& entry, const LocalPosition& there) {
        const double length_m = distance_between_m(place_, there);
        const double course_deg = course_between(place_, there);
        if (entry.duration_s) {
            if (length_m > same_place_m) course_deg_ = std::fmod(course_deg + 360.0, 360.0);
            add_element(entry, Hold{*entry.duration_s, Leg{length_m, course_deg_}});
        } else if (length_m > same_place_m) {
            fly_leg(entry, length_m, course_deg);
        }
        place_ = there;
    }

    void fly_leg(const PathEntry& entry, double length_m, double course_deg) {
        course_deg_ = std::fmod(course_deg + 360.0, 360.0);
        place_ = moved(place_, length_m, course_deg);
        add_element(entry, Leg{length_m, course_deg_});
    }

    /// Straight towards the centre, or from it, to the edge.
    void fly_to_circle(const PathEntry& entry, const LocalPosition& centre) {
        const bool is_at_centre = distance_between_m(centre, place_) <= same_place_m;
        const double bearing_deg = is_at_centre ? course_deg_ : course_between(centre, place_);
        fly_to(entry, moved(centre, *entry.radius_m, bearing_deg));
        course_deg_ = std::fmod(bearing_deg + (entry.to_right ? 90.0 : 270.0) + 360.0, 360.0);
    }

    void circle(const PathEntry& entry, const std::optional<LocalPosition>& centre) {
        const double side = entry.to_right ? 1.0 : -1.0;
        const double radius_m = *entry.radius_m;
        const auto middle = centre.value_or(moved(place_, radius_m, course_deg_ + side * 90.0));
        add_element(entry, Circles{radius_m, *entry.circles, entry.to_right, course_deg_});
        const double turned_deg = 360.0 * std::fmod(*entry.circles, 1.0);
        course_deg_ = std::fmod(course_deg_ + side * turned_deg + 360.0, 360.0);
        place_ = moved(middle, radius_m, course_deg_ - side * 90.0);
    }

    /// Adds an element; the first of an entry takes the change of height.
    template <typename Shape>
    void add_element(const PathEntry& entry, const Shape& shape) {
        PathElement element;
        element.shape = shape;
        element.airspeed_m_per_s = entry.airspeed_m_per_s.value_or(defaults_.airspeed_m_per_s);
        element.altitude_change_m = change_m_;
        element.is_turn = entry.is_turn;
        element.survey_line = entry.survey_line;
        element.climb_rate_m_per_s = rate_of(entry);
        element.name = entry.name;
        element.where = entry.where;
        path_.elements.push_back(std::move(element));
        change_m_ = 0.0;
    }

    /// What of the change of height is flown at the entry's place, until its altitude is reached.
    double height_there_m(const PathEntry& entry) const {
        const auto there = place_of(entry);
        const auto& on_spot = defaults_.rates_on_spot;
        const auto rate = change_m_ > 0.0 ? on_spot.climb_m_per_s : on_spot.descent_m_per_s;
        if (!entry.waits_for_altitude || !there || !rate || rate_of(entry)) return 0.0;
        const double airspeed = entry.airspeed_m_per_s.value_or(defaults_.airspeed_m_per_s);
        const double on_way_m = *rate * distance_between_m(place_, *there) / airspeed;
        return std::copysign(std::max(0.0, std::abs(change_m_) - on_way_m), change_m_);
    }

    /// Whether the way back to the start is too short for its change of height at the rates above one place.
    bool is_too_steep_for_return(const PathEntry& home) const {
        const double length_m = distance_between_m(place_, start_);
        const auto& on_spot = defaults_.rates_on_spot;
        const auto rate = change_m_ > 0.0 ? on_spot.climb_m_per_s : on_spot.descent_m_per_s;
        return change_m_ != 0.0 && rate && !rate_of(home) && length_m > same_place_m &&
               std::abs(change_m_) / *rate * defaults_.airspeed_m_per_s > length_m;
    }

    std::optional<double> rate_of(const PathEntry& entry) const {
        return change_m_ == 0.0 ? std::nullopt : rate(entry, change_m_ > 0.0);
    }

    /// Of a way whose time was measured its own alone: by the path's it would take another time.
    std::optional<double> rate(const PathEntry& entry, bool is_up) const {
        const auto own = is_up ? entry.rates.climb_m_per_s : entry.rates.descent_m_per_s;
        if (own || entry.duration_s) return own;
        return is_up ? defaults_.rates.climb_m_per_s : defaults_.rates.descent_m_per_s;
    }

    /// On the spot: the place was reached already.
    void change_height(const PathEntry& entry) {
        auto rate = rate_of(entry);
        if (!rate)
            rate = change_m_ > 0.0 ? defaults_.rates_on_spot.climb_m_per_s : defaults_.rates_on_spot.descent_m_per_s;
        if (!rate) {
            refuse(entry, fmt::format("changes the altitude by {:.4g} m where the aircraft is already", change_m_),
                   "state the rate, climb_m_per_s or descent_m_per_s, or the time, hold_s");
        }
        add_element(entry, Hold{std::abs(change_m_) / *rate});
    }

    const PathDefaults& defaults_;
    std::optional<GeodeticPosition> origin_;
    std::optional<double> altitude_m_;
    std::optional<double> start_altitude_m_;
    LocalPosition start_;
    LocalPosition place_;
    double course_deg_ = 0.0;
    double change_m_ = 0.0;  ///< of the height, that the entry's elements have not flown yet
    FlightPath path_;
};

}  // namespace

LocalPosition to_local(const GeodeticPosition& place, const GeodeticPosition& origin) {
    const GeographicLib::LocalCartesian plane(origin.latitude_deg, origin.longitude_deg);
    LocalPosition local;
    double above_m = 0.0;
    plane.Forward(place.latitude_deg, place.longitude_deg, 0.0, local.east_m, local.north_m, above_m);
    return local;
}

GeodeticPosition to_geodetic(const LocalPosition& position, const GeodeticPosition& origin) {
    const GeographicLib::LocalCartesian plane(origin.latitude_deg, origin.longitude_deg);
    GeodeticPosition place;
    double above_m = 0.0;
    plane.Reverse(position.east_m, position.north_m, 0.0, place.latitude_deg, place.longitude_deg, above_m);
    return place;
}

FlightPath build_path(const std::vector<PathEntry>& entries, const PathDefaults& defaults) {
    PathBuilder builder(defaults, entries);
    for (const auto& entry : entries) builder.add(entry);
    auto path = builder.finish();
    if (path.elements.empty())
        throw InputError(defaults.where, "the path has no leg to fly: it has no waypoint beyond its start",
                         "add legs or waypoints");
    return path;
}

std::optional<PathOrigin> path_origin(const std::vector<PathEntry>& entries, const PathDefaults& defaults) {
    PathBuilder builder(defaults, entries);
    for (const auto& entry : entries) builder.add(entry);  // the first may state the altitude
    return builder.origin();
}

std::optional<double> start_above_ground_m(const std::vector<PathEntry>& entries, const PathDefaults& defaults) {
    PathBuilder builder(defaults, entries);
    for (const auto& entry : entries) builder.add(entry);
    return builder.start_above_ground_m();
}

}  // namespace flightwatt::path
