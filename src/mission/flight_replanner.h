#pragma once

#include "battery/battery.h"
#include "mission/mission.h"

#include <memory>
#include <optional>

namespace flightwatt::mission {

struct MissionLoad;
struct PlanningTables;

/// What a flight controller knows beforehand: the mission as it was stated, and how that depletes the battery.
struct AdaptivePlanner {
    PlanningProblem nominal;
    std::shared_ptr<const PlanningTables> planner;
};

/// Throws as make_planning_tables does, and std::invalid_argument for a problem without a policy.
AdaptivePlanner make_adaptive_planner(const PlanningProblem& problem);

/// A time of a phase, in seconds since the phase began.
struct PhaseTime {
    Phase phase = Phase::takeoff;
    double time_s = 0.0;
};

/// Decides in flight as an adaptive policy does, in a real flight or a simulated one: the best plan of the rest from
/// the state of charge reached, with the factor of mechanical power that what was flown has taught (docs/methods.md,
/// Eqs. 33 and 34). The planner must outlive it.
class FlightReplanner {
  public:
    explicit FlightReplanner(const AdaptivePlanner& planner);

    /// The plan from a moment on. Where nothing that the battery can deliver is known, what demands least energy. Takes
    /// milliseconds; less than 0.2 s for any mission of a few thousand slots.
    Plan replan(const PhaseTime& moment, const battery::BatteryState& now) const;

    /// Learns from an interval that was flown with `run`: where the battery was before, and what is left.
    void update(const PhaseSegment& interval, const Schedule& run, const battery::BatteryState& before,
                double soc_after_percent);

    /// Of mechanical power to the model's, as learned so far.
    double mechanical_factor() const;

  private:
    /// Seconds flown and points lost so far, where they tell of mechanical power.
    struct Learned {
        double time_s = 0.0;
        double observed_percent = 0.0;
        double predicted_percent = 0.0;
        double mechanical_percent = 0.0;
    };
    /// What a part of a flight depletes [points], as predicted.
    struct PredictedDepletion {
        double percent = 0.0;
        double mechanical_percent = 0.0;  ///< how much more by mechanical power of twice as much
    };

    bool state_counts() const;
    double mechanical_percent(const PhaseSegment& time) const;
    double rest_mechanical_percent(const PhaseTime& moment) const;  ///< of tables
    PredictedDepletion predict(const PhaseSegment& interval, const Schedule& run,
                               const battery::BatteryState& state) const;

    const AdaptivePlanner& adaptive_;
    const PlanningProblem& nominal_;
    MissionTimeline planned_;
    std::shared_ptr<const MissionLoad> known_load_;
    Learned learned_;
    std::optional<compute::Configuration> running_;
    double running_for_s_ = 0.0;
    double required_deviation_ = 0.0;  ///< what the reserve is kept against, as a part of mechanical power
};

/// What of a plan lies within an interval.
Schedule clip_to_interval(const Schedule& plan, const PhaseSegment& interval);

}  // namespace flightwatt::mission
