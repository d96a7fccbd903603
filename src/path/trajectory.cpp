#include "path/trajectory.h"

#include "base/error.h"
#include "base/units.h"
#include "path/trajectory/ground_track.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>

namespace flightwatt::path {
namespace {

constexpr double crawling_fraction = 0.02;  // of the airspeed, over ground, where a drawn wind forbids an element
constexpr double max_path_s = 1e7;
constexpr double nearly = 1.0 - 1e-9;

/// A part of a track with one climb rate.
struct TrackInterval {
    double from_m = 0.0;
    double to_m = 0.0;
    double climb_m_per_s = 0.0;
};

double horizontal_of(double airspeed_m_per_s, double climb_m_per_s) {
    return std::sqrt(std::max(0.0, airspeed_m_per_s * airspeed_m_per_s - climb_m_per_s * climb_m_per_s));
}

/// Where `function` crosses 0, rising from `low` to `high`.
template <typename Function>
double rising_root(const Function& function, double low, double high) {
    std::uintmax_t iterations = 200;
    const auto [below, above] = boost::math::tools::toms748_solve(
        function, low, high, boost::math::tools::eps_tolerance<double>(48), iterations);
    return std::midpoint(below, above);
}

/// Flies the elements one after the other.
class PathFlight {
  public:
    PathFlight(const FlightPath& path, const Wind& wind, InfeasibleLegPolicy infeasible_legs)
        : path_(path), wind_(wind), crawls_(infeasible_legs == InfeasibleLegPolicy::crawl) {}

    PathTrajectory fly() {
        for (std::size_t i = 0; i < path_.elements.size(); ++i) {
            index_ = i;
            element_ = &path_.elements[i];
            const double before_s = flown_.duration_s;
            std::visit([&](const auto& shape) { fly_shape(shape); }, element_->shape);
            flown_.element_s.push_back(flown_.duration_s - before_s);
            if (!crawls_ && !(flown_.duration_s <= max_path_s)) refuse_length();
        }
        return std::move(flown_);
    }

  private:
    double airspeed() const { return element_->airspeed_m_per_s; }
    double airspeed(double climb_m_per_s) const {
        const auto* hold = std::get_if<Hold>(&element_->shape);
        if (hold != nullptr && hold->hovers) return std::hypot(wind_.speed_m_per_s, climb_m_per_s);
        const bool is_over_ground = hold != nullptr && hold->over_ground && hold->over_ground->length_m > 0.0;
        if (!is_over_ground || !keeps_ground_speed()) return airspeed();
        const auto& leg = *hold->over_ground;
        const GroundTrack track(leg, wind_, true);
        return std::hypot(track.airspeed_m_per_s(0.0, leg.length_m, leg.length_m / hold->time_s), climb_m_per_s);
    }
    bool keeps_ground_speed() const { return element_->keeps_ground_speed && wind_.speed_m_per_s > 0.0; }
    double sign() const { return element_->altitude_change_m < 0.0 ? -1.0 : 1.0; }
    double height_m() const { return std::abs(element_->altitude_change_m); }

    [[noreturn]] void refuse(const std::string& message, const std::string& hint) const {
        throw InputError(element_->where, element_->name + ": " + message, hint);
    }
    [[noreturn]] void refuse_length() const {
        refuse(fmt::format("up to its end the path takes {:.3g} s, more than {:.0e}", flown_.duration_s, max_path_s),
               "is a length or a speed in another unit?");
    }

    void add(double time_s, double climb_m_per_s) { add(time_s, {airspeed(climb_m_per_s), climb_m_per_s, 1.0}); }
    void add(double time_s, const mechanical::FlightState& motion) {
        if (!(time_s > 0.0)) return;
        flown_.pieces.push_back({time_s, motion, index_});
        flown_.duration_s += time_s;
    }

    void fly_shape(const Hold& hold) {
        const double rate = element_->climb_rate_m_per_s.value_or(height_m() / hold.time_s);
        const double climb_s = height_m() > 0.0 ? height_m() / rate : 0.0;
        if (height_m() > 0.0 && !hold.hovers) require_slower_than_airspeed(rate);
        if (climb_s * nearly > hold.time_s) {
            refuse(fmt::format("takes {:.4g} s, and at {:.4g} m/s {} m of height need {:.4g} s", hold.time_s, rate,
                               height_m(), climb_s),
                   "hold longer, or change the height faster");
        }
        add(std::min(climb_s, hold.time_s), sign() * rate);
        add(hold.time_s - climb_s, 0.0);
    }

