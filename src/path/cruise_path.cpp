#include "path/cruise_path.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

constexpr double steep_load_factor = 2.0;  // a bank of 60 degrees

constexpr double same_power_fraction = 1e-12;

/// A piece is long enough for its power to follow from the energies at its ends.
constexpr double min_piece_s = 1e-6;

/// Neighbours of the same power become one piece; a shorter one becomes part of the next.
PiecewisePower power_pieces(const mechanical::PhysicalModel& model, const PathTrajectory& flown, double factor) {
    PiecewisePower pieces;
    std::optional<double> last_w;
    double end_s = 0.0;
    double end_j = 0.0;
    for (const auto& [time_s, motion, element] : flown.pieces) {
        const double power_w = factor * mechanical::power_w(model, motion);
        end_s += time_s;
        end_j += power_w * time_s;
        if (end_s - pieces.time_s.back() < min_piece_s) continue;
        const bool is_same = last_w && std::abs(power_w - *last_w) <= same_power_fraction * std::abs(*last_w);
        if (!is_same) {
            pieces.time_s.push_back(0.0);
            pieces.energy_j.push_back(0.0);
        }
        pieces.time_s.back() = end_s;
        pieces.energy_j.back() = end_j;
        last_w = power_w;
    }
    if (pieces.time_s.size() == 1) {
        end_s = std::max(end_s, min_piece_s);
        pieces = {{0.0, end_s}, {0.0, end_j}};
    }
    pieces.time_s.back() = end_s;
    pieces.energy_j.back() = end_j;
    return pieces;
}

/// "12.1 to 14.9 m/s".
std::string range_text(const Interval& range) { return fmt::format("{:.4g} to {:.4g} m/s", range.low, range.high); }

}  // namespace

FlightPath as_flown(const PlannedPath& plan, FlightPath drawn) {
    return plan.turns ? fly_turns(drawn, plan.wind, *plan.turns).path : std::move(drawn);
}

CruisePath compute_cruise(std::shared_ptr<const PlannedPath> plan, const Wind& wind,
                          InfeasibleLegPolicy infeasible_legs, double factor) {
    const auto flown = compute_trajectory(plan->path, wind, infeasible_legs);
    CruisePath cruise;
    cruise.pieces = std::make_shared<const PiecewisePower>(power_pieces(plan->power, flown, factor));
    cruise.is_infeasible = !flown.infeasible_elements.empty();
    cruise.plan = std::move(plan);
    return cruise;
}

double duration_s(const CruisePath& cruise) { return cruise.pieces->time_s.back(); }

double energy_j(const CruisePath& cruise) { return cruise.pieces->energy_j.back(); }

double mean_power_w(const CruisePath& cruise) { return energy_j(cruise) / duration_s(cruise); }

std::vector<PathElementResult> path_element_results(const PlannedPath& plan) {
    const auto flown = compute_trajectory(plan.path, plan.wind);
    std::vector<PathElementResult> elements;
    double start_s = 0.0;
    for (std::size_t i = 0; i < plan.path.elements.size(); ++i) {
        const auto& element = plan.path.elements[i];
        PathElementResult row;
        row.name = element.name;
        row.kind = "hold";
        row.start_s = start_s;
        row.duration_s = flown.element_s[i];
        row.airspeed_m_per_s = element.airspeed_m_per_s;
        const auto* hold = std::get_if<Hold>(&element.shape);
        const auto* timed = hold != nullptr && hold->over_ground ? &*hold->over_ground : nullptr;
        if (const auto* leg = hold != nullptr ? timed : std::get_if<Leg>(&element.shape)) {
            row.kind = "leg";
            row.length_m = leg->length_m;
            row.course_deg = leg->course_deg;
        } else if (const auto* circles = std::get_if<Circles>(&element.shape)) {
            row.kind = "circles";
            row.length_m = units::rad_from_turns(circles->turns) * circles->radius_m;
        }
        if (element.is_turn) row.kind = "turn";
        start_s += row.duration_s;
        row.load_factor = 0.0;
        elements.push_back(std::move(row));
    }
    for (const auto& [time_s, motion, index] : flown.pieces) {
        auto& row = elements[index];
        const double part = time_s / row.duration_s;
        row.airspeed_m_per_s += part * (motion.airspeed_m_per_s - plan.path.elements[index].airspeed_m_per_s);
        row.climb_m_per_s += part * motion.climb_m_per_s;
        row.load_factor += part * motion.load_factor * motion.load_factor;
        row.mechanical_w += part * mechanical::power_w(plan.power, motion);
    }
    for (auto& row : elements) row.load_factor = std::sqrt(row.load_factor);
    return elements;
}

