#include "mission/feasibility_limits.h"

#include "base/duration_text.h"
#include "base/error.h"
#include "base/units.h"
#include "mission/planning/limit_search.h"
#include "mission/planning/planner.h"
#include "mission/sampling/landing_distribution.h"
#include "path/path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <variant>
#include <vector>

#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

constexpr double longest_cruise_s = 1e7;
constexpr double shortest_cruise_s = 1.0;
constexpr double largest_payload_w = 1e6;
constexpr double max_circles_tried = 1e4;

/// The last value known to have a surplus, and a greater one that has none; each may be missing.
struct Bracket {
    std::optional<double> good;
    std::optional<double> bad;
    double low = 0.0;  ///< `good`, or a greater value that is too small for the schedule
};

/// Doubles `value` until there is no surplus, at most up to `max_value`.
Bracket find_bracket(LimitSearch& search, double value, double max_value) {
    Bracket bracket;
    for (; value <= max_value; value *= 2.0) {
        const auto surplus = search.surplus(value);
        if (surplus && *surplus < 0.0) {
            bracket.bad = value;
            return bracket;
        }
        if (surplus) bracket.good = value;
        bracket.low = value;
    }
    return bracket;
}

/// Narrows a bracket with a bad value to the accuracy of the search, or to neighbouring whole numbers. Values that do
/// not fit the schedule are too small.
Bracket refine(LimitSearch& search, Bracket bracket, bool is_whole = false) {
    constexpr double of_misfit = 100.0;
    const auto at = [&](double value) { return is_whole ? std::floor(value) : value; };
    const auto surplus = [&](double value) {
        const double percent = search.surplus(at(value)).value_or(of_misfit);
        return percent >= 0.0 ? std::max(percent, std::numeric_limits<double>::min()) : percent;
    };
    const double accuracy = is_whole ? 0.5 : search.relative_accuracy() * *bracket.bad;
    const auto is_close = [&](double low, double high) { return high - low <= accuracy; };
    const double surplus_low = bracket.low > 0.0 ? surplus(bracket.low) : of_misfit;
    std::uintmax_t iterations = 300;
    const auto [low, high] = boost::math::tools::toms748_solve(surplus, bracket.low, *bracket.bad, surplus_low,
                                                               surplus(*bracket.bad), is_close, iterations);
    bracket.low = at(low);
    bracket.bad = at(high);
    bracket.good = bracket.low > 0.0 && search.surplus(bracket.low) ? std::optional(bracket.low) : std::nullopt;
    return bracket;
}

/// Its interval, if it has one, in proportion.
Mission with_capacity(Mission mission, double capacity_ah) {
    auto& battery = mission.setup.battery;
    if (auto& interval = battery.intervals.capacity_ah) {
        interval->low *= capacity_ah / battery.capacity_ah;
        interval->high *= capacity_ah / battery.capacity_ah;
    }
    battery.capacity_ah = capacity_ah;
    return mission;
}

/// The longest distance that can be flown at all: a leg may be infeasible on the way back, and with it all that follow.
std::optional<double> longest_that_fits(LimitSearch& search, double max_m) {
    constexpr int tried = 64;
    if (search.fits(max_m)) return max_m;
    double high = max_m;
    for (int k = tried - 1; k > 0; --k, high -= max_m / tried) {
        double low = max_m * k / tried;
        if (!search.fits(low)) continue;
        while (high - low > search.relative_accuracy() * max_m) {
            const double middle = std::midpoint(low, high);
            (search.fits(middle) ? low : high) = middle;
        }
        return low;
    }
    return std::nullopt;
}

[[noreturn]] void refuse(const LimitSearch& search, const std::string& message) {
    if (search.misfit()) throw *search.misfit();
    throw NoResultError(message);
}

}  // namespace

FeasibilityLimit longest_cruise(const MissionVariation& with_cruise_s, const std::optional<double>& probability) {
    LimitSearch search(with_cruise_s, probability);
    auto bracket = find_bracket(search, shortest_cruise_s, longest_cruise_s);
    if (!bracket.bad && bracket.good)
        throw NoResultError(fmt::format("a cruise of {:.3g} s still lands with the reserve", *bracket.good));
    if (!bracket.bad)  // as of a planned schedule, without `otherwise`
        throw InputError(search.misfit()->where(), "the schedule fits one length of the cruise only",
                         "use the mission that it was planned from, or add an entry with `otherwise = true`");
    bracket = refine(search, bracket);
    if (!bracket.good)
        throw NoResultError(
            fmt::format("even with a cruise of {:.6g} s, the shortest that fits the schedule, the "
                        "mission does not land with its reserve{}",
                        *bracket.bad, search.share_text()));
    return search.limit(*bracket.good, std::nextafter(*bracket.good, longest_cruise_s) * (1.0 + 1e-9));
}

