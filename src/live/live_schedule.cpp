#include "live/live_schedule.h"

#include "base/error.h"
#include "mission/prepared_mission.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace flightwatt::live {
namespace {

using mission::PhaseTime;

/// The planning problem of a mission, with an adaptive policy.
mission::PlanningProblem deciding(const mission::MissionVariant& mission) {
    const auto* problem = std::get_if<mission::PlanningProblem>(&mission);
    if (problem == nullptr) {
        throw InputError({setup_of(mission).file}, "its schedule is fixed and cannot be replanned",
                         "add [plan] with the choices (docs/missions.md), or remove --replan");
    }
    auto decided = *problem;
    if (!decided.adaptive) {
        decided.adaptive.emplace();
        decided.adaptive->decide_every_s = decided.plan.slot_s;
    }
    return decided;
}

/// The schedule known before the flight.
mission::Schedule planned_schedule(mission::MissionVariant mission) {
    if (auto* problem = std::get_if<mission::PlanningProblem>(&mission)) problem->adaptive.reset();
    return prepare_mission(mission).schedule;
}

bool is_after(const mission::ScheduleSegment& segment, const PhaseTime& moment) {
    return segment.phase > moment.phase || (segment.phase == moment.phase && segment.end_s > moment.time_s);
}

}  // namespace

LiveSchedule::LiveSchedule(mission::MissionVariant mission, bool replans) : mission_(std::move(mission)) {
    if (setup().survey && setup().survey->is_chosen)
        throw InputError({setup().file}, "its lines are yet to be chosen, and the flight on them is followed",
                         "choose them before the flight: flightwatt plan MISSION.toml -o PLANNED.toml");
    if (replans) {
        planner_ = std::make_unique<mission::AdaptivePlanner>(make_adaptive_planner(deciding(mission_)));
        decider_.emplace(*planner_);
    } else {
        schedule_ = planned_schedule(mission_);
    }
}

void LiveSchedule::reset() {
    slot_.reset();
    running_.reset();
    if (planner_) decider_.emplace(*planner_);
}

PhaseTime LiveSchedule::planned_moment(PhaseTime moment) const {
    const auto& duration_s = setup().duration_s;
    while (moment.phase != mission::Phase::landing && !(duration_s[moment.phase] > 0.0))
        moment = {static_cast<mission::Phase>(static_cast<int>(moment.phase) + 1), 0.0};
    if (!(duration_s[moment.phase] > 0.0)) moment.phase = mission::Phase::cruise;  // a mission without a landing
    constexpr double before_the_end_s = 1e-3;
    moment.time_s = std::clamp(moment.time_s, 0.0, std::max(0.0, duration_s[moment.phase] - before_the_end_s));
    return moment;
}

void LiveSchedule::update_from_slot(double clock_s, double soc_percent) {
    const mission::PhaseSegment interval{slot_->start.phase, slot_->start.time_s,
                                         slot_->start.time_s + clock_s - slot_->clock_s};
    if (interval.duration_s() <= 0.0 || interval.end_s > setup().duration_s[interval.phase]) return;
    decider_->update(interval, clip_to_interval(schedule_, interval), slot_->battery, soc_percent);
}

void LiveSchedule::decide(const PhaseTime& moment, double clock_s, const battery::BatteryState& now) {
    const double every_s = planner_->nominal.adaptive->decide_every_s;
    const auto slot_of = [&](const PhaseTime& at) { return std::floor(at.time_s / every_s); };
    if (slot_ && slot_->start.phase == moment.phase && slot_of(slot_->start) == slot_of(moment)) return;
    if (slot_) update_from_slot(clock_s, now.soc_percent);
    auto plan = decider_->replan(moment, now);
    schedule_ = std::move(plan.schedule);
    keeps_reserve_ = plan.feasible;
    final_soc_percent_.reset();
    if (std::isfinite(plan.final_soc_percent)) final_soc_percent_ = plan.final_soc_percent;
    slot_ = Slot{moment, clock_s, now};
}

std::optional<LiveDecision> LiveSchedule::at(const PhaseTime& moment, double clock_s,
                                             const std::optional<battery::BatteryState>& now) {
    const auto planned = planned_moment(moment);
    if (decider_ && now) decide(planned, clock_s, *now);
    const auto current =
        std::ranges::find_if(schedule_, [&](const auto& segment) { return is_after(segment, planned); });
    if (current == schedule_.end()) return std::nullopt;
    const auto& of = setup();
    const auto timeline = mission::timeline_of(of.duration_s);
    const double now_s = timeline.start_s[planned.phase] + planned.time_s;
    LiveDecision decision{
        current->run, utility_per_s(of.utilities, current->run), {}, 0.0, {}, keeps_reserve_, final_soc_percent_, 0};
    double utility = 0.0;
    double remaining_s = 0.0;
    for (auto segment = current; segment != schedule_.end(); ++segment) {
        const double start_s = std::max(now_s, timeline.start_s[segment->phase] + segment->start_s);
        const double duration_s = timeline.start_s[segment->phase] + segment->end_s - start_s;
        utility += utility_per_s(of.utilities, segment->run) * duration_s;
        remaining_s += duration_s;
        if (decision.next || segment->run == decision.run) continue;
        decision.next = segment->run;
        decision.next_in_s = start_s - now_s;
    }
    const bool has_utility = std::ranges::any_of(of.utilities, [](const auto& each) { return each.has_value(); });
    if (has_utility && remaining_s > 0.0) decision.remaining_utility_per_s = utility / remaining_s;
    if (running_ != decision.run) ++changes_;
    running_ = decision.run;
    decision.changes = changes_;
    return decision;
}

}  // namespace flightwatt::live
