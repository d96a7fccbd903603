#include "mission/replay.h"

#include "base/error.h"
#include "base/piecewise_linear.h"
#include "helpers/generated_missions.h"
#include "helpers/paper_missions.h"
#include "helpers/replayed_flights.h"
#include "helpers/steady_mission.h"
#include "mission/plan.h"
#include "mission/simulation.h"

#include <array>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::flight_of_model;
using test::flight_with_power;
using test::generated_mission;
using testing::ElementsAre;
using testing::HasSubstr;

const ReplayedSchedule* by(const Replay& replay, ScheduleMethod way) {
    for (const auto& replayed : replay.schedules)
        if (replayed.way == way) return &replayed;
    return nullptr;
}

/// What is known before the flight is the mission's own model.
ReplayOptions with_model_of(const MissionSetup& mission) {
    ReplayOptions options;
    options.model = mission.mechanical;
    return options;
}

Replay only_replay(const MissionVariant& mission, const mechanical::MeasuredFlight& flight,
                   const ReplayOptions& options) {
    const std::array missions{mission};
    const std::array flights{flight};
    auto replays = replay_flights(missions, flights, options);
    EXPECT_EQ(replays.replays.size(), 1U);
    return std::move(replays.replays.at(0));
}

/// Charge for half of what the software may do.
void set_reserve(PlanningProblem& problem) {
    const auto least = with_minimum_energy_schedule(problem);
    auto most = least;
    for (auto& segment : most.schedule) segment.run.front().qos = {problem.plan.choices.front().levels.front().back()};
    problem.setup.reserve_soc_percent =
        (*simulate(least).summary.final_soc_percent + *simulate(most).summary.final_soc_percent) / 2.0;
}

/// All phases of constant power.
PlanningProblem constant_problem(unsigned seed) {
    auto problem = generated_mission(seed).problem;
    for (const auto phase : all_phases) {
        auto& curve = problem.setup.mechanical->phases[phase].fourier;
        curve.cos_w.clear();
        curve.sin_w.clear();
        problem.setup.duration_is_stated[phase] = true;
    }
    set_reserve(problem);
    return problem;
}

/// The same with a battery whose state counts and that may be cut off, few slots, and no spread to keep a margin for.
PlanningProblem with_thevenin(PlanningProblem problem) {
    problem.setup.battery.resistance_ohm = 0.04;
    auto& circuit = problem.setup.battery.thevenin.emplace();
    circuit.open_circuit = {{0.0, 10.0, 30.0, 60.0, 100.0}, {9.9, 11.0, 11.3, 11.6, 12.5}};
    circuit.rc_resistance_ohm = 0.02;
    circuit.rc_time_constant_s = 40.0;
    problem.setup.cutoff_voltage_v = 9.6;
    problem.plan.slot_s = 120.0;
    problem.setup.uncertainty.level_sd_percent = {};
    problem.setup.mechanical->flights.clear();
    for (auto& phase : problem.setup.mechanical->phases.values) phase.level_spread.reset();
    set_reserve(problem);
    return problem;
}

/// One that keeps the reserve as it is known.
Mission planned_mission(const PlanningProblem& problem) { return plan_mission(problem).mission; }

TEST(Replay, OfTheModelsOwnPowerEndsAsSimulateEnds) {
    for (const bool has_circuit : {false, true}) {
        SCOPED_TRACE(has_circuit);
        const auto problem = constant_problem(1);
        auto mission = with_minimum_energy_schedule(has_circuit ? with_thevenin(problem) : problem);
        const auto replay = only_replay(mission, flight_of_model("same", mission.setup), with_model_of(mission.setup));
        const auto& given = *by(replay, ScheduleMethod::given);
        const auto simulated = simulate(mission).summary;
        EXPECT_NEAR(*given.summary.final_soc_percent, *simulated.final_soc_percent, 1e-7);
        EXPECT_NEAR(*given.expected_soc_percent, *simulated.final_soc_percent, 1e-12);
        EXPECT_NEAR(given.summary.utility.value_or(0.0), simulated.utility.value_or(0.0), 1e-12);
        EXPECT_NEAR(given.summary.energy_wh, simulated.energy_wh, 1e-9);
        EXPECT_NEAR(replay.measured_mechanical_wh, replay.expected_mechanical_wh, 1e-9);
    }
}

TEST(Replay, OfSamplesOfACurveEndsAsTheCurve) {
    for (const bool has_circuit : {false, true}) {
        SCOPED_TRACE(has_circuit);
        auto problem = generated_mission(11).problem;
        if (has_circuit) problem = with_thevenin(problem);
        for (const auto phase : all_phases) problem.setup.duration_is_stated[phase] = true;
        auto mission = with_minimum_energy_schedule(problem);
        const auto replay =
            only_replay(mission, flight_of_model("same", mission.setup, 1.0, 1.0, 0.05), with_model_of(mission.setup));
        EXPECT_NEAR(*by(replay, ScheduleMethod::given)->summary.final_soc_percent,
                    *simulate(mission).summary.final_soc_percent, 2e-4);
    }
}

