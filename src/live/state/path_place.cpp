#include "live/state/path_place.h"

#include "base/units.h"
#include "live/turn_home.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <variant>
#include <vector>

namespace flightwatt::live {
namespace {

// Chosen by what they mean; none was fitted to flights.
constexpr double finest_s = 1.0;           // between places
constexpr double most_places = 1200.0;     // on a path
constexpr double off_path_m = 25.0;        // one deviation: satellite navigation, and a turn that cuts its corner
constexpr double first_off_path_m = 60.0;  // while it is not known from where the path begins
constexpr double origin_m = 60.0;          // one deviation of that: some seconds of the climb
constexpr double course_weight = 2.0;
constexpr double news_part = 0.5;  // of a position: it is off as the one before was
constexpr double off_sds = 3.5;    // from there on it is likelier that the path was left
constexpr double oldest_position_s = 5.0;
constexpr double least_on_path_s = 20.0;
constexpr double least_on_path_part = 0.5;

struct Advance {
    std::ptrdiff_t places = 0;
    double chance = 0.0;
};
// In the time that a place takes as planned; off the path a flight goes on where it left it, or elsewhere.
constexpr std::array advances_on_path{Advance{0, 0.25}, Advance{1, 0.45}, Advance{2, 0.22}, Advance{3, 0.08}};
constexpr std::array advances_off_path{Advance{0, 0.7},     Advance{1, 0.2},      Advance{2, 0.07},
                                       Advance{3, 0.029},   Advance{-30, 0.0002}, Advance{30, 0.0005},
                                       Advance{100, 0.0003}};
constexpr double leaves = 0.02;
constexpr double comes_back = 0.05;

struct Place {
    Displacement at;
    Displacement course;  ///< of length 1, or 0 where it is not known
    bool is_anywhere = false;
};

struct Observation {
    Displacement at;
    Displacement course;
    bool is_known = false;
};

/// Places along a path, evenly in its planned time.
struct Places {
    std::vector<Place> of;
    double step_s = 0.0;
};

Displacement unit(const Displacement& of, double least_m) {
    const double length_m = std::hypot(of.east_m, of.north_m);
    return length_m < least_m ? Displacement{} : Displacement{of.east_m / length_m, of.north_m / length_m};
}

Displacement minus(const Displacement& a, const Displacement& b) {
    return {a.east_m - b.east_m, a.north_m - b.north_m};
}

double product(const Displacement& a, const Displacement& b) { return a.east_m * b.east_m + a.north_m * b.north_m; }

Places places_of(const mission::PathForecast& path) {
    const auto& flown = path.flown();
    const auto& elements = path.plan().path.elements;
    Places places;
    const double steps = std::clamp(std::ceil(flown.duration_s / finest_s), 1.0, most_places);
    places.step_s = flown.duration_s / steps;
    const auto count = static_cast<std::size_t>(steps) + 1;
    places.of.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double time_s = static_cast<double>(i) * places.step_s;
        const auto here = place_at(flown, std::min(time_s, flown.duration_s));
        const auto before = place_at(flown, std::max(0.0, time_s - 0.1 * places.step_s));
        const auto after = place_at(flown, std::min(flown.duration_s, time_s + 0.1 * places.step_s));
        Place place;
        place.at = displacement_at(path.plan().path, here);
        place.course =
            unit(minus(displacement_at(path.plan().path, after), displacement_at(path.plan().path, before)), 1e-6);
        if (here.element < elements.size()) {
            const auto* hold = std::get_if<mission::Hold>(&elements[here.element].shape);
            place.is_anywhere = hold != nullptr && !hold->over_ground;
        }
        places.of.push_back(place);
    }
    return places;
}

/// Positions of the cruise at even times, from where it began.
std::vector<Observation> observations_of(const flight::FlightSeries& series, double start_s, double until_s,
                                         double step_s) {
    const flight::ChosenTracks tracks(series);
    const bool is_plane = !tracks["east_m"].empty() && !tracks["north_m"].empty();
    const auto& east = tracks[is_plane ? "east_m" : "longitude_deg"];
    const auto& north = tracks[is_plane ? "north_m" : "latitude_deg"];
    if (east.empty() || north.empty()) return {};
    constexpr double metres_per_degree = 111195.0;
    const double metres_per_north = is_plane ? 1.0 : metres_per_degree;
    const double metres_per_east =
        is_plane ? 1.0 : metres_per_degree * std::cos(north.value.front() / units::degree_per_rad);
    std::vector<Observation> observations;
    std::size_t sample = 0;
    Displacement origin;
    bool has_origin = false;
    for (std::size_t k = 0; start_s + static_cast<double>(k) * step_s <= until_s; ++k) {
        const double time_s = start_s + static_cast<double>(k) * step_s;
        while (sample < east.time_s.size() && east.time_s[sample] < time_s) ++sample;
        Observation now;
        const bool is_between = sample > 0 && sample < east.time_s.size() &&
                                east.time_s[sample] - east.time_s[sample - 1] <= 2.0 * oldest_position_s;
        const bool is_at = sample < east.time_s.size() && east.time_s[sample] == time_s;
        if (is_between || is_at) {
            now.at = {value_at(east, time_s) * metres_per_east, value_at(north, time_s) * metres_per_north};
            now.is_known = std::isfinite(now.at.east_m) && std::isfinite(now.at.north_m);
        }
        if (now.is_known && !has_origin) {
            // Without a position where the cruise began nothing tells where the path is.
            if (time_s > start_s + oldest_position_s) return {};
            origin = now.at;
            has_origin = true;
        }
        now.at = minus(now.at, origin);
        constexpr double least_m = 3.0;
        if (now.is_known && !observations.empty() && observations.back().is_known)
            now.course = unit(minus(now.at, observations.back().at), least_m);
        observations.push_back(now);
    }
    return has_origin ? observations : std::vector<Observation>{};
}

/// How likely a flight at each place is, on the path and off it.
class PlaceFilter {
  public:
    PlaceFilter(const Places& places, double off_path_m, const Displacement& origin)
        : places_(places),
          off_path_m_(off_path_m),
          origin_(origin),
          on_(places.of.size(), 0.0),
          off_(places.of.size(), 0.0),
          next_on_(places.of.size(), 0.0),
          next_off_(places.of.size(), 0.0) {
        on_[0] = 1.0 - leaves;
        off_[0] = leaves;
    }

