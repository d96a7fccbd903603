#include "path/turns.h"

#include "base/units.h"
#include "path/trajectory.h"
#include "path/trajectory/shortest_way.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

constexpr double max_cut_deg = 120.0;  // of a corner: beyond, the arc would pass more than a radius before it
constexpr double straight_deg = 0.1;   // of a corner: below, the path is straight
constexpr double same_place_m = 1e-3;
// As autopilots of multicopters have them by default: WPNAV_ACCEL, WPNAV_JERK and WPNAV_RADIUS of ArduPilot.
constexpr double acceleration_m_per_s2 = 2.5;
constexpr double jerk_m_per_s3 = 1.0;
constexpr double corner_radius_m = 2.0;

/// The change of course [degrees], more than 0 to the right.
double change_deg(double from_deg, double to_deg) { return std::remainder(to_deg - from_deg, 360.0); }

bool is_bent(double from_deg, double to_deg) { return std::abs(change_deg(from_deg, to_deg)) > straight_deg; }

double tangent_of(double deg) { return std::tan(deg / units::degree_per_rad); }

double length_m(const std::variant<Leg, Circles, Hold>& shape) {
    if (const auto* leg = std::get_if<Leg>(&shape)) return leg->length_m;
    if (const auto* circles = std::get_if<Circles>(&shape))
        return units::rad_from_turns(circles->turns) * circles->radius_m;
    return 0.0;
}

LocalPosition after(const LocalPosition& at, const PathElement& element) {
    return at + local_position_at({{element}}, {1, 0.0});
}

/// The poses between which an element is drawn; of a hold without a leg the courses are absent.
struct Drawn {
    Pose start;
    Pose end;
    bool has_course = true;
};

std::vector<Drawn> drawn_poses(const FlightPath& path) {
    std::vector<Drawn> poses;
    LocalPosition at;
    for (const auto& element : path.elements) {
        Drawn drawn;
        drawn.start.place = at;
        drawn.end.place = at = after(at, element);
        if (const auto* circles = std::get_if<Circles>(&element.shape)) {
            drawn.start.course_deg = circles->start_course_deg;
            drawn.end.course_deg = circles->start_course_deg + (circles->to_right ? 360.0 : -360.0) * circles->turns;
        } else if (const auto* leg = std::get_if<Leg>(&element.shape)) {
            drawn.start.course_deg = drawn.end.course_deg = leg->course_deg;
        } else {
            drawn.has_course = false;
        }
        poses.push_back(drawn);
    }
    return poses;
}

std::string first_and_more(const std::vector<std::string>& names) {
    return names.size() == 1 ? names.front() : fmt::format("{} and {} more", names.front(), names.size() - 1);
}

/// Adds the turns of a wing, element after element.
class WingTurns {
  public:
    WingTurns(const FlightPath& drawn, const Wind& wind, const TurnLimits& limits)
        : elements_(drawn.elements), wind_(wind), limits_(limits), drawn_(drawn_poses(drawn)) {}