mechanical::TermValues mean_terms(const mechanical::PhysicalModel& model, const PathTrajectory& flown) {
    mechanical::TermValues sums;
    for (const auto& piece : flown.pieces) {
        const auto terms = mechanical::term_values(piece.motion, model.load);
        if (sum_of_terms_w(model, terms) < 0.0) continue;
        for (const auto term : mechanical::all_power_terms) sums[term] += terms[term] * piece.time_s / flown.duration_s;
    }
    return sums;
}

std::optional<PathSpeed> best_path_speed(const PlannedPath& plan) {
    auto model = mechanical::speed_model(plan.power);
    if (!model) return std::nullopt;
    add_turns_of_induced_drag(*model);
    const auto terms_wh = [&](const FlightPath& path) {
        const auto flown = compute_trajectory(path, plan.wind);
        auto terms = mean_terms(*model, flown);
        for (auto& value : terms.values) value *= units::wh_from_joule(flown.duration_s);
        return terms;
    };
    const auto at_airspeed = [&](double airspeed) -> std::optional<mechanical::TermValues> {
        auto path = drawn_path(plan);
        for (auto& element : path.elements) element.airspeed_m_per_s = airspeed;
        try {
            return terms_wh(as_flown(plan, path));
        } catch (const InputError&) {  // the wind forbids an element, or a climb is too steep
            return std::nullopt;
        }
    };
    return PathSpeed{best_speed(*model, "least energy on this path", "Wh", at_airspeed),
                     sum_of_terms_w(*model, terms_wh(plan.path))};
}

bool has_steep_turn(const PathTrajectory& flown) {
    return std::ranges::any_of(flown.pieces,
                               [](const auto& piece) { return piece.motion.load_factor > steep_load_factor; });
}

double part_far_beyond(const PlannedPath& plan, const PathTrajectory& flown) {
    constexpr double part_more = 0.2;  // of the airspeed: the drag is 44 % more
    const auto& [slowest_flown, fastest] = plan.power.airspeed_m_per_s;
    const double slowest = plan.turns && plan.turns->is_rotorcraft ? 0.0 : slowest_flown;  // all hover
    double beyond_s = 0.0;
    for (const auto& piece : flown.pieces) {
        const auto& motion = piece.motion;
        const bool is_near = motion.airspeed_m_per_s >= slowest * (1.0 - part_more) &&
                             motion.airspeed_m_per_s <= fastest * (1.0 + part_more) &&
                             is_near_flown_climb(plan.power, motion.climb_m_per_s);
        if (!is_near) beyond_s += piece.time_s;
    }
    return flown.duration_s > 0.0 ? beyond_s / flown.duration_s : 0.0;
}

std::vector<std::string> path_warnings(const PlannedPath& plan, const PathTrajectory& flown) {
    constexpr double felt_load_factor = 1.1;  // a tenth more lift is a fifth more drag of lift
    std::vector<std::string> warnings;
    const auto name_of = [&](const TrajectorySegment& piece) { return plan.path.elements[piece.element].name; };
    const auto is_flown = [&](const TrajectorySegment& piece) {
        return is_within_flown_range(plan.power, piece.motion);
    };
    if (const auto beyond = std::ranges::find_if_not(flown.pieces, is_flown); beyond != flown.pieces.end()) {
        warnings.push_back(fmt::format(
            "{}: {:.4g} m/s with a climb of {:.3g} m/s is beyond what the model's flights flew ({}, climb {}): its "
            "power is extrapolated",
            name_of(*beyond), beyond->motion.airspeed_m_per_s, beyond->motion.climb_m_per_s,
            range_text(plan.power.airspeed_m_per_s), range_text(plan.power.climb_m_per_s)));
    }
    const auto load_of = [](const TrajectorySegment& piece) { return piece.motion.load_factor; };
    const auto steepest = std::ranges::max_element(flown.pieces, {}, load_of);
    if (steepest == flown.pieces.end()) return warnings;
    if (load_of(*steepest) > steep_load_factor) {
        const double bank_deg = std::acos(1.0 / load_of(*steepest)) * units::degree_per_rad;
        warnings.push_back(fmt::format("{}: such a turn takes a bank of {:.0f} degrees", name_of(*steepest), bank_deg));
    }
    if (load_of(*steepest) > felt_load_factor && !std::ranges::count(plan.power.terms, mechanical::PowerTerm::turn)) {
        warnings.push_back(
            fmt::format("its turns take up to {:.2f} times the lift of straight flight, and the model has no term for "
                        "turns: they are taken to cost nothing",
                        load_of(*steepest)));
    }
    return warnings;
}

}  // namespace flightwatt::path
