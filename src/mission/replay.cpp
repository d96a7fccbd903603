#include "mission/replay.h"

#include "base/error.h"
#include "base/units.h"
#include "mission/plan.h"
#include "mission/planning/planner.h"
#include "mission/planning/survey_layouts.h"
#include "mission/prepared_mission.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double shortest_piece_s = 1.0;  // as the coarse steps of drawn flights

/// One mission on one flight: as it is known before, and as it was.
struct LeaveOneOutMission {
    MissionSetup known;
    MissionSetup actual;
};

std::vector<std::string> flights_of(const mechanical::MechanicalModel& model) {
    std::vector<std::string> names;
    for (const auto& contribution : model.flights) names.push_back(contribution.flight);
    return names;
}

TrainingOverlap saw(const std::vector<std::string>& model_flights, const std::string& flight) {
    if (model_flights.empty()) return TrainingOverlap::unknown;
    return std::ranges::count(model_flights, flight) > 0 ? TrainingOverlap::yes : TrainingOverlap::no;
}

/// Changes a problem, and those of all lines that it may choose.
void change(PlanningProblem& problem, const std::function<void(PlanningProblem&)>& change_one) {
    if (problem.survey) {
        auto choices = *problem.survey;
        choices.mission_with = [with = choices.mission_with, change_one](const path::SurveyLayout& layout) {
            auto mission = with(layout);
            change_one(mission);
            return mission;
        };
        problem.survey = std::make_shared<const SurveyChoices>(std::move(choices));
    }
    change_one(problem);
}

/// Reason why a mission cannot be replayed on a flight; empty if it can.
std::string no_replay_reason(const MissionSetup& mission, const mechanical::MeasuredFlight& flight) {
    for (const auto phase : all_phases) {
        if (mission.duration_s[phase] == 0.0 || flight.power[phase]) continue;
        return fmt::format("the power of its {} was not measured from end to end", phase_word(phase));
    }
    return "";
}

void add_notes(const MissionSetup& mission, const mechanical::MeasuredFlight& flight, Replay& replay) {
    if (mission.survey && mission.survey->is_chosen)
        replay.notes.emplace_back(
            "the mission's lines are chosen: the flight's cruise is cut short or repeated for their duration, and "
            "planned for with the model's");
    else if (mission.cruise_path)
        replay.notes.emplace_back(
            "the mission's path is not flown: its duration is planned for, with the model's cruise");
    else if (mission.cruise_level)
        replay.notes.emplace_back("the mission's airspeed is not used: the model's cruise is as it was fitted");
    for (const auto phase : all_phases) {
        if (mission.duration_s[phase] > 0.0 || !flight.power[phase]) continue;
        replay.notes.push_back(fmt::format("the mission has no {}: that of the flight is left out", phase_word(phase)));
    }
}

/// Energies, durations and gaps of the flight.
void describe_flight(const LeaveOneOutMission& folded, const mechanical::MeasuredFlight& flight, Replay& replay) {
    replay.planned_s = folded.known.duration_s;
    replay.flown_s = folded.actual.duration_s;
    replay.counter_energy_wh = 0.0;
    double measured_wh = 0.0;
    for (const auto phase : all_phases) {
        const double planned_s = folded.known.duration_s[phase];
        if (planned_s == 0.0) continue;
        const auto curve =
            time_scaled_model(folded.known.mechanical->phases[phase], planned_s, folded.known.phase_clock);
        replay.expected_mechanical_wh += units::wh_from_joule(energy_j(curve, planned_s));
        const auto& pieces = *folded.actual.measured_power[phase];
        replay.measured_mechanical_wh += units::wh_from_joule(pieces.energy_j.back());
        const auto& statistics = flight.power[phase]->statistics;
        measured_wh += statistics.energy_wh;
        replay.gaps += statistics.gaps;
        replay.max_gap_s = std::max(replay.max_gap_s, statistics.max_gap_s);
        if (statistics.counter_energy_wh && replay.counter_energy_wh)
            *replay.counter_energy_wh += *statistics.counter_energy_wh;
        else
            replay.counter_energy_wh.reset();
    }
    constexpr double shown_wh = 5e-4;
    if (const double added_wh = replay.measured_mechanical_wh - measured_wh; added_wh > shown_wh)
        replay.notes.push_back(fmt::format("power measured below 0 counts as 0, which adds {:.3f} Wh", added_wh));
}

