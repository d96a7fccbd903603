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

/// Flights drawn a mission: the chance of landing below the reserve then has a standard error of 1.6 percent points at
/// most. A policy plans the rest of each anew in every slot, some thousand times the work: 3.5 points.
constexpr std::size_t flights_drawn = 1000;
constexpr std::size_t flights_drawn_of_policy = 200;
/// Of the band over time.
constexpr std::size_t band_times = 61;

/// Flies a mission, planned first where it is yet to be, or in flight where a policy does; flights are drawn
/// where something says how they differ. The answer is the same at every run.
SimulatedMission fly_for_report(const mission::MissionVariant& mission, const mission::SimulationOptions& steps) {
    SimulatedMission simulated;
    mission::PreparedMission prepared;
    std::optional<mission::MissionSummary> summary;  // of a plan, as finely simulated as it was made
    const auto* problem = std::get_if<mission::PlanningProblem>(&mission);
    if (problem != nullptr && !problem->adaptive) {
        const auto plan = plan_mission(*problem);
        simulated.planned = PlannedSchedule{plan.plan.feasible, plan.plan.utility_bound, plan.margin_percent};
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

/// None where the question has no answer; `why` then says why not.
template <typename Question>
auto ask(const Question& question, std::string* why = nullptr) -> std::optional<decltype(question())> {
    try {
        return question();
    } catch (const NoResultError& error) {
        if (why != nullptr) *why = error.what();
    } catch (const InputError&) {
        if (why != nullptr) *why = "its schedule does not say what runs in a longer cruise";
    }
    return std::nullopt;
}

std::string in_words(const mission::Reach& reach) {
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

std::string landing_line(const SimulatedMission& simulated) {
    const auto& summary = simulated.simulation.summary;
    const auto landing = modelled_landing(summary);
    return summary.by_flights ? fmt::format("{} ({})", landing, describe(*summary.by_flights, 1)) : landing;
}

std::string reserve_line(const SimulatedMission& simulated) {
    const auto& summary = simulated.simulation.summary;
    const bool asks = summary.reserve_soc_percent > 0.0;  // else it is enough that the battery lasts
    const auto reserve = fmt::format("its reserve of {:.3g} %", summary.reserve_soc_percent);
    if (!summary.samples) {
        const auto modelled = summary.keeps_reserve ? (asks ? "Keeps " + reserve : std::string("The battery lasts"))
                                                    : (asks ? "Does not keep " + reserve : "The battery does not last");
        return modelled + " as modelled; nothing says how flights differ, so nobody knows the chance";
    }
    const auto& samples = *summary.samples;
    const auto& below = samples.probability_below_reserve_95;
    return fmt::format("{} with a chance of {:.1f} % ({} flights drawn: 95 % interval {:.1f} to {:.1f})",
                       asks ? "Keeps " + reserve : "The battery lasts",
                       units::percentage(1.0 - samples.probability_below_reserve, 1.0), samples.samples,
                       units::percentage(1.0 - below.high, 1.0), units::percentage(1.0 - below.low, 1.0));
}

std::string now_flown(const SimulatedMission& simulated, const mission::Reach& reach) {
    if (reach.unit != mission::ReachUnit::cruise_s) return "";
    return fmt::format(" (now {})", duration_text(simulated.mission.setup.duration_s[flight::Phase::cruise]));
}

std::string reach_line(const SimulatedMission& simulated, const MissionAssessment& answer) {
    if (!answer.reach) return "How long it could fly is not known: " + answer.no_reach;
    auto line = fmt::format("At most {}{} as modelled", in_words(*answer.reach), now_flown(simulated, *answer.reach));
    if (answer.reach_at_95_percent)
        line += fmt::format(", {} with a chance of {:.0f} %{}", in_words(*answer.reach_at_95_percent),
                            units::percentage(reach_probability, 1.0),
                            answer.cruise_differs_now ? " if that is stated" : "");
    if (answer.is_unplanned) line += ", with as little software as it may run";
    return line;
}

std::string utility_line(const SimulatedMission& simulated) {
    const auto& summary = simulated.simulation.summary;
    auto line = fmt::format("Utility {:.4g}", *summary.utility);
    if (simulated.planned && simulated.planned->feasible)
        line += fmt::format(", of at most {:.4g} that any schedule could have", simulated.planned->bound);
    return line;
}

std::string as_sentence(std::string text) {
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
}

/// Whether less of what the mission flies would keep the reserve.
bool shorter_helps(const SimulatedMission& simulated, const mission::Reach& reach) {
    return reach.unit != mission::ReachUnit::cruise_s ||
           reach.limit.value < simulated.mission.setup.duration_s[flight::Phase::cruise];
}

/// "fly 24 min of cruise at most". Such a length has to be stated: where nothing states that of the mission, flights
/// differ in it, and a longer one on average may land as well.
std::string shorter_way(const SimulatedMission& simulated, const MissionAssessment& answer,
                        const mission::Reach& reach) {
    if (!answer.cruise_differs_now) return fmt::format("fly {} at most", in_words(reach));
    const double now_s = simulated.mission.setup.duration_s[flight::Phase::cruise];
    return "fly " + mission::describe_stated_cruise(reach.limit.value, now_s);
}

/// What would make the mission keep its reserve; empty where nothing is known that would.
std::string remedy_line(const SimulatedMission& simulated, const MissionAssessment& answer) {
    const auto& reach = answer.reach_at_95_percent ? answer.reach_at_95_percent : answer.reach;
    const double capacity_ah = simulated.mission.setup.battery.capacity_ah;
    std::vector<std::string> ways;
    const bool shorter = reach && shorter_helps(simulated, *reach);
    // Beyond what the least software reaches, no plan does.
    const bool is_in_reach = answer.reach_at_95_percent && (!shorter || reach->unit != mission::ReachUnit::cruise_s);
    if (simulated.planned && is_in_reach) ways.emplace_back("plan it with --probability 0.95");
    if (shorter) ways.push_back(shorter_way(simulated, answer, *reach));
    if (answer.capacity_ah)
        ways.push_back(fmt::format("take a battery of {:.2f} Ah (it has {:.4g})", *answer.capacity_ah, capacity_ah));
    if (ways.empty()) return "";
    const auto aim = answer.reach_at_95_percent
                         ? fmt::format("For a chance of {:.0f} %", units::percentage(reach_probability, 1.0))
                         : std::string("To keep it");
    return fmt::format("{}: {}", aim, fmt::join(ways, ", or "));
}

/// By the capacity that the mission has.
ReserveStatus verdict_as_modelled(const mission::MissionSummary& summary) {
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
        simulated.push_back(fly_for_report(mission, steps));
        simulated.back().title = std::move(title);
    }
    return simulated;
}

MissionAssessment assess_mission(const SimulatedMission& simulated, const mission::MissionLoader& mission_of) {
    MissionAssessment answer;
    const auto mission = ask([&] { return mission_of({.allow_unplanned = true}); });
    if (!mission) {
        answer.no_reach = "its file cannot be read again";
        return answer;
    }
    answer.is_unplanned = std::holds_alternative<mission::PlanningProblem>(*mission);
    answer.reach = ask([&] { return find_reach(mission_of); }, &answer.no_reach);
    const bool knows_chance = simulated.simulation.summary.samples.has_value();
    if (answer.reach && knows_chance)
        answer.reach_at_95_percent = ask([&] { return find_reach(mission_of, reach_probability); });
    answer.cruise_differs_now = answer.reach_at_95_percent &&
                                answer.reach_at_95_percent->unit == mission::ReachUnit::cruise_s &&
                                mission::cruise_duration_varies(setup_of(*mission));
    if (verdict_as_modelled(simulated.simulation.summary) == ReserveStatus::keeps) return answer;
    const auto chance = answer.reach_at_95_percent ? std::optional(reach_probability) : std::nullopt;
    const auto capacity_ah = ask([&] { return min_capacity_ah(*mission, chance); }).value_or(std::nullopt);
    // Of the least software, which may land with the pack as it is where what was planned may not.
    if (capacity_ah && *capacity_ah > simulated.mission.setup.battery.capacity_ah) answer.capacity_ah = capacity_ah;
    return answer;
}

ReserveStatus verdict_of(const SimulatedMission& simulated) {
    const auto& summary = simulated.simulation.summary;
    const auto verdict = verdict_as_modelled(summary);
    const bool keeps_by_flights = !summary.by_flights || summary.by_flights->keeps_reserve;
    return verdict == ReserveStatus::keeps && !keeps_by_flights ? ReserveStatus::may_keep : verdict;
}

std::vector<std::string> card_lines(const SimulatedMission& simulated, const MissionAssessment& answer) {
    std::vector<std::string> lines{landing_line(simulated), reserve_line(simulated), reach_line(simulated, answer)};
    if (auto warning = capacity_warning(simulated.mission.setup.battery); !warning.empty())
        lines.insert(lines.begin() + 1, "Warning: " + warning);
    if (simulated.simulation.summary.utility) lines.push_back(utility_line(simulated));
    if (const auto& model = simulated.mission.setup.power_model)
        lines.push_back(as_sentence(mission::describe(*model)));
    if (verdict_as_modelled(simulated.simulation.summary) == ReserveStatus::keeps) return lines;
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