    TurnedPath fly() {
        if (!drawn_.empty()) at_ = drawn_.front().start;
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            if (std::holds_alternative<Leg>(elements_[i].shape))
                fly_leg(i);
            else if (std::holds_alternative<Circles>(elements_[i].shape))
                fly_circles(i);
            else
                hold(i);
        }
        add_notes();
        return std::move(turned_);
    }

  private:
    /// The radius of circles that the bank permits, and that of turns.
    double least_radius(std::size_t i) const {
        return turn_radius_m(elements_[i].airspeed_m_per_s, limits_.max_bank_deg, wind_.speed_m_per_s);
    }
    double radius(std::size_t i) const { return std::max(least_radius(i), limits_.radius_m.value_or(0.0)); }
    bool is_leg(std::size_t i) const { return i < elements_.size() && std::holds_alternative<Leg>(elements_[i].shape); }
    /// A part of a circle between lines that is too narrow: another turn takes its place.
    bool is_replaced(std::size_t i) const {
        const auto* circles = i < elements_.size() ? std::get_if<Circles>(&elements_[i].shape) : nullptr;
        return circles != nullptr && elements_[i].is_turn && circles->radius_m < radius(i) * (1.0 - 1e-9);
    }
    /// Whether the path has a corner between an element and the next.
    bool has_corner(std::size_t i) const {
        return i + 1 < elements_.size() && drawn_[i].has_course && drawn_[i + 1].has_course &&
               is_bent(drawn_[i].end.course_deg, drawn_[i + 1].start.course_deg);
    }

    /// Whether the corner before a leg is no sharper than an arc can cut, and is not cut: the legs are too short.
    bool is_bound(std::size_t i) const {
        return i > 0 && is_leg(i - 1) && has_corner(i - 1) && cut_m(i - 1) == 0.0 &&
               std::abs(change_deg(drawn_[i - 1].end.course_deg, drawn_[i].start.course_deg)) <= max_cut_deg;
    }

    /// The length of a leg before its corner that an arc cuts; 0 where it cannot.
    double cut_m(std::size_t i) const {
        const auto available_m = [&](std::size_t leg) {
            const bool has_two = leg > 0 && has_corner(leg - 1) && has_corner(leg);
            return length_m(elements_[leg].shape) * (has_two ? 0.5 : 1.0);
        };
        if (!is_leg(i + 1) || !has_corner(i)) return 0.0;
        const double turn_deg = std::abs(change_deg(drawn_[i].end.course_deg, drawn_[i + 1].start.course_deg));
        const double needed_m = radius(i) * tangent_of(turn_deg / 2.0);
        const bool fits = turn_deg <= max_cut_deg && needed_m <= std::min(available_m(i), available_m(i + 1));
        return fits ? needed_m : 0.0;
    }

    void fly_leg(std::size_t i) {
        auto target = drawn_[i].end;
        const double cut = cut_m(i);
        const bool begins_bent = is_bent(at_.course_deg, drawn_[i].start.course_deg);
        const bool is_short = length_m(elements_[i].shape) < 2.0 * radius(i);
        is_entered_ = has_corner(i) && !is_leg(i + 1) && !is_replaced(i + 1);
        if (is_entered_)
            target = entry(i + 1);
        else if (begins_bent && is_short && cut == 0.0 && has_corner(i))
            target.course_deg = drawn_[i + 1].start.course_deg;
        else
            target.place = moved(target.place, -cut, target.course_deg);
        fly_to(i, target);
        if (cut == 0.0) return;
        const double turn_deg = change_deg(target.course_deg, drawn_[i + 1].start.course_deg);
        add(i, Circles{radius(i), std::abs(turn_deg) / 360.0, turn_deg > 0.0, target.course_deg});
        at_ = {moved(drawn_[i].end.place, cut, drawn_[i + 1].start.course_deg), drawn_[i + 1].start.course_deg};
    }

    void fly_circles(std::size_t i) {
        if (is_replaced(i) && is_replaced(i + 1)) return carry_height(i);
        if (is_replaced(i)) return fly_to(i, drawn_[i].end);
        auto element = elements_[i];
        auto& circles = std::get<Circles>(element.shape);
        if (!element.is_turn && circles.radius_m < least_radius(i) * (1.0 - 1e-9)) widened_.push_back(i);
        if (!std::exchange(is_entered_, false) && is_bent(at_.course_deg, drawn_[i].start.course_deg))
            fly_to(i, entry(i));
        else
            carry_height(i);
        circles.radius_m = flown_radius(i);
        circles.start_course_deg = at_.course_deg;
        element.altitude_change_m = std::exchange(height_m_, 0.0);
        at_ = {after(at_.place, element), at_.course_deg + (circles.to_right ? 360.0 : -360.0) * circles.turns};
        turned_.path.elements.push_back(std::move(element));
    }

    double flown_radius(std::size_t i) const {
        const double drawn_m = std::get<Circles>(elements_[i].shape).radius_m;
        return elements_[i].is_turn ? drawn_m : std::max(drawn_m, least_radius(i));
    }

    /// Where circles are entered: of their places the one with the shortest way there, from which they are counted.
    /// Parts of patterns are entered where they are drawn.
    Pose entry(std::size_t i) const {
        const auto& circles = std::get<Circles>(elements_[i].shape);
        const auto& start = drawn_[i].start;
        if (elements_[i].is_turn) return start;
        constexpr int steps = 72;
        const double side = circles.to_right ? 1.0 : -1.0;
        const auto centre = moved(start.place, circles.radius_m, start.course_deg + side * 90.0);
        Pose best;
        double least_m = std::numeric_limits<double>::infinity();
        for (int step = 0; step < steps; ++step) {
            const double course_deg = at_.course_deg + 360.0 * step / steps;
            const Pose tried{moved(centre, flown_radius(i), course_deg - side * 90.0), course_deg};
            double way_m = 0.0;
            for (const auto& shape : shortest_way(at_, tried, radius(i))) way_m += length_m(shape);
            if (way_m >= least_m) continue;
            least_m = way_m;
            best = tried;
        }
        return best;
    }

    void hold(std::size_t i) {
        turned_.path.elements.push_back(elements_[i]);
        turned_.path.elements.back().altitude_change_m += std::exchange(height_m_, 0.0);
        at_ = {after(at_.place, elements_[i]), drawn_[i].end.course_deg};
        if (i + 1 < elements_.size()) at_.course_deg = drawn_[i + 1].start.course_deg;
    }

    void carry_height(std::size_t i) { height_m_ += elements_[i].altitude_change_m; }

    /// Flies an element to a pose, straight where that leads there.
    void fly_to(std::size_t i, const Pose& target) {
        const double straight_m = distance_between_m(at_.place, target.place);
        const double course_deg = course_between(at_.place, target.place);
        const bool is_there = straight_m <= same_place_m && !is_bent(at_.course_deg, target.course_deg);
        const bool is_straight = straight_m > same_place_m && !is_bent(at_.course_deg, course_deg) &&
                                 !is_bent(target.course_deg, course_deg);
        carry_height(i);
        if (is_straight) {
            add_parts(i, {Leg{straight_m, std::fmod(course_deg + 360.0, 360.0)}});
        } else if (!is_there) {
            const auto shapes = shortest_way(at_, target, radius(i));
            if (is_replaced(i) || is_bound(i)) {
                bound_.push_back(i);
                for (const auto& shape : shapes) added_m_ += length_m(shape);
                added_m_ -= straight_m;
            }
            add_parts(i, shapes);
        }
        at_ = target;
    }

    void add(std::size_t i, const std::variant<Leg, Circles, Hold>& shape, double height_m = 0.0) {
        auto part = elements_[i];
        part.shape = shape;
        part.is_turn = std::holds_alternative<Circles>(shape);
        part.altitude_change_m = height_m;
        part.climb_rate_m_per_s.reset();
        turned_.path.elements.push_back(std::move(part));
    }

    /// Adds the parts of an element with its change of height: at its rate on a straight part where that is long
    /// enough, else evenly over all.
    void add_parts(std::size_t i, const std::vector<std::variant<Leg, Circles, Hold>>& shapes) {
        double all_m = 0.0;
        for (const auto& shape : shapes) all_m += length_m(shape);
        const auto& rate = elements_[i].climb_rate_m_per_s;
        const double height_m = std::exchange(height_m_, 0.0);
        bool is_left = true;
        const auto fits = [&](const std::variant<Leg, Circles, Hold>& shape) {
            const auto* leg = std::get_if<Leg>(&shape);
            const double airspeed = elements_[i].airspeed_m_per_s;
            if (leg == nullptr || !rate || *rate >= airspeed) return false;
            const auto speed = ground_speed_m_per_s(elements_[i], *rate, leg->course_deg, wind_);
            return speed && std::abs(height_m) / *rate * *speed < leg->length_m;
        };
        const bool has_rate = std::ranges::any_of(shapes, fits);
        for (const auto& shape : shapes) {
            if (!has_rate) {
                add(i, shape, height_m * length_m(shape) / all_m);
                continue;
            }
            const bool is_here = fits(shape) && std::exchange(is_left, false);
            add(i, shape, is_here ? height_m : 0.0);
            if (is_here) turned_.path.elements.back().climb_rate_m_per_s = rate;
        }
    }

    std::vector<std::string> names(const std::vector<std::size_t>& elements) const {
        std::vector<std::string> names;
        for (const auto i : elements)
            if (names.empty() || names.back() != elements_[i].name) names.push_back(elements_[i].name);
        return names;
    }

    void add_notes() {
        if (!widened_.empty()) {
            const auto i = widened_.front();
            turned_.notes.push_back(fmt::format(
                "{}: circles of {:.4g} m need a bank of more than {:g} degrees at {:.4g} m/s{}: they are flown with "
                "{:.4g} m",
                first_and_more(names(widened_)), std::get<Circles>(elements_[i].shape).radius_m, limits_.max_bank_deg,
                elements_[i].airspeed_m_per_s, wind_.speed_m_per_s > 0.0 ? " and this wind" : "", least_radius(i)));
        }
        if (bound_.empty()) return;
        const auto i = bound_.front();
        turned_.notes.push_back(fmt::format(
            "{}: the turn before it does not fit with a radius of {:.4g} m ({}{}): its corner is flown over, and the "
            "way from there is {:.2f} km longer{}",
            first_and_more(names(bound_)), radius(i),
            radius(i) > least_radius(i) ? "turn_radius_m" : fmt::format("a bank of {:g} degrees", limits_.max_bank_deg),
            wind_.speed_m_per_s > 0.0 ? " in this wind" : "", added_m_ / units::metre_per_kilometre,
            bound_.size() == 1 ? "" : " in all"));
    }

    const std::vector<PathElement>& elements_;
    const Wind& wind_;
    const TurnLimits& limits_;
    std::vector<Drawn> drawn_;
    TurnedPath turned_;
    Pose at_;
    double height_m_ = 0.0;    ///< change that is not flown yet
    double added_m_ = 0.0;     ///< by ways that are not straight
    bool is_entered_ = false;  ///< at the place where the next circles begin
    std::vector<std::size_t> bound_;
    std::vector<std::size_t> widened_;
};