    template <typename Shape>
    void fly_shape(const Shape& shape) {
        const GroundTrack track(shape, wind_, keeps_ground_speed());
        const double least = track.min_horizontal_m_per_s();
        const double crawl_s = track.length_m() / (crawling_fraction * airspeed());
        const bool is_infeasible = airspeed() <= least * (1.0 + 1e-12);
        if (is_infeasible && !crawls_) refuse_wind();
        if (crawls_ && (is_infeasible || track.time_s(0.0, track.length_m(), airspeed()) > crawl_s)) {
            flown_.infeasible_elements.push_back(index_);
            add(crawl_s, 0.0);
            return;
        }
        const auto intervals = height_m() == 0.0              ? std::vector<TrackInterval>{{0.0, track.length_m(), 0.0}}
                               : element_->climb_rate_m_per_s ? climb_first(track, least)
                                                              : climb_all_along(track, least);
        for (const auto& interval : intervals) fly_interval(track, interval);
    }

    void fly_interval(const GroundTrack& track, const TrackInterval& interval) {
        const double horizontal = horizontal_of(airspeed(), interval.climb_m_per_s);
        const double tolerance_m = 1e-9 * track.length_m();
        const double piece_m = track.segment_length_m();
        const auto period = track.segments_per_turn();
        std::vector<TrajectorySegment> whole;  // of the first turn: the others are the same
        for (std::size_t k = 0;; ++k) {
            const double from_m = interval.from_m + piece_m * static_cast<double>(k);
            if (from_m >= interval.to_m - tolerance_m) break;
            const bool is_whole = from_m + piece_m <= interval.to_m - tolerance_m;
            if (is_whole && whole.size() == period) {
                add(whole[k % period].time_s, whole[k % period].motion);
                continue;
            }
            const double to_m = is_whole ? from_m + piece_m : interval.to_m;
            mechanical::FlightState motion{airspeed(), interval.climb_m_per_s,
                                           std::sqrt(track.load_factor_squared(from_m, to_m, horizontal))};
            if (keeps_ground_speed())
                motion.airspeed_m_per_s =
                    std::hypot(track.airspeed_m_per_s(from_m, to_m, horizontal), interval.climb_m_per_s);
            add(track.time_s(from_m, to_m, horizontal), motion);
            if (is_whole) whole.push_back(flown_.pieces.back());
        }
    }

    void require_slower_than_airspeed(double rate_m_per_s) const {
        if (rate_m_per_s < airspeed()) return;
        refuse(fmt::format("changes its height at {:.4g} m/s with an airspeed of {:.4g} m/s", rate_m_per_s, airspeed()),
               "climb or descend more slowly");
    }

    /// At the stated rate from the start on.
    std::vector<TrackInterval> climb_first(const GroundTrack& track, double least) {
        const double rate = *element_->climb_rate_m_per_s;
        require_slower_than_airspeed(rate);
        const double horizontal = horizontal_of(airspeed(), rate);
        const double climb_s = height_m() / rate;
        const double length_m = track.length_m();
        const double possible_s = horizontal > least ? track.time_s(0.0, length_m, horizontal) : 0.0;
        if (horizontal <= least || possible_s < climb_s * nearly) {
            if (!crawls_) refuse_climb(rate, climb_s, possible_s);
            add(climb_s, sign() * rate);  // up or down on the spot
            return {};
        }
        if (possible_s <= climb_s) return {{0.0, length_m, sign() * rate}};
        const auto missing_s = [&](double until_m) { return track.time_s(0.0, until_m, horizontal) - climb_s; };
        const double until_m = rising_root(missing_s, 0.0, length_m);
        return {{0.0, until_m, sign() * rate}, {until_m, length_m, 0.0}};
    }

    /// At the one rate that reaches the height at the end.
    std::vector<TrackInterval> climb_all_along(const GroundTrack& track, double least) {
        constexpr double below_steepest = 1.0 - 1e-6;
        const double steepest = below_steepest * horizontal_of(airspeed(), least);
        const auto above_m = [&](double rate) {
            return rate * track.time_s(0.0, track.length_m(), horizontal_of(airspeed(), rate)) - height_m();
        };
        if (above_m(steepest) < 0.0) {
            if (!crawls_) {
                refuse(
                    fmt::format("changes its height by {:.4g} m over {:.4g} m, too steep for an airspeed of {:.4g} m/s",
                                height_m(), track.length_m(), airspeed()),
                    "make it longer, or state climb_m_per_s and descent_m_per_s and circle while the height changes");
            }
            add(height_m() / steepest, sign() * steepest);
            return {};
        }
        return {{0.0, track.length_m(), sign() * rising_root(above_m, 0.0, steepest)}};
    }

    [[noreturn]] void refuse_climb(double rate, double climb_s, double possible_s) const {
        refuse(
            fmt::format("changes its height by {:.4g} m at {:.4g} m/s, which takes {:.4g} s, and is flown in {:.4g} s",
                        height_m(), rate, climb_s, possible_s),
            "make it longer or the rate greater, add circles for the change, or state no rate: it is then spread over "
            "all of it");
    }

    [[noreturn]] void refuse_wind() const {
        refuse(fmt::format("the wind of {:.4g} m/s from {:.4g} degrees is too strong for an airspeed of {:.4g} m/s",
                           wind_.speed_m_per_s, wind_.from_deg, airspeed()),
               "fly it faster, on another course, or on another day");
    }

