#include "base/units.h"
#include "mission/mission_file.h"
#include "mission/planning/depletion_table.h"
#include "mission/planning/planner.h"
#include "mission/simulation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include <benchmark/benchmark.h>
#include <boost/numeric/odeint/algebra/vector_space_algebra.hpp>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

/// Final state of charge of many schedules of the paper's mission: by cumulative tables, beside
/// Boost.Odeint's classic Runge-Kutta with 43 steps of 16 s. Both look at the same schedules, drawn slot by
/// slot.
namespace flightwatt::bench {
namespace {

constexpr int runge_kutta_steps = 43;

mission::PlanningProblem paper_mission() {
    return std::get<mission::PlanningProblem>(mission::read_mission(
        std::filesystem::path(FLIGHTWATT_SOURCE_DIR) / "missions" / "paper" / "plan.toml", {true, std::nullopt}));
}

/// The paper's mission with everything that a schedule needs looked up beforehand.
struct Problem {
    mission::PlanningProblem mission = paper_mission();
    mission::PlanningTables planner = make_planning_tables(mission);
    std::vector<mission::MissionSlot> slots = make_slots(mission);
    std::size_t fixed_choice = planner.utility_per_s.size() - 1;

    /// A free slot runs any of the choices, or the one of least power: how often, differs between schedules, so that
    /// some last the mission. Segments that run the same are not joined.
    void draw(std::mt19937& random, std::vector<mission::IndexedSegment>& schedule) const {
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const double part = uniform(random);
        schedule.clear();
        for (const auto& slot : slots) {
            const auto free = uniform(random) < part ? random() % planner.free_choices : 0;
            schedule.push_back({slot, slot.fixed ? fixed_choice : free});
        }
    }
};

std::vector<std::vector<mission::IndexedSegment>> draw_schedules(const Problem& problem, std::size_t count) {
    std::mt19937 random(1);
    std::vector<std::vector<mission::IndexedSegment>> schedules(count);
    for (auto& schedule : schedules) problem.draw(random, schedule);
    return schedules;
}

/// What the equation's right side needs of a schedule: mechanical curves, and when which power begins.
class ScheduleRate {
  public:
    explicit ScheduleRate(const Problem& problem)
        : battery_(problem.mission.setup.battery), timeline_(mission::timeline_of(problem.mission.setup.duration_s)) {
        for (const auto phase : flight::all_phases)
            curves_[phase] = problem.mission.setup.mechanical->phases[phase].fourier;
        for (const auto& run : problem.planner.depletions.configurations) {
            choice_w_.push_back(power_w(problem.mission.setup.compute, run));
        }
    }

    void take(const std::vector<mission::IndexedSegment>& schedule) {
        schedule_ = &schedule;
        now_ = 0;
    }

    /// Times come in rising order, as Runge-Kutta asks for them.
    void operator()(double /*soc*/, double& percent_per_s, double time_s) {
        while (now_ + 1 < schedule_->size() && time_s >= start_s((*schedule_)[now_ + 1])) ++now_;
        const auto& segment = (*schedule_)[now_];
        const double load_w = power_w(curves_[segment.phase], time_s - timeline_.start_s[segment.phase]) +
                              choice_w_[segment.configuration];
        percent_per_s =
            -units::percentage(internal_current_a(battery_, load_w), units::coulomb_from_ah(battery_.capacity_ah));
    }

    double end_s() const { return timeline_.duration_s; }

  private:
    double start_s(const mission::IndexedSegment& segment) const {
        return timeline_.start_s[segment.phase] + segment.start_s;
    }

