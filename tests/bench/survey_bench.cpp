// Plans of random surveys whose lines and schedule are free beside all schedules on all lines.
// usage: survey_bench [MISSIONS [SEED]]: 200 and 72000 if not said

#include "base/number.h"
#include "helpers/survey_missions.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

constexpr double wanted = 1e-3;

/// Returns whether all is as it should be.
bool compare(std::size_t missions, unsigned first_seed) {
    std::size_t feasible = 0, wrong = 0, broken_bounds = 0, short_of_best = 0, several = 0;
    double worst_shortfall = 0.0, worst_gap = 0.0, slowest_s = 0.0;
    for (unsigned seed = first_seed; seed < first_seed + missions; ++seed) {
        const auto made = test::survey_mission(seed);
        const auto problem = made.problem();
        const auto begin = std::clock();
        const auto plan = plan_mission(problem);
        slowest_s = std::max(slowest_s, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
        const auto best = made.max_utility(plan.plan.feasible ? plan.summary.utility : std::nullopt);
        wrong += plan.plan.feasible == best.has_value() ? 0 : 1;
        if (!plan.plan.feasible || !best) continue;
        ++feasible;
        several += plan.mission.setup.survey->layout.strips.size() > 1 ? 1 : 0;
        const double utility = *plan.summary.utility;
        const double shortfall = 1.0 - utility / *best;
        const double gap = 1.0 - utility / plan.plan.utility_bound;
        const bool holds = plan.plan.bound_is_proven && plan.plan.utility_bound >= *best * (1.0 - 1e-9);
        broken_bounds += holds ? 0 : 1;
        short_of_best += shortfall > wanted ? 1 : 0;
        worst_shortfall = std::max(worst_shortfall, shortfall);
        worst_gap = std::max(worst_gap, gap);
        if (holds && shortfall <= wanted && gap <= wanted) continue;
        fmt::print("seed {}: planned {:.6f}, bound {:.6f}, best {:.6f}\n", seed, utility, plan.plan.utility_bound,
                   *best);
        std::fflush(stdout);
    }
    fmt::print("{} surveys from seed {}: {} can land, {} of them in two blocks; plans say otherwise in {}\n", missions,
               first_seed, feasible, several, wrong);
    fmt::print("plans short of the best schedule on the best lines by more than {:.0e}: {}; at most by {:.1e}\n",
               wanted, short_of_best, worst_shortfall);
    fmt::print("bounds above their plan at most by {:.1e}; below the best: {}\n", worst_gap, broken_bounds);
    fmt::print("the slowest plan took {:.2f} s\n", slowest_s);
    return wrong + broken_bounds + short_of_best == 0;
}

}  // namespace

int main(int argc, char** argv) {
    const auto missions = argc > 1 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(200);
    const auto seed = argc > 2 ? parse_unsigned(argv[2]) : std::optional<std::uint64_t>(72000);  // the tests use 1 on
    if (argc > 3 || !missions || !seed) {
        fmt::print(stderr, "usage: survey_bench [MISSIONS [SEED]]\n");
        return 2;
    }
    try {
        return compare(*missions, static_cast<unsigned>(*seed)) ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "survey_bench: error: {}\n", error.what());
        return 1;
    }
}