/// What a rotorcraft takes to change its speed.
struct SpeedChange {
    double time_s = 0.0;
    double way_m = 0.0;
};

/// Between a slower speed and a faster one. From and to a stop, the acceleration grows and falls by the jerk; at a
/// corner the changes before and behind it overlap, so that it costs about as much as with the acceleration all along.
SpeedChange speed_change(double slow, double fast) {
    if (slow > 0.0)
        return {(fast - slow) / acceleration_m_per_s2, (fast * fast - slow * slow) / (2.0 * acceleration_m_per_s2)};
    const double growth_s = acceleration_m_per_s2 / jerk_m_per_s3;
    const double time_s = fast < acceleration_m_per_s2 * growth_s ? 2.0 * std::sqrt(fast / jerk_m_per_s3)
                                                                  : fast / acceleration_m_per_s2 + growth_s;
    return {time_s, fast / 2.0 * time_s};
}

/// The greatest speed up to `most` whose changes fit on a way; `least` if none does.
template <typename ChangingWay>
double fitting_speed(double least, double most, double way_m, const ChangingWay& changing_m) {
    if (changing_m(most) <= way_m) return most;
    constexpr int halvings = 50;
    for (int i = 0; i < halvings; ++i) {
        const double speed = std::midpoint(least, most);
        (changing_m(speed) <= way_m ? least : most) = speed;
    }
    return least;
}

