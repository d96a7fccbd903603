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

/// Two values, the first with a surplus and the second without, if there is such a one.
struct Bracket {
    double good = 0.0;
    std::optional<double> bad;
};

/// From a good value on: `tried.bad`, and so on times `factor` up to `last`.
Bracket bracket_of(const LimitSearch& search, Bracket tried, double factor, double last) {
    while (search.surplus(*tried.bad) >= 0.0) {
        const double next = *tried.bad * factor;
        tried = {*tried.bad, next};
        if (factor > 1.0 ? next > last : next < last) return {tried.good, std::nullopt};
    }
    return tried;
}

/// The last value with a surplus, between `good` where there is one and `bad` where there is none.
double last_good(const LimitSearch& search, double good, double bad) {
    const double surplus_good = search.surplus(good);
    const double surplus_bad = search.surplus(bad);
    if (surplus_good == 0.0) return good;
    std::uintmax_t iterations = 200;
    const auto [low, high] = boost::math::tools::toms748_solve(
        [&](double value) { return search.surplus(value); }, std::min(good, bad), std::max(good, bad),
        good < bad ? surplus_good : surplus_bad, good < bad ? surplus_bad : surplus_good,
        boost::math::tools::eps_tolerance<double>(search.accurate_bits()), iterations);
    return search.surplus(high) >= 0.0 ? high : search.surplus(low) >= 0.0 ? low : good;
}

/// A cruise short enough to land with the reserve, below `too_long_s`.
double short_enough_s(LimitSearch& search, double too_long_s) {
    double fits_s = too_long_s;
    double too_short_s = 0.0;
    for (double cruise_s = too_long_s / 2.0; cruise_s >= shortest_cruise_s;) {
        if (const auto mission = search.mission_if_it_fits(cruise_s)) {
            if (search.surplus(*mission) >= 0.0) return cruise_s;
            fits_s = cruise_s;
        } else {
            too_short_s = cruise_s;
        }
        cruise_s = (fits_s + too_short_s) / 2.0;
        if (too_short_s > 0.0 && fits_s - too_short_s < 1e-6 * fits_s) break;
    }
    throw NoResultError(
        fmt::format("even with a cruise of {:.6g} s, the shortest that fits the schedule, the "
                    "mission does not land with its reserve{}",
                    fits_s, search.share_text()));
}

double find_cruise_s(LimitSearch& search) {
    // From a length that fits: schedules may need so much, never so little.
    double fits_s = shortest_cruise_s;
    while (!search.mission_if_it_fits(fits_s)) {
        // A schedule that was planned says what runs for as long as it was planned, and no longer.
        if (fits_s >= longest_cruise_s)
            throw InputError(search.misfit()->where(), "the schedule says what runs for one length of the cruise alone",
                             "ask the mission that it was planned from, or add an entry with `otherwise = true`");
        fits_s *= 2.0;
    }
    Bracket bracket{0.0, fits_s};
    if (search.surplus(fits_s) < 0.0)
        bracket.good = short_enough_s(search, fits_s);
    else
        bracket = bracket_of(search, {fits_s, 2.0 * fits_s}, 2.0, longest_cruise_s);
    if (!bracket.bad)
        throw NoResultError(fmt::format("a cruise of {:.3g} s still lands with the reserve", bracket.good));
    return last_good(search, bracket.good, *bracket.bad);
}

double find_payload_w(const LimitSearch& search) {
    if (const double surplus = search.surplus(0.0); surplus < 0.0) {
        if (const auto summary = simulate(search.mission(0.0)).summary; !summary.feasible)
            throw NoResultError("without any payload already: " + describe(summary));
        throw NoResultError(fmt::format("without any payload the mission misses its reserve by {:.4g} points already{}",
                                        -surplus, search.share_text()));
    }
    const auto bracket = bracket_of(search, {0.0, 1.0}, 2.0, largest_payload_w);
    if (!bracket.bad)
        throw NoResultError(fmt::format("a payload of {:.3g} W still lands with the reserve", bracket.good));
    return last_good(search, bracket.good, *bracket.bad);
}