/// The mission with the lines that a plan has chosen, if it has.
LeaveOneOutMission with_lines(const LeaveOneOutMission& folded, const MissionSetup& planned) {
    if (!planned.survey || planned.survey->layout == folded.known.survey->layout) return folded;
    return {planned, actual_with_lines(folded.known, planned, folded.actual)};
}

/// Simulates a schedule that was made before the flight.
ReplayedSchedule replay_schedule(const LeaveOneOutMission& folded, ScheduleMethod way, const Schedule& schedule,
                                 ScheduleOrigin origin) {
    ReplayedSchedule replayed;
    replayed.way = way;
    replayed.expected_soc_percent = simulate(folded.known, schedule).summary.final_soc_percent;
    replayed.schedule = rescale_to_flown_durations(schedule, folded.known.duration_s, folded.actual.duration_s);
    replayed.summary = simulate(folded.actual, replayed.schedule).summary;
    replayed.summary.schedule = origin;
    return replayed;
}

ReplayedSchedule replay_plan(const LeaveOneOutMission& folded, const PlanningProblem& problem, ScheduleMethod way,
                             const std::optional<double>& probability = std::nullopt) {
    const auto plan = plan_mission(problem, probability);
    return replay_schedule(with_lines(folded, plan.mission.setup), way, plan.mission.schedule,
                           summary_with_origin(plan).schedule);
}

/// The best configuration that, run wherever nothing is fixed, keeps the reserve; else the one of least power. Of lines
/// that are chosen, those with which its utility is greatest.
ReplayedSchedule invariant(const LeaveOneOutMission& folded, const PlanningProblem& problem,
                           const PlanningTables& planner) {
    const auto schedule_with = [&](const PlanningProblem& of, std::size_t choice) {
        Schedule schedule;
        for (const auto& slot : make_slots(of))
            append_merged(schedule, {slot, slot.fixed.value_or(planner.configurations[choice])});
        return schedule;
    };
    struct Best {
        bool keeps = false;
        double utility = 0.0;
        Schedule schedule;
        MissionSetup setup;
    };
    const auto best_of = [&](const PlanningProblem& of) {
        // By rising power, all the way: where one does not keep the reserve, none behind it does.
        Best best;
        std::size_t choice = 0;
        std::size_t low = 0;
        std::size_t high = planner.free_choices;
        while (low < high) {
            const auto middle = low + (high - low) / 2;
            const bool keeps = simulate(of.setup, schedule_with(of, middle)).summary.keeps_reserve;
            best.keeps = best.keeps || keeps;
            (keeps ? low : high) = keeps ? middle + 1 : middle;
        }
        for (std::size_t other = 0; other < low; ++other)
            if (planner.utility_per_s[other] > planner.utility_per_s[choice]) choice = other;
        best.schedule = schedule_with(of, choice);
        best.utility = planner.utility_per_s[choice] + coverage_utility(of.setup);
        best.setup = of.setup;
        return best;
    };
    auto best = best_of(problem);
    for (const auto& layout : problem.survey ? all_layouts(*problem.survey) : std::vector<path::SurveyLayout>()) {
        try {
            auto other = best_of(problem.survey->mission_with(layout));
            if (std::pair(other.keeps, other.utility) > std::pair(best.keeps, best.utility)) best = std::move(other);
        } catch (const InputError&) {  // its path cannot be flown
            continue;
        }
    }
    return replay_schedule(with_lines(folded, best.setup), ScheduleMethod::invariant, best.schedule,
                           best.keeps ? ScheduleOrigin::planned : ScheduleOrigin::infeasible);
}

ReplayedSchedule phased(const LeaveOneOutMission& folded, PlanningProblem problem) {
    change(problem, [](PlanningProblem& each) {
        each.plan.slot_s = std::ranges::max(each.setup.duration_s.values);
        each.plan.dwell_s = 0.0;
    });
    return replay_plan(folded, problem, ScheduleMethod::phased);
}