/// A flight that no one planned for: other durations, another level, swings, and samples of any distance.
mechanical::MeasuredFlight any_flight(const MissionSetup& mission, std::mt19937& random) {
    std::uniform_real_distribution<double> part(0.8, 1.25);
    std::normal_distribution<double> noise(0.0, 1.0);
    auto flown_s = mission.duration_s;
    for (auto& duration_s : flown_s.values) duration_s *= part(random);
    const double factor = std::uniform_real_distribution<double>(0.85, 1.15)(random);
    return flight_with_power(
        "any", flown_s,
        [&](flight::Phase phase, double time_s) {
            const auto curve =
                time_scaled_model(mission.mechanical->phases[phase], flown_s[phase], mission.phase_clock);
            return std::max(0.0, factor * power_w(curve, time_s) + noise(random));
        },
        std::uniform_real_distribution<double>(0.4, 6.0)(random));
}

TEST(Replay, HindsightIsAtLeastAsGoodAsEverythingThatKeepsTheReserve) {
    constexpr double most_gap = 0.01;
    std::size_t kept = 0;
    std::size_t missed = 0;
    for (const unsigned seed : {21U, 23U, 25U}) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        auto problem = generated_mission(seed).problem;
        if (seed == 25U) problem = with_thevenin(problem);
        const auto replay = only_replay(problem, any_flight(problem.setup, random), with_model_of(problem.setup));
        const auto& hindsight = *by(replay, ScheduleMethod::hindsight);
        for (const auto& replayed : replay.schedules) {
            if (!replayed.summary.keeps_reserve) {
                EXPECT_FALSE(replayed.regret);
                ++missed;
                continue;
            }
            ++kept;
            ASSERT_TRUE(hindsight.summary.keeps_reserve) << to_string(replayed.way);
            ASSERT_TRUE(replayed.regret);
            EXPECT_GE(*replayed.regret, 0.0) << to_string(replayed.way);
            ASSERT_TRUE(replay.bound);
            EXPECT_LE(*replayed.summary.utility, *replay.bound * (1.0 + 1e-9)) << to_string(replayed.way);
        }
        if (replay.bound) {
            EXPECT_GE(*hindsight.summary.utility, (1.0 - most_gap) * *replay.bound);
        }
    }
    EXPECT_GT(kept, 8U);
    EXPECT_GT(missed, 0U) << "both were tried";
}

/// Equal slots on a battery without resistance: all ways to spend a part are as good by the slope of the relaxation.
TEST(Replay, HindsightComesCloseToItsBoundOnManySlots) {
    const auto problem = test::paper_problem("adaptive-replanned");
    auto options = with_model_of(problem.setup);
    options.model->phases[Phase::cruise].duration_s = 1517.0;
    options.model->phases[Phase::landing].duration_s = 37.0;
    std::mt19937 random(1);
    std::normal_distribution<double> power_w(22.6, 4.0);
    const auto flight = flight_with_power(
        "many", {{35.0, 710.432, 34.0}}, [&](auto, double) { return std::max(0.0, power_w(random)); }, 1.7);
    const auto replay = only_replay(problem, flight, options);
    ASSERT_TRUE(replay.bound);
    EXPECT_GE(*by(replay, ScheduleMethod::hindsight)->summary.utility, (1.0 - 2e-3) * *replay.bound);
}

/// More power than the model has, which a plan without a margin does not survive, and less.
TEST(Replay, SaysWhatReplanningWasWorth) {
    const auto problem = constant_problem(1);
    const auto options = with_model_of(problem.setup);
    const std::array missions{MissionVariant(problem)};
    const std::array flights{flight_of_model("as the model", problem.setup),
                             flight_of_model("headwind", problem.setup, 1.05),
                             flight_of_model("tailwind", problem.setup, 0.9)};
    const auto replays = replay_flights(missions, flights, options).replays;
    const auto comparisons = compare_replanned(replays, problem.setup.name, ScheduleMethod::planned);
    ASSERT_EQ(comparisons.size(), 3U);
    EXPECT_NE(comparisons[0].outcome, ComparisonOutcome::better) << "nothing was to be learned";
    EXPECT_EQ(comparisons[1].outcome, ComparisonOutcome::better);
    EXPECT_TRUE(comparisons[1].replanned_keeps_reserve);
    EXPECT_FALSE(comparisons[1].baseline_keeps_reserve);
    EXPECT_EQ(comparisons[2].outcome, ComparisonOutcome::better);
    EXPECT_GT(comparisons[2].more_utility, 0.0);
    EXPECT_LT(*comparisons[2].more_soc_percent, 0.0) << "what was saved was spent";
    for (const auto& replay : replays) {
        EXPECT_GE(*by(replay, ScheduleMethod::planned)->expected_soc_percent, problem.setup.reserve_soc_percent);
        EXPECT_FALSE(by(replay, ScheduleMethod::replanned)->expected_soc_percent) << "no one knew beforehand";
    }
}

