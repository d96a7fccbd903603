#pragma once

#include "mission/flight_replanner.h"
#include "mission/mission.h"
#include "mission/schedule.h"

#include <cstddef>
#include <memory>
#include <optional>

namespace flightwatt::live {

/// The software configuration that runs now, and the rest of the schedule.
struct LiveDecision {
    compute::Configuration run;
    double utility_per_s = 0.0;                  ///< utility of `run`; 0 if the mission states none
    std::optional<compute::Configuration> next;  ///< the next different configuration
    double next_in_s = 0.0;
    std::optional<double> remaining_utility_per_s;  ///< mean from now to the mission's end
    bool keeps_reserve = true;                      ///< the replanned schedule keeps the reserve
    std::optional<double> final_soc_percent;        ///< planned charge at landing of a replanned schedule
    std::size_t changes = 0;                        ///< number of changes of `run` so far
};

/// The schedule of a mission during a real flight: stated by the mission, planned before the flight, or with `replans`
/// replanned at every slot of each phase as by an adaptive policy. A phase that takes longer than planned stays in its
/// last slot.
class LiveSchedule {
  public:
    /// Plans the mission if it has no schedule. Throws InputError for `replans` of a mission with a fixed schedule, and
    /// as mission::prepare_mission.
    LiveSchedule(mission::MissionVariant mission, bool replans);

    const mission::MissionSetup& setup() const { return setup_of(mission_); }

    /// Returns the decision at a moment of the mission; std::nullopt before the first plan. `clock_s` gives the time
    /// between calls. Replanning needs the battery's state `now`; without it the last plan continues.
    std::optional<LiveDecision> at(const mission::PhaseTime& moment, double clock_s,
                                   const std::optional<battery::BatteryState>& now);
    /// Prepares for another flight of the mission.
    void reset();

  private:
    struct Slot {
        mission::PhaseTime start;
        double clock_s = 0.0;
        battery::BatteryState battery;
    };

    mission::PhaseTime planned_moment(mission::PhaseTime moment) const;
    void decide(const mission::PhaseTime& moment, double clock_s, const battery::BatteryState& now);
    void update_from_slot(double clock_s, double soc_percent);

    mission::MissionVariant mission_;
    std::unique_ptr<const mission::AdaptivePlanner> planner_;  ///< referred to by the decider
    std::optional<mission::FlightReplanner> decider_;
    mission::Schedule schedule_;
    std::optional<Slot> slot_;  ///< the current slot of the plan
    bool keeps_reserve_ = true;
    std::optional<double> final_soc_percent_;
    std::optional<compute::Configuration> running_;
    std::size_t changes_ = 0;
};

}  // namespace flightwatt::live
