#include "mission/planning/schedule_search.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

constexpr double impossible = std::numeric_limits<double>::infinity();

/// Whether the runs of `choices` last as they must, from the definition alone.
bool dwells(const ScheduleChoices& problem, const std::vector<std::size_t>& choices) {
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

/// Slots of constant power on the paper's source, and what may run in them.
struct SearchCase {
    SlotDynamics dynamics;
    ScheduleChoices choices;
    double reserve_percent = 0.0;

    SearchResult search(const SearchLimits& limits = {}) const {
        return search_schedule({dynamics, choices, {100.0}, reserve_percent}, limits);
    }

    double end_percent(const std::vector<std::size_t>& run) const {
        battery::BatteryState state{100.0};
        for (std::size_t i = 0; i < run.size(); ++i) {
            const auto after = advance_slot(dynamics, i, run[i], state);
            if (!after) return -impossible;
            state = *after;
        }
        return state.soc_percent;
    }

    bool allows(const std::vector<std::size_t>& run) const {
        for (std::size_t i = 0; i < run.size(); ++i) {
            const auto& fixed = choices.slots[i].fixed;
            if (fixed ? run[i] != *fixed : run[i] >= choices.free_choices) return false;
        }
        return dwells(choices, run);
    }
};

void add_slot(double duration_s, double power_w, std::optional<std::size_t> fixed, SearchCase& made) {
    SlotDynamics::Slot slot;
    slot.parts.push_back({duration_s, {made.dynamics.circuit, duration_s}, {power_w, power_w, power_w}});
    slot.min_mechanical_w = slot.max_mechanical_w = power_w;
    slot.duration_s = duration_s;
    made.dynamics.slots.push_back(slot);
    made.choices.slots.push_back({duration_s, fixed});
}

SearchCase empty_case(double resistance_ohm) {
    SearchCase made;
    made.dynamics.open_circuit = {{0.0, 100.0}, {11.1, 11.1}};
    made.dynamics.circuit.resistance_ohm = resistance_ohm;
    return made;
}

/// The battery so large that the reserve is between what the least and the greatest power leave.
void set_reserve(double part, SearchCase& made) {
    const std::vector<std::size_t> first(made.choices.slots.size(), 0);
    double greatest_w = 0.0;
    double mechanical_w = 0.0;
    double duration_s = 0.0;
    for (const double compute_w : made.dynamics.compute_w) greatest_w = std::max(greatest_w, compute_w);
    for (const auto& slot : made.dynamics.slots) {
        mechanical_w = std::max(mechanical_w, slot.max_mechanical_w);
        duration_s += slot.duration_s;
    }
    constexpr double source_v = 11.1;
    made.dynamics.circuit.percent_per_as = 50.0 * source_v / ((mechanical_w + greatest_w) * duration_s);
    for (auto& slot : made.dynamics.slots)
        for (auto& each : slot.parts) each.step = {made.dynamics.circuit, each.step_s};
    std::vector<std::size_t> least = first;
    std::vector<std::size_t> most = first;
    for (std::size_t i = 0; i < first.size(); ++i) {
        const auto& compute_w = made.dynamics.compute_w;
        for (std::size_t c = 0; c < compute_w.size(); ++c) {
            if (compute_w[c] < compute_w[least[i]]) least[i] = c;
            if (compute_w[c] > compute_w[most[i]]) most[i] = c;
        }
    }
    made.reserve_percent = std::lerp(made.end_percent(least), made.end_percent(most), part);
}

struct Enumerated {
    double utility = -impossible;
    double greatest_end_percent = -impossible;
};

/// Every way to choose.
Enumerated enumerate(const SearchCase& made) {
    Enumerated best;
    std::vector<std::size_t> run(made.choices.slots.size(), 0);
    for (;;) {
        if (made.allows(run)) {
            const double end_percent = made.end_percent(run);
            best.greatest_end_percent = std::max(best.greatest_end_percent, end_percent);
            if (end_percent >= made.reserve_percent)
                best.utility = std::max(best.utility, utility_of(made.choices, run));
        }
        std::size_t i = 0;
        while (i < run.size() && ++run[i] == made.choices.utility_per_s.size()) run[i++] = 0;
        if (i == run.size()) return best;
    }
}

struct RandomCase {
    bool dwell = false;
    bool fixed = false;
    bool running = false;
    bool equal_slots = false;  ///< slots of equal duration, and utilities that are whole numbers
};

SearchCase random_case(std::mt19937& random, const RandomCase& kind) {
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto count = [&](int low, int high) {
        return static_cast<std::size_t>(std::uniform_int_distribution<int>(low, high)(random));
    };
    auto made = empty_case(kind.equal_slots ? 0.0 : uniform(0.0, 0.3));
    auto& choices = made.choices;
    choices.free_choices = count(1, 3);
    const auto all = choices.free_choices + (kind.fixed ? count(0, 1) : 0);
    for (std::size_t c = 0; c < all; ++c) {
        choices.utility_per_s.push_back(kind.equal_slots ? std::round(uniform(0, 5)) : uniform(0, 5));
        made.dynamics.compute_w.push_back(uniform(0.5, 4));
    }
    const auto slots = count(1, all == 4 ? 7 : 8);
    for (std::size_t i = 0; i < slots; ++i) {
        std::optional<std::size_t> fixed;
        if (kind.fixed && uniform(0, 1) < 0.3) fixed = count(0, static_cast<int>(all) - 1);
        add_slot(kind.equal_slots ? 10.0 : uniform(1, 10), kind.equal_slots ? 5.0 : uniform(2, 8), fixed, made);
    }
    if (kind.dwell) choices.dwell_s = uniform(0, 40);
    if (kind.running) choices.running = {count(0, static_cast<int>(choices.free_choices) - 1), uniform(0, 40)};
    set_reserve(uniform(-0.1, 1.1), made);
    return made;
}

void expect_the_enumerated(const SearchCase& made, int& feasible) {
    const auto plan = made.search();
    const auto all = enumerate(made);
    ASSERT_EQ(plan.feasible, std::isfinite(all.utility));
    EXPECT_TRUE(made.allows(plan.best.choices));
    EXPECT_NEAR(plan.best.end_percent, made.end_percent(plan.best.choices), 1e-9);
    if (!plan.feasible) {
        EXPECT_NEAR(plan.best.end_percent, all.greatest_end_percent, 1e-9);
        return;
    }
    ++feasible;
    EXPECT_NEAR(plan.best.utility, utility_of(made.choices, plan.best.choices), 1e-9);
    EXPECT_GE(plan.best.end_percent, made.reserve_percent);
    EXPECT_GE(plan.bound, all.utility - 1e-9);
    EXPECT_LE(plan.bound, plan.best.utility * (1.0 + 3e-5) + 1e-9);
    EXPECT_NEAR(plan.best.utility, all.utility, 3e-5 * all.utility + 1e-9);
}

TEST(ScheduleSearch, FindsTheBestOfAllThatCanBeEnumerated) {
    std::mt19937 random(20201104);
    int feasible = 0;
    for (int kind = 0; kind < 16; ++kind) {
        const RandomCase described{(kind & 1) != 0, (kind & 2) != 0, (kind & 4) != 0, (kind & 8) != 0};
        for (int i = 0; i < 40; ++i) {
            SCOPED_TRACE(testing::Message() << "kind " << kind << ", case " << i);
            ASSERT_NO_FATAL_FAILURE(expect_the_enumerated(random_case(random, described), feasible));
        }
    }
    EXPECT_GT(feasible, 400);
}

/// So many slots and choices, with no two slots equal.
SearchCase large_case(std::size_t slots, std::size_t choices, double dwell_s) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.9, 1.1);
    auto made = empty_case(0.1);
    made.choices.free_choices = choices;
    made.choices.dwell_s = dwell_s;
    for (std::size_t c = 0; c < choices; ++c) {
        made.choices.utility_per_s.push_back(std::sqrt(static_cast<double>(c)) * uniform(random));
        made.dynamics.compute_w.push_back((1.0 + static_cast<double>(c)) * uniform(random));
    }
    for (std::size_t i = 0; i < slots; ++i) add_slot(10.0, 10.0 * uniform(random), std::nullopt, made);
    set_reserve(0.37, made);
    return made;
}

