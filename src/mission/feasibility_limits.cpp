#include "mission/feasibility_limits.h"

#include "base/duration_text.h"
#include "base/units.h"
#include "mission/planning/depletion_table.h"
#include "mission/planning/margin_search.h"
#include "mission/planning/planner.h"
#include "mission/sampling/landing_distribution.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

constexpr double longest_cruise_s = 1e7;
constexpr double shortest_cruise_s = 1.0;
constexpr double largest_payload_w = 1e6;

using SpareOf = std::function<double(double)>;

/// The last value with something to spare, between `good` where there is and `bad` where there is not.
double last_good(const SpareOf& spare_of, double good, double bad) {
    const double spare_good = spare_of(good);
    const double spare_bad = spare_of(bad);
    if (spare_good == 0.0) return good;
    std::uintmax_t iterations = 200;
    const auto [low, high] = boost::math::tools::toms748_solve(
        spare_of, std::min(good, bad), std::max(good, bad), good < bad ? spare_good : spare_bad,
        good < bad ? spare_bad : spare_good, boost::math::tools::eps_tolerance<double>(48), iterations);
    return spare_of(high) >= 0.0 ? high : spare_of(low) >= 0.0 ? low : good;
}

/// Two values, the first with something to spare and the second without, if there is such a one.
struct Bracket {
    double good = 0.0;
    std::optional<double> bad;
};

/// From a good value on: `tried.bad`, and so on times `factor` up to `last`.
Bracket bracket_of(const SpareOf& spare_of, Bracket tried, double factor, double last) {
    while (spare_of(*tried.bad) >= 0.0) {
        const double next = *tried.bad * factor;
        tried = {*tried.bad, next};
        if (factor > 1.0 ? next > last : next < last) return {tried.good, std::nullopt};
    }
    return tried;
}

/// Its interval, if it has one, in proportion.
Mission with_capacity(Mission mission, double capacity_ah) {
    auto& battery = mission.battery;
    if (auto& interval = battery.intervals.capacity_ah) {
        interval->low *= capacity_ah / battery.capacity_ah;
        interval->high *= capacity_ah / battery.capacity_ah;
    }
    battery.capacity_ah = capacity_ah;
    return mission;
}

/// Whether the schedule fits into a cruise; what else is wrong with a mission was seen when it was first read.
std::optional<Mission> if_it_fits(const MissionForCruise& mission_of, double cruise_s) {
    try {
        return with_minimum_energy_schedule(mission_of(cruise_s));
    } catch (const InputError&) {
        return std::nullopt;
    }
}

/// A schedule that was planned says what runs for as long as it was planned, and no longer.
void require_fit(const MissionForCruise& mission_of, double cruise_s) {
    try {
        with_minimum_energy_schedule(mission_of(cruise_s));
    } catch (const InputError& error) {
        throw InputError(error.where(), "the schedule says what runs for one length of the cruise alone",
                         "ask the mission that it was planned from, or add an entry with `otherwise = true`");
    }
}

/// A cruise short enough to land with the reserve, below `too_long_s`.
double short_enough_s(const MissionForCruise& mission_of, double too_long_s) {
    double fits_s = too_long_s;
    double too_short_s = 0.0;
    for (double cruise_s = too_long_s / 2.0; cruise_s >= shortest_cruise_s;) {
        if (const auto mission = if_it_fits(mission_of, cruise_s)) {
            if (surplus_percent(*mission) >= 0.0) return cruise_s;
            fits_s = cruise_s;
        } else {
            too_short_s = cruise_s;
        }
        cruise_s = (fits_s + too_short_s) / 2.0;
        if (too_short_s > 0.0 && fits_s - too_short_s < 1e-6 * fits_s) break;
    }
    throw NoResultError(
        fmt::format("even with a cruise of {:.6g} s, the shortest that fits the schedule, the "
                    "mission does not land with its reserve",
                    fits_s));
}

