#pragma once

#include "mechanical/validation.h"
#include "mission/mission.h"
#include "mission/mission_summary.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// Who made a schedule, and what was known then.
enum class ScheduleMethod {
    given,                ///< by the mission file
    invariant,            ///< one configuration all the way: the best that the model says keeps the reserve
    phased,               ///< one a phase: the plan whose slots are whole phases
    planned,              ///< before the flight, by the model
    planned_with_margin,  ///< the same, to keep the reserve with the policy's probability
    replanned,            ///< in flight, by the adaptive policy
    hindsight             ///< by the power and the durations that were measured
};

/// "given", "planned_with_margin", ...
std::string to_string(ScheduleMethod way);

/// What one schedule came to on one flight's measured power.
struct ReplayedSchedule {
    ScheduleMethod way = ScheduleMethod::given;
    MissionSummary
        summary;  ///< its origin is what the model said: infeasible where that saw no way to keep the reserve
    std::optional<double> expected_soc_percent = {};  ///< at the end, by what was known beforehand
    Schedule schedule = {};                           ///< as it was flown
    /// The utility that hindsight has more; none where a reserve is not kept, or the mission states no utility.
    std::optional<double> regret = {};
};

/// Whether the model was fitted to the flight itself.
enum class TrainingOverlap { no, yes, unknown };

/// One mission on one flight.
struct Replay {
    std::string flight;
    std::string mission;
    std::string model;
    std::vector<std::string> model_flights;  ///< that it was fitted to
    TrainingOverlap model_saw_flight = TrainingOverlap::no;
    PerPhase<double> planned_s;  ///< that the schedules were made for
    PerPhase<double> flown_s;
    double expected_mechanical_wh = 0.0;      ///< by the model, over the durations planned for
    double measured_mechanical_wh = 0.0;      ///< of the phases that the mission flies
    std::optional<double> counter_energy_wh;  ///< the same by the counter on board
    std::size_t gaps = 0;                     ///< in the measured power, bridged by straight lines
    double max_gap_s = 0.0;
    std::optional<double> bound;  ///< of the utility: no schedule on the plan's slots that keeps the reserve has more
    bool bound_is_proven = true;
    std::vector<ReplayedSchedule> schedules;  ///< hindsight last; it is absent where the mission states no utility
    std::vector<std::string> notes;
};

/// A mission that could not be flown on a flight, and why.
struct SkippedReplay {
    std::string flight;
    std::string mission;
    std::string reason;
};

struct ReplayOptions {
    mechanical::ModelFitOptions fit;                        ///< of the model of the other flights
    std::optional<mechanical::MechanicalModel> model = {};  ///< instead of that
};

struct Replays {
    std::vector<Replay> replays;  ///< of each mission, every flight
    std::vector<SkippedReplay> not_replayed;
};

/// Flies each flight's measured power, with each schedule's computing power on top, on each mission's battery
/// (docs/methods.md, Replay). The model that schedules are made with is fitted to the other flights alone. Of a mission
/// with a schedule that schedule is flown; of one to be planned all the other ways are. Throws NoResultError for a
/// single flight without options.model, UsageError for a flight given twice, InputError for a mission without a flight
/// (mechanical = "none"), and what plan_mission throws.
Replays replay_flights(std::span<const MissionVariant> missions, std::span<const mechanical::MeasuredFlight> flights,
                       const ReplayOptions& options = {});

/// What a schedule that was made in flight was against one made before it: one that keeps the reserve is better than
/// one that does not; of two that keep it, the one of more utility; of two that do not, the one that lasts longer, or
/// leaves more. It is a tie where utilities are within tie_tolerance of the better one, or charges and times within
/// rounding.
enum class ComparisonOutcome { better, tie, worse };
inline constexpr double tie_tolerance = 1e-3;

struct Comparison {
    std::string flight;
    ComparisonOutcome verdict = ComparisonOutcome::tie;
    bool replanned_keeps_reserve = false;
    bool baseline_keeps_reserve = false;
    double more_utility = 0.0;               ///< replanned less baseline
    std::optional<double> more_soc_percent;  ///< at the end; none where a battery could not deliver
};

/// The replays of one mission, replanned against `baseline`; those that have both.
std::vector<Comparison> compare_replanned(std::span<const Replay> replays, const std::string& mission,
                                          ScheduleMethod baseline);

}  // namespace flightwatt::mission
