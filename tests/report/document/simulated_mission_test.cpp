// Missions as the report flies them.

#include "report/document/simulated_mission.h"

#include "base/error.h"
#include "helpers/paper_missions.h"
#include "mission/feasibility_limits.h"
#include "mission/mission_file.h"
#include "mission/mission_read_options.h"
#include "report/document/mission_card.h"

#include <memory>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

/// The card as sentences.
std::vector<std::string> card_lines(const SimulatedMission& simulated, const MissionAssessment& answer) {
    const auto card = mission_card(simulated, answer).texts;
    const auto text = [&](const char* key) { return card.at(key).get<std::string>(); };
    std::vector<std::string> lines{fmt::format("{}: {}", capitalized(text("words")), text("lead")),
                                   fmt::format("Probability: {}: {}", text("aim"), text("probability"))};
    if (!text("reach").empty())
        lines.push_back(fmt::format("{}: {}{}", text("reach_name"), text("reach"),
                                    text("planned").empty() ? "" : fmt::format(" (planned: {})", text("planned"))));
    if (!text("help").empty()) lines.push_back(text("help"));
    for (const auto& note : card.at("notes")) lines.push_back(note.get<std::string>());
    return lines;
}

TEST(SimulateForReport, TellsMissionsOfOneNameApart) {
    const auto missions = simulate_for_report({test::paper_mission("phased"), test::paper_mission("phased")});
    EXPECT_EQ(missions[0].title, "phased");
    EXPECT_EQ(missions[1].title, "phased (2)");
}

TEST(SimulateForReport, TellsHowFarItIs) {
    std::vector<std::pair<std::size_t, std::size_t>> reported;
    simulate_for_report({test::paper_mission("phased"), test::paper_mission("phased")},
                        [&](std::size_t done, std::size_t all) { reported.emplace_back(done, all); });
    EXPECT_EQ(reported, (std::vector<std::pair<std::size_t, std::size_t>>{{0, 2}, {1, 2}}));
}

TEST(SimulateForReport, EndsTheCurveWhereTheBatteryCannotDeliver) {
    auto weak = test::paper_mission("phased");
    weak.setup.battery.resistance_ohm = 1.0;
    const auto missions = simulate_for_report({weak});
    const auto& [mission, simulation, title, planned, is_longest] = missions.front();
    ASSERT_TRUE(simulation.summary.undeliverable);
    EXPECT_LE(simulation.curve.rows.back().time_s, simulation.summary.undeliverable->time_s);
    EXPECT_FALSE(planned) << "it gave its schedule";
}

TEST(SimulateForReport, HasAsManyRowsAsAScreenShows) {
    const auto missions = simulate_for_report({test::paper_mission("phased")});
    EXPECT_NEAR(static_cast<double>(missions.front().simulation.curve.rows.size()), 300.0, 30.0);
}

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

mission::MissionLoader reading_of(const std::string& name) {
    const auto path = test::paper_mission_path(name);
    return [path](const mission::MissionReadOptions& reading) { return mission::read_mission(path, reading); };
}

SimulatedMission flown(const std::string& name) {
    return simulate_for_report({reading_of(name)({.allow_unplanned = true})}).front();
}

TEST(MissionAnswer, IsWhatPlanSaysOfTheLongestCruise) {
    const auto answer = assess_mission(flown("phased"), reading_of("phased"));
    const auto of_cruise = [&](double cruise_s) {
        return reading_of("phased")({.allow_unplanned = true, .cruise_s = cruise_s});
    };
    ASSERT_TRUE(answer.reach && answer.reach_at_95_percent);
    EXPECT_EQ(answer.reach->unit, mission::ReachUnit::cruise_s);
    EXPECT_EQ(answer.reach->limit.value, mission::longest_cruise(of_cruise).value);
    EXPECT_EQ(answer.reach_at_95_percent->limit.value, mission::longest_cruise(of_cruise, reach_probability).value);
    EXPECT_LT(answer.reach_at_95_percent->limit.value, answer.reach->limit.value);
    EXPECT_FALSE(answer.is_unplanned);
}

