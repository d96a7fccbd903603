#pragma once

#include "mission/planning/schedule_graph.h"
#include "mission/planning/slot_dynamics.h"

#include <cstddef>
#include <vector>

namespace flightwatt::mission {

struct CurvePoint {
    double x = 0.0;
    double y = 0.0;
};

/// Straight lines between points, concave and nowhere falling; minus infinity before the first point, level beyond the
/// last. Without points: minus infinity.
struct ConcaveCurve {
    std::vector<CurvePoint> points;
};

/// The least such curve that is nowhere below any of the points.
ConcaveCurve concave_hull(std::vector<CurvePoint> points);

double value_at(const ConcaveCurve& curve, double x);

/// A rising map on an interval: the image of its end, and the least slope.
struct MappedCell {
    double start = 0.0;
    double end = 0.0;
    double end_maps_to = 0.0;
    double growth = 1.0;
};

/// Adds points whose hull is an upper bound of `gain` plus `curve` of any map that is possible within the cell.
void add_mapped(const ConcaveCurve& curve, const MappedCell& cell, double gain, std::vector<CurvePoint>& points);

/// Which choice to run in each slot, so that the battery lands with the reserve.
struct ScheduleProblem {
    const SlotDynamics& exact;
    const SlotDynamics& coarse;  ///< in longer steps, for the many states that are compared
    const SlotDynamics& medium;  ///< in between, where `coarse` is too inaccurate
    const ScheduleChoices& choices;
    battery::BatteryState start;
    double reserve_soc_percent = 0.0;
};

/// Where a run leads to from evenly spread effective charges.
struct RunTransition {
    std::vector<double> end_percent;  ///< minus infinity: the battery does not do it
    std::vector<double> growth;       ///< by which the end rises at least with the start, from the charge below
};

/// An upper bound of the utility that can follow from any state in which a slot may be reached.
///
/// If nothing charges, more charge and less RC voltage are better at any later time (Eqs. 23 and 26 with -U_rc are a
/// cooperative system). So no schedule has more charge or less RC voltage than that of least power, the difference of
/// two charges never shrinks, and RC voltage costs between `rc_low` and `rc_high` points a volt.
struct UtilityBound {
    /// Of the schedule of least power at each slot's start, and the mission's end.
    std::vector<battery::BatteryState> min_power_trajectory;
    double spare_percent = 0.0;  ///< surplus of that schedule over the reserve; no state that lands is lower by more
    std::size_t cells = 0;       ///< of charge, from there up to min_power_trajectory
    std::vector<double> rc_low;  ///< [points/V] at each slot's start
    std::vector<double> rc_high;
    std::vector<double> rc_usual;  ///< rc_high, if neither a cut-off nor the power limit ends what lands otherwise
    /// By which leaving out a volt makes a state better, about: beyond rc_low, and where the voltage limits the power.
    std::vector<double> rc_joined;
    std::vector<double> max_above_v;  ///< RC voltage of the greatest power above the trajectory's, at each slot's start
    /// Where there is a cut-off: with less than this charge not even the least power keeps the battery from it. At each
    /// slot's start, for RC voltages from the course's on, in equal steps.
    std::vector<std::vector<double>> min_charge_percent;
    std::vector<double> enough_step_v;
    std::vector<ConcaveCurve> any;                 ///< over effective charge; free to begin a run
    std::vector<std::vector<ConcaveCurve>> with;   ///< while a choice runs that may continue; empty: as any
    std::vector<std::vector<RunTransition>> runs;  ///< as the graph's
    std::vector<std::vector<RunTransition>> one_more;
    bool possible = true;  ///< the course of least power lands with the reserve
};

UtilityBound make_schedule_value(const ScheduleProblem& problem, const ScheduleGraph& graph, std::size_t cells);

/// A state's charge, less what its RC voltage above the trajectory's costs at least.
double effective_percent(const UtilityBound& value, std::size_t slot, const battery::BatteryState& state);

/// Whether the course of least power may land from a state; nothing else lands otherwise.
bool may_land(const UtilityBound& value, std::size_t slot, const battery::BatteryState& state);

/// The bound of what can follow while a choice runs.
double utility_to_go(const UtilityBound& value, std::size_t slot, std::size_t choice, double percent);

/// No more than this is left of an effective charge at `slot` after a run.
double apply_transition(const UtilityBound& value, std::size_t slot, const RunTransition& reach, double percent);

}  // namespace flightwatt::mission
