#pragma once

#include "base/statistics.h"
#include "battery/discharge.h"
#include "mechanical/mechanical_model.h"
#include "path/area.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mission {

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

/// Decisions of an adaptive policy.
struct AdaptiveDecisions {
    std::size_t made = 0;
    std::size_t without_plan = 0;    ///< where no plan kept the reserve: least energy demand was run
    double mechanical_factor = 1.0;  ///< of mechanical power to the model's, as estimated at the end
};

/// State of charge at one part of the mission, over the flights.
struct SocBand {
    double time_s = 0.0;  ///< of the mission as planned
    double p05_percent = 0.0;
    double p50_percent = 0.0;
    double p95_percent = 0.0;
};

/// Quantities that vary between drawn flights, each with its basis; and those that are fixed, because their variability
/// is unknown or the mission states them.
struct UncertaintySources {
    std::vector<std::string> varied;
    std::vector<std::string> fixed;
};

/// "drawn: ...; not drawn: ...".
std::string describe(const UncertaintySources& sources);

inline constexpr std::array<int, 5> shown_quantiles_percent{5, 25, 50, 75, 95};

/// How flights that were drawn end. Those that run empty, are cut off or ask for more than the battery can deliver have
/// the state of charge of that moment, and land below the reserve even if that is 0.
struct MonteCarloResult {
    std::string mission;
    std::size_t samples = 0;
    std::uint64_t seed = 0;
    double reserve_soc_percent = 0.0;
    double final_soc_mean_percent = 0.0;
    double final_soc_sd_percent = 0.0;
    std::array<double, shown_quantiles_percent.size()> final_soc_quantiles_percent{};
    double probability_depleted = 0.0;                      ///< empty before the end
    double probability_battery_failure = 0.0;               ///< that, or cut off, or beyond the power limit
    double probability_below_reserve = 0.0;                 ///< the share of the flights
    double probability_below_reserve_standard_error = 0.0;  ///< sqrt(p (1 - p) / samples)
    /// Of the part of new flights: by the number drawn, and by the few flights that show how flights differ.
    Interval probability_below_reserve_95;
    /// False: nothing shows how flights differ in power (one flight, a published model). The probabilities are unknown.
    bool variability_is_known = true;
    UncertaintySources sources;
    std::vector<SocBand> bands;
};

/// Cause of a limit.
enum class LimitingFactor {
    charge,
    power,    ///< beyond, the battery could not deliver the power at any charge
    cut_off,  ///< beyond, its voltage would fall below the cut-off
    path      ///< none of them: all of the path fits
};

/// "charge", "power", "cut-off" or "path".
std::string to_string(LimitingFactor bound);

/// The greatest value with which a mission lands with its reserve.
struct FeasibilityLimit {
    double value = 0.0;
    double final_soc_percent = 0.0;                            ///< with it, simulated
    double margin_percent = 0.0;                               ///< for a probability
    std::optional<UncertaintySources> sources = std::nullopt;  ///< what may differ with that probability
    double residual_percent = 0.0;                             ///< final charge minus reserve and margin
    LimitingFactor limited_by = LimitingFactor::charge;
};

/// How a mission lands with the capacity that the flights of its pack indicate, where its own contradicts them.
struct EstimatedLanding {
    double capacity_ah = 0.0;
    std::optional<double> final_soc_percent;  ///< none if the battery cannot deliver the power
    std::optional<double> fails_at_s;         ///< empty, cut off, or asked for more power than it can deliver
    bool keeps_reserve = false;
};

/// "59.70 % with the 2.05 Ah that the flights indicate"
std::string describe(const EstimatedLanding& landing, int decimals = 2);

/// Result of a mission. Energies are the demand of the whole mission, also after the battery's end.
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
    bool feasible = false;                    ///< the battery lasts: empty at the very end counts, any earlier does not
    double reserve_soc_percent = 0.0;         ///< required by the mission
    bool keeps_reserve = false;               ///< feasible, and the reserve is left
    std::vector<std::string> uncertain = {};  ///< as in MissionSetup
    std::optional<path::SurveyLayout> lines = std::nullopt;     ///< over an area, if they were chosen
    std::optional<double> coverage = std::nullopt;              ///< with them: how often a place is seen on average
    std::optional<AdaptiveDecisions> decisions = std::nullopt;  ///< of an adaptive policy
    std::optional<MonteCarloResult> samples = std::nullopt;     ///< if flights were drawn
    std::optional<EstimatedLanding> by_flights = std::nullopt;
    std::optional<mechanical::HeldOutScore> power_model = {};  ///< as in MissionSetup
};

/// Which model a mission uses and how it predicts: "power by each phase's mean: 18.6 % off on 4 flights left out of
/// the fit".
std::string describe(const mechanical::HeldOutScore& power_model);

/// When the battery ended or failed, or the mission's end if it lasts.
double powered_end_s(const MissionSummary& summary);

/// "lines 20, 35 m apart on 30 degrees at 12 m/s", the airspeed only where the lines state it.
std::string describe(const path::SurveyLayout& layout);

/// One line for people: the final charge, or time and cause of the battery's failure.
std::string describe(const MissionSummary& summary);

/// The best first: by state of charge left, then (when empty) by how long the battery lasted; those whose
/// power it cannot deliver last. Equals keep their order.
std::vector<MissionSummary> ranked(std::vector<MissionSummary> summaries);

}  // namespace flightwatt::mission
