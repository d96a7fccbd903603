#pragma once

#include "battery/battery.h"
#include "mission/mission.h"

#include <memory>
#include <optional>

namespace flightwatt::mission {

struct MissionLoad;
struct PlanningTables;

/// The mission as stated, with its planning tables.
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

/// Replans in a real or simulated flight as an adaptive policy does: the best plan of the remaining mission from the
/// present state of charge, with the estimated factor of mechanical power (docs/methods.md, Eqs. 33 and 34). The
/// planner must outlive it.
class FlightReplanner {
  public:
    explicit FlightReplanner(const AdaptivePlanner& planner);

    /// The plan from a time on; the schedule of least energy demand if none is feasible. Takes milliseconds, less
    /// than 0.2 s for a few thousand slots. Of an area whose lines are chosen, also for those that are not flown yet.
    Plan replan(const PhaseTime& moment, const battery::BatteryState& now);

    /// The mission as it is planned now, with the lines that were chosen last.
    const PlanningProblem& problem() const { return *problem_; }

    /// Updates the factor of mechanical power from an interval flown with `run`.
    void update(const PhaseSegment& interval, const Schedule& run, const battery::BatteryState& before,
                double soc_after_percent);

    /// Estimated ratio of mechanical power to the model's.
    double mechanical_factor() const;

  private:
    /// Sums over the intervals that are used to estimate mechanical power.
    struct Observed {
        double time_s = 0.0;
        double observed_percent = 0.0;
        double predicted_percent = 0.0;
        double mechanical_percent = 0.0;
    };
    /// Predicted depletion [points] of a part of a flight.
    struct PredictedDepletion {
        double percent = 0.0;
        double mechanical_percent = 0.0;  ///< how much more by mechanical power of twice as much
    };

    /// The plan of a mission from a mission time on.
    Plan plan_from(const PlanningProblem& problem, double time_s, const battery::BatteryState& now) const;
    void use(std::shared_ptr<const PlanningProblem> problem);

    PredictedDepletion predict(const Schedule& run, const battery::BatteryState& state) const;

    const AdaptivePlanner& adaptive_;
    std::shared_ptr<const PlanningProblem> problem_;
    MissionTimeline planned_;
    std::shared_ptr<const MissionLoad> known_load_;
    Observed observed_;
    std::optional<compute::Configuration> running_;
    double running_for_s_ = 0.0;
    double utility_ = 0.0;             ///< so far: utility a second times its time
    double required_deviation_ = 0.0;  ///< of mechanical power, as a fraction: the reserve is kept up to it
};

/// The part of a plan within an interval.
Schedule clip_to_interval(const Schedule& plan, const PhaseSegment& interval);

}  // namespace flightwatt::mission