ReplayedSchedule replanned(const LeaveOneOutMission& folded, const AdaptivePlanner& planner) {
    ReplayedSchedule replayed;
    replayed.way = ScheduleMethod::replanned;
    auto flight = simulate_adaptive(planner, folded.actual, {});
    replayed.schedule = std::move(flight.schedule);
    replayed.summary = simulate(flight.setup.value_or(folded.actual), replayed.schedule).summary;
    replayed.summary.schedule = ScheduleOrigin::replanned;
    replayed.summary.decisions = flight.decisions;
    return replayed;
}

/// The best schedule for the measured power: a plan, or one of the other schedules if that is better (it may change
/// between the plan's slots).
void add_hindsight(const LeaveOneOutMission& folded, PlanningProblem problem, Replay& replay) {
    change(problem, [folded](PlanningProblem& each) {
        const auto [known, actual] = with_lines(folded, each.setup);
        for (const auto phase : all_phases) {
            if (known.duration_s[phase] == 0.0) continue;
            each.plan.slot_scale[phase] *= actual.duration_s[phase] / known.duration_s[phase];
        }
        each.fixed = rescale_to_flown_durations(std::move(each.fixed), known.duration_s, actual.duration_s);
        each.setup = actual;
    });
    const auto plan = plan_mission(problem);
    ReplayedSchedule best;
    best.way = ScheduleMethod::hindsight;
    best.schedule = plan.mission.schedule;
    best.summary = summary_with_origin(plan);
    for (const auto& other : replay.schedules) {
        if (!other.summary.keeps_reserve) continue;
        if (best.summary.keeps_reserve && *other.summary.utility <= *best.summary.utility) continue;
        best.schedule = other.schedule;
        best.summary = other.summary;
        best.summary.decisions.reset();
        best.summary.schedule = ScheduleOrigin::planned;
    }
    if (plan.plan.feasible && !problem.survey) {  // in flight lines may change within a block
        replay.bound = plan.plan.utility_bound;
        replay.bound_is_proven = plan.plan.bound_is_proven;
    }
    if (best.summary.keeps_reserve) {
        for (auto& other : replay.schedules)
            if (other.summary.keeps_reserve) other.regret = *best.summary.utility - *other.summary.utility;
        best.regret = 0.0;
    }
    replay.schedules.push_back(std::move(best));
}

void replay_planned(const PlanningProblem& stated, const LeaveOneOutMission& folded, Replay& replay) {
    auto problem = stated;
    change(problem, [model = *folded.known.mechanical](PlanningProblem& each) {
        const auto stated_s = each.setup.duration_s;
        each.setup = nominal_mission(each.setup, model);
        each.fixed = rescale_to_flown_durations(std::move(each.fixed), stated_s, each.setup.duration_s);
    });
    if (!problem.adaptive) {
        problem.adaptive.emplace();
        problem.adaptive->decide_every_s = problem.plan.slot_s;
    }
    const auto planner = make_adaptive_planner(problem);
    auto& schedules = replay.schedules;
    schedules.push_back(invariant(folded, problem, *planner.planner));
    schedules.push_back(phased(folded, problem));
    schedules.push_back(replay_plan(folded, problem, ScheduleMethod::planned));
    try {
        require_known_spread(problem.setup);
        schedules.push_back(
            replay_plan(folded, problem, ScheduleMethod::planned_with_margin, problem.adaptive->probability));
    } catch (const InputError& error) {
        replay.notes.push_back(fmt::format("no plan with a margin: {}", error.what()));
    }
    schedules.push_back(replanned(folded, planner));
    add_hindsight(folded, problem, replay);
}

/// The model that a flight's schedules are made with.
mechanical::MechanicalModel model_for(const mechanical::MeasuredFlight& flight,
                                      std::span<const mechanical::MeasuredFlight> flights,
                                      const ReplayOptions& options) {
    if (options.model) return *options.model;
    std::vector<mechanical::FlightSamples> others;
    for (const auto& other : flights)
        if (&other != &flight) others.push_back(other.samples);
    auto fit = options.fit;
    fit.name = "fitted to the other flights";
    return fit_model(others, fit).model;
}

