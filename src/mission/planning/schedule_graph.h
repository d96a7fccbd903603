#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace flightwatt::mission {

/// A time in which one choice runs throughout.
struct ChoiceSlot {
    double duration_s = 0.0;
    std::optional<std::size_t> fixed = std::nullopt;  ///< the choice is made
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
};

/// The choices as a graph: at a node between two slots, a choice has run for long enough to end. From there either a
/// run of minimum duration begins, or the same choice continues for one slot.
struct ScheduleGraph {
    std::size_t slots = 0;
    std::size_t choices = 0;
    std::vector<std::vector<ChoiceRun>> runs;      ///< that may begin with a slot
    std::vector<std::vector<ChoiceRun>> one_more;  ///< the slot alone; only where a new run is longer
    std::size_t begin = 0;                         ///< the first slot that is not committed already
    std::size_t begin_choice = no_choice;          ///< what runs then
    double utility_before_begin = 0.0;             ///< of the slots that are committed
    static constexpr std::size_t no_choice = std::numeric_limits<std::size_t>::max();
};

ScheduleGraph make_schedule_graph(const ScheduleChoices& problem);

/// The choices of least energy demand, where each choice draws `compute_w`: in each time between fixed slots the one
/// that draws least of those that may run there.
std::vector<std::size_t> least_choices(const ScheduleChoices& problem, const ScheduleGraph& graph,
                                       const std::vector<double>& compute_w);

/// Sum of utility_per_s * duration.
double utility_of(const ScheduleChoices& problem, const std::vector<std::size_t>& choices);

/// A part of a schedule that ends with a run; `before` is the index of the previous run in the trail.
struct RunStep {
    std::size_t before = 0;
    std::size_t choice = 0;
    std::size_t to = 0;
};

/// The choices that lead to the end of a run.
std::vector<std::size_t> choices_until(RunStep last, const std::vector<RunStep>& trail, const ScheduleGraph& graph);

}  // namespace flightwatt::mission
