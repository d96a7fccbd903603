#include "mission/planning/planner.h"

#include "mission/flown_schedule.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double most_combinations = 1e6;
constexpr double most_slots = 20000;

struct Choice {
    compute::Configuration run;
    double power_w = 0.0;
    double worth_per_s = 0.0;
};

/// Every way to run one component; none stands for off.
std::vector<std::optional<compute::RunningComponent>> ways_to_run(std::size_t component,
                                                                  const ComponentChoices& choices) {
    std::vector<std::optional<compute::RunningComponent>> ways{compute::RunningComponent{component, {}}};
    for (const auto& levels : choices.levels) {
        std::vector<std::optional<compute::RunningComponent>> longer;
        for (const auto& way : ways) {
            for (const double level : levels) {
                longer.push_back(way);
                longer.back()->qos.push_back(level);
            }
        }
        ways = std::move(longer);
    }
    if (choices.may_be_off) ways.emplace_back(std::nullopt);
    return ways;
}

void require_few(const Mission& mission) {
    double combinations = 1.0;
    for (const auto& component : mission.plan->choices) {
        const double ways = std::accumulate(
            component.levels.begin(), component.levels.end(), 1.0,
            [](double all, const auto& levels) { return all * static_cast<double>(levels.size()); });
        combinations *= ways + (component.may_be_off ? 1.0 : 0.0);
    }
    if (combinations <= most_combinations) return;
    throw InputError(
        {mission.file},
        fmt::format("the components have {:.3g} combinations of levels, more than {:.0e} to choose from",
                    combinations, most_combinations),
        "say with `levels` in [plan] which ones may be chosen");
}

std::vector<Choice> every_choice(const Mission& mission) {
    std::vector<compute::Configuration> runs{{}};
    for (std::size_t i = 0; i < mission.plan->choices.size(); ++i) {
        std::vector<compute::Configuration> longer;
        for (const auto& way : ways_to_run(i, mission.plan->choices[i])) {
            for (const auto& run : runs) {
                longer.push_back(run);
                if (way) longer.back().push_back(*way);
            }
        }
        runs = std::move(longer);
    }
    std::vector<Choice> choices;
    choices.reserve(runs.size());
    for (auto& run : runs) {
        const double draws_w = power_w(mission.compute, run);
        const double worth_per_s = worth(mission.utilities, run);
        choices.push_back({std::move(run), draws_w, worth_per_s});
    }
    return choices;
}

/// Only what is worth more than everything that draws less. Whatever else is kept: with a dwell time, going
/// on with what is fixed can be better than something better.
std::vector<Choice> undominated(std::vector<Choice> choices,
                                const std::vector<compute::Configuration>& kept) {
    std::stable_sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) {
        return a.power_w != b.power_w ? a.power_w < b.power_w : a.worth_per_s > b.worth_per_s;
    });
    std::optional<double> most;
    std::erase_if(choices, [&](const Choice& choice) {
        const bool better = !most || choice.worth_per_s > *most;
        if (better) most = choice.worth_per_s;
        return !better && std::find(kept.begin(), kept.end(), choice.run) == kept.end();
    });
    return choices;
}

}  // namespace

compute::Configuration weakest_configuration(const Mission& mission) {
    require_few(mission);
    const auto choices = every_choice(mission);
    return std::min_element(choices.begin(), choices.end(),
                            [](const auto& a, const auto& b) { return a.power_w < b.power_w; })
        ->run;
}

Planner make_planner(const Mission& mission) {
    if (!mission.plan) throw std::invalid_argument("make_planner: the mission is not to be planned");
    if (std::none_of(mission.utilities.begin(), mission.utilities.end(), [](const auto& u) { return !!u; })) {
        throw InputError({mission.file}, "the mission does not say what quality of service is worth",
                         "give a component utility = { parameter = ..., weight = ... }");
    }
    require_few(mission);
    const auto fixed = configurations_of(mission.schedule);
    const auto kept = mission.plan->dwell_s > 0.0 ? fixed : std::vector<compute::Configuration>();
    Planner planner;
    std::vector<compute::Configuration> configurations;
    for (auto& choice : undominated(every_choice(mission), kept)) {
        configurations.push_back(std::move(choice.run));
        planner.worth_per_s.push_back(choice.worth_per_s);
    }
    planner.free_choices = configurations.size();
    for (const auto& run : fixed) {
        if (std::find(configurations.begin(), configurations.end(), run) != configurations.end()) continue;
        configurations.push_back(run);
        planner.worth_per_s.push_back(worth(mission.utilities, run));
    }
    if (mission.battery.thevenin) {
        if (auto highest = source_voltage_of(with_least_schedule(mission))) {
            for (auto& voltage_v : highest->voltage_v) voltage_v += highest->error_v;
            planner.drains = make_drain_table(mission, std::move(configurations), *highest);
            return planner;
        }
    }
    planner.drains = make_drain_table(mission, std::move(configurations));
    planner.mechanical_drains = make_drain_table(mission, {{}});
    return planner;
}

Planner along(const Mission& mission, Planner planner, const SourceVoltage& source) {
    planner.drains = make_drain_table(mission, std::move(planner.drains.configurations), source);
    return planner;
}

namespace {

/// Appends the slots of a time that nothing is fixed for.
void add_free_slots(flight::Phase phase, double from_s, double to_s, double slot_s, double tolerance_s,
                    std::vector<MissionSlot>& slots) {
    while (from_s < to_s - tolerance_s) {
        const double next_s = (std::floor((from_s + tolerance_s) / slot_s) + 1.0) * slot_s;
        const double end_s = next_s < to_s - tolerance_s ? next_s : to_s;
        slots.push_back({phase, from_s, end_s, std::nullopt});
        from_s = end_s;
    }
}

void require_few_slots(const Mission& mission) {
    double duration_s = 0.0;
    for (const auto phase : flight::all_phases) duration_s += mission.duration_s[phase];
    if (duration_s / mission.plan->slot_s <= most_slots) return;
    throw InputError({mission.file},
                     fmt::format("{} s in slots of {} s are more than {} slots", duration_s,
                                 mission.plan->slot_s, most_slots),
                     "make slot_s in [plan] longer");
}

}  // namespace

std::vector<MissionSlot> slots_of(const Mission& mission, double time_s) {
    require_few_slots(mission);
    std::vector<MissionSlot> slots;
    double phase_begins_s = 0.0;
    for (const auto phase : flight::all_phases) {
        const double duration_s = mission.duration_s[phase];
        const double tolerance_s = same_time_tolerance_s(duration_s);
        double covered_s = std::max(0.0, time_s - phase_begins_s);
        phase_begins_s += duration_s;
        const auto fill_until = [&](double until_s) {
            add_free_slots(phase, covered_s, until_s, mission.plan->slot_s, tolerance_s, slots);
        };
        for (const auto& stretch : mission.schedule) {
            if (stretch.phase != phase || stretch.to_s <= covered_s + tolerance_s) continue;
            fill_until(stretch.from_s);
            slots.push_back({phase, std::max(covered_s, stretch.from_s), stretch.to_s, stretch.run});
            covered_s = stretch.to_s;
        }
        fill_until(duration_s);
    }
    return slots;
}

Mission with_least_schedule(const Mission& mission) {
    if (!mission.plan) return mission;
    const auto weakest = weakest_configuration(mission);
    std::vector<Stretch> schedule;
    for (const auto& slot : slots_of(mission)) {
        schedule.push_back({slot.phase, slot.from_s, slot.to_s, slot.fixed.value_or(weakest)});
    }
    return with_schedule(mission, std::move(schedule));
}

}  // namespace flightwatt::mission