double find_capacity_ah(const LimitSearch& search, double own_ah) {
    constexpr double max_times = 1000.0;
    double good_ah = own_ah;
    while (search.surplus(good_ah) < 0.0) {
        good_ah *= 2.0;
        if (good_ah > max_times * own_ah) throw NoResultError("no capacity is enough");
    }
    const auto bracket = bracket_of(search, {good_ah, good_ah / 2.0}, 0.5, own_ah / max_times);
    return bracket.bad ? last_good(search, bracket.good, *bracket.bad) : bracket.good;
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

/// The longest that can be flown at all, to within `apart`: a leg may forbid the way back of all that lie behind it.
std::optional<double> longest_that_fits(LimitSearch& search, double most, double apart) {
    constexpr int tried = 64;
    if (search.mission_if_it_fits(most)) return most;
    double high = most;
    for (int k = tried - 1; k > 0; --k, high -= most / tried) {
        double low = most * k / tried;
        if (!search.mission_if_it_fits(low)) continue;
        while (high - low > apart) {
            const double middle = std::midpoint(low, high);
            (search.mission_if_it_fits(middle) ? low : high) = middle;
        }
        return low;
    }
    return std::nullopt;
}

/// Halves what lies between an extent that is too short or good and one that is too long, until they are `apart`.
std::optional<double> bisected(LimitSearch& search, double low, double high, double apart) {
    std::optional<double> good;
    while (high - low > apart) {
        const double middle = apart == 1.0 ? std::floor(std::midpoint(low, high)) : std::midpoint(low, high);
        const auto surplus = search.surplus_if_it_fits(middle);
        if (surplus && *surplus < 0.0) {
            high = middle;
        } else {
            low = middle;
            if (surplus) good = middle;
        }
    }
    return good;
}

[[noreturn]] void refuse(const LimitSearch& search, const std::string& message) {
    if (search.misfit()) throw *search.misfit();
    throw NoResultError(message);
}

}  // namespace

FeasibilityLimit longest_cruise(const MissionVariation& with_cruise_s, const std::optional<double>& probability) {
    LimitSearch search(with_cruise_s, probability);
    const double cruise_s = find_cruise_s(search);
    return search.limit(cruise_s, std::nextafter(cruise_s, longest_cruise_s) * (1.0 + 1e-9));
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
    const double payload_w = find_payload_w(search);
    auto most = search.limit(payload_w, payload_w * (1.0 + 1e-9) + 1e-9);
    if (probability) most.sources = collect_uncertainty(bare.setup).sources;
    return most;
}

std::optional<double> min_capacity_ah(const MissionVariant& mission, const std::optional<double>& probability) {
    const auto bare = with_minimum_energy_schedule(mission);
    LimitSearch search([&](double capacity_ah) { return with_capacity(bare, capacity_ah); }, probability);
    try {
        return find_capacity_ah(search, bare.setup.battery.capacity_ah);
    } catch (const NoResultError&) {
        return std::nullopt;
    }
}

FeasibilityLimit max_circles(const MissionVariation& with_circles, const std::optional<double>& probability) {
    LimitSearch search(with_circles, probability);
    double low = 0.0;
    std::optional<double> good;
    double high = 1.0;
    while (high <= max_circles_tried) {
        const auto surplus = search.surplus_if_it_fits(high);
        if (surplus && *surplus < 0.0) break;
        low = high;
        if (surplus) good = high;
        high *= 2.0;
    }
    if (high > max_circles_tried) {
        if (good) throw NoResultError(fmt::format("{:.0f} circles still land with the reserve", *good));
        refuse(search, "the mission does not land with its reserve");
    }
    if (const auto better = bisected(search, low, high, 1.0)) good = better;
    if (!good) throw NoResultError("the fewest circles that fit do not land with the reserve");
    return search.limit(*good, *good + 1.0);
}

FeasibilityLimit farthest_return(const MissionVariation& with_return_after_m, double length_m,
                                 const std::optional<double>& probability) {
    constexpr double accuracy = 1e-9;
    constexpr double accuracy_of_chance = 1e-4;
    if (!(length_m > 0.0))
        throw NoResultError("the path has no legs to turn back on: ways that take a duration_s or a hold are none");
    LimitSearch search(with_return_after_m, probability);
    const double apart_m = length_m * (probability ? accuracy_of_chance : accuracy);
    const auto max_m = longest_that_fits(search, length_m, apart_m);
    if (!max_m) refuse(search, "the path cannot be flown there and back");
    const auto surplus = search.surplus_if_it_fits(*max_m);
    if (surplus && *surplus >= 0.0) return search.limit(*max_m, *max_m);
    const auto good = bisected(search, 0.0, *max_m, apart_m);
    if (!good) throw NoResultError("from nowhere along the path does the mission return with its reserve");
    return search.limit(*good, std::min(*max_m, *good + apart_m));
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

std::optional<double> spare_without_fixed(PlanningProblem problem, const std::optional<double>& probability) {
    if (problem.fixed.empty()) return std::nullopt;
    problem.fixed.clear();
    const auto least = with_minimum_energy_schedule(problem);
    const double spare = probability ? draw_landings_until_known(least, collect_uncertainty(least.setup), *probability)
                                           .spare_percent(*probability)
                                     : surplus_percent(least);
    return spare < 0.0 ? std::nullopt : std::optional(spare);
}

/// What to state of the cruise. With an estimated duration goes its spread: then a longer cruise may do.
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
    const double stated_s = std::floor(max_s * 10.0) / 10.0;  // as it is printed, it has to do
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
    report.min_fixed_surplus_percent = spare_without_fixed(problem, probability);
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
