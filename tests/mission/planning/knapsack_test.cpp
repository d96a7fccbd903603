#include "mission/planning/knapsack.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

constexpr double impossible = std::numeric_limits<double>::infinity();

/// Whether the runs of `choices` last as they must, from the definition alone.
bool dwells(const MultipleChoiceKnapsack& problem, const std::vector<std::size_t>& choices) {
    const auto& slots = problem.slots;
    for (std::size_t i = 0; i < slots.size();) {
        std::size_t end = i;
        double lasts_s = 0.0;
        bool has_fixed = false;
        while (end < slots.size() && choices[end] == choices[i]) {
            lasts_s += slots[end].duration_s;
            has_fixed = has_fixed || slots[end].fixed;
            ++end;
        }
        std::size_t from = i;  // the time between fixed slots around it
        std::size_t to = end;
        while (from > 0 && !slots[from - 1].fixed) --from;
        while (to < slots.size() && !slots[to].fixed) ++to;
        double gap_s = 0.0;
        for (std::size_t k = from; k < to; ++k) gap_s += slots[k].duration_s;
        const bool runs_already = i == 0 && problem.running && problem.running->choice == choices[0];
        if (runs_already) lasts_s += problem.running->since_s;
        const bool excused = has_fixed || (runs_already && end == to);
        const double due_s = runs_already ? problem.dwell_s : std::min(problem.dwell_s, gap_s);
        if (!excused && lasts_s < due_s - 1e-6) return false;
        i = end;
    }
    if (problem.running && !slots[0].fixed && problem.running->choice != choices[0]) {
        return problem.running->since_s >= problem.dwell_s - 1e-6;
    }
    return true;
}

struct Enumerated {
    double utility = -impossible;
    double least_drain = impossible;
};

/// Every way to choose.
Enumerated enumerate(const MultipleChoiceKnapsack& problem) {
    Enumerated best;
    std::vector<std::size_t> choices(problem.slots.size(), 0);
    for (;;) {
        double utility = 0.0;
        double cost = 0.0;
        bool allowed = true;
        for (std::size_t i = 0; i < choices.size(); ++i) {
            const auto& slot = problem.slots[i];
            allowed = allowed && (slot.fixed ? choices[i] == *slot.fixed : choices[i] < problem.free_choices);
            utility += problem.utility_per_s[choices[i]] * slot.duration_s;
            cost += slot.cost[choices[i]];
        }
        if (allowed && dwells(problem, choices)) {
            best.least_drain = std::min(best.least_drain, cost);
            if (cost <= problem.budget) best.utility = std::max(best.utility, utility);
        }
        std::size_t i = 0;
        while (i < choices.size() && ++choices[i] == problem.utility_per_s.size()) choices[i++] = 0;
        if (i == choices.size()) return best;
    }
}

struct RandomCase {
    bool dwell = false;
    bool fixed = false;
    bool running = false;
    bool impossible = false;
    bool alike = false;  ///< drain is power times time, as without resistance
};

MultipleChoiceKnapsack random_problem(std::mt19937& random, const RandomCase& kind) {
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto count = [&](int low, int high) {
        return static_cast<std::size_t>(std::uniform_int_distribution<int>(low, high)(random));
    };
    MultipleChoiceKnapsack problem;
    problem.free_choices = count(1, 3);
    const auto choices = problem.free_choices + (kind.fixed ? count(0, 1) : 0);
    std::vector<double> power;
    for (std::size_t c = 0; c < choices; ++c) {
        problem.utility_per_s.push_back(kind.alike ? std::round(uniform(0, 5)) : uniform(0, 5));
        power.push_back(uniform(0.5, 4));
    }
    const auto slots = count(1, choices == 4 ? 7 : 8);
    double least = 0.0;
    double most = 0.0;
    for (std::size_t i = 0; i < slots; ++i) {
        KnapsackSlot slot;
        slot.duration_s = kind.alike ? 10.0 : uniform(1, 10);
        for (std::size_t c = 0; c < choices; ++c) {
            slot.cost.push_back(power[c] * slot.duration_s * (kind.alike ? 1.0 : uniform(0.9, 1.1)));
            if (kind.impossible && uniform(0, 1) < 0.1) slot.cost.back() = impossible;
        }
        if (kind.fixed && uniform(0, 1) < 0.3) slot.fixed = count(0, static_cast<int>(choices) - 1);
        const auto [low, high] = std::minmax_element(slot.cost.begin(), slot.cost.end());
        least += std::isfinite(*low) ? *low : 0.0;
        most += std::isfinite(*high) ? *high : 40.0;
        problem.slots.push_back(slot);
    }
    problem.budget = least + uniform(-0.1, 1.1) * (most - least);
    if (kind.dwell) problem.dwell_s = uniform(0, 40);
    if (kind.running) problem.running = {count(0, static_cast<int>(problem.free_choices) - 1), uniform(0, 40)};
    return problem;
}