    void go_on() {
        auto& on = next_on_;
        auto& off = next_off_;
        std::ranges::fill(on, 0.0);
        std::ranges::fill(off, 0.0);
        const auto last = static_cast<std::ptrdiff_t>(on_.size()) - 1;
        const auto to = [&](std::size_t from, std::ptrdiff_t places) {
            return static_cast<std::size_t>(
                std::clamp(static_cast<std::ptrdiff_t>(from) + places, std::ptrdiff_t{0}, last));
        };
        for (std::size_t i = 0; i < on_.size(); ++i) {
            if (on_[i] > negligible) {
                for (const auto& [places, chance] : advances_on_path)
                    on[to(i, places_.of[i].is_anywhere ? 1 : places)] += on_[i] * chance * (1.0 - leaves);
                off[i] += on_[i] * leaves;
            }
            if (off_[i] > negligible) {
                for (const auto& [places, chance] : advances_off_path)
                    off[to(i, places)] += off_[i] * chance * (1.0 - comes_back);
                on[i] += off_[i] * comes_back;
            }
        }
        on_.swap(on);
        off_.swap(off);
    }

    void look(const Observation& seen) {
        if (!seen.is_known) return;
        const double off_chance = std::exp(-news_part * 0.5 * off_sds * off_sds);
        double sum = 0.0;
        for (std::size_t i = 0; i < on_.size(); ++i) {
            if (on_[i] > negligible) on_[i] *= std::exp(news_part * logarithm(i, seen));
            off_[i] *= off_chance;
            sum += on_[i] + off_[i];
        }
        for (std::size_t i = 0; i < on_.size(); ++i) {
            on_[i] /= sum;
            off_[i] /= sum;
        }
    }

    double on_path() const { return std::accumulate(on_.begin(), on_.end(), 0.0); }
    /// The middle of what is likely, in places.
    double place() const {
        const bool is_on = on_path() > 0.5;
        const auto& of = is_on ? on_ : off_;
        const double half = 0.5 * std::accumulate(of.begin(), of.end(), 0.0);
        double sum = 0.0;
        for (std::size_t i = 0; i < of.size(); ++i) {
            if (sum + of[i] >= half && of[i] > 0.0) return static_cast<double>(i) - 0.5 + (half - sum) / of[i];
            sum += of[i];
        }
        return static_cast<double>(of.size()) - 1.0;
    }
    /// The place nearest to a position, of those about the middle: the filter lags behind a flight that is faster or
    /// slower than planned.
    double nearest_place(const Observation& seen) const {
        double best = -std::numeric_limits<double>::infinity();
        const double middle = place();
        auto nearest = static_cast<std::size_t>(&place_of(middle) - places_.of.data());
        for (std::size_t i = 0; i < on_.size(); ++i) {
            constexpr double about = 4.0;
            if (!(on_[i] > negligible) || std::abs(static_cast<double>(i) - middle) > about) continue;
            constexpr double prior_part = 0.1;
            const double score = logarithm(i, seen) + prior_part * std::log(on_[i]);
            if (score <= best) continue;
            best = score;
            nearest = i;
        }
        const auto& place = places_.of[nearest];
        if (place.is_anywhere) return middle;
        const double ahead_m = product(minus(minus(seen.at, origin_), place.at), place.course);
        const auto next = std::min(nearest + 1, on_.size() - 1);
        const auto step = minus(places_.of[next].at, place.at);
        const double step_m = std::max(1.0, std::hypot(step.east_m, step.north_m));
        return static_cast<double>(nearest) + std::clamp(ahead_m / step_m, -0.5, 0.5);
    }
    /// Of the likeliest place: what the position is off it.
    Displacement off(double place, const Observation& seen) const {
        return minus(minus(seen.at, origin_), place_of(place).at);
    }
    const Place& place_of(double place) const {
        const double last = static_cast<double>(places_.of.size()) - 1.0;
        return places_.of[static_cast<std::size_t>(std::clamp(std::round(place), 0.0, last))];
    }