TEST(MissionAnswer, SaysWhatWouldKeepTheReserve) {
    const auto simulated = flown("invariant-32fps-448bit");
    EXPECT_EQ(outcome_of(simulated), Outcome::fails);
    const auto answer = assess_mission(simulated, reading_of("invariant-32fps-448bit"));
    ASSERT_TRUE(answer.capacity_ah);
    EXPECT_GT(*answer.capacity_ah, simulated.mission.setup.battery.capacity_ah);
    const auto lines = card_lines(simulated, answer);
    EXPECT_THAT(lines.front(), StartsWith("Runs empty: Runs empty "));
    EXPECT_THAT(lines[1], HasSubstr("the battery lasts: under 1 %"));
    EXPECT_THAT(lines[3], testing::MatchesRegex("[0-9]+ min [0-9]+ s less cruise, or a pack of [0-9.]+ Ah"));
}

TEST(MissionAnswer, KnowsNoChanceWhereNothingSaysHowFlightsDiffer) {
    const auto simulated = flown("computing-only");
    const auto answer = assess_mission(simulated, reading_of("computing-only"));
    EXPECT_FALSE(answer.reach_at_95_percent);
    EXPECT_EQ(outcome_of(simulated), Outcome::keeps);
    EXPECT_THAT(card_lines(simulated, answer), Contains(HasSubstr(": unknown")));
    EXPECT_TRUE(record_json(MissionOutput{&simulated, &answer})["probability_below_reserve"].is_null());
}

/// "computing-only", whose pack of 3.2 Ah is of flights that indicate another capacity.
mission::Mission on_pack_of_flights(double indicated_ah) {
    auto mission = test::paper_mission("computing-only");
    mission.setup.battery.flight_estimate = std::make_shared<battery::FlightEstimate>(
        battery::FlightEstimate{indicated_ah, {0.9 * indicated_ah, 1.1 * indicated_ah}});
    return mission;
}

TEST(MissionAnswer, WarnsOfACapacityThatContradictsTheFlights) {
    const auto lines_of = [](double indicated_ah) {
        const auto simulated = simulate_for_report({on_pack_of_flights(indicated_ah)}).front();
        return card_lines(simulated, assess_mission(simulated, reading_of("computing-only")));
    };
    EXPECT_THAT(lines_of(3.2), testing::Each(testing::Not(HasSubstr("flights indicate"))));
    const auto lines = lines_of(6.4);
    EXPECT_THAT(lines, Contains(StartsWith("Warning: the capacity of 3.2 Ah contradicts the flights")));
    EXPECT_THAT(lines, Contains(testing::ContainsRegex("[0-9]+[.][0-9] % with the 6.4 Ah that the flights indicate")));
}

TEST(MissionAnswer, IsNotSureOfALandingThatTheFlightsContradict) {
    const auto simulated = simulate_for_report({on_pack_of_flights(6.4)}).front();
    EXPECT_EQ(outcome_of(simulated), Outcome::keeps) << "with their capacity too";
    const auto fails = simulate_for_report({on_pack_of_flights(0.8)}).front();
    EXPECT_EQ(outcome_of(fails), Outcome::may_miss);
    const auto answer = assess_mission(fails, reading_of("computing-only"));
    EXPECT_THAT(card_lines(fails, answer), Contains(HasSubstr("; the battery fails after ")));
    const auto json = record_json(MissionOutput{&fails, &answer});
    EXPECT_EQ(json["with_capacity_of_flights"]["keeps_reserve"], false);
    const auto computing = flown("computing-only");
    EXPECT_FALSE(record_json(MissionOutput{&computing, &answer}).contains("with_capacity_of_flights"));
}

TEST(MissionAnswer, QualifiesALandingOfWhichAPartIsUncertain) {
    auto steep = test::paper_mission("computing-only");
    steep.setup.uncertain = {"a turn takes a bank of 78 degrees"};
    const auto simulated = simulate_for_report({steep}).front();
    EXPECT_EQ(outcome_of(simulated), Outcome::is_uncertain);
    EXPECT_THAT(card_lines(simulated, {}).front(),
                testing::MatchesRegex("Uncertain: Lands with .*, but a turn takes a bank of 78 degrees"));
}

TEST(MissionAnswer, StatesThatTheLongestFlightIsAtTheLimit) {
    auto simulated = simulate_for_report({test::paper_mission("invariant-32fps-448bit")}).front();
    simulated.is_longest = true;
    EXPECT_EQ(outcome_of(simulated), Outcome::keeps);
    EXPECT_EQ(mission_card(simulated, {}).texts.at("help"),
              "The longest flight that the battery lasts as modelled: how flights differ is unknown");
}

