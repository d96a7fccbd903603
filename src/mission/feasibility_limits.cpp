#include "mission/feasibility_limits.h"

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "mission/planning/planner.h"
#include "mission/sampling/landing_search.h"
#include "path/path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

/// Surplus of a value with which a leg, or the way back, cannot be flown: as if the battery ended.
constexpr double too_far_percent = -100.0;

/// The end of a mission, without its curve.
MissionSummary simulated_end(const Mission& mission) { return simulate(mission, {.with_curve = false}).summary; }

/// Simulated final state of charge minus the reserve [points]. Negative if the reserve is not kept, the more so the
/// earlier the battery ends.
double surplus_percent(const Mission& mission) {
    const auto summary = simulated_end(mission);
    const double reserve_percent = mission.setup.reserve_soc_percent;
    if (summary.feasible) return *summary.final_soc_percent - reserve_percent;
    return -reserve_percent - units::percentage(summary.duration_s - powered_end_s(summary), summary.duration_s) - 1e-9;
}

/// Search for the greatest of a mission's numbers that keeps the reserve.
class LimitSearch {
  public:
    /// `misfit_percent` is the surplus of values that do not fit the schedule: they are too small, or too great.
    LimitSearch(const MissionVariation& variation, const std::optional<double>& probability,
                double misfit_percent = 100.0)
        : variation_(variation),
          probability_(probability),
          misfit_percent_(misfit_percent),
          landings_(probability.value_or(0.0)) {}

    /// Surplus [points] over the reserve of the mission as stated, or with the search's probability; none where its
    /// schedule does not fit.
    std::optional<double> surplus(double value) {
        const auto [known, is_new] = known_.try_emplace(value);
        if (!is_new) return known->second;
        if (const auto at = fitting_mission(value))
            known->second = probability_ ? spare_of_flights_percent(*at, value) : surplus_percent(*at);
        return known->second;
    }

    bool fits(double value) { return fitting_mission(value).has_value(); }

    /// Doubles `value` until the surplus is negative; false if it stays positive up to `max_value`.
    bool find_end(double value, double max_value) {
        if (probability_) value = last_likely_doubling(value, max_value);
        for (; value <= max_value; value *= 2.0) {
            const auto percent = surplus(value);
            if (percent && *percent < 0.0) {
                bad_ = value;
                return true;
            }
            if (percent) good_ = value;
            if (percent || misfit_percent_ > 0.0) low_ = value;
        }
        return false;
    }

    /// The same; where there is no end throws NoResultError, whose text contains the greatest value, or the misfit.
    void require_end(double max_value, std::string_view text) {
        if (find_end(1.0, max_value)) return;
        if (!good_) throw *misfit_;
        throw NoResultError(fmt::format(fmt::runtime(text), *good_));
    }

    void set_end(double bad) { bad_ = bad; }

    /// Narrows to the accuracy of the search, or to neighbouring whole numbers.
    void refine(bool is_whole = false) {
        constexpr double of_nothing = 100.0;
        const auto at = [&](double value) { return is_whole ? std::floor(value) : value; };
        const auto sign = [&](double value) {
            const double percent = surplus(at(value)).value_or(misfit_percent_);
            return percent >= 0.0 ? std::max(percent, std::numeric_limits<double>::min()) : percent;
        };
        const double accuracy = is_whole ? 0.5 : relative_accuracy() * bad_;
        const auto is_close = [&](double low, double high) { return high - low <= accuracy; };
        std::uintmax_t iterations = 300;
        const auto [low, high] = boost::math::tools::toms748_solve(
            sign, low_, bad_, low_ > 0.0 ? sign(low_) : of_nothing, sign(bad_), is_close, iterations);
        low_ = at(low);
        bad_ = at(high);
        good_ = low_ > 0.0 && surplus(low_) ? std::optional(low_) : std::nullopt;
    }

    /// The greatest value known to have a surplus, `low` one that may be too small for the schedule, and one without.
    const std::optional<double>& good() const { return good_; }
    double low() const { return low_; }
    double bad() const { return bad_; }
    /// The error of the last value that did not fit the schedule.
    const std::optional<InputError>& misfit() const { return misfit_; }
    /// To which limits can be known: drawn flights show less.
    double relative_accuracy() const { return probability_ ? 0x1p-14 : 0x1p-48; }