TEST(Replay, InvariantAndPhasedRunOneConfigurationAllTheWayAndAPhase) {
    auto problem = constant_problem(3);
    problem.fixed.clear();
    const auto replay = only_replay(problem, flight_of_model("f", problem.setup), with_model_of(problem.setup));
    const auto& invariant = *by(replay, ScheduleMethod::invariant);
    EXPECT_EQ(configurations_of(invariant.schedule).size(), 1U);
    EXPECT_TRUE(invariant.summary.keeps_reserve);
    const auto& phased = *by(replay, ScheduleMethod::phased);
    EXPECT_EQ(phased.schedule.size(), 3U);
    EXPECT_GE(*phased.summary.utility, *invariant.summary.utility - 1e-9);
    EXPECT_GE(*by(replay, ScheduleMethod::planned)->summary.utility, *phased.summary.utility * (1.0 - 1e-3));
    // The next better configuration would not have kept it.
    const auto& levels = problem.plan.choices.front().levels.front();
    const auto next = std::ranges::upper_bound(levels, invariant.schedule.front().run.front().qos.front());
    ASSERT_NE(next, levels.end());
    Schedule more;
    for (const auto phase : all_phases) more.push_back({{phase, 0.0, problem.setup.duration_s[phase]}, {{0, {*next}}}});
    EXPECT_FALSE(simulate(problem.setup, more).summary.keeps_reserve);
}

TEST(Replay, ModelsAreOfTheOtherFlightsAlone) {
    auto problem = constant_problem(1);
    for (auto& stated : problem.setup.duration_is_stated.values) stated = false;
    std::vector<mechanical::MeasuredFlight> flights;
    const auto duration_s = problem.setup.duration_s;
    const std::array level_w{20.0, 22.0, 30.0};
    for (std::size_t i = 0; i < 3; ++i) {
        flights.push_back(flight_with_power(
            fmt::format("flight {}", i), duration_s, [&](auto, double) { return level_w.at(i); }, 2.0));
    }
    ReplayOptions options;
    options.fit.phases.order = 0;
    problem.adaptive.emplace().decide_every_s = problem.plan.slot_s * 4.0;
    const std::array missions{MissionVariant(problem)};
    const auto replays = replay_flights(missions, flights, options).replays;
    ASSERT_EQ(replays.size(), 3U);
    const double hours = timeline_of(duration_s).duration_s / 3600.0;
    EXPECT_NEAR(replays[2].expected_mechanical_wh, 21.0 * hours, 1e-6);
    EXPECT_NEAR(replays[2].measured_mechanical_wh, 30.0 * hours, 1e-6);
    EXPECT_THAT(replays[2].model_flights, ElementsAre("flight 0", "flight 1"));
    EXPECT_EQ(replays[2].model_saw_flight, TrainingOverlap::no);
}

TEST(Replay, SaysWhetherAGivenModelSawTheFlight) {
    const auto mission = planned_mission(constant_problem(1));
    auto options = with_model_of(mission.setup);
    options.model->flights = {{"one", {}}, {"two", {}}};
    EXPECT_EQ(only_replay(mission, flight_of_model("two", mission.setup), options).model_saw_flight,
              TrainingOverlap::yes);
    EXPECT_EQ(only_replay(mission, flight_of_model("three", mission.setup), options).model_saw_flight,
              TrainingOverlap::no);
    options.model->flights.clear();
    EXPECT_EQ(only_replay(mission, flight_of_model("two", mission.setup), options).model_saw_flight,
              TrainingOverlap::unknown);
}

TEST(Replay, LeavesOutWhatCannotBeFlown) {
    const auto mission = planned_mission(constant_problem(1));
    auto cut = flight_of_model("cut", mission.setup);
    cut.power[Phase::landing].reset();
    const std::array missions{MissionVariant(mission)};
    const std::array flights{cut, flight_of_model("whole", mission.setup)};
    const auto replays = replay_flights(missions, flights, with_model_of(mission.setup));
    ASSERT_EQ(replays.replays.size(), 1U);
    EXPECT_EQ(replays.replays[0].flight, "whole");
    ASSERT_EQ(replays.not_replayed.size(), 1U);
    EXPECT_EQ(replays.not_replayed[0].flight, "cut");
    EXPECT_THAT(replays.not_replayed[0].reason, HasSubstr("landing"));
}