  private:
    static constexpr double negligible = 1e-15;

    double logarithm(std::size_t i, const Observation& seen) const {
        const auto& place = places_.of[i];
        if (place.is_anywhere) return -0.5;
        const auto off = minus(minus(seen.at, origin_), place.at);
        const bool have_courses = product(place.course, place.course) > 0.0 && product(seen.course, seen.course) > 0.0;
        const double turned = have_courses ? 1.0 - product(place.course, seen.course) : 0.0;
        return -0.5 * product(off, off) / (off_path_m_ * off_path_m_) - course_weight * turned;
    }

    const Places& places_;
    double off_path_m_;
    Displacement origin_;
    std::vector<double> on_;
    std::vector<double> off_;
    std::vector<double> next_on_;  ///< of go_on
    std::vector<double> next_off_;
};

/// From where the path begins: what the positions are off it, across it, as far as that is known better than beforehand.
class Origin {
  public:
    void add(const Displacement& off, const Displacement& course, double off_path_m) {
        const Displacement across{-course.north_m, course.east_m};
        const double weight = news_part / (off_path_m * off_path_m);
        const double off_m = product(off, across);
        ee_ += weight * across.east_m * across.east_m;
        en_ += weight * across.east_m * across.north_m;
        nn_ += weight * across.north_m * across.north_m;
        e_ += weight * across.east_m * off_m;
        n_ += weight * across.north_m * off_m;
    }
    Displacement value() const {
        const double determinant = ee_ * nn_ - en_ * en_;
        return {(nn_ * e_ - en_ * n_) / determinant, (ee_ * n_ - en_ * e_) / determinant};
    }

  private:
    double ee_ = 1.0 / (origin_m * origin_m);
    double en_ = 0.0;
    double nn_ = 1.0 / (origin_m * origin_m);
    double e_ = 0.0;
    double n_ = 0.0;
};

Displacement origin_of(const Places& places, const std::vector<Observation>& seen) {
    PlaceFilter filter(places, first_off_path_m, {});
    Origin origin;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        if (k > 0) filter.go_on();
        filter.look(seen[k]);
        if (!seen[k].is_known || filter.on_path() < 0.5) continue;
        const double place = filter.place();
        if (!filter.place_of(place).is_anywhere)
            origin.add(filter.off(place, seen[k]), filter.place_of(place).course, first_off_path_m);
    }
    return origin.value();
}

}  // namespace

std::optional<PathSighting> sighted_on_path(const mission::PathForecast& path, const flight::FlightSeries& series,
                                            double cruise_start_s, double until_s) {
    if (!(path.flown().duration_s > 0.0) || !(until_s > cruise_start_s)) return std::nullopt;
    const auto places = places_of(path);
    const auto seen = observations_of(series, cruise_start_s, until_s, places.step_s);
    if (seen.empty()) return std::nullopt;
    PlaceFilter filter(places, off_path_m, origin_of(places, seen));
    double known_s = 0.0;
    double on_path_s = 0.0;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        if (k > 0) filter.go_on();
        filter.look(seen[k]);
        if (!seen[k].is_known) continue;
        known_s += places.step_s;
        if (filter.on_path() >= 0.5) on_path_s += places.step_s;
    }
    PathSighting sighting;
    if (on_path_s < std::max(least_on_path_s, least_on_path_part * known_s)) return sighting;
    sighting.is_on_path = filter.on_path() >= 0.5;
    const bool is_seen = sighting.is_on_path && seen.back().is_known;
    const double place = is_seen ? filter.nearest_place(seen.back()) : filter.place();
    const double seen_s = cruise_start_s + static_cast<double>(seen.size() - 1) * places.step_s;
    sighting.on_path_s = std::clamp(place * places.step_s + (sighting.is_on_path ? until_s - seen_s : 0.0), 0.0,
                                    path.flown().duration_s);
    if (seen.back().is_known) {
        const auto off = filter.off(place, seen.back());
        sighting.off_m = std::hypot(off.east_m, off.north_m);
    }
    return sighting;
}

}  // namespace flightwatt::live