void expect_the_enumerated(const MultipleChoiceKnapsack& problem, int& feasible) {
    const auto plan = solve_knapsack(problem);
    const auto all = enumerate(problem);
    if (!std::isfinite(all.least_drain)) {
        EXPECT_FALSE(plan.possible);
        EXPECT_FALSE(plan.feasible);
        return;
    }
    EXPECT_TRUE(plan.possible);
    ASSERT_EQ(plan.feasible, std::isfinite(all.utility));
    EXPECT_TRUE(dwells(problem, plan.choices));
    if (!plan.feasible) {
        EXPECT_NEAR(plan.cost, all.least_drain, 1e-9);
        return;
    }
    ++feasible;
    double utility = 0.0;
    double cost = 0.0;
    for (std::size_t i = 0; i < plan.choices.size(); ++i) {
        const auto& slot = problem.slots[i];
        EXPECT_EQ(plan.choices[i], slot.fixed.value_or(plan.choices[i]));
        utility += problem.utility_per_s[plan.choices[i]] * slot.duration_s;
        cost += slot.cost[plan.choices[i]];
    }
    EXPECT_NEAR(plan.utility, utility, 1e-9);
    EXPECT_NEAR(plan.cost, cost, 1e-9);
    EXPECT_LE(cost, problem.budget + 1e-9);
    EXPECT_GE(plan.bound, all.utility - 1e-9);
    EXPECT_LE(plan.bound, plan.utility * (1.0 + 1e-6) + 1e-9);
    EXPECT_NEAR(plan.utility, all.utility, 1e-6 * all.utility + 1e-9);
}

TEST(KnapsackSolution, IsTheBestOfAllThatCanBeEnumerated) {
    std::mt19937 random(20201104);
    int feasible = 0;
    for (int kind = 0; kind < 32; ++kind) {
        const RandomCase described{(kind & 1) != 0, (kind & 2) != 0, (kind & 4) != 0, (kind & 8) != 0,
                                   (kind & 16) != 0};
        for (int i = 0; i < 60; ++i) {
            SCOPED_TRACE(testing::Message() << "kind " << kind << ", case " << i);
            ASSERT_NO_FATAL_FAILURE(expect_the_enumerated(random_problem(random, described), feasible));
        }
    }
    EXPECT_GT(feasible, 1000);
}

/// So many slots and choices, with no two slots alike.
MultipleChoiceKnapsack large_problem(std::size_t slots, std::size_t choices, double dwell_s) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.9, 1.1);
    MultipleChoiceKnapsack problem;
    problem.free_choices = choices;
    problem.dwell_s = dwell_s;
    for (std::size_t c = 0; c < choices; ++c) {
        problem.utility_per_s.push_back(std::sqrt(static_cast<double>(c)) * uniform(random));
    }
    for (std::size_t i = 0; i < slots; ++i) {
        KnapsackSlot slot{10.0, {}, {}};
        for (std::size_t c = 0; c < choices; ++c) slot.cost.push_back((1.0 + static_cast<double>(c)) * uniform(random));
        problem.slots.push_back(slot);
        problem.budget += slot.cost.front() + 0.37 * (slot.cost.back() - slot.cost.front());
    }
    return problem;
}

TEST(KnapsackSolution, ProvesItsGapWhereNothingIsAlike) {
    for (const double dwell_s : {0.0, 60.0}) {
        const auto problem = large_problem(70, 20, dwell_s);
        const auto begin = std::chrono::steady_clock::now();
        const auto plan = solve_knapsack(problem);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        ASSERT_TRUE(plan.feasible);
        EXPECT_LE(plan.cost, problem.budget);
        EXPECT_LE(plan.bound, plan.utility * 1.001) << dwell_s;
        EXPECT_GE(plan.bound, plan.utility);
        RecordProperty("seconds_dwell_" + std::to_string(static_cast<int>(dwell_s)), std::to_string(took.count()));
    }
}

TEST(KnapsackSolution, StaysWithinItsMeansInTenHours) {
    for (const double dwell_s : {0.0, 120.0}) {
        const auto problem = large_problem(3600, 8, dwell_s);
        const auto plan = solve_knapsack(problem);
        ASSERT_TRUE(plan.feasible);
        EXPECT_LE(plan.cost, problem.budget);
        EXPECT_LE(plan.bound, plan.utility * 1.001) << dwell_s;
    }
}

TEST(KnapsackSolution, HasABoundThatHoldsWhenItMayNotSearch) {
    const auto problem = large_problem(12, 3, 0.0);
    const auto plan = solve_knapsack(problem, {1e-9, 1});
    const auto best = enumerate(problem);
    EXPECT_GE(plan.bound, best.utility - 1e-9);
    EXPECT_LE(plan.utility, best.utility + 1e-9);
    EXPECT_LE(plan.cost, problem.budget);
}

TEST(KnapsackSolution, OfNoSlotsIsNothing) {
    const auto plan = solve_knapsack({{}, {1.0}, 1, 0.0, 0.0, {}});
    EXPECT_TRUE(plan.feasible);
    EXPECT_EQ(plan.utility, 0.0);
    EXPECT_TRUE(plan.choices.empty());
}

}  // namespace
}  // namespace flightwatt::mission