/// `problem` or mission with a reserve so much higher.
MissionVariant with_margin(MissionVariant mission, double margin_percent) {
    std::visit([&](MissionSetup& setup) { setup.reserve_soc_percent += margin_percent; }, mission);
    return mission;
}

/// An answer that depends on a margin above the reserve, and the mission that it makes.
struct MarginQuestion {
    std::function<double(double margin_percent)> answer;
    std::function<Mission(double answer)> mission_of;
};

/// An answer, and the margin that its own flights need.
struct AnswerWithMargin {
    double value = 0.0;
    double margin_percent = 0.0;
};

/// The answer with which `probability` of the flights, no more and no less, keep the reserve; without one, that of
/// the flight as stated. Where its flights fail from one value to the next, the last with which they do not.
AnswerWithMargin answer_with_chance(const MarginQuestion& question, const std::optional<double>& probability) {
    constexpr int rounds = 40;
    constexpr double close_fraction = 2e-4;  // of the flights' deviation
    if (!probability) return {question.answer(0.0), 0.0};
    MarginSearch search(0.0);
    std::optional<AnswerWithMargin> last;
    std::optional<NoResultError> none;
    std::optional<LandingDistribution> nearest;
    for (int round = 0; round < rounds && !search.has_converged(); ++round) {
        const double margin_percent = search.margin_percent();
        try {
            const double value = question.answer(margin_percent);
            const auto mission = question.mission_of(value);
            require_known_spread(mission);
            const auto landings = draw_landings_until_known(mission, collect_uncertainty(mission), *probability);
            if (!nearest || landings.below() < nearest->below()) nearest = landings;
            const double slack_percent = landings.spare_percent(*probability);
            if (slack_percent < 0.0) search.raise_lower_bound(landings.nominal_spare_percent());
            search.add_result(slack_percent, 0.0);
            const bool is_close = std::abs(slack_percent) <= close_fraction * landings.sd_percent ||
                                  std::abs(landings.below() - (1.0 - *probability)) <= landings.resolution();
            if (slack_percent >= 0.0 || is_close)
                last = {value, std::max(0.0, landings.nominal_spare_percent() - slack_percent)};
            if (is_close) break;
        } catch (const NoResultError& error) {
            none = error;
            search.mark_infeasible();
        }
    }
    if (last) return *last;
    if (!nearest) throw none.value_or(NoResultError("no answer lands with the reserve often enough"));
    throw NoResultError(fmt::format(
        "no answer lands with the reserve in {:.4g} % of flights: with the one that came nearest {:.3g} % do "
        "not (standard error {:.2g} %)",
        units::percentage(*probability, 1.0), units::percentage(nearest->below(), 1.0),
        units::percentage(nearest->standard_error(), 1.0)));
}

}  // namespace

FeasibilityLimit limit_at(double value, double margin_percent, const Mission& at, const Mission& beyond) {
    FeasibilityLimit most;
    most.value = value;
    most.margin_percent = margin_percent;
    most.final_soc_percent = simulate(at).summary.final_soc_percent.value_or(0.0);
    most.residual_percent = most.final_soc_percent - margin_percent - at.reserve_soc_percent;
    const auto further = simulate(beyond).summary;
    most.limited_by = further.undeliverable  ? LimitingFactor::power
                      : further.cut_off_at_s ? LimitingFactor::cut_off
                                             : LimitingFactor::charge;
    return most;
}

std::string to_string(LimitingFactor bound) {
    constexpr std::array names{"charge", "power", "cut-off"};
    return names.at(static_cast<std::size_t>(bound));
}

double surplus_percent(const Mission& mission) {
    if (!mission.battery.thevenin) {
        const auto table = make_depletion_table(mission, configurations_of(mission.schedule));
        if (const auto soc = soc_after_schedule(table, to_indexed(mission.schedule, table)))
            return *soc - mission.reserve_soc_percent;
    }
    const auto summary = simulate(mission).summary;
    if (summary.feasible) return *summary.final_soc_percent - mission.reserve_soc_percent;
    return -mission.reserve_soc_percent -
           units::percentage(summary.duration_s - powered_end_s(summary), summary.duration_s) - 1e-9;
}

