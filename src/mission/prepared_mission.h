#pragma once

#include "mission/disturbance.h"
#include "mission/flight_replanner.h"
#include "mission/simulation.h"

#include <optional>

namespace flightwatt::mission {

/// A mission with all decisions made before take-off.
struct PreparedMission {
    MissionSetup setup;
    Schedule schedule;                        ///< empty if a policy makes it in flight
    std::optional<AdaptivePlanner> adaptive;  ///< such a policy
    ScheduleOrigin origin = ScheduleOrigin::given;
};

/// Plans a mission that is yet to be planned; of an adaptive one, prepares the plans, or with `probability` plans it
/// before take-off, too. Throws as plan_mission.
PreparedMission prepare_mission(const MissionVariant& mission, const std::optional<double>& probability = std::nullopt);

/// A simulated schedule.
struct SimulatedFlight {
    Schedule schedule;
    Simulation simulation;
    /// The mission as it was flown, if that is not the prepared one: its lines were chosen in flight.
    std::optional<MissionSetup> setup = std::nullopt;
};

/// Simulates a mission with disturbances that its schedule or policy does not know.
SimulatedFlight simulate_prepared(const PreparedMission& prepared, const SimulationOptions& steps = {},
                                  const Disturbances& disturbances = {});

/// The mission as it really is with the lines of `chosen`: power and duration of the cruise differ from those as planned
/// as `actual` differs from `first`, both with the same lines. A measured power is repeated where it is too short.
MissionSetup actual_with_lines(const MissionSetup& first, const MissionSetup& chosen, const MissionSetup& actual);

struct AdaptiveResult {
    Schedule schedule;  ///< that resulted
    AdaptiveDecisions decisions;
    std::optional<MissionSetup> setup = std::nullopt;  ///< as flown, if lines were chosen
};

/// Simulates `actual`, the mission with its true durations, battery and powers, with disturbances. The policy replans
/// at each decision from the state of charge, the RC voltage, the completed fraction of the phase and the estimated
/// factor of mechanical power (docs/methods.md, Eqs. 33 and 34). Without a plan that keeps the reserve with its margin,
/// it runs the configuration of least power; fixed segments are always kept. Lines over an
/// area that are chosen with the schedule are chosen again, but for those flown (actual_with_lines).
AdaptiveResult simulate_adaptive(const AdaptivePlanner& planner, const MissionSetup& actual,
                                 const Disturbances& disturbances);

}  // namespace flightwatt::mission