    battery::Battery battery_;
    flight::PerPhase<mechanical::FourierModel> curves_;
    mission::MissionTimeline timeline_;
    std::vector<double> choice_w_;
    const std::vector<mission::IndexedSegment>* schedule_ = nullptr;
    std::size_t now_ = 0;
};

double soc_by_odeint(ScheduleRate& rate, const std::vector<mission::IndexedSegment>& schedule, double initial_percent) {
    namespace odeint = boost::numeric::odeint;
    odeint::runge_kutta4<double, double, double, double, odeint::vector_space_algebra> stepper;
    rate.take(schedule);
    double soc = initial_percent;
    odeint::integrate_n_steps(stepper, std::ref(rate), soc, 0.0, rate.end_s() / runge_kutta_steps, runge_kutta_steps);
    return soc;
}

/// The greatest difference to the simulation (Runge-Kutta from jump to jump, 0.1 s), over some of the
/// schedules.
double worst_difference(const Problem& problem, const std::vector<std::vector<mission::IndexedSegment>>& schedules,
                        const std::vector<double>& soc) {
    double worst = 0.0;
    std::size_t lasting = 0;
    for (std::size_t i = 0; i < schedules.size() && lasting < 100; ++i) {
        if (soc[i] <= 0.0) continue;  // the simulation stops at empty
        ++lasting;
        std::vector<mission::ScheduleSegment> schedule;
        for (const auto& segment : schedules[i])
            schedule.push_back({segment, problem.planner.depletions.configurations[segment.configuration]});
        const double reference =
            simulate(problem.mission.setup, schedule, {100.0, 0.1}).summary.final_soc_percent.value_or(std::nan(""));
        worst = std::max(worst, std::abs(soc[i] - reference));
    }
    return lasting == 0 ? std::nan("") : worst;
}

void final_soc_by_tables(benchmark::State& state) {
    const Problem problem;
    const auto schedules = draw_schedules(problem, static_cast<std::size_t>(state.range(0)));
    std::vector<double> soc(schedules.size());
    for (auto _ : state) {
        for (std::size_t i = 0; i < schedules.size(); ++i) {
            soc[i] = *soc_after_schedule(problem.planner.depletions, schedules[i]);
        }
        benchmark::DoNotOptimize(soc.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.counters["worst_difference_percent"] = worst_difference(problem, schedules, soc);
}

/// The depletion by every configuration in each slot.
struct SlotDepletions {
    std::size_t slots = 0;
    std::size_t choices = 0;      ///< the configurations of the table
    std::vector<double> percent;  ///< slots x choices
};

SlotDepletions make_slot_depletions(const mission::DepletionTable& table, std::vector<mission::IndexedSegment> slots) {
    SlotDepletions depletions{slots.size(), table.configurations.size(), {}};
    for (auto& slot : slots) {
        for (slot.configuration = 0; slot.configuration < depletions.choices; ++slot.configuration) {
            depletions.percent.push_back(soc_depletion_percent(table, slot));
        }
    }
    return depletions;
}

/// Final state of charge of the schedule that runs choices[i] in slot i of `depletions`.
double soc_after(const SlotDepletions& depletions, const std::uint16_t* choices, double initial_percent) {
    double depleted_percent = 0.0;
    const double* of_slot = depletions.percent.data();
    for (std::size_t i = 0; i < depletions.slots; ++i) {
        depleted_percent += of_slot[choices[i]];
        of_slot += depletions.choices;
    }
    return initial_percent - depleted_percent;
}

/// The same where only the choices of the slots differ.
void final_soc_by_slots(benchmark::State& state) {
    const Problem problem;
    const auto schedules = draw_schedules(problem, static_cast<std::size_t>(state.range(0)));
    const auto depletions = make_slot_depletions(problem.planner.depletions, schedules.front());
    std::vector<std::uint16_t> choices;
    for (const auto& schedule : schedules) {
        for (const auto& segment : schedule) choices.push_back(static_cast<std::uint16_t>(segment.configuration));
    }
    std::vector<double> soc(schedules.size());
    for (auto _ : state) {
        for (std::size_t i = 0; i < schedules.size(); ++i) {
            soc[i] = soc_after(depletions, choices.data() + i * depletions.slots, 100.0);
        }
        benchmark::DoNotOptimize(soc.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.counters["worst_difference_percent"] = worst_difference(problem, schedules, soc);
}

void final_soc_by_odeint(benchmark::State& state) {
    const Problem problem;
    const auto schedules = draw_schedules(problem, static_cast<std::size_t>(state.range(0)));
    std::vector<double> soc(schedules.size());
    ScheduleRate rate(problem);
    for (auto _ : state) {
        for (std::size_t i = 0; i < schedules.size(); ++i) soc[i] = soc_by_odeint(rate, schedules[i], 100.0);
        benchmark::DoNotOptimize(soc.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.counters["worst_difference_percent"] = worst_difference(problem, schedules, soc);
}

void sizes(benchmark::internal::Benchmark* benchmark) {
    benchmark->ArgName("schedules")->Arg(1000)->Arg(1000000)->Iterations(1)->Unit(benchmark::kMillisecond);
}

BENCHMARK(final_soc_by_tables)->Apply(sizes);
BENCHMARK(final_soc_by_slots)->Apply(sizes);
BENCHMARK(final_soc_by_odeint)->Apply(sizes);

}  // namespace
}  // namespace flightwatt::bench

BENCHMARK_MAIN();