namespace {

double max_cruise_s_of(const MissionForCruise& mission_of) {
    const auto spare_of = [&](double cruise_s) {
        return surplus_percent(with_minimum_energy_schedule(mission_of(cruise_s)));
    };
    // From a length that fits: schedules may need so much, never so little.
    double fits_s = shortest_cruise_s;
    while (fits_s < longest_cruise_s && !if_it_fits(mission_of, fits_s)) fits_s *= 2.0;
    require_fit(mission_of, fits_s);
    Bracket bracket{0.0, fits_s};
    if (spare_of(fits_s) < 0.0)
        bracket.good = short_enough_s(mission_of, fits_s);
    else
        bracket = bracket_of(spare_of, {fits_s, 2.0 * fits_s}, 2.0, longest_cruise_s);
    if (!bracket.bad)
        throw NoResultError(fmt::format("a cruise of {:.3g} s still lands with the reserve", bracket.good));
    return last_good(spare_of, bracket.good, *bracket.bad);
}

}  // namespace

FeasibilityLimit longest_cruise(const MissionForCruise& mission_of, const std::optional<double>& probability) {
    const auto mission_at = [&](double cruise_s) { return with_minimum_energy_schedule(mission_of(cruise_s)); };
    const auto max_s = [&](double margin_percent) {
        return max_cruise_s_of([&](double cruise_s) { return with_margin(mission_of(cruise_s), margin_percent); });
    };
    const auto [cruise_s, margin_percent] = answer_with_chance({max_s, mission_at}, probability);
    const double beyond_s = std::nextafter(cruise_s, longest_cruise_s) * (1.0 + 1e-9);
    auto most = limit_at(cruise_s, margin_percent, mission_at(cruise_s), mission_at(beyond_s));
    if (probability) most.sources = collect_uncertainty(mission_at(cruise_s)).sources;
    return most;
}

Mission with_payload(const Mission& mission, double payload_w) {
    auto loaded = mission;
    const auto index = loaded.compute.components.size();
    loaded.compute.components.push_back({"payload", compute::make_power_profile("payload", {}, {{{}, payload_w, {}}})});
    if (!loaded.utilities.empty()) loaded.utilities.resize(index + 1);
    loaded.uncertainty.compute_sd_percent.resize(index + 1);
    for (auto& segment : loaded.schedule) segment.run.push_back({index, {}});
    return loaded;
}

namespace {

double largest_payload_w_of(const Mission& bare) {
    const auto spare_of = [&](double payload_w) { return surplus_percent(with_payload(bare, payload_w)); };
    if (const double spare = spare_of(0.0); spare < 0.0) {
        if (const auto summary = simulate(bare).summary; !summary.feasible)
            throw NoResultError("without any payload already: " + describe(summary));
        throw NoResultError(
            fmt::format("without any payload the mission misses its reserve by {:.4g} points already", -spare));
    }
    const auto bracket = bracket_of(spare_of, {0.0, 1.0}, 2.0, largest_payload_w);
    if (!bracket.bad)
        throw NoResultError(fmt::format("a payload of {:.3g} W still lands with the reserve", bracket.good));
    return last_good(spare_of, bracket.good, *bracket.bad);
}

/// None if no capacity is enough.
std::optional<double> min_capacity_ah_of(const Mission& bare) {
    constexpr double max_times = 1000.0;
    const auto spare_of = [&](double capacity_ah) { return surplus_percent(with_capacity(bare, capacity_ah)); };
    const double own_ah = bare.battery.capacity_ah;
    double good_ah = own_ah;
    while (spare_of(good_ah) < 0.0) {
        good_ah *= 2.0;
        if (good_ah > max_times * own_ah) return std::nullopt;
    }
    const auto bracket = bracket_of(spare_of, {good_ah, good_ah / 2.0}, 0.5, own_ah / max_times);
    return bracket.bad ? last_good(spare_of, bracket.good, *bracket.bad) : bracket.good;
}

}  // namespace

