#include "base/units.h"
#include "mission/load_segments.h"
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

mission::Mission paper_mission() {
    return mission::read_mission(
        std::filesystem::path(FLIGHTWATT_SOURCE_DIR) / "missions" / "paper" / "plan.toml",
        {true, std::nullopt});
}

/// The paper's mission with everything that a schedule needs looked up beforehand.
struct Problem {
    mission::Mission mission = paper_mission();
    mission::Planner planner = make_planner(mission);
    std::vector<mission::MissionSlot> slots = slots_of(mission);
    std::size_t fixed_choice = planner.worth_per_s.size() - 1;

    /// A free slot runs any of the choices, or the weakest: how often, differs between schedules, so that
    /// some last the mission. Stretches that run the same are not joined.
    void draw(std::mt19937& random, std::vector<mission::TabledStretch>& schedule) const {
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const double part = uniform(random);
        schedule.clear();
        for (const auto& slot : slots) {
            const auto free = uniform(random) < part ? random() % planner.free_choices : 0;
            schedule.push_back({slot.fixed ? fixed_choice : free, slot.phase, slot.from_s, slot.to_s});
        }
    }
};

std::vector<std::vector<mission::TabledStretch>> draw_schedules(const Problem& problem, std::size_t count) {
    std::mt19937 random(1);
    std::vector<std::vector<mission::TabledStretch>> schedules(count);
    for (auto& schedule : schedules) problem.draw(random, schedule);
    return schedules;
}

/// What the equation's right side needs of a schedule: mechanical curves, and when which power begins.
class ScheduleRate {
  public:
    explicit ScheduleRate(const Problem& problem) : battery_(problem.mission.battery) {
        double begins_s = 0.0;
        for (const auto phase : flight::all_phases) {
            curves_[phase] = problem.mission.mechanical->phases[phase].fourier;
            begins_s_[phase] = begins_s;
            begins_s += problem.mission.duration_s[phase];
        }
        end_s_ = begins_s;
        for (const auto& run : problem.planner.drains.configurations) {
            choice_w_.push_back(power_w(problem.mission.compute, run));
        }
    }

    void take(const std::vector<mission::TabledStretch>& schedule) {
        schedule_ = &schedule;
        now_ = 0;
    }

    /// Times come in rising order, as Runge-Kutta asks for them.
    void operator()(double /*soc*/, double& percent_per_s, double time_s) {
        while (now_ + 1 < schedule_->size() && time_s >= begin_s((*schedule_)[now_ + 1])) ++now_;
        const auto& stretch = (*schedule_)[now_];
        const double load_w = power_w(curves_[stretch.phase], time_s - begins_s_[stretch.phase]) +
                              choice_w_[stretch.configuration];
        percent_per_s = -units::percent_of(internal_current_a(battery_, load_w),
                                           units::coulomb_from_ah(battery_.capacity_ah));
    }

    double end_s() const { return end_s_; }

  private:
    double begin_s(const mission::TabledStretch& stretch) const {
        return begins_s_[stretch.phase] + stretch.from_s;
    }

    battery::Battery battery_;
    flight::PerPhase<mechanical::FourierModel> curves_;
    flight::PerPhase<double> begins_s_;
    std::vector<double> choice_w_;
    double end_s_ = 0.0;
    const std::vector<mission::TabledStretch>* schedule_ = nullptr;
    std::size_t now_ = 0;
};

double soc_by_odeint(ScheduleRate& rate, const std::vector<mission::TabledStretch>& schedule,
                     double initial_percent) {
    namespace odeint = boost::numeric::odeint;
    odeint::runge_kutta4<double, double, double, double, odeint::vector_space_algebra> stepper;
    rate.take(schedule);
    double soc = initial_percent;
    odeint::integrate_n_steps(stepper, std::ref(rate), soc, 0.0, rate.end_s() / runge_kutta_steps,
                              runge_kutta_steps);
    return soc;
}

/// The greatest difference to the simulation (Runge-Kutta from jump to jump, 0.1 s), over some of the
/// schedules.
double worst_difference(const Problem& problem,
                        const std::vector<std::vector<mission::TabledStretch>>& schedules,
                        const std::vector<double>& soc) {
    double worst = 0.0;
    std::size_t lasting = 0;
    for (std::size_t i = 0; i < schedules.size() && lasting < 100; ++i) {
        if (soc[i] <= 0.0) continue;  // the simulation stops at empty
        ++lasting;
        auto mission = problem.mission;
        mission.plan.reset();
        mission.schedule.clear();
        for (const auto& s : schedules[i]) {
            mission.schedule.push_back(
                {s.phase, s.from_s, s.to_s, problem.planner.drains.configurations[s.configuration]});
        }
        const double reference =
            simulate(mission, {100.0, 0.1}).summary.final_soc_percent.value_or(std::nan(""));
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
            soc[i] = *soc_after(problem.planner.drains, schedules[i]);
        }
        benchmark::DoNotOptimize(soc.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.counters["worst_difference_percent"] = worst_difference(problem, schedules, soc);
}

/// The same where only the choices of the slots differ.
void final_soc_by_slots(benchmark::State& state) {
    const Problem problem;
    const auto schedules = draw_schedules(problem, static_cast<std::size_t>(state.range(0)));
    const auto drains = make_slot_drains(problem.planner.drains, schedules.front());
    std::vector<std::uint16_t> choices;
    for (const auto& schedule : schedules) {
        for (const auto& stretch : schedule)
            choices.push_back(static_cast<std::uint16_t>(stretch.configuration));
    }
    std::vector<double> soc(schedules.size());
    for (auto _ : state) {
        for (std::size_t i = 0; i < schedules.size(); ++i) {
            soc[i] = soc_after(drains, {choices.data() + i * drains.slots, drains.slots});
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