TEST(ScheduleSearch, ProvesItsGapWhereNothingIsAlike) {
    for (const double dwell_s : {0.0, 60.0}) {
        const auto made = large_case(70, 20, dwell_s);
        const auto plan = made.search();
        ASSERT_TRUE(plan.feasible);
        EXPECT_GE(plan.best.end_percent, made.reserve_percent);
        EXPECT_LE(plan.bound, plan.best.utility * 1.001) << dwell_s;
        EXPECT_GE(plan.bound, plan.best.utility);
    }
}

TEST(ScheduleSearch, StaysWithinItsMeansInTenHours) {
    const auto made = large_case(3600, 8, 0.0);
    const auto plan = made.search();
    ASSERT_TRUE(plan.feasible);
    EXPECT_LE(plan.bound, plan.best.utility * 1.001);
}

TEST(ScheduleSearch, HasABoundThatHoldsWhenItMayNotSearch) {
    const auto made = large_case(12, 3, 0.0);
    const auto plan = made.search({1e-9, 1, 16});
    const auto best = enumerate(made);
    EXPECT_GE(plan.bound, best.utility - 1e-9);
    EXPECT_LE(plan.best.utility, best.utility + 1e-9);
    EXPECT_GE(plan.best.end_percent, made.reserve_percent);
}

TEST(ScheduleSearch, OfNoSlotsIsNothing) {
    auto made = empty_case(0.0);
    made.choices.utility_per_s = {1.0};
    made.choices.free_choices = 1;
    made.dynamics.compute_w = {1.0};
    const auto plan = made.search();
    EXPECT_TRUE(plan.feasible);
    EXPECT_EQ(plan.best.utility, 0.0);
    EXPECT_TRUE(plan.best.choices.empty());
}

}  // namespace
}  // namespace flightwatt::mission
