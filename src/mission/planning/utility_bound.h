#pragma once

#include "mission/planning/schedule_graph.h"
#include "mission/planning/slot_dynamics.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

/// Which choice to run in each slot, so that the battery lands with the reserve.
struct ScheduleProblem {
    const SlotDynamics& dynamics;
    const ScheduleChoices& choices;
    battery::BatteryState start;
    double reserve_soc_percent = 0.0;
};

struct CurvePoint {
    double x = 0.0;
    double y = 0.0;
};

/// Straight lines between points, concave and nowhere falling; minus infinity before the first point, level beyond the
/// last. Without points: minus infinity.
using ConcaveCurve = std::vector<CurvePoint>;

/// Returns the least such curve that is nowhere below any of the points.
ConcaveCurve concave_hull(std::vector<CurvePoint> points);

double value_at(const ConcaveCurve& curve, double x);

/// An upper bound of the utility that can follow from any state in which a slot may be reached: a function of the
/// effective charge, whose slope is the Lagrangian price of charge. The effective charge of a state is the charge that
/// is no worse with a reference RC voltage: less what the voltage above that costs at least, or more by what a lower
/// voltage saves at most (docs/methods.md, Eq. 30).
struct UtilityBound {
    /// Battery of the schedule of least power at each slot's start and the mission's end: the most charge and the least
    /// RC voltage that any schedule has there. Shorter where the battery does not last.
    std::vector<battery::BatteryState> best_state;
    bool lands = false;                  ///< that schedule keeps the reserve; no other does otherwise
    std::vector<double> lowest_percent;  ///< at each slot's start: no schedule lands from less charge
    std::vector<double> rc_min_cost;     ///< [points/V] by which a volt of RC voltage makes a state worse at least
    std::vector<double> rc_max_cost;     ///< the same at most; infinite where it may end the flight
    std::vector<double> reference_rc_v;  ///< at each slot's start
    std::size_t cells = 0;               ///< of effective charge, from lowest_percent to that of best_state
    std::vector<ConcaveCurve> free;      ///< at each slot's start, if the running choice may end
    std::vector<std::vector<ConcaveCurve>> running;  ///< while a choice continues; empty: as `free`
};

/// Returns the bound with the RC voltages of a schedule as reference, which makes it exact for schedules like that one;
/// without choices, and where the RC voltage may end the flight, with the least RC voltages.
UtilityBound make_utility_bound(const ScheduleProblem& problem, const ScheduleGraph& graph, std::size_t cells,
                                const std::vector<std::size_t>& reference = {});

/// Returns the bound of the utility that can follow from a state at a slot's start while a choice runs; minus infinity
/// where nothing lands.
double utility_to_go(const UtilityBound& bound, std::size_t slot, std::size_t choice,
                     const battery::BatteryState& state);

}  // namespace flightwatt::mission
