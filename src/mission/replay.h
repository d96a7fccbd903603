#pragma once

#include "base/parallel.h"
#include "mechanical/validation.h"
#include "mission/mission.h"
#include "mission/mission_summary.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::mission {

/// How a schedule was made.
enum class ScheduleMethod {
    given,                ///< by the mission file
    invariant,            ///< one configuration throughout: the best that keeps the reserve by the model
    phased,               ///< one configuration per phase
    planned,              ///< before the flight, by the model
    planned_with_margin,  ///< the same, to keep the reserve with the policy's probability
    replanned,            ///< in flight, by the adaptive policy
    hindsight             ///< by the power and the durations that were measured
};

/// "given", "planned_with_margin", ...
std::string to_string(ScheduleMethod way);

/// One schedule on the measured power of one flight.
struct ReplayedSchedule {
    ScheduleMethod way = ScheduleMethod::given;
    MissionSummary summary;  ///< with the origin by the model: infeasible if no schedule keeps the reserve
    std::optional<double> expected_soc_percent = {};  ///< at the end, as expected before the flight
    Schedule schedule = {};                           ///< as it was flown
    /// The utility that hindsight has more; none where a reserve is not kept, or the schedule is given.
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
    std::vector<ReplayedSchedule> schedules;  ///< hindsight last, of a mission that is to be planned
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
    /// Receives the numbers of replays that are done and of all, from one thread at a time.
    Progress progress = {};
};

struct Replays {
    std::vector<Replay> replays;  ///< of each mission, every flight
    std::vector<SkippedReplay> not_replayed;
};

/// Pieces of constant power with the measured energy, of 1 s or more, at least from sample to sample. Negative energy
/// counts as 0.
path::PiecewisePower measured_power_profile(const mechanical::PhasePower& measured);

/// The mission as known before a flight: with another mechanical model, its durations where the mission states none,
/// and without a path.
MissionSetup nominal_mission(const MissionSetup& stated, const mechanical::MechanicalModel& model);

/// The mission with the power and durations of a flight, which must have every phase that is flown.
MissionSetup measured_mission(const MissionSetup& known, const mechanical::MeasuredFlight& flight);

/// Simulates each mission on each flight's measured mechanical power (docs/methods.md, Replay), with its own schedule,
/// or if it is to be planned with all other methods. Schedules are made with a model of the other flights. Throws
/// NoResultError for a single flight without options.model, UsageError for a flight given twice, InputError for a
/// mission with mechanical = "none", and as plan_mission.
Replays replay_flights(std::span<const MissionVariant> missions, std::span<const mechanical::MeasuredFlight> flights,
                       const ReplayOptions& options = {});

/// A schedule made in flight, compared with one made before it: better if only it keeps the reserve; if both do, by
/// utility (a tie within tie_tolerance of the greater); if neither does, by endurance or remaining charge.
enum class ComparisonOutcome { better, tie, worse };
inline constexpr double tie_tolerance = 1e-3;

struct Comparison {
    std::string flight;
    ComparisonOutcome outcome = ComparisonOutcome::tie;
    bool replanned_keeps_reserve = false;
    bool baseline_keeps_reserve = false;
    double more_utility = 0.0;               ///< replanned less baseline
    std::optional<double> more_soc_percent;  ///< at the end; none where a battery could not deliver
};

/// The replays of one mission, replanned against `baseline`; those that have both.
std::vector<Comparison> compare_replanned(std::span<const Replay> replays, const std::string& mission,
                                          ScheduleMethod baseline);

}  // namespace flightwatt::mission