Mission with_payload(const Mission& mission, double payload_w) {
    auto loaded = mission;
    const auto index = loaded.setup.compute.components.size();
    loaded.setup.compute.components.push_back(
        {"payload", compute::make_power_profile("payload", {}, {{{}, payload_w, {}}})});
    if (!loaded.setup.utilities.empty()) loaded.setup.utilities.resize(index + 1);
    loaded.setup.uncertainty.compute_sd_percent.resize(index + 1);
    for (auto& segment : loaded.schedule) segment.run.push_back({index, {}});
    return loaded;
}

FeasibilityLimit largest_payload(const MissionVariant& mission, const std::optional<double>& probability) {
    const auto bare = with_minimum_energy_schedule(mission);
    LimitSearch search([&](double payload_w) { return with_payload(bare, payload_w); }, probability);
    if (const double surplus = search.surplus(0.0).value(); surplus < 0.0) {
        if (const auto summary = simulate(bare).summary; !summary.feasible)
            throw NoResultError("without any payload already: " + describe(summary));
        throw NoResultError(fmt::format("without any payload the mission misses its reserve by {:.4g} points already{}",
                                        -surplus, search.share_text()));
    }
    auto bracket = find_bracket(search, 1.0, largest_payload_w);
    if (!bracket.bad)
        throw NoResultError(
            fmt::format("a payload of {:.3g} W still lands with the reserve", bracket.good.value_or(0.0)));
    const double payload_w = refine(search, bracket).low;
    auto most = search.limit(payload_w, payload_w * (1.0 + 1e-9) + 1e-9);
    if (probability) most.sources = collect_uncertainty(bare.setup).sources;
    return most;
}

std::optional<double> min_capacity_ah(const MissionVariant& mission, const std::optional<double>& probability) {
    constexpr double max_times = 1000.0;
    const auto bare = with_minimum_energy_schedule(mission);
    const double own_ah = bare.setup.battery.capacity_ah;
    LimitSearch search([&](double times_less) { return with_capacity(bare, own_ah / times_less); }, probability);
    double times_less = 1.0;
    for (; search.surplus(times_less).value() < 0.0; times_less /= 2.0)
        if (times_less * max_times < 1.0) return std::nullopt;
    auto bracket = find_bracket(search, times_less, max_times);
    return own_ah / (bracket.bad ? refine(search, bracket).low : bracket.low);
}

FeasibilityLimit max_circles(const MissionVariation& with_circles, const std::optional<double>& probability) {
    LimitSearch search(with_circles, probability);
    auto bracket = find_bracket(search, 1.0, max_circles_tried);
    if (!bracket.bad) {
        if (bracket.good) throw NoResultError(fmt::format("{:.0f} circles still land with the reserve", *bracket.good));
        refuse(search, "the mission does not land with its reserve");
    }
    if (*bracket.bad > 1.0) bracket = refine(search, bracket, true);
    if (!bracket.good) throw NoResultError("the fewest circles that fit do not land with the reserve");
    return search.limit(*bracket.good, *bracket.good + 1.0);
}

FeasibilityLimit farthest_return(const MissionVariation& with_return_after_m, double length_m,
                                 const std::optional<double>& probability) {
    if (!(length_m > 0.0))
        throw NoResultError(
            "the path has no legs along which to return: holds, and ways to a place with duration_s, are not legs");
    LimitSearch search(with_return_after_m, probability);
    const auto max_m = longest_that_fits(search, length_m);
    if (!max_m) refuse(search, "the path cannot be flown there and back");
    if (search.surplus(*max_m).value() >= 0.0) return search.limit(*max_m, *max_m);
    const auto bracket = refine(search, {std::nullopt, *max_m, 0.0});
    if (!bracket.good) throw NoResultError("from nowhere along the path does the mission return with its reserve");
    return search.limit(*bracket.good, std::min(*max_m, *bracket.bad));
}

ReachUnit reach_unit_of(const MissionSetup& mission) {
    if (!mission.cruise_path) return ReachUnit::cruise_s;
    const bool has_circles = std::ranges::any_of(mission.cruise_path->plan->path.elements, [](const auto& element) {
        return std::holds_alternative<path::Circles>(element.shape);
    });
    return has_circles ? ReachUnit::circles : ReachUnit::return_m;
}

