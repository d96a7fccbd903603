#include "report/document/simulated_mission.h"

#include "base/error.h"
#include "base/text.h"
#include "cli/output/mission_output.h"
#include "mission/plan.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

namespace flightwatt::mission {

Fields<Reach> record_fields(const Reach*) {
    using R = Reach;
    const auto of = [](const char* key, ReachUnit unit, const char* description) {
        const auto value = [unit](const R& r) { return r.unit == unit ? std::optional(r.limit.value) : std::nullopt; };
        return field(key, value, description, optional_key{});
    };
    return {of("longest_cruise_s", ReachUnit::cruise_s, "without a path"),
            of("most_circles", ReachUnit::circles, "of a path with circles"),
            of("farthest_return_m", ReachUnit::return_m, "of another path, out and back"),
            of("path_times", ReachUnit::path_times, "of an area: how often its lines are flown")};
}

}  // namespace flightwatt::mission

namespace flightwatt::report {
namespace {

/// Drawn flights: the standard error of a probability is at most 1.6 percent points, or 3.5 of a policy, which replans
/// each flight in every slot (a thousand times the work).
constexpr std::size_t flights_drawn = 1000;
constexpr std::size_t flights_drawn_of_policy = 200;
/// Points of the band over time.
constexpr std::size_t band_times = 61;

/// Plans a mission without a schedule, simulates it, and draws flights if uncertainties are known. Deterministic.
SimulatedMission simulate_one(const mission::MissionVariant& mission, const mission::SimulationOptions& steps) {
    SimulatedMission simulated;
    mission::PreparedMission prepared;
    std::optional<mission::MissionSummary> summary;  // of a plan, with its time steps
    const auto* problem = std::get_if<mission::PlanningProblem>(&mission);
    if (problem != nullptr && !problem->adaptive) {
        const auto plan = plan_mission(*problem);
        simulated.planned = PlannedSchedule{plan.plan.feasible, plan.plan.utility_bound};
        prepared = {plan.mission.setup, plan.mission.schedule, std::nullopt, mission::ScheduleOrigin::planned};
        summary = summary_with_origin(plan);
    } else {
        prepared = prepare_mission(mission);
    }
    auto flown = simulate_prepared(prepared, steps);
    simulated.simulation = std::move(flown.simulation);
    if (summary) {
        summary->by_flights = simulated.simulation.summary.by_flights;
        simulated.simulation.summary = std::move(*summary);
    }
    if (has_uncertainty(prepared.setup))
        simulated.simulation.summary.samples =
            sample_flights(prepared, {}, {prepared.adaptive ? flights_drawn_of_policy : flights_drawn, 1, band_times});
    if (flown.setup) prepared.setup = std::move(*flown.setup);
    simulated.mission = {std::move(prepared.setup), std::move(flown.schedule)};
    return simulated;
}

/// The result of `compute`, or std::nullopt and the reason.
template <typename Compute>
auto try_compute(const Compute& compute, std::string* reason = nullptr) -> std::optional<decltype(compute())> {
    try {
        return compute();
    } catch (const NoResultError& error) {
        if (reason != nullptr) *reason = error.what();
    } catch (const InputError&) {
        if (reason != nullptr) *reason = "its schedule ends with the planned cruise";
    }
    return std::nullopt;
}

/// With the mission's capacity.
Outcome modelled_outcome(const mission::MissionSummary& summary) {
    if (!summary.feasible) return Outcome::fails;
    if (!summary.keeps_reserve) return Outcome::misses;
    const bool is_likely = known_probability_below_reserve(summary).value_or(0.0) <= 1.0 - reach_probability;
    return is_likely ? Outcome::keeps : Outcome::may_miss;
}

}  // namespace

std::vector<SimulatedMission> simulate_for_report(const std::vector<mission::MissionVariant>& missions,
                                                  const Progress& progress) {
    constexpr double rows = 300.0;
    std::vector<SimulatedMission> simulated;
    std::map<std::string, int> seen;
    for (const auto& mission : missions) {
        if (progress) progress(simulated.size(), missions.size());
        const auto& setup = setup_of(mission);
        mission::SimulationOptions steps;
        steps.output_s = mission::timeline_of(setup.duration_s).duration_s / rows;
        auto title = valid_utf8(setup.name);
        if (const int times = ++seen[title]; times > 1) title += fmt::format(" ({})", times);
        simulated.push_back(simulate_one(mission, steps));
        simulated.back().simulation.summary.mission = simulated.back().title = std::move(title);
    }
    return simulated;
}

MissionAssessment assess_mission(const SimulatedMission& simulated, const mission::MissionLoader& mission_of) {
    MissionAssessment answer;
    const auto mission = try_compute([&] { return mission_of({.allow_unplanned = true}); });
    if (!mission) {
        answer.no_reach_reason = "its file cannot be read again";
        return answer;
    }
    if (setup_of(*mission).packs) return answer;  // reach and capacity are of one flight
    answer.is_unplanned = std::holds_alternative<mission::PlanningProblem>(*mission);
    answer.reach = try_compute([&] { return find_reach(mission_of); }, &answer.no_reach_reason);
    if (answer.reach && known_probability_below_reserve(simulated.simulation.summary))
        answer.reach_at_95_percent = try_compute([&] { return find_reach(mission_of, reach_probability); });
    if (modelled_outcome(simulated.simulation.summary) == Outcome::keeps) return answer;
    const auto probability = answer.reach_at_95_percent ? std::optional(reach_probability) : std::nullopt;
    const auto capacity_ah = try_compute([&] { return min_capacity_ah(*mission, probability); }).value_or(std::nullopt);
    // It is that of the minimum of software, which the present pack may suffice for.
    if (capacity_ah && *capacity_ah > simulated.mission.setup.battery.capacity_ah) answer.capacity_ah = capacity_ah;
    return answer;
}

std::optional<double> known_probability_below_reserve(const mission::MissionSummary& summary) {
    const bool is_known = summary.samples && summary.samples->variability_is_known;
    return is_known ? std::optional(summary.samples->probability_below_reserve) : std::nullopt;
}

Outcome outcome_of(const SimulatedMission& simulated) {
    const auto& summary = simulated.simulation.summary;
    const auto outcome = modelled_outcome(summary);
    const bool keeps_by_flights = !summary.by_flights || summary.by_flights->keeps_reserve;
    if (simulated.is_longest) return Outcome::keeps;
    if (outcome != Outcome::keeps) return outcome;
    if (!keeps_by_flights) return Outcome::may_miss;
    return summary.uncertain.empty() ? outcome : Outcome::is_uncertain;
}

std::vector<std::size_t> worst_first(std::span<const SimulatedMission> missions) {
    const auto rank = [&](std::size_t i) {
        const auto& summary = missions[i].simulation.summary;
        return std::tuple(-static_cast<int>(outcome_of(missions[i])),
                          -known_probability_below_reserve(summary).value_or(0.0),
                          summary.final_soc_percent.value_or(-1.0));
    };
    std::vector<std::size_t> order(missions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, rank);
    return order;
}

Fields<MissionOutput> record_fields(const MissionOutput*) {
    using R = MissionOutput;
    using M = SimulatedMission;
    using A = MissionAssessment;
    using S = mission::MissionSummary;
    const auto of = [](auto member) {
        return at(&R::simulated, &M::simulation, &mission::Simulation::summary, member);
    };
    return {field("mission", at(&R::simulated, &M::title), "title of the mission"),
            field("final_soc_percent", of(&S::final_soc_percent), "null: the battery cannot deliver the power"),
            field("reserve_soc_percent", of(&S::reserve_soc_percent), "reserve of the mission"),
            field("keeps_reserve", of(&S::keeps_reserve), "the reserve is left, as modelled"),
            field("probability_below_reserve", of(known_probability_below_reserve),
                  "of 1000 flights; null: how flights differ is unknown"),
            field("utility", of(&S::utility), "mean utility per second"),
            field("reach", at(&R::assessment, &A::reach), "largest feasible mission, as modelled"),
            field("reach_with_95_percent", at(&R::assessment, &A::reach_at_95_percent), "with that probability"),
            field("min_capacity_ah", at(&R::assessment, &A::capacity_ah), "smallest battery; null: its own suffices"),
            field("with_capacity_of_flights", of(&S::by_flights), "with the pack's capacity by flights, if it differs",
                  optional_key{})};
}

}  // namespace flightwatt::report