    std::string share_text() const {
        return probability_ ? fmt::format(" in {:.4g} % of its flights", units::percentage(*probability_, 1.0)) : "";
    }

    /// The value as a limit; `beyond` is slightly more.
    FeasibilityLimit limit(double value, double beyond) const {
        const auto at = mission(value);
        FeasibilityLimit most;
        most.value = value;
        if (probability_) {
            most.margin_percent = margin_percent_.at(value);
            most.sources = collect_uncertainty(at.setup).sources;
        }
        most.final_soc_percent = simulated_end(at).final_soc_percent.value_or(0.0);
        most.residual_percent = most.final_soc_percent - most.margin_percent - at.setup.reserve_soc_percent;
        const auto further = simulated_end(mission(beyond));
        most.limited_by = further.undeliverable  ? LimitingFactor::power
                          : further.cut_off_at_s ? LimitingFactor::cut_off
                                                 : LimitingFactor::charge;
        return most;
    }

  private:
    std::optional<Mission> fitting_mission(double value) {
        try {
            return mission(value);
        } catch (const InputError& error) {
            misfit_ = error;
            return std::nullopt;
        }
    }

    /// With the schedule of least energy demand. Throws InputError where the mission's own does not fit.
    Mission mission(double value) const { return with_minimum_energy_schedule(variation_(value)); }

    double spare_of_flights_percent(const Mission& at, double value) {
        require_known_spread(at.setup);
        const auto landings = landings_.landings(at, collect_uncertainty(at.setup));
        const double landed_percent = landings.quantile_percent(*probability_);
        margin_percent_[value] = std::max(0.0, landings.nominal_percent - landed_percent);
        return landed_percent - landings.reserve_percent;
    }

    /// The greatest of `value`, its double ... with a surplus, of those below where the mission as stated has none: there
    /// flights have none either, unless they charge.
    double last_likely_doubling(double value, double max_value) {
        LimitSearch stated(variation_, std::nullopt, misfit_percent_);
        if (!stated.find_end(value, max_value) || mission(stated.bad()).setup.may_charge) return value;
        for (double last = stated.bad() / 2.0; last > value; last /= 2.0) {
            const auto percent = surplus(last);
            if (!percent) return value;
            if (*percent >= 0.0) return last;
        }
        return value;
    }

    const MissionVariation& variation_;
    std::optional<double> probability_;
    double misfit_percent_;
    LandingSearch landings_;
    std::map<double, double> margin_percent_;  ///< of drawn flights, by value
    std::optional<InputError> misfit_;
    std::map<double, std::optional<double>> known_;  ///< surplus by value: drawn flights take long
    std::optional<double> good_;
    double low_ = 0.0;
    double bad_ = 0.0;
};

}  // namespace

FeasibilityLimit longest_cruise(const MissionVariation& with_cruise_s, const std::optional<double>& probability) {
    constexpr double longest_cruise_s = 1e7;
    LimitSearch search(with_cruise_s, probability);
    search.require_end(longest_cruise_s, "a cruise of {:.3g} s still lands with the reserve");
    search.refine();
    constexpr double no_cruise_s = 1.0;
    if (!search.good())
        throw NoResultError(fmt::format(
            "even {}, the mission does not land with its reserve{}",
            search.bad() < no_cruise_s
                ? std::string("without a cruise")
                : fmt::format("with a cruise of {:.6g} s, the shortest that fits the schedule", search.bad()),
            search.share_text()));
    const double most_s = *search.good();
    return search.limit(most_s, std::nextafter(most_s, longest_cruise_s) * (1.0 + 1e-9));
}