/// Adds the times that a rotorcraft loses at corners.
class RotorcraftTurns {
  public:
    RotorcraftTurns(const FlightPath& drawn, const Wind& wind, const TurnLimits& limits)
        : elements_(drawn.elements), wind_(wind), limits_(limits), drawn_(drawn_poses(drawn)) {}

    TurnedPath fly() {
        for (auto& element : elements_) slow_down(element);
        const auto speeds = corner_speeds();
        TurnedPath turned;
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            turned.path.elements.push_back(elements_[i]);
            const double lost = drawn_[i].has_course ? lost_s(i, speeds[i], speeds[i + 1]) : 0.0;
            if (lost < min_lost_s) continue;
            auto braking = elements_[i];
            braking.shape = Hold{lost, Leg{0.0, std::fmod(drawn_[i].end.course_deg + 360.0, 360.0)}};
            braking.is_turn = true;
            braking.altitude_change_m = 0.0;
            braking.climb_rate_m_per_s.reset();
            turned.path.elements.push_back(std::move(braking));
        }
        turned.notes = std::move(notes_);
        return turned;
    }

  private:
    static constexpr double min_lost_s = 1e-3;

    /// Flies circles as fast as the bank permits.
    void slow_down(PathElement& element) {
        const auto* circles = std::get_if<Circles>(&element.shape);
        if (circles == nullptr) return;
        const double wind = element.keeps_ground_speed ? 0.0 : wind_.speed_m_per_s;
        const double most =
            std::sqrt(units::standard_gravity_m_per_s2 * circles->radius_m * tangent_of(limits_.max_bank_deg)) - wind;
        if (element.airspeed_m_per_s <= most || most <= wind) return;
        if (notes_.empty())
            notes_.push_back(fmt::format(
                "{}: circles of {:.4g} m are flown at {:.3g} m/s: {:.4g} m/s need a bank of more than {:g} degrees",
                element.name, circles->radius_m, most, element.airspeed_m_per_s, limits_.max_bank_deg));
        element.airspeed_m_per_s = most;
    }

    double speed(std::size_t i) const {
        const auto* leg = std::get_if<Leg>(&elements_[i].shape);
        if (leg == nullptr) return elements_[i].airspeed_m_per_s;
        return ground_speed_m_per_s(elements_[i], 0.0, leg->course_deg, wind_).value_or(elements_[i].airspeed_m_per_s);
    }

    /// The ground speed before each element, and at the end: the one that the acceleration permits at the corner, on a
    /// circle within its radius of acceptance, and that can be reached from the corners around it.
    std::vector<double> corner_speeds() const {
        const auto count = elements_.size();
        std::vector<double> speeds(count + 1, 0.0);  // it begins and ends in hover, and holds
        const auto is_measured = [&](std::size_t i) {
            const auto* hold = std::get_if<Hold>(&elements_[i].shape);
            return hold != nullptr && hold->over_ground;
        };
        for (std::size_t i = 0; i <= count; ++i) {
            const bool has_before = i > 0 && drawn_[i - 1].has_course;
            const bool has_next = i < count && drawn_[i].has_course;
            if (has_before && has_next) {
                const double turn_deg = std::abs(change_deg(drawn_[i - 1].end.course_deg, drawn_[i].start.course_deg));
                const double tangent = std::max(tangent_of(std::min(turn_deg, 179.9) / 2.0), 1e-9);
                speeds[i] =
                    std::min({speed(i - 1), speed(i), std::sqrt(acceleration_m_per_s2 * corner_radius_m / tangent)});
            } else if ((i > 0 && is_measured(i - 1)) || (i < count && is_measured(i))) {
                speeds[i] = has_before ? speed(i - 1) : has_next ? speed(i) : 0.0;  // its time has the braking
            }
        }
        const auto reach = [&](std::size_t i, std::size_t from, std::size_t to) {
            if (!drawn_[i].has_course || speeds[to] <= speeds[from]) return;
            speeds[to] = fitting_speed(speeds[from], speeds[to], length_m(elements_[i].shape),
                                       [&](double speed) { return speed_change(speeds[from], speed).way_m; });
        };
        for (std::size_t i = 0; i < count; ++i) reach(i, i, i + 1);
        for (std::size_t i = count; i-- > 0;) reach(i, i + 1, i);
        return speeds;
    }

    /// The time beyond that of the element's speed all along.
    double lost_s(std::size_t i, double begin, double end) const {
        const double cruise = speed(i);
        const double way_m = length_m(elements_[i].shape);
        const double peak = fitting_speed(std::max(begin, end), cruise, way_m, [&](double speed) {
            return speed_change(begin, speed).way_m + speed_change(end, speed).way_m;
        });
        const auto from = speed_change(begin, peak);
        const auto to = speed_change(end, peak);
        return std::max(0.0, from.time_s + to.time_s - std::min(from.way_m + to.way_m, way_m) / cruise);
    }

    std::vector<PathElement> elements_;
    const Wind& wind_;
    const TurnLimits& limits_;
    std::vector<Drawn> drawn_;
    std::vector<std::string> notes_;
};

}  // namespace

