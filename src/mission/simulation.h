#pragma once

#include "mission/disturbance.h"
#include "mission/mission.h"
#include "mission/mission_summary.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mission {

struct SocRow {
    double time_s = 0.0;  ///< since the mission began
    Phase phase = Phase::takeoff;
    double mechanical_w = 0.0;  ///< demand, also after the battery's end
    double compute_w = 0.0;
    double power_w = 0.0;    ///< both together
    double current_a = 0.0;  ///< inside the battery (Eq. 10); 0 once it has ended
    double soc_percent = 0.0;
    double terminal_voltage_v = 0.0;  ///< at the load
    bool operator==(const SocRow&) const = default;
};

/// State of charge over a mission. Time never decreases. Where power jumps (a phase or a configuration ends,
/// the battery is empty or cut off) two rows have the same time: the last before the jump and the first after
/// it, so that straight lines between rows are true to the curve.
struct SocCurve {
    std::vector<SocRow> rows;
};

struct Simulation {
    SocCurve curve;  ///< up to the end of the mission, or to where the battery cannot deliver
    MissionSummary summary;
};

struct SimulationOptions {
    double output_s = 1.0;       ///< the curve has a row at every multiple, and at every jump
    double integration_s = 1.0;  ///< the Runge-Kutta step, at most; shorter where power or the RC pair change fast
    bool with_curve = true;      ///< false: no rows
};

/// Runs a mission with a schedule: mechanical and computing power, added, deplete the battery (Eqs. 8-10). Energies are
/// exact integrals; state of charge is integrated numerically and empties once: neither power that flows back later nor
/// a voltage that recovers after a cut-off revives it. `disturbances` happen in its course. Throws InputError for a
/// mission that, undisturbed, charges its battery and may not; UsageError for an output step that is not positive or
/// makes too many rows; and std::invalid_argument for an empty schedule.
Simulation simulate(const MissionSetup& mission, const Schedule& schedule, const SimulationOptions& steps = {},
                    const Disturbances& disturbances = {});

/// The same with the mission's own schedule.
Simulation simulate(const Mission& mission, const SimulationOptions& steps = {}, const Disturbances& disturbances = {});

/// How the schedule lands with the capacity that the flights of the mission's pack indicate; none where the mission's
/// capacity agrees with them, or the pack is of no flights.
std::optional<EstimatedLanding> landing_by_flights(const MissionSetup& mission, const Schedule& schedule,
                                                   const Disturbances& disturbances = {});

/// A cruise along its path as it is flown, with the charge along it.
struct FlownTrack {
    std::vector<double> time_s;  ///< since the mission began
    std::vector<double> east_m;  ///< from the start of the path
    std::vector<double> north_m;
    std::vector<double> latitude_deg;  ///< empty where the place of the path on the earth is unknown
    std::vector<double> longitude_deg;
    std::vector<double> soc_percent;          ///< not a number after the battery's end
    std::optional<std::size_t> return_index;  ///< where the way home begins, if a pack is to be changed
    path::Wind wind;
};

/// Returns the track of a simulated mission; std::nullopt of one without a path.
std::optional<FlownTrack> flown_track(const MissionSetup& mission, const Simulation& simulation);

/// time_s,phase,mechanical_w,compute_w,power_w,current_a,soc_percent,terminal_voltage_v
std::string to_csv(const SocCurve& curve);

}  // namespace flightwatt::mission