FeasibilityLimit largest_payload(const MissionVariant& mission, const std::optional<double>& probability) {
    const auto bare = with_minimum_energy_schedule(mission);
    const auto mission_at = [&](double payload_w) { return with_payload(bare, payload_w); };
    const auto largest_w = [&](double margin_percent) {
        return largest_payload_w_of(std::get<Mission>(with_margin(bare, margin_percent)));
    };
    const auto [payload_w, margin_percent] = answer_with_chance({largest_w, mission_at}, probability);
    auto most = limit_at(payload_w, margin_percent, mission_at(payload_w), mission_at(payload_w * (1.0 + 1e-9) + 1e-9));
    if (probability) most.sources = collect_uncertainty(bare).sources;
    return most;
}

std::optional<double> min_capacity_ah(const MissionVariant& mission, const std::optional<double>& probability) {
    const auto bare = with_minimum_energy_schedule(mission);
    const auto min_ah = [&](double margin_percent) {
        const auto capacity_ah = min_capacity_ah_of(std::get<Mission>(with_margin(bare, margin_percent)));
        if (!capacity_ah) throw NoResultError("no capacity is enough");
        return *capacity_ah;
    };
    try {
        return answer_with_chance({min_ah, [&](double ah) { return with_capacity(bare, ah); }}, probability).value;
    } catch (const NoResultError&) {
        return std::nullopt;
    }
}

namespace {

std::optional<double> cruise_that_lands(const MissionForCruise& mission_of, const std::optional<double>& probability) {
    try {
        return longest_cruise(mission_of, probability).value;
    } catch (const NoResultError&) {
        return std::nullopt;
    }
}

std::optional<double> spare_without_fixed(PlanningProblem problem, const std::optional<double>& probability) {
    if (problem.fixed.empty()) return std::nullopt;
    problem.fixed.clear();
    const auto least = with_minimum_energy_schedule(problem);
    const double spare =
        probability
            ? draw_landings_until_known(least, collect_uncertainty(least), *probability).spare_percent(*probability)
            : surplus_percent(least);
    return spare < 0.0 ? std::nullopt : std::optional(spare);
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
                                         const MissionForCruise& mission_of, const std::optional<double>& probability) {
    InfeasibilityReport report;
    const double possible = plan.plan.final_soc_percent - plan.margin_percent;
    report.shortfall_percent = problem.reserve_soc_percent - possible;
    report.shortfall_wh = units::amount_from_percent(full_energy_wh(problem.battery), report.shortfall_percent);
    report.cut_off_at_s = plan.summary.cut_off_at_s;
    report.cruise_s = cruise_that_lands(mission_of, probability);
    report.cruise_differs_now = probability && cruise_duration_varies(problem);
    report.min_fixed_surplus_percent = spare_without_fixed(problem, probability);
    if (possible >= 0.0 && plan.summary.feasible) report.reserve_soc_percent = possible;
    report.capacity_ah = min_capacity_ah(problem, probability);
    return report;
}

namespace {

/// What to state of the cruise. With an estimated duration goes its spread: then a longer cruise may do.
std::string cruise_remedy(const MissionSetup& mission, const InfeasibilityReport& report) {
    const double now_s = mission.duration_s[Phase::cruise];
    if (!report.cruise_differs_now)
        return fmt::format("a cruise {} shorter ({:.1f} s: {})", duration_text(now_s - *report.cruise_s),
                           *report.cruise_s, duration_text(*report.cruise_s));
    return describe_stated_cruise(*report.cruise_s, now_s);
}

}  // namespace

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
