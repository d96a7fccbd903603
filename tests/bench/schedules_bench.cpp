#include "base/units.h"
#include "mission/mission_file.h"
#include "mission/planning/planner.h"
#include "mission/simulation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <span>

#include <benchmark/benchmark.h>
#include <boost/numeric/odeint/algebra/vector_space_algebra.hpp>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

/// Final state of charge of many schedules of the paper's mission: by the depletion of each slot, beside Boost.Odeint's
/// classic Runge-Kutta with 43 steps of 16 s. Both are of the same schedules, drawn slot by slot.
namespace flightwatt::bench {
namespace {

constexpr int runge_kutta_steps = 43;

mission::PlanningProblem paper_mission() {
    return std::get<mission::PlanningProblem>(mission::read_mission(
        std::filesystem::path(FLIGHTWATT_SOURCE_DIR) / "missions" / "paper" / "plan.toml", {true, std::nullopt}));
}

/// A slot, and the choice that runs in it.
struct ChosenSlot : flight::PhaseSegment {
    std::size_t choice = 0;
};

/// The paper's mission with everything that a schedule needs looked up beforehand.
struct Problem {
    mission::PlanningProblem mission = paper_mission();
    mission::PlanningTables planner = make_planning_tables(mission);
    std::vector<mission::MissionSlot> slots = make_slots(mission);
    std::size_t fixed_choice = planner.utility_per_s.size() - 1;

    /// A free slot runs any of the choices, or the one of least power: how often, differs between schedules, so that
    /// some last the mission. Segments that run the same are not joined.
    void draw(std::mt19937& random, std::vector<ChosenSlot>& schedule) const {
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const double part = uniform(random);
        schedule.clear();
        for (const auto& slot : slots) {
            const auto free = uniform(random) < part ? random() % planner.free_choices : 0;
            schedule.push_back({slot, slot.fixed ? fixed_choice : free});
        }
    }
};

std::vector<std::vector<ChosenSlot>> draw_schedules(const Problem& problem, std::size_t count) {
    std::mt19937 random(1);
    std::vector<std::vector<ChosenSlot>> schedules(count);
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
        for (const auto& run : problem.planner.configurations) {
            choice_w_.push_back(power_w(problem.mission.setup.compute, run));
        }
    }

    void take(const std::vector<ChosenSlot>& schedule) {
        schedule_ = &schedule;
        now_ = 0;
    }

    /// Times come in rising order, as Runge-Kutta asks for them.
    void operator()(double /*soc*/, double& percent_per_s, double time_s) {
        while (now_ + 1 < schedule_->size() && time_s >= start_s((*schedule_)[now_ + 1])) ++now_;
        const auto& segment = (*schedule_)[now_];
        const double load_w =
            power_w(curves_[segment.phase], time_s - timeline_.start_s[segment.phase]) + choice_w_[segment.choice];
        percent_per_s =
            -units::percentage(internal_current_a(battery_, load_w), units::coulomb_from_ah(battery_.capacity_ah));
    }

    double end_s() const { return timeline_.duration_s; }

  private:
    double start_s(const ChosenSlot& segment) const { return timeline_.start_s[segment.phase] + segment.start_s; }

    battery::Battery battery_;
    flight::PerPhase<mechanical::FourierModel> curves_;
    mission::MissionTimeline timeline_;
    std::vector<double> choice_w_;
    const std::vector<ChosenSlot>* schedule_ = nullptr;
    std::size_t now_ = 0;
};

double soc_by_odeint(ScheduleRate& rate, const std::vector<ChosenSlot>& schedule, double initial_percent) {
    namespace odeint = boost::numeric::odeint;
    odeint::runge_kutta4<double, double, double, double, odeint::vector_space_algebra> stepper;
    rate.take(schedule);
    double soc = initial_percent;
    odeint::integrate_n_steps(stepper, std::ref(rate), soc, 0.0, rate.end_s() / runge_kutta_steps, runge_kutta_steps);
    return soc;
}

/// The greatest difference to the simulation (Runge-Kutta from jump to jump, 0.1 s), over some of the
/// schedules.
double worst_difference(const Problem& problem, const std::vector<std::vector<ChosenSlot>>& schedules,
                        const std::vector<double>& soc) {
    double worst = 0.0;
    std::size_t lasting = 0;
    for (std::size_t i = 0; i < schedules.size() && lasting < 100; ++i) {
        if (soc[i] <= 0.0) continue;  // the simulation stops at empty
        ++lasting;
        std::vector<mission::ScheduleSegment> schedule;
        for (const auto& segment : schedules[i])
            schedule.push_back({segment, problem.planner.configurations[segment.choice]});
        const double reference =
            simulate(problem.mission.setup, schedule, {100.0, 0.1}).summary.final_soc_percent.value_or(std::nan(""));
        worst = std::max(worst, std::abs(soc[i] - reference));
    }
    return lasting == 0 ? std::nan("") : worst;
}

/// Final state of charge of the schedule that runs choices[i] in slot i; `depletions` is slots x choices.
double soc_after(const std::vector<double>& depletions, std::span<const std::uint16_t> choices,
                 std::size_t choice_count, double initial_percent) {
    double depleted_percent = 0.0;
    const double* of_slot = depletions.data();
    for (const auto choice : choices) {
        depleted_percent += of_slot[choice];
        of_slot += choice_count;
    }
    return initial_percent - depleted_percent;
}

void final_soc_by_slots(benchmark::State& state) {
    const Problem problem;
    const auto schedules = draw_schedules(problem, static_cast<std::size_t>(state.range(0)));
    std::vector<double> depletions;
    for (const auto& slot : problem.planner.depletions)
        depletions.insert(depletions.end(), slot.percent.begin(), slot.percent.end());
    const auto slots = problem.slots.size();
    std::vector<std::uint16_t> choices;
    for (const auto& schedule : schedules) {
        for (const auto& segment : schedule) choices.push_back(static_cast<std::uint16_t>(segment.choice));
    }
    std::vector<double> soc(schedules.size());
    for (auto _ : state) {
        for (std::size_t i = 0; i < schedules.size(); ++i) {
            soc[i] = soc_after(depletions, std::span(choices).subspan(i * slots, slots),
                               problem.planner.configurations.size(), 100.0);
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

BENCHMARK(final_soc_by_slots)->Apply(sizes);
BENCHMARK(final_soc_by_odeint)->Apply(sizes);

}  // namespace
}  // namespace flightwatt::bench

BENCHMARK_MAIN();
