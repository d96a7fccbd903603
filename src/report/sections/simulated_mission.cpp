#include "report/sections/simulated_mission.h"

#include "base/duration_text.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/output/mission_output.h"
#include "mission/plan.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"
#include "report/figure.h"

#include <cctype>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {

Fields<Reach> record_fields(const Reach*) {
    using R = Reach;
    const auto of = [](const char* key, ReachUnit unit, const char* description) {
        const auto value = [unit](const R& r) { return r.unit == unit ? std::optional(r.limit.value) : std::nullopt; };
        return field(key, value, description, optional_key{});
    };
    return {of("longest_cruise_s", ReachUnit::cruise_s, "without a path"),
            of("most_circles", ReachUnit::circles, "of a path with circles"),
            of("farthest_return_m", ReachUnit::return_m, "of another path, out and back")};
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
        prepared = {problem->setup, plan.mission.schedule, std::nullopt, mission::ScheduleOrigin::planned};
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

std::string describe_reach(const mission::Reach& reach) {
    if (reach.unit == mission::ReachUnit::circles) return fmt::format("{:.0f} circles", reach.limit.value);
    if (reach.unit == mission::ReachUnit::return_m)
        return fmt::format("{:.2f} km out and back", reach.limit.value / 1000.0);
    return duration_text(reach.limit.value) + " of cruise";
}

std::string modelled_landing(const mission::MissionSummary& summary) {
    if (!summary.final_soc_percent) return "The battery cannot deliver the power";
    const auto before_end = [&](double time_s) {
        return fmt::format("{} in the air, {} before the end", duration_text(time_s),
                           duration_text(summary.duration_s - time_s));
    };
    const double cut_off_s = summary.cut_off_at_s.value_or(summary.duration_s);
    if (summary.cut_off_at_s && cut_off_s <= summary.depleted_at_s.value_or(summary.duration_s))
        return fmt::format("Is cut off after {}", before_end(cut_off_s));
    if (summary.depleted_at_s) return fmt::format("Runs empty after {}", before_end(*summary.depleted_at_s));
    return fmt::format("Lands with {:.1f} %", *summary.final_soc_percent);
}

std::string landing_line(const mission::MissionSummary& summary) {
    const auto landing = modelled_landing(summary);
    return summary.by_flights ? fmt::format("{} ({})", landing, describe(*summary.by_flights, 1)) : landing;
}

std::string reserve_line(const mission::MissionSummary& summary) {
    const bool has_reserve = summary.reserve_soc_percent > 0.0;  // else the battery has to last
    const auto reserve = fmt::format("its reserve of {:.3g} %", summary.reserve_soc_percent);
    const auto kept = has_reserve ? "Keeps " + reserve : "The battery lasts";
    const auto missed = has_reserve ? "Does not keep " + reserve : "The battery does not last";
    if (!summary.samples)
        return (summary.keeps_reserve ? kept : missed) + " as modelled; no uncertainty is known, and so no probability";
    const auto& samples = *summary.samples;
    const auto& below = samples.probability_below_reserve_95;
    return fmt::format("{} with a probability of {:.1f} % ({} flights drawn: 95 % interval {:.1f} to {:.1f})", kept,
                       units::percentage(1.0 - samples.probability_below_reserve, 1.0), samples.samples,
                       units::percentage(1.0 - below.high, 1.0), units::percentage(1.0 - below.low, 1.0));
}

std::string reach_line(const SimulatedMission& simulated, const MissionAssessment& answer) {
    if (!answer.reach) return "Reach unknown: " + answer.no_reach_reason;
    auto line = fmt::format("At most {}", describe_reach(*answer.reach));
    if (answer.reach->unit == mission::ReachUnit::cruise_s)
        line += fmt::format(" (now {})", duration_text(simulated.mission.setup.duration_s[flight::Phase::cruise]));
    line += " as modelled";
    if (answer.reach_at_95_percent)
        line += fmt::format(", {} with a probability of {:.0f} %", describe_reach(*answer.reach_at_95_percent),
                            units::percentage(reach_probability, 1.0));
    if (answer.is_unplanned) line += ", with the minimum of software";
    return line;
}

std::string utility_line(const SimulatedMission& simulated) {
    const auto& summary = simulated.simulation.summary;
    auto line = fmt::format("Utility {:.4g}", *summary.utility);
    if (simulated.planned && simulated.planned->feasible)
        line += fmt::format(", of at most {:.4g} for any schedule", simulated.planned->bound);
    return line;
}

/// Whether a shorter flight keeps the reserve.
bool shorter_helps(const SimulatedMission& simulated, const mission::Reach& reach) {
    return reach.unit != mission::ReachUnit::cruise_s ||
           reach.limit.value < simulated.mission.setup.duration_s[flight::Phase::cruise];
}

/// Ways to keep the reserve; empty without any.
std::string remedy_line(const SimulatedMission& simulated, const MissionAssessment& answer) {
    const auto& reach = answer.reach_at_95_percent ? answer.reach_at_95_percent : answer.reach;
    const double capacity_ah = simulated.mission.setup.battery.capacity_ah;
    std::vector<std::string> ways;
    const bool shorter = reach && shorter_helps(simulated, *reach);
    // A plan does not reach further than the minimum of software.
    const bool is_in_reach = answer.reach_at_95_percent && (!shorter || reach->unit != mission::ReachUnit::cruise_s);
    if (simulated.planned && is_in_reach) ways.emplace_back("plan it with --probability 0.95");
    if (shorter) ways.push_back(fmt::format("fly {} at most", describe_reach(*reach)));
    if (answer.capacity_ah)
        ways.push_back(fmt::format("use a battery of {:.2f} Ah (now {:.4g})", *answer.capacity_ah, capacity_ah));
    if (ways.empty()) return "";
    const auto aim = answer.reach_at_95_percent
                         ? fmt::format("For a probability of {:.0f} %", units::percentage(reach_probability, 1.0))
                         : std::string("To keep it");
    return fmt::format("{}: {}", aim, fmt::join(ways, ", or "));
}

/// With the mission's capacity.
ReserveStatus modelled_status(const mission::MissionSummary& summary) {
    if (!summary.keeps_reserve) return ReserveStatus::fails;
    const bool is_likely = !summary.samples || summary.samples->probability_below_reserve <= 1.0 - reach_probability;
    return is_likely ? ReserveStatus::keeps : ReserveStatus::may_keep;
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
        simulated.back().title = std::move(title);
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
    answer.is_unplanned = std::holds_alternative<mission::PlanningProblem>(*mission);
    answer.reach = try_compute([&] { return find_reach(mission_of); }, &answer.no_reach_reason);
    if (answer.reach && simulated.simulation.summary.samples)
        answer.reach_at_95_percent = try_compute([&] { return find_reach(mission_of, reach_probability); });
    if (modelled_status(simulated.simulation.summary) == ReserveStatus::keeps) return answer;
    const auto probability = answer.reach_at_95_percent ? std::optional(reach_probability) : std::nullopt;
    const auto capacity_ah = try_compute([&] { return min_capacity_ah(*mission, probability); }).value_or(std::nullopt);
    // It is that of the minimum of software, which the present pack may suffice for.
    if (capacity_ah && *capacity_ah > simulated.mission.setup.battery.capacity_ah) answer.capacity_ah = capacity_ah;
    return answer;
}

ReserveStatus reserve_status(const SimulatedMission& simulated) {
    const auto& summary = simulated.simulation.summary;
    const auto status = modelled_status(summary);
    const bool keeps_by_flights = !summary.by_flights || summary.by_flights->keeps_reserve;
    return status == ReserveStatus::keeps && !keeps_by_flights ? ReserveStatus::may_keep : status;
}

std::vector<std::string> card_lines(const SimulatedMission& simulated, const MissionAssessment& answer) {
    std::vector<std::string> lines{landing_line(simulated.simulation.summary),
                                   reserve_line(simulated.simulation.summary), reach_line(simulated, answer)};
    if (auto warning = capacity_warning(simulated.mission.setup.battery); !warning.empty())
        lines.insert(lines.begin() + 1, "Warning: " + warning);
    if (simulated.simulation.summary.utility) lines.push_back(utility_line(simulated));
    if (const auto& model = simulated.mission.setup.power_model) {
        lines.push_back(mission::describe(*model));
        lines.back().front() = static_cast<char>(std::toupper(static_cast<unsigned char>(lines.back().front())));
    }
    if (modelled_status(simulated.simulation.summary) == ReserveStatus::keeps) return lines;
    if (auto remedy = remedy_line(simulated, answer); !remedy.empty()) lines.push_back(std::move(remedy));
    return lines;
}

Fields<MissionOutput> record_fields(const MissionOutput*) {
    using R = MissionOutput;
    using M = SimulatedMission;
    using A = MissionAssessment;
    using S = mission::MissionSummary;
    const auto of = [](auto member) {
        return at(&R::simulated, &M::simulation, &mission::Simulation::summary, member);
    };
    const auto probability = [](const S& summary) {
        return summary.samples ? std::optional(summary.samples->probability_below_reserve) : std::nullopt;
    };
    const auto card = [](const R& r) { return card_lines(*r.simulated, *r.assessment); };
    return {field("mission", at(&R::simulated, &M::title), "title of the mission"),
            field("final_soc_percent", of(&S::final_soc_percent), "null: the battery cannot deliver the power"),
            field("reserve_soc_percent", of(&S::reserve_soc_percent), "reserve of the mission"),
            field("keeps_reserve", of(&S::keeps_reserve), "the reserve is left, as modelled"),
            field("probability_below_reserve", of(probability), "of 1000 flights; null: without variability data"),
            field("utility", of(&S::utility), "mean utility per second"),
            field("reach", at(&R::assessment, &A::reach), "largest feasible mission, as modelled"),
            field("reach_with_95_percent", at(&R::assessment, &A::reach_at_95_percent), "with that probability"),
            field("min_capacity_ah", at(&R::assessment, &A::capacity_ah), "smallest battery; null: its own suffices"),
            field("card", card, "text of its card"),
            field("with_capacity_of_flights", of(&S::by_flights), "with the pack's capacity by flights, if it differs",
                  optional_key{})};
}

}  // namespace flightwatt::report