Reach find_reach(const MissionLoader& mission_of, const std::optional<double>& probability) {
    const auto mission = mission_of({.allow_unplanned = true});
    const auto& setup = setup_of(mission);
    const auto unit = reach_unit_of(setup);
    const MissionVariation variation = [&](double value) {
        MissionReadOptions reading{.allow_unplanned = true};
        (unit == ReachUnit::cruise_s  ? reading.cruise_s
         : unit == ReachUnit::circles ? reading.circles
                                      : reading.return_after_m) = value;
        return mission_of(reading);
    };
    if (unit == ReachUnit::cruise_s) return {unit, longest_cruise(variation, probability)};
    if (unit == ReachUnit::circles) return {unit, max_circles(variation, probability)};
    return {unit, farthest_return(variation, length_of_legs_m(setup.cruise_path->plan->path), probability)};
}

namespace {

std::optional<double> cruise_that_lands(const MissionVariation& with_cruise_s,
                                        const std::optional<double>& probability) {
    try {
        return longest_cruise(with_cruise_s, probability).value;
    } catch (const NoResultError&) {
        return std::nullopt;
    }
}

std::optional<double> surplus_without_fixed(PlanningProblem problem, const std::optional<double>& probability) {
    if (problem.fixed.empty()) return std::nullopt;
    problem.fixed.clear();
    const double percent = LimitSearch([&](double) { return problem; }, probability).surplus(0.0).value();
    return percent < 0.0 ? std::nullopt : std::optional(percent);
}

/// A shorter cruise; where its duration differs between flights, a stated one, which may be longer.
std::string cruise_remedy(const MissionSetup& mission, const InfeasibilityReport& report) {
    const double now_s = mission.duration_s[Phase::cruise];
    if (!report.cruise_differs_now)
        return fmt::format("a cruise {} shorter ({:.1f} s: {})", duration_text(now_s - *report.cruise_s),
                           *report.cruise_s, duration_text(*report.cruise_s));
    return describe_stated_cruise(*report.cruise_s, now_s);
}

}  // namespace

bool cruise_duration_varies(const MissionSetup& mission) {
    return !mission.duration_is_stated[Phase::cruise] && !mission.uncertainty.duration_sd_s[Phase::cruise] &&
           collect_uncertainty(mission).duration_sd_s[Phase::cruise] > 0.0;
}

std::string describe_stated_cruise(double max_s, double now_s) {
    const double stated_s = std::floor(max_s * 10.0) / 10.0;  // must land as printed
    return fmt::format(
        "a stated cruise of at most {} (duration_s = {{ cruise = {:.1f} }}: the {} of the model's flights differ from "
        "flight to flight)",
        duration_text(stated_s), stated_s, duration_text(now_s));
}

InfeasibilityReport infeasibility_report(const PlanningProblem& problem, const MissionPlan& plan,
                                         const MissionVariation& with_cruise_s,
                                         const std::optional<double>& probability) {
    InfeasibilityReport report;
    const double possible = plan.plan.final_soc_percent - plan.margin_percent;
    report.shortfall_percent = problem.setup.reserve_soc_percent - possible;
    report.shortfall_wh = units::amount_from_percent(full_energy_wh(problem.setup.battery), report.shortfall_percent);
    report.cut_off_at_s = plan.summary.cut_off_at_s;
    report.cruise_s = cruise_that_lands(with_cruise_s, probability);
    report.cruise_differs_now = probability && cruise_duration_varies(problem.setup);
    report.min_fixed_surplus_percent = surplus_without_fixed(problem, probability);
    if (possible >= 0.0 && plan.summary.feasible) report.reserve_soc_percent = possible;
    report.capacity_ah = min_capacity_ah(problem, probability);
    return report;
}

std::string describe(const MissionSetup& mission, const InfeasibilityReport& report) {
    std::vector<std::string> remedies;
    if (report.cruise_s) remedies.push_back(cruise_remedy(mission, report));
    if (report.min_fixed_surplus_percent) {
        remedies.push_back(fmt::format("lower quality where it is fixed (the least leaves {:.2f} points to spare)",
                                       *report.min_fixed_surplus_percent));
    }
    if (report.reserve_soc_percent)
        remedies.push_back(fmt::format("a reserve of at most {:.2f} %", *report.reserve_soc_percent));
    if (report.capacity_ah) {
        remedies.push_back(fmt::format("a battery of {:.3f} Ah instead of {:.3f} Ah", *report.capacity_ah,
                                       mission.battery.capacity_ah));
    }
    auto text = fmt::format(
        "no schedule lands with the reserve: the one that demands least energy is {}short by {:.2f} points "
        "({:.3f} Wh)",
        report.cut_off_at_s ? fmt::format("cut off after {}, ", duration_text(*report.cut_off_at_s)) : "",
        report.shortfall_percent, report.shortfall_wh);
    if (!remedies.empty()) text += fmt::format("; any one of these would do: {}", fmt::join(remedies, ", "));
    return text;
}

}  // namespace flightwatt::mission