TEST(Replay, RefusesWhatHasNoAnswer) {
    const auto mission = planned_mission(constant_problem(1));
    const auto flight = flight_of_model("f", mission.setup);
    const std::array missions{MissionVariant(mission)};
    const std::array one{flight};
    EXPECT_THROW(replay_flights(missions, one), NoResultError) << "no other flight";
    const std::array twice{flight, flight};
    EXPECT_THROW(replay_flights(missions, twice, with_model_of(mission.setup)), UsageError);
    auto grounded = mission;
    grounded.setup.mechanical.reset();
    const std::array nothing_flies{MissionVariant(grounded)};
    EXPECT_THROW(replay_flights(nothing_flies, one, with_model_of(mission.setup)), InputError);
}

TEST(Replay, CountsPowerBelowZeroAsNothingAndSaysSo) {
    const auto mission = planned_mission(constant_problem(1));
    const auto flight = flight_with_power("offset", mission.setup.duration_s,
                                          [](auto phase, double) { return phase == Phase::landing ? -3.0 : 20.0; });
    const auto replay = only_replay(mission, flight, with_model_of(mission.setup));
    EXPECT_THAT(replay.notes, ElementsAre(HasSubstr("below 0 counts as 0")));
    const auto seconds = mission.setup.duration_s[Phase::takeoff] + mission.setup.duration_s[Phase::cruise];
    EXPECT_NEAR(replay.measured_mechanical_wh, 20.0 * seconds / 3600.0, 1e-6);
}

TEST(PowerPieces, HaveTheEnergyBetweenTheirSamples) {
    mechanical::PhasePower measured;
    measured.time_s = {0.0, 2.0, 5.0, 27.0, 27.4, 27.8, 28.6, 29.0};  // with a gap of 22 s, and faster at the end
    measured.power_w = {10.0, 20.0, 30.0, 20.0, 10.0, 10.0, 20.0, 40.0};
    const auto pieces = measured_power_profile(measured);
    EXPECT_EQ(pieces.time_s, (std::vector<double>{0.0, 2.0, 5.0, 27.0, 28.6, 29.0})) << "of 1 s or more, but the last";
    EXPECT_EQ(pieces.energy_j[1], 2.0 * 15.0);
    EXPECT_EQ(pieces.energy_j[2] - pieces.energy_j[1], 3.0 * 25.0);
    EXPECT_EQ(pieces.energy_j[3] - pieces.energy_j[2], 22.0 * 25.0) << "a straight line over the gap";
    EXPECT_NEAR(pieces.energy_j[4] - pieces.energy_j[3], 6.0 + 4.0 + 12.0, 1e-9);
    EXPECT_NEAR(interpolate_extended(pieces.time_s, pieces.energy_j, 29.0), 30.0 + 75.0 + 550.0 + 22.0 + 12.0, 1e-9);
    EXPECT_NEAR(interpolate_extended(pieces.time_s, pieces.energy_j, 5.0), 105.0, 1e-9);
}

TEST(PowerPieces, GiveNothingBack) {
    const auto pieces = measured_power_profile({{0.0, 10.0, 20.0}, {-4.0, -4.0, 24.0}, {}});
    EXPECT_EQ(pieces.energy_j[1], 0.0);
    EXPECT_EQ(interpolate_extended(pieces.time_s, pieces.energy_j, 20.0), 100.0);
}

TEST(KnownMission, TakesTheModelAndWhatTheMissionStates) {
    auto stated = test::steady_mission().setup;
    auto model = *stated.mechanical;
    model.phases[Phase::cruise].duration_s = 700.0;
    model.phases[Phase::landing].duration_s = 60.0;
    EXPECT_EQ(nominal_mission(stated, model).duration_s[Phase::cruise], 700.0);
    EXPECT_EQ(nominal_mission(stated, model).duration_s[Phase::landing], 0.0) << "it has none";
    stated.duration_is_stated[Phase::cruise] = true;
    EXPECT_EQ(nominal_mission(stated, model).duration_s[Phase::cruise], 1000.0);
}

TEST(FlownMission, HasPowerAndDurationsOfTheFlight) {
    const auto known = test::steady_mission().setup;
    const auto flight = test::flight_with_power("f", {{10.0, 500.0, 10.0}}, [](auto, double) { return 30.0; });
    const auto flown = measured_mission(known, flight);
    EXPECT_EQ(flown.duration_s[Phase::cruise], 500.0);
    EXPECT_EQ(flown.duration_s[Phase::takeoff], 0.0) << "the mission has none";
    EXPECT_FALSE(flown.measured_power[Phase::takeoff]);
    EXPECT_NEAR(flown.measured_power[Phase::cruise]->energy_j.back(), 15000.0, 1e-6);
}

}  // namespace
}  // namespace flightwatt::mission