void require_flights(std::span<const mechanical::MeasuredFlight> flights, const ReplayOptions& options) {
    if (flights.size() < 2 && !options.model) {
        throw NoResultError(fmt::format("{} flight{}: a model of the other flights needs 2 or more; or give a model",
                                        flights.size(), flights.size() == 1 ? "" : "s"));
    }
    mechanical::require_distinct(flights);
}

/// Throws InputError for a mission that cannot be replayed on any flight.
void require_flies(const MissionSetup& mission) {
    if (mission.mechanical) return;
    throw InputError({mission.file}, "nothing flies in this mission: there is no power to measure for it",
                     "replay a mission with a mechanical model, or `flightwatt simulate` this one");
}

Replay replay_one(const MissionVariant& mission, const mechanical::MeasuredFlight& flight,
                  const mechanical::MechanicalModel& model) {
    const auto& stated = setup_of(mission);
    auto known = nominal_mission(stated, model);
    auto actual = measured_mission(known, flight);
    LeaveOneOutMission folded{std::move(known), std::move(actual)};
    Replay replay;
    replay.flight = flight.samples.flight;
    replay.mission = stated.name;
    replay.model = model.name;
    replay.model_flights = flights_of(model);
    replay.model_saw_flight = saw(replay.model_flights, replay.flight);
    add_notes(stated, flight, replay);
    describe_flight(folded, flight, replay);
    if (stated.survey && stated.survey->is_chosen) {
        folded.actual.duration_s[Phase::cruise] = folded.known.duration_s[Phase::cruise];
        folded.actual = actual_with_lines(folded.known, folded.known, folded.actual);
    }
    if (const auto* scheduled = std::get_if<Mission>(&mission))
        replay.schedules.push_back(
            replay_schedule(folded, ScheduleMethod::given,
                            rescale_to_flown_durations(scheduled->schedule, stated.duration_s, folded.known.duration_s),
                            ScheduleOrigin::given));
    else
        replay_planned(std::get<PlanningProblem>(mission), folded, replay);
    return replay;
}

const ReplayedSchedule* schedule_by(const Replay& replay, ScheduleMethod way) {
    const auto found = std::ranges::find(replay.schedules, way, &ReplayedSchedule::way);
    return found == replay.schedules.end() ? nullptr : &*found;
}

ComparisonOutcome compare(const MissionSummary& ours, const MissionSummary& theirs) {
    if (ours.keeps_reserve != theirs.keeps_reserve)
        return ours.keeps_reserve ? ComparisonOutcome::better : ComparisonOutcome::worse;
    double more = 0.0;
    double rounding = 0.0;
    if (ours.keeps_reserve) {
        more = ours.utility.value_or(0.0) - theirs.utility.value_or(0.0);
        rounding = tie_tolerance * std::max(ours.utility.value_or(0.0), theirs.utility.value_or(0.0));
    } else if (ours.feasible && theirs.feasible) {
        more = *ours.final_soc_percent - *theirs.final_soc_percent;
        rounding = 1e-6;
    } else {
        more = powered_end_s(ours) - powered_end_s(theirs);
        rounding = 1e-3;
    }
    if (std::abs(more) <= rounding) return ComparisonOutcome::tie;
    return more > 0.0 ? ComparisonOutcome::better : ComparisonOutcome::worse;
}

}  // namespace

std::string to_string(ScheduleMethod way) {
    constexpr std::array names{"given",     "invariant", "phased", "planned", "planned_with_margin",
                               "replanned", "hindsight"};
    return names.at(static_cast<std::size_t>(way));
}

path::PiecewisePower measured_power_profile(const mechanical::PhasePower& measured) {
    const auto& time_s = measured.time_s;
    const auto& power_w = measured.power_w;
    path::PiecewisePower pieces;
    double energy_j = 0.0;  // of the current piece
    for (std::size_t i = 1; i < time_s.size(); ++i) {
        energy_j += (power_w[i - 1] + power_w[i]) / 2.0 * (time_s[i] - time_s[i - 1]);
        const double length_s = time_s[i] - pieces.time_s.back();
        if (length_s <= 0.0 || (length_s < shortest_piece_s && i + 1 < time_s.size())) continue;
        pieces.time_s.push_back(time_s[i]);
        pieces.energy_j.push_back(pieces.energy_j.back() + std::max(0.0, energy_j));
        energy_j = 0.0;
    }
    return pieces;
}

