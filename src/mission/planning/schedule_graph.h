#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// A time in which one choice runs throughout.
struct ChoiceSlot {
    double duration_s = 0.0;
    std::optional<std::size_t> fixed = std::nullopt;  ///< the choice that the mission states
};

/// The choice that is running when the first slot starts.
struct RunningChoice {
    std::size_t choice = 0;
    double since_s = 0.0;
};

/// One choice a slot. After a change the new choice is kept for at least `dwell_s`, or until the next fixed slot if
/// that is sooner. A run that contains a fixed slot may be of any length; the end of the last slot does not excuse a
/// run that started too late.
struct ScheduleChoices {
    std::vector<ChoiceSlot> slots;
    std::vector<double> utility_per_s;  ///< of every choice
    std::size_t free_choices = 0;       ///< number of leading choices that may be chosen; the others are only fixed
    double dwell_s = 0.0;
    std::optional<RunningChoice> running;
};

/// Running a choice from one slot to before another.
struct ChoiceRun {
    std::size_t choice = 0;
    std::size_t to = 0;
    double utility = 0.0;
    bool continues = false;  ///< the choice runs already: one slot more of it
};

/// The schedules as paths of a graph. Its nodes are the starts of slots at which the running choice may end; from
/// there a run of minimum duration begins, or the same choice continues for one slot.
struct ScheduleGraph {
    std::size_t slots = 0;
    std::size_t choices = 0;
    /// Runs from each slot's start. Those that continue are listed only where a new run of the choice is longer.
    std::vector<std::vector<ChoiceRun>> runs;
    std::size_t begin = 0;                 ///< the first slot after the dwell time of the running choice
    std::size_t begin_choice = no_choice;  ///< the choice that runs then
    double utility_before_begin = 0.0;     ///< of the slots before `begin`
    static constexpr std::size_t no_choice = std::numeric_limits<std::size_t>::max();
};

ScheduleGraph make_schedule_graph(const ScheduleChoices& problem);

/// Returns the choices of least energy demand, where each choice draws `compute_w`: between two fixed slots, the choice
/// that draws least of those that may run there.
std::vector<std::size_t> least_choices(const ScheduleChoices& problem, const ScheduleGraph& graph,
                                       const std::vector<double>& compute_w);

/// Returns the sum of utility_per_s * duration.
double utility_of(const ScheduleChoices& problem, const std::vector<std::size_t>& choices);

}  // namespace flightwatt::mission