TEST(MissionAnswer, OffersAPlanWithAMarginWhereOneIsInReach) {
    const auto reading_with = [](double reserve_percent) -> mission::MissionLoader {
        return [reserve_percent](const mission::MissionReadOptions& how) {
            auto problem = std::get<mission::PlanningProblem>(reading_of("plan")(how));
            problem.setup.reserve_soc_percent = reserve_percent;
            return mission::MissionVariant(std::move(problem));
        };
    };
    const auto last_line = [](const mission::MissionLoader& reading) {
        const auto simulated = simulate_for_report({reading({.allow_unplanned = true})}).front();
        EXPECT_EQ(outcome_of(simulated), Outcome::may_miss);
        const auto answer = assess_mission(simulated, reading);
        EXPECT_TRUE(answer.is_unplanned);
        return mission_card(simulated, answer).texts.at("help").get<std::string>();
    };
    EXPECT_THAT(last_line(reading_with(3.0)), HasSubstr("Plan it with --probability 0.95"));
    EXPECT_THAT(last_line(reading_of("plan")),
                testing::AllOf(HasSubstr("less cruise"), testing::Not(HasSubstr("lan it with"))));
}

TEST(MissionAnswer, CountsCirclesOfAPath) {
    const auto path = test::source_dir() / "missions/synthetic/survey-path.toml";
    const mission::MissionLoader reading = [&](const mission::MissionReadOptions& how) {
        return mission::read_mission(path, how);
    };
    auto simulated = simulate_for_report({reading({.allow_unplanned = true})}).front();
    simulated.simulation.summary.samples.reset();  // its chance takes a second
    const auto answer = assess_mission(simulated, reading);
    ASSERT_TRUE(answer.reach);
    EXPECT_EQ(answer.reach->unit, mission::ReachUnit::circles);
    EXPECT_TRUE(record_json(MissionOutput{&simulated, &answer})["reach"].contains("most_circles"));
    EXPECT_THAT(card_lines(simulated, answer),
                Contains(testing::MatchesRegex("Most circles, as modelled: [0-9]+ circles")));
}

TEST(MissionAnswer, SaysWhichModelIsUsedAndHowItPredicts) {
    auto simulated = flown("computing-only");
    const auto answer = assess_mission(simulated, reading_of("computing-only"));
    EXPECT_THAT(card_lines(simulated, answer), testing::Not(Contains(HasSubstr("left out of the fit"))));
    simulated.mission.setup.power_model = mechanical::HeldOutScore{"constant_mean", 4, 18.6};
    EXPECT_THAT(card_lines(simulated, answer),
                Contains("Power by each phase's mean: 18.6 % off on 4 flights left out of the fit"));
}

TEST(MissionAnswer, SaysWhyThereIsNone) {
    auto simulated = flown("phased");
    const auto answer = assess_mission(simulated, [](const mission::MissionReadOptions&) -> mission::MissionVariant {
        throw InputError({"absent.toml"}, "it is absent", "find it");
    });
    EXPECT_FALSE(answer.reach);
    EXPECT_THAT(card_lines(simulated, answer), Contains(HasSubstr("cannot be read again")));
}

TEST(WorstFirst, OrdersByOutcomeThenProbability) {
    auto missions =
        simulate_for_report({test::paper_mission("computing-only"), test::paper_mission("phased"),
                             test::paper_mission("invariant-32fps-448bit"), test::paper_mission("adaptive")});
    EXPECT_EQ(worst_first(missions), (std::vector<std::size_t>{2, 1, 3, 0}));
    missions[3].simulation.summary.samples->probability_below_reserve = 0.9;
    EXPECT_EQ(worst_first(missions), (std::vector<std::size_t>{2, 3, 1, 0}));
}

TEST(ProbabilityText, IsNeverNoneOrAll) {
    EXPECT_EQ(probability_text(0.0), "under 1 %");
    EXPECT_EQ(probability_text(0.124), "12 %");
    EXPECT_EQ(probability_text(0.485), "49 %") << "as the page, whose sliders show 49 of 100";
    EXPECT_EQ(probability_text(1.0), "over 99 %");
}

}  // namespace
}  // namespace flightwatt::report