MissionSetup nominal_mission(const MissionSetup& stated, const mechanical::MechanicalModel& model) {
    auto known = stated;
    known.mechanical = model;
    known.cruise_level.reset();
    known.cruise_path.reset();
    known.power_model.reset();
    for (const auto phase : all_phases) {
        if (stated.duration_s[phase] == 0.0 || stated.duration_is_stated[phase]) continue;
        known.duration_s[phase] = model.phases[phase].duration_s;
    }
    return known;
}

MissionSetup measured_mission(const MissionSetup& known, const mechanical::MeasuredFlight& flight) {
    auto flown = known;
    for (const auto phase : all_phases) {
        if (known.duration_s[phase] == 0.0) continue;
        const auto& power = flight.power[phase].value();
        flown.measured_power[phase] = std::make_shared<const path::PiecewisePower>(measured_power_profile(power));
        flown.duration_s[phase] = power.time_s.back();
    }
    return flown;
}

Replays replay_flights(std::span<const MissionVariant> missions, std::span<const mechanical::MeasuredFlight> flights,
                       const ReplayOptions& options) {
    require_flights(flights, options);
    for (const auto& mission : missions) require_flies(setup_of(mission));
    std::vector<std::optional<mechanical::MechanicalModel>> models(flights.size());
    std::vector<std::string> no_model_reason(flights.size());
    for (std::size_t i = 0; i < flights.size(); ++i) {
        try {
            models[i] = model_for(flights[i], flights, options);
        } catch (const NoResultError& error) {
            no_model_reason[i] = fmt::format("there is no model of the other flights: {}", error.what());
        }
    }
    Replays result;
    std::vector<std::pair<const MissionVariant*, std::size_t>> flown;
    for (const auto& mission : missions) {
        const auto& setup = setup_of(mission);
        for (std::size_t i = 0; i < flights.size(); ++i) {
            auto reason = models[i] ? no_replay_reason(setup, flights[i]) : no_model_reason[i];
            if (!reason.empty())
                result.not_replayed.push_back({flights[i].samples.flight, setup.name, std::move(reason)});
            else
                flown.emplace_back(&mission, i);
        }
    }
    result.replays.resize(flown.size());
    std::mutex mutex;  // guards `done`
    std::size_t done = 0;
    if (options.progress) options.progress(done, flown.size());
    for_each_in_parallel(flown.size(), [&](std::size_t k) {
        const auto& [mission, i] = flown[k];
        result.replays[k] = replay_one(*mission, flights[i], *models[i]);
        if (!options.progress) return;
        const std::lock_guard lock(mutex);
        options.progress(++done, flown.size());
    });
    return result;
}

std::vector<Comparison> compare_replanned(std::span<const Replay> replays, const std::string& mission,
                                          ScheduleMethod baseline) {
    std::vector<Comparison> comparisons;
    for (const auto& replay : replays) {
        if (replay.mission != mission) continue;
        const auto* replanned = schedule_by(replay, ScheduleMethod::replanned);
        const auto* other = schedule_by(replay, baseline);
        if (!replanned || !other) continue;
        const auto& ours = replanned->summary;
        const auto& theirs = other->summary;
        Comparison comparison{replay.flight,
                              compare(ours, theirs),
                              ours.keeps_reserve,
                              theirs.keeps_reserve,
                              ours.utility.value_or(0.0) - theirs.utility.value_or(0.0),
                              std::nullopt};
        if (ours.final_soc_percent && theirs.final_soc_percent)
            comparison.more_soc_percent = *ours.final_soc_percent - *theirs.final_soc_percent;
        comparisons.push_back(std::move(comparison));
    }
    return comparisons;
}

}  // namespace flightwatt::mission