Mission with_capacity(Mission mission, double capacity_ah) {
    auto& battery = mission.setup.battery;
    if (auto& interval = battery.intervals.capacity_ah) {
        interval->low *= capacity_ah / battery.capacity_ah;
        interval->high *= capacity_ah / battery.capacity_ah;
    }
    battery.capacity_ah = capacity_ah;
    return mission;
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
    constexpr double largest_payload_w = 1e6;
    const auto bare = with_minimum_energy_schedule(mission);
    const MissionVariation variation = [&](double payload_w) { return with_payload(bare, payload_w); };
    LimitSearch search(variation, probability);
    if (const double surplus = search.surplus(0.0).value(); surplus < 0.0) {
        if (const auto summary = simulated_end(bare); !summary.feasible)
            throw NoResultError("without any payload already: " + describe(summary));
        throw NoResultError(fmt::format("without any payload the mission misses its reserve by {:.4g} points already{}",
                                        -surplus, search.share_text()));
    }
    search.require_end(largest_payload_w, "a payload of {:.3g} W still lands with the reserve");
    search.refine();
    auto most = search.limit(search.low(), search.low() * (1.0 + 1e-9) + 1e-9);
    if (probability) most.sources = collect_uncertainty(bare.setup).sources;
    return most;
}

std::optional<double> min_capacity_ah(const MissionVariant& mission, const std::optional<double>& probability) {
    constexpr double max_times = 1000.0;
    const auto bare = with_minimum_energy_schedule(mission);
    const double own_ah = bare.setup.battery.capacity_ah;
    const MissionVariation variation = [&](double times_less) { return with_capacity(bare, own_ah / times_less); };
    LimitSearch search(variation, probability);
    double times_less = 1.0;
    for (; search.surplus(times_less).value() < 0.0; times_less /= 2.0)
        if (times_less * max_times < 1.0) return std::nullopt;
    if (search.find_end(times_less, max_times)) search.refine();
    return own_ah / search.low();
}

FeasibilityLimit max_circles(const MissionVariation& with_circles, const std::optional<double>& probability) {
    constexpr double max_circles_tried = 1e4;
    LimitSearch search(with_circles, probability);
    search.require_end(max_circles_tried, "{:.0f} circles still land with the reserve");
    if (search.bad() > 1.0) search.refine(true);
    if (!search.good()) throw NoResultError("the fewest circles that fit do not land with the reserve");
    return search.limit(*search.good(), *search.good() + 1.0);
}

FeasibilityLimit farthest_return(const MissionVariation& with_return_after_m, double length_m,
                                 const std::optional<double>& probability) {
    if (!(length_m > 0.0))
        throw NoResultError(
            "the path has no legs along which to return: holds, and ways to a place with duration_s, are not legs");
    LimitSearch search(with_return_after_m, probability, too_far_percent);
    if (search.surplus(length_m).value_or(too_far_percent) >= 0.0) {
        auto all = search.limit(length_m, length_m);
        all.limited_by = LimitingFactor::path;
        return all;
    }
    search.set_end(length_m);
    search.refine();
    const bool fits_beyond = search.fits(search.bad());
    if (search.good()) return search.limit(*search.good(), fits_beyond ? search.bad() : *search.good());
    if (!fits_beyond) throw *search.misfit();
    throw NoResultError("from nowhere along the path does the mission return with its reserve");
}

FeasibilityLimit most_path_times(const MissionVariation& with_path_times, const std::optional<double>& probability) {
    constexpr double max_times_tried = 1000.0;
    LimitSearch search(with_path_times, probability, too_far_percent);
    search.require_end(max_times_tried, "flown {:.0f} times, the path still lands with the reserve");
    search.refine();
    if (!search.good())
        throw NoResultError("from nowhere along the path does the mission land with its reserve" + search.share_text());
    const double beyond = *search.good() * (1.0 + 1e-9);
    return search.limit(*search.good(), search.fits(beyond) ? beyond : *search.good());
}

std::string describe_path_times(const MissionSetup& mission, double times) {
    const auto& plan = *mission.cruise_path->plan;
    const auto& drawn = drawn_path(plan);
    const auto flown_s = [&](double count) {
        const auto part = repeated(drawn, plan.wind, count, plan.rates);
        return compute_trajectory(as_flown(plan, part), plan.wind).duration_s;
    };
    const double whole = std::floor(times);
    const double share_percent = units::percentage(times - whole, 1.0);
    if (whole == 0.0) {
        const auto once = compute_trajectory(drawn, plan.wind);
        const auto end = position_at(once, times * once.duration_s).element;
        const auto& elements = drawn.elements;
        return fmt::format("{:.0f} % of the path fits{}: {} of {}, until element {} of {}, {}", share_percent,
                           returns_to_start(drawn) ? " with the way back from there" : "",
                           duration_text(flown_s(times)), duration_text(flown_s(1.0)), end + 1, elements.size(),
                           elements.at(end).name);
    }
    return fmt::format(
        "the path is flown {}; {} of cruise remain, {:.0f} % of another time with the way back to its start",
        whole == 1.0 ? "once" : fmt::format("{:.0f} times", whole), duration_text(flown_s(times) - flown_s(whole)),
        share_percent);
}

