#pragma once

#include "mission/flight_replanner.h"
#include "mission/mission.h"
#include "mission/schedule.h"

#include <cstddef>
#include <memory>
#include <optional>

namespace flightwatt::live {

/// Which software runs now, and what is to come.
struct LiveDecision {
    compute::Configuration run;
    double utility_per_s = 0.0;                  ///< of that; 0 where the mission states no utility
    std::optional<compute::Configuration> next;  ///< what runs after it, if that changes
    double next_in_s = 0.0;
    std::optional<double> remaining_utility_per_s;  ///< mean a second, from here to the mission's end
    bool keeps_reserve = true;                      ///< of a decision in flight: some plan does
    std::optional<double> final_soc_percent;        ///< of a decision in flight, as planned
    std::size_t changes = 0;                        ///< of what runs, so far
};

/// A mission's schedule beside a real flight: the one that it states or that was planned before the flight, or with
/// `replans` planned anew at every slot of each phase, as an adaptive policy does. A phase that takes longer than
/// planned stays at its end.
class LiveSchedule {
  public:
    /// Throws InputError where `replans` is asked of a mission that has a fixed schedule, and as mission::prepare.
    LiveSchedule(mission::MissionVariant mission, bool replans);

    bool replans() const { return decider_.has_value(); }
    const mission::MissionSetup& setup() const { return setup_of(mission_); }

    /// What runs at a moment; `clock_s` tells how much time lies between two calls. Without a state of the battery the
    /// last decision goes on; std::nullopt before there is one.
    std::optional<LiveDecision> at(const mission::PhaseTime& moment, double clock_s,
                                   const std::optional<battery::BatteryState>& now);
    /// Another flight begins: nothing is learned of it yet.
    void reset();

  private:
    /// The slot that is being flown.
    struct Slot {
        mission::PhaseTime start;
        double clock_s = 0.0;
        battery::BatteryState battery;
    };

    mission::PhaseTime planned_moment(mission::PhaseTime moment) const;
    void decide(const mission::PhaseTime& moment, double clock_s, const battery::BatteryState& now);
    void update_from_slot(double clock_s, double soc_percent);

    mission::MissionVariant mission_;
    std::unique_ptr<const mission::AdaptivePlanner> planner_;  ///< the decider refers to it
    std::optional<mission::FlightReplanner> decider_;
    mission::Schedule schedule_;
    std::optional<Slot> slot_;
    bool keeps_reserve_ = true;
    std::optional<double> final_soc_percent_;
    std::optional<compute::Configuration> running_;
    std::size_t changes_ = 0;
};

}  // namespace flightwatt::live
