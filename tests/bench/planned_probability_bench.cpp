// What `plan --probability` asked for, beside what flights drawn of the plan do, in generated missions.
// usage: planned_probability_bench [MISSIONS [FLIGHTS [SEED]]]: 20, 20000 and 1001 if not said

#include "base/number.h"
#include "base/units.h"
#include "helpers/generated_missions.h"
#include "mission/feasibility_limits.h"
#include "mission/plan.h"
#include "mission/sampled_flights.h"

#include <cmath>
#include <cstdio>
#include <exception>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// How far the share of flights below the reserve is from what was asked for [standard errors].
double deviations(const mission::Mission& flown, double probability, std::size_t flights) {
    const auto sampled = mission::sample_flights({flown.setup, flown.schedule, std::nullopt}, {}, {flights, 1, 0});
    return (sampled.probability_below_reserve - (1.0 - probability)) /
           std::sqrt(probability * (1.0 - probability) / static_cast<double>(flights));
}

/// Whether at most one mission of twenty is beyond three standard errors, as one run in ten has by chance.
bool run(std::size_t missions, std::size_t flights, unsigned first_seed) {
    fmt::print(
        "{} missions from seed {}, {} flights each: share below the reserve less what was asked for,\n"
        "in standard errors; of the plan, and of the largest payload beside the least schedule.\n\n"
        "seed  mission                        asked for  margin, points    plan  payload\n",
        missions, first_seed, flights);
    std::size_t within = 0;
    for (unsigned seed = first_seed; seed < first_seed + missions; ++seed) {
        const auto generated = test::generated_mission(seed);
        const double probability = generated.probability;
        const auto plan = plan_mission(generated.problem, probability);
        const double of_plan = plan.plan.feasible ? deviations(plan.mission, probability, flights) : std::nan("");
        const auto least = with_minimum_energy_schedule(generated.problem);
        const auto payload = largest_payload(least, probability);
        const double of_payload = deviations(with_payload(least, payload.value), probability, flights);
        if (std::abs(of_plan) <= 3.0 && std::abs(of_payload) <= 3.0) ++within;
        fmt::print("{:>4}  {:<29}  {:>9.2f}  {:>14.3f}  {:>+6.2f}  {:>+7.2f}\n", seed, generated.kind,
                   1.0 - probability, plan.margin_percent, of_plan, of_payload);
        std::fflush(stdout);
    }
    fmt::print("\n{} of {} within 3 standard errors\n", within, missions);
    return missions - within <= missions / 20;
}

}  // namespace

int main(int argc, char** argv) {
    const auto missions = argc > 1 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(20);
    const auto flights = argc > 2 ? parse_unsigned(argv[2]) : std::optional<std::uint64_t>(20000);
    const auto seed = argc > 3 ? parse_unsigned(argv[3]) : std::optional<std::uint64_t>(1001);  // the tests use 1 on
    if (argc > 4 || !missions || !flights || !seed || *flights < 2) {
        fmt::print(stderr, "usage: planned_probability_bench [MISSIONS [FLIGHTS [SEED]]]\n");
        return 2;
    }
    try {
        return run(*missions, *flights, static_cast<unsigned>(*seed)) ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "planned_probability_bench: error: {}\n", error.what());
        return 1;
    }
}
