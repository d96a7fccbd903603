#pragma once

#include "mission/plan.h"

#include <functional>
#include <optional>
#include <string>

namespace flightwatt::mission {

/// The mission with a cruise of so many seconds. May throw InputError where its schedule does not fit.
using MissionForCruise = std::function<MissionVariant(double cruise_s)>;

/// What forbids more.
enum class LimitingFactor {
    charge,
    power,   ///< beyond, the battery could not deliver the power, whatever its charge
    cut_off  ///< beyond, its voltage would fall below the cut-off
};

/// "charge", "power" or "cut-off".
std::string to_string(LimitingFactor bound);

/// The most of something with which a mission still lands with its reserve.
struct FeasibilityLimit {
    double value = 0.0;
    double final_soc_percent = 0.0;                            ///< then, simulated
    double margin_percent = 0.0;                               ///< for the sake of a probability
    std::optional<UncertaintySources> sources = std::nullopt;  ///< what may differ with that probability
    double residual_percent = 0.0;                             ///< what is left, less reserve and margin
    LimitingFactor limited_by = LimitingFactor::charge;
};

/// The limit `at`, whose flights need a margin, of which `beyond` is the mission with a little more.
FeasibilityLimit limit_at(double value, double margin_percent, const Mission& at, const Mission& beyond);

/// With a `probability`, that part of the flights which sampling/flight_draws.h makes of the answer keep the reserve;
/// and they throw as require_known_spread does.

/// The longest cruise [s] with the mission's schedule, or if it is yet to be planned with the one that demands least
/// energy. Throws NoResultError if no cruise that the schedule fits into is short enough, or none is too long.
FeasibilityLimit longest_cruise(const MissionForCruise& mission_of,
                                const std::optional<double>& probability = std::nullopt);

/// The greatest constant power [W] that the mission can feed besides, all the way. Throws NoResultError if it
/// does not land with its reserve as it is.
FeasibilityLimit largest_payload(const MissionVariant& mission,
                                 const std::optional<double>& probability = std::nullopt);

/// The mission with a constant load besides.
Mission with_payload(const Mission& mission, double payload_w);

/// The least capacity [Ah] with which the mission lands with its reserve, its battery otherwise as it is,
/// with the mission's own schedule or the one that demands least energy. None if no capacity is enough.
std::optional<double> min_capacity_ah(const MissionVariant& mission,
                                      const std::optional<double>& probability = std::nullopt);

/// State of charge at the end less the reserve [points]: by tables where they hold, else simulated. Negative
/// if the reserve is not kept, and the more so the earlier the battery ends.
double surplus_percent(const Mission& mission);

/// Whether the length of the cruise differs between flights, as nothing states it of the mission.
bool cruise_duration_varies(const MissionSetup& mission);

/// What to state of such a cruise instead of `now_s` [s]: "a stated cruise of at most 20 min 1 s (duration_s = ...".
std::string describe_stated_cruise(double max_s, double now_s);

/// By how much a mission that no schedule lands with its reserve misses it, and what would mend that, each
/// measure on its own; a measure that alone is not enough is none.
struct InfeasibilityReport {
    double shortfall_percent = 0.0;                   ///< of the schedule that demands least energy
    double shortfall_wh = 0.0;                        ///< the same, as a part of what a full battery holds
    std::optional<double> cut_off_at_s;               ///< short is then also what is demanded after the cut-off
    std::optional<double> cruise_s;                   ///< the longest that lands, its duration stated by the mission
    bool cruise_differs_now = false;                  ///< between flights, as the mission does not state its duration
    std::optional<double> min_fixed_surplus_percent;  ///< over the reserve, with the least where quality is fixed
    std::optional<double> reserve_soc_percent;        ///< the greatest that can be kept
    std::optional<double> capacity_ah;                ///< the least that suffices
};

/// `plan`, made with `probability`, is infeasible, of the mission that `mission_of` gives for the cruise as it is.
InfeasibilityReport infeasibility_report(const PlanningProblem& problem, const MissionPlan& plan,
                                         const MissionForCruise& mission_of,
                                         const std::optional<double>& probability = std::nullopt);

/// For people: "short by 2.1 points (0.23 Wh); ...".
std::string describe(const MissionSetup& mission, const InfeasibilityReport& report);

}  // namespace flightwatt::mission