    const FlightPath& path_;
    const Wind& wind_;
    bool crawls_;
    PathTrajectory flown_;
    std::size_t index_ = 0;
    const PathElement* element_ = nullptr;
};

/// The straight leg from the end of a path to its start, if these differ. A height that the rates do not change on such
/// a way changes above the start.
std::vector<PathElement> way_back(const FlightPath& path, const ClimbRates& rates) {
    const auto end = local_position_at(path, {path.elements.size(), 0.0});
    const double length_m = std::hypot(end.east_m, end.north_m);
    PathElement back = path.elements.back();
    back.shape = Leg{length_m, std::atan2(-end.east_m, -end.north_m) * units::degree_per_rad};
    back.name = "way back to the start";
    back.climb_rate_m_per_s.reset();
    back.altitude_change_m = 0.0;
    for (const auto& element : path.elements) back.altitude_change_m -= element.altitude_change_m;
    const double height_m = std::abs(back.altitude_change_m);
    const auto rate = back.altitude_change_m > 0.0 ? rates.climb_m_per_s : rates.descent_m_per_s;
    std::vector<PathElement> ways{back};
    constexpr double same_height_m = 1e-3;
    if (rate && height_m > same_height_m && height_m / *rate * back.airspeed_m_per_s > length_m) {
        ways.front().altitude_change_m = 0.0;
        ways.push_back(back);
        ways.back().shape = Hold{height_m / *rate, std::nullopt, back.keeps_ground_speed};
    }
    if (returns_to_start(path)) ways.erase(ways.begin());
    return ways;
}

}  // namespace

PathTrajectory compute_trajectory(const FlightPath& path, const Wind& wind, InfeasibleLegPolicy infeasible_legs) {
    return PathFlight(path, wind, infeasible_legs).fly();
}

std::optional<double> ground_speed_m_per_s(const PathElement& element, double climb_m_per_s, double course_deg,
                                           const Wind& wind) {
    const double horizontal = horizontal_of(element.airspeed_m_per_s, climb_m_per_s);
    if (element.keeps_ground_speed) return horizontal;
    const auto drift = solve_wind_triangle(horizontal, course_deg / units::degree_per_rad, velocity_of(wind));
    return drift ? std::optional(drift->ground_speed_m_per_s) : std::nullopt;
}

bool returns_to_start(const FlightPath& path) {
    constexpr double same_place_m = 1e-3;
    return distance_between_m(local_position_at(path, {path.elements.size(), 0.0}), {}) <= same_place_m;
}

FlightPath repeated(const FlightPath& path, const Wind& wind, double times, const ClimbRates& rates) {
    const auto add_share = [&](const FlightPath& round, double share, FlightPath& to) {
        const auto flown = compute_trajectory(round, wind);
        const auto part = path_between(round, {}, position_at(flown, share * flown.duration_s));
        to.elements.insert(to.elements.end(), part.elements.begin(), part.elements.end());
    };
    FlightPath result;
    add_share(path, std::min(times, 1.0), result);
    FlightPath round{way_back(path, rates)};
    round.elements.insert(round.elements.end(), path.elements.begin(), path.elements.end());
    for (double left = times - 1.0; left > 0.0; left -= 1.0) add_share(round, std::min(left, 1.0), result);
    if (!returns_to_start(path) || returns_to_start(result)) return result;
    std::ranges::move(way_back(result, rates), std::back_inserter(result.elements));
    return result;
}

PathPosition position_at(const PathTrajectory& flown, double time_s) {
    double start_s = 0.0;
    for (std::size_t i = 0; i < flown.element_s.size(); ++i) {
        const double element_s = flown.element_s[i];
        if (time_s < start_s + element_s) return {i, std::max(time_s - start_s, 0.0) / element_s};
        start_s += element_s;
    }
    return {flown.element_s.size(), 0.0};
}

PathTrajectory remaining_trajectory(const PathTrajectory& flown, const PathPosition& place) {
    PathTrajectory rest;
    rest.element_s = flown.element_s;
    for (const auto element : flown.infeasible_elements)
        if (element >= place.element) rest.infeasible_elements.push_back(element);
    rest.pieces.reserve(flown.pieces.size());
    for (std::size_t i = 0; i < rest.element_s.size() && i <= place.element; ++i)
        rest.element_s[i] *= i < place.element ? 0.0 : 1.0 - place.part;
    double behind_s = place.element < flown.element_s.size() ? place.part * flown.element_s[place.element] : 0.0;
    for (auto piece : flown.pieces) {
        if (piece.element < place.element) continue;
        const double here_s = std::min(behind_s, piece.time_s);
        behind_s -= here_s;
        piece.time_s -= here_s;
        if (!(piece.time_s > 0.0)) continue;
        rest.duration_s += piece.time_s;
        rest.pieces.push_back(piece);
    }
    return rest;
}

}  // namespace flightwatt::path
