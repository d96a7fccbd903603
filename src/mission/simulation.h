#pragma once

#include "battery/discharge.h"
#include "mission/disturbance.h"
#include "mission/mission.h"
#include "mission/sampled_soc.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mission {

struct SocRow {
    double time_s = 0.0;  ///< since the mission began
    flight::Phase phase = flight::Phase::takeoff;
    double mechanical_w = 0.0;  ///< what the mission demands, whatever the battery has left
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

/// How a mission's schedule came about.
enum class ScheduleOrigin {
    given,    ///< by the mission
    optimal,  ///< planned, and proven to be as good as the best
    planned,
    infeasible,  ///< no plan keeps the reserve: the one of least energy demand
    replanned    ///< in flight, by an adaptive policy
};

/// "optimal", "no plan keeps the reserve" ...; empty for one that was given.
std::string to_string(ScheduleOrigin origin);

/// What an adaptive policy decided.
struct AdaptiveDecisions {
    std::size_t made = 0;
    std::size_t without_plan = 0;    ///< where no plan kept the reserve: least energy demand was run
    double mechanical_factor = 1.0;  ///< of mechanical power to the model's, as learned at the end
};

/// What a mission comes to. Energies are what the whole mission demands of the battery, also beyond the
/// battery's end.
struct MissionSummary {
    std::string mission;
    ScheduleOrigin schedule = ScheduleOrigin::given;
    std::optional<double> final_soc_percent;  ///< none if the battery cannot deliver the power
    double mechanical_energy_wh = 0.0;
    double compute_energy_wh = 0.0;
    double energy_wh = 0.0;            ///< both together
    double delivered_energy_wh = 0.0;  ///< demanded until the battery ended or failed
    double duration_s = 0.0;
    std::optional<double> depleted_at_s;  ///< when the battery was empty, if before the mission's end
    std::optional<double> cut_off_at_s;   ///< when its voltage fell below the cut-off, if before the end
    std::optional<battery::Undeliverable> undeliverable;
    /// Mean utility a second over the whole mission (of a linear utility of FPS with weight 1: mean FPS), where
    /// the mission states utilities. What would run after the battery's end has none.
    std::optional<double> utility;
    bool feasible = false;  ///< the battery lasts: empty at the very end counts, any earlier does not
    double reserve_soc_percent = 0.0;                           ///< what the mission asks to be left
    bool keeps_reserve = false;                                 ///< feasible, and the reserve is left
    std::optional<AdaptiveDecisions> decisions = std::nullopt;  ///< of an adaptive policy
    std::optional<SampledFlights> samples = std::nullopt;       ///< if flights were drawn
};

struct Simulation {
    SocCurve curve;  ///< up to the end of the mission, or to where the battery cannot deliver
    MissionSummary summary;
};

struct SimulationSteps {
    double output_s = 1.0;       ///< the curve has a row at every multiple, and at every jump
    double integration_s = 0.1;  ///< the Runge-Kutta step, at most
    bool cuts_off = true;        ///< false: the battery goes on below the mission's cut-off voltage
};

/// Runs a mission with a schedule: mechanical and computing power, added, deplete the battery (Eqs. 8-10).
/// Energies are exact integrals; state of charge is integrated numerically and empties once: power that flows
/// back later does not revive it, and neither does the voltage that recovers after a cut-off. `disturbances`
/// happen in its course. Throws UsageError for an output step that is not positive or makes too many rows, and
/// std::invalid_argument for an empty schedule.
Simulation simulate(const MissionSetup& mission, const std::vector<ScheduleSegment>& schedule,
                    const SimulationSteps& steps = {}, const std::vector<Disturbance>& disturbances = {});

/// The same with the mission's own schedule.
Simulation simulate(const Mission& mission, const SimulationSteps& steps = {},
                    const std::vector<Disturbance>& disturbances = {});

/// One line for people: what is left, or when and why the battery failed.
std::string describe(const MissionSummary& summary);

/// time_s,phase,mechanical_w,compute_w,power_w,current_a,soc_percent,terminal_voltage_v
std::string to_csv(const SocCurve& curve);

}  // namespace flightwatt::mission