double turn_radius_m(double airspeed_m_per_s, double bank_deg, double wind_m_per_s) {
    const double speed = airspeed_m_per_s + wind_m_per_s;
    return speed * speed / (units::standard_gravity_m_per_s2 * tangent_of(bank_deg));
}

double circle_time_s(double radius_m, double airspeed_m_per_s, const Wind& wind, const TurnLimits& limits) {
    const double bank_tangent = tangent_of(limits.max_bank_deg);
    PathElement circle;
    circle.airspeed_m_per_s = airspeed_m_per_s;
    if (limits.is_rotorcraft) {
        circle.keeps_ground_speed = true;
        circle.airspeed_m_per_s =
            std::min(airspeed_m_per_s, std::sqrt(units::standard_gravity_m_per_s2 * radius_m * bank_tangent));
    } else {
        radius_m = std::max(radius_m, turn_radius_m(airspeed_m_per_s, limits.max_bank_deg, wind.speed_m_per_s));
    }
    circle.shape = Circles{radius_m, 1.0};
    return compute_trajectory({{circle}}, wind, InfeasibleLegPolicy::crawl).duration_s;
}

TurnedPath fly_turns(const FlightPath& drawn, const Wind& wind, const TurnLimits& limits) {
    auto numbered = drawn;
    for (std::size_t i = 0; i < drawn.elements.size(); ++i) numbered.elements[i].drawn = i;
    return limits.is_rotorcraft ? RotorcraftTurns(numbered, wind, limits).fly()
                                : WingTurns(numbered, wind, limits).fly();
}

}  // namespace flightwatt::path