ReachUnit reach_unit_of(const MissionSetup& mission) {
    if (!mission.cruise_path) return ReachUnit::cruise_s;
    bool has_turns = false;
    for (const auto& element : drawn_path(*mission.cruise_path->plan).elements)
        if (std::holds_alternative<path::Circles>(element.shape)) {
            if (!element.is_turn) return ReachUnit::circles;
            has_turns = true;
        }
    return has_turns ? ReachUnit::path_times : ReachUnit::return_m;
}

Reach find_reach(const MissionLoader& mission_of, const std::optional<double>& probability,
                 std::optional<ReachUnit> measure) {
    const auto mission = mission_of({.allow_unplanned = true});
    const auto& setup = setup_of(mission);
    const auto unit = measure.value_or(reach_unit_of(setup));
    const double length_m = setup.cruise_path ? length_of_legs_m(drawn_path(*setup.cruise_path->plan)) : 0.0;
    const bool flies_back = setup.cruise_path && drawn_path(*setup.cruise_path->plan).elements.back().is_return_leg;
    const MissionVariation variation = [&](double value) {
        MissionReadOptions reading{.allow_unplanned = true};
        if (unit == ReachUnit::return_m && flies_back && value >= length_m)
            return mission_of(reading);  // straight back
        (unit == ReachUnit::cruise_s   ? reading.cruise_s
         : unit == ReachUnit::circles  ? reading.circles
         : unit == ReachUnit::return_m ? reading.return_after_m
                                       : reading.path_times) = value;
        return mission_of(reading);
    };
    if (unit == ReachUnit::cruise_s) return {unit, longest_cruise(variation, probability)};
    if (unit == ReachUnit::circles) return {unit, max_circles(variation, probability)};
    if (unit == ReachUnit::path_times) return {unit, most_path_times(variation, probability)};
    return {unit, farthest_return(variation, length_m, probability)};
}

InfeasibilityReport infeasibility_report(const PlanningProblem& problem, const MissionPlan& plan,
                                         const MissionVariation& with_cruise_s,
                                         const std::optional<double>& probability) {
    InfeasibilityReport report;
    const double possible = plan.plan.final_soc_percent - plan.margin_percent;
    report.shortfall_percent = problem.setup.reserve_soc_percent - possible;
    report.shortfall_wh = units::amount_from_percent(full_energy_wh(problem.setup.battery), report.shortfall_percent);
    report.cut_off_at_s = plan.summary.cut_off_at_s;
    try {
        report.cruise_s = longest_cruise(with_cruise_s, probability).value;
    } catch (const NoResultError&) {
        // no cruise is short enough
    }
    if (possible >= 0.0 && plan.summary.feasible) report.reserve_soc_percent = possible;
    report.capacity_ah = min_capacity_ah(problem, probability);
    return report;
}

std::string describe(const MissionSetup& mission, const InfeasibilityReport& report) {
    std::vector<std::string> remedies;  // they must land as printed
    if (report.cruise_s) {
        const double cruise_s = std::floor(*report.cruise_s * 10.0) / 10.0;
        remedies.push_back(fmt::format("a cruise of at most {} (duration_s = {{ cruise = {:.1f} }})",
                                       duration_text(cruise_s), cruise_s));
    }
    if (report.reserve_soc_percent)
        remedies.push_back(
            fmt::format("a reserve of at most {:.2f} %", std::floor(*report.reserve_soc_percent * 100.0) / 100.0));
    if (report.capacity_ah) {
        remedies.push_back(fmt::format("a battery of {:.3f} Ah instead of {:.3f} Ah",
                                       std::ceil(*report.capacity_ah * 1000.0) / 1000.0, mission.battery.capacity_ah));
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
