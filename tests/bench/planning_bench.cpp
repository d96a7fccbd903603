// Plans of random small missions on Thévenin batteries beside all of their schedules, and the time that long ones take.
// usage: planning_bench [MISSIONS [SEED]]: 200 and 71000 if not said; 0: the long ones alone

#include "base/number.h"
#include "helpers/small_missions.h"
#include "mission/plan.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// Of the processor.
double seconds_since(std::clock_t begin) {
    return static_cast<double>(std::clock() - begin) / static_cast<double>(CLOCKS_PER_SEC);
}

/// What a plan falls short of the best schedule, and of its own bound, as parts of these.
struct Compared {
    bool feasible = false;
    bool agrees = false;  ///< on whether there is a schedule that lands
    double shortfall = 0.0;
    double gap = 0.0;
    bool bound_holds = true;
};

Compared compare(const mission::MissionPlan& plan, const std::optional<double>& best) {
    Compared compared;
    compared.feasible = plan.plan.feasible;
    compared.agrees = plan.plan.feasible == best.has_value();
    if (!compared.feasible || !best) return compared;
    const double utility = *plan.summary.utility;
    compared.shortfall = *best > 0.0 ? 1.0 - utility / *best : 0.0;
    compared.gap = plan.plan.utility_bound > 0.0 ? 1.0 - utility / plan.plan.utility_bound : 0.0;
    compared.bound_holds = plan.plan.bound_is_proven && plan.plan.utility_bound >= *best * (1.0 - 1e-9);
    return compared;
}

std::optional<double> best_of(const mission::PlanningProblem& problem, const mission::MissionPlan& plan) {
    return test::EverySchedule(problem, make_planning_tables(problem))
        .max_utility(plan.plan.feasible ? plan.summary.utility : std::nullopt);
}

/// What came of many missions.
struct Tally {
    std::size_t feasible = 0;
    std::size_t wrong = 0;
    std::size_t broken_bounds = 0;
    std::size_t short_of_best = 0;
    std::size_t gaps = 0;
    double worst_shortfall = 0.0;
    double worst_gap = 0.0;
    double slowest_s = 0.0;
};

constexpr double wanted = 1e-4;

void add(const Compared& compared, double took_s, Tally& tally) {
    tally.feasible += compared.feasible ? 1 : 0;
    tally.wrong += compared.agrees ? 0 : 1;
    tally.broken_bounds += compared.bound_holds ? 0 : 1;
    tally.short_of_best += compared.shortfall > wanted ? 1 : 0;
    tally.gaps += compared.gap > wanted ? 1 : 0;
    tally.worst_shortfall = std::max(tally.worst_shortfall, compared.shortfall);
    tally.worst_gap = std::max(tally.worst_gap, compared.gap);
    tally.slowest_s = std::max(tally.slowest_s, took_s);
}

/// Whether all is as it should be.
bool compare_small(std::size_t missions, unsigned first_seed) {
    fmt::print("{} small missions from seed {}\n\n", missions, first_seed);
    std::fflush(stdout);
    Tally tally;
    for (unsigned seed = first_seed; seed < first_seed + missions; ++seed) {
        const auto [problem, kind] = test::small_mission(seed);
        const auto begin = std::clock();
        const auto plan = plan_mission(problem);
        const double took_s = seconds_since(begin);
        const auto best = best_of(problem, plan);
        const auto compared = compare(plan, best);
        add(compared, took_s, tally);
        if (compared.agrees && compared.bound_holds && compared.shortfall <= wanted && compared.gap <= wanted) continue;
        fmt::print("seed {} ({}): planned {:.6f}, bound {:.6f}, best {:.6f}\n", seed, kind,
                   plan.plan.feasible ? *plan.summary.utility : 0.0, plan.plan.utility_bound, best.value_or(0.0));
        std::fflush(stdout);
    }
    fmt::print("{} have a schedule that lands; plans say otherwise in {}\n", tally.feasible, tally.wrong);
    fmt::print("plans short of the best schedule by more than {:.0e}: {}; at most by {:.1e}\n", wanted,
               tally.short_of_best, tally.worst_shortfall);
    fmt::print("bounds above their plan by more than {:.0e}: {}; at most by {:.1e}\n", wanted, tally.gaps,
               tally.worst_gap);
    fmt::print("bounds below the best schedule: {}\n", tally.broken_bounds);
    fmt::print("the slowest plan took {:.3f} s\n", tally.slowest_s);
    return tally.wrong + tally.broken_bounds + tally.short_of_best + tally.gaps == 0;
}

void time_long(unsigned first_seed) {
    constexpr unsigned each = 5;
    fmt::print("\n{:<40} {:>6} {:>10} {:>12}\n", "long missions, the worst of 5", "slots", "seconds", "gap");
    for (const bool dwells : {false, true}) {
        for (const bool cut_off : {false, true}) {
            double slowest_s = 0.0;
            double worst_gap = 0.0;
            std::size_t slots = 0;
            std::string kind;
            for (unsigned seed = first_seed; seed < first_seed + each; ++seed) {
                const auto made = test::SmallMissionGenerator(seed).make_long(dwells, cut_off);
                const auto begin = std::clock();
                const auto plan = plan_mission(made.problem);
                const double took_s = seconds_since(begin);
                const double gap = 1.0 - *plan.summary.utility / plan.plan.utility_bound;
                slowest_s = std::max(slowest_s, took_s);
                worst_gap = std::max(worst_gap, gap);
                slots = std::max(slots, make_slots(made.problem).size());
                kind = made.kind;
            }
            fmt::print("{:<40} {:>6} {:>10.2f} {:>12.1e}\n", kind, slots, slowest_s, worst_gap);
            std::fflush(stdout);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto missions = argc > 1 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(200);
    const auto seed = argc > 2 ? parse_unsigned(argv[2]) : std::optional<std::uint64_t>(71000);  // the tests use 1 on
    if (argc > 3 || !missions || !seed) {
        fmt::print(stderr, "usage: planning_bench [MISSIONS [SEED]]\n");
        return 2;
    }
    try {
        const bool holds = *missions == 0 || compare_small(*missions, static_cast<unsigned>(*seed));
        if (*missions == 0 || *missions >= 100) time_long(static_cast<unsigned>(*seed));  // a few are to be quick
        return holds ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "planning_bench: error: {}\n", error.what());
        return 1;
    }
}
