// Trends of flights whose ageing is known.

#include "report/flight_trends.h"

#include "base/error.h"
#include "base/text_table.h"
#include "helpers/aged_flights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;

constexpr double seconds_per_day = 86400.0;
constexpr double fresh_w = 40.0;

/// Flights of a pack that ages, of an aircraft whose cruise takes `part_a_day` more power.
std::vector<FlightTrendData> flown(const test::AgedFlights& aged, double part_a_day, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<FlightTrendData> flights;
    for (std::size_t f = 0; f < aged.day.size(); ++f) {
        FlightTrendData flight;
        flight.name = "f" + std::to_string(f);
        flight.aircraft = "7 Wing";
        flight.facts.start_clock_s = seconds_per_day * aged.day[f];
        flight.facts.mean_power_w[flight::Phase::cruise] =
            fresh_w * (1.0 + part_a_day * aged.day[f] + 0.02 * normal(random));
        answer::PackUse use;
        use.flight = flight.name;
        use.aircraft = flight.aircraft;
        use.start_s = flight.facts.start_clock_s;
        use.record = aged.records[f];
        flight.uses = {std::move(use)};
        flights.push_back(std::move(flight));
    }
    return flights;
}

answer::PackLedger add_health(std::vector<FlightTrendData>& flights, const answer::LedgerOptions& options = {}) {
    return add_state_of_health(flights, take_uses(flights), options);
}

std::map<std::string, batch::Trend> by_quantity(const std::vector<AircraftTrend>& trends) {
    std::map<std::string, batch::Trend> by_quantity;
    for (const auto& trend : trends)
        if (trend.answer.trend) by_quantity[trend.quantity] = *trend.answer.trend;
    return by_quantity;
}

constexpr std::size_t seeds = 20;

TEST(TrendsStudy, HoldTheAgeingThatIsThere) {
    const test::Ageing ageing{0.0001, 0.001, 9};
    constexpr double power_part_a_day = 0.002;
    std::map<std::string, std::size_t> held;
    std::map<std::string, std::size_t> found;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        auto flights = flown(test::aged_flights(ageing, seed), power_part_a_day, seed);
        add_health(flights);
        for (const auto& flight : flights) EXPECT_TRUE(flight.capacity_ah) << flight.name << " of seed " << seed;
        const double mean_part = 1.0 - ageing.part_a_day * ageing.days / 2.0;
        const std::map<std::string, double> truth{{"cruise_power_w", power_part_a_day * fresh_w},
                                                  {"resistance_ohm", ageing.ohm_a_day},
                                                  {"capacity_percent", -100.0 * ageing.part_a_day / mean_part}};
        const auto trends = by_quantity(estimate_trends(flights));
        for (const auto& [quantity, per_day] : truth) {
            ASSERT_TRUE(trends.contains(quantity)) << quantity << " of seed " << seed;
            const auto& trend = trends.at(quantity);
            held[quantity] += trend.low_per_day <= per_day && per_day <= trend.high_per_day ? 1 : 0;
            found[quantity] += is_significant(trend) && trend.per_day * per_day > 0.0 ? 1 : 0;
        }
    }
    for (const auto* quantity : {"cruise_power_w", "resistance_ohm", "capacity_percent"}) {
        EXPECT_GE(held[quantity], seeds - 3) << quantity;
        EXPECT_GE(found[quantity], seeds - 1) << quantity;
    }
}

TEST(TrendsStudy, AreNotFoundWhereNothingAges) {
    std::size_t checked = 0;
    std::size_t found = 0;
    for (std::uint64_t seed = 11; seed < 11 + seeds; ++seed) {
        auto flights = flown(test::aged_flights({0.0, 0.0, 9}, seed), 0.0, seed);
        add_health(flights);
        for (const auto& [quantity, trend] : by_quantity(estimate_trends(flights))) {
            ++checked;
            found += is_significant(trend) ? 1 : 0;
        }
    }
    EXPECT_EQ(checked, 3 * seeds);
    EXPECT_LE(found, 7U) << "one in 20 by chance";
}

TEST(Trends, AreDrawnFromFiveFlightsOnThreeDaysOn) {
    std::vector<FlightTrendData> flights(4);
    for (std::size_t f = 0; f < flights.size(); ++f) {
        flights[f].aircraft = "7 Wing";
        flights[f].facts.start_clock_s = seconds_per_day * static_cast<double>(f);
        flights[f].facts.mean_power_w[flight::Phase::cruise] = fresh_w + static_cast<double>(f);
    }
    LatexTables tables;
    EXPECT_TRUE(trends_json(estimate_trends(flights), {}, tables).is_null());
    flights.push_back(flights.back());
    flights.back().facts.start_clock_s = seconds_per_day * 9.0;
    flights.back().facts.mean_power_w[flight::Phase::cruise] = fresh_w + 9.0;
    const auto json = trends_json(estimate_trends(flights), {}, tables);
    const auto power =
        std::ranges::find_if(json["trends"], [](const Json& one) { return one["title"] == "cruise power [W]"; });
    ASSERT_NE(power, json["trends"].end());
    EXPECT_NEAR((*power)["change_in_30_days"].get<double>(), 30.0, 1e-9);
    EXPECT_EQ((*power)["direction"], "rises");
    EXPECT_EQ((*power)["flights"]["value"].size(), 5U);
    EXPECT_EQ((*power)["lines"].size(), 3U) << "the slope, and the ends of its interval";
    EXPECT_THAT(tables.text, HasSubstr("\\label{tab:trends}"));
}

/// Five flights on the wing and then four in hover had a cruise power that rises.
TEST(Trends, OfThePowerOfAVtolLeaveOutHover) {
    std::vector<FlightTrendData> flights(9);
    for (std::size_t i = 0; i < flights.size(); ++i) {
        flights[i].only_hovers = i >= 5;
        flights[i].facts.start_clock_s = 30.0 * seconds_per_day * static_cast<double>(i);
        flights[i].facts.mean_power_w[flight::Phase::cruise] = flights[i].only_hovers ? 300.0 : 100.0;
        flights[i].capacity_percent = 100.0;
    }
    auto trends = by_quantity(estimate_trends(flights));
    EXPECT_EQ(trends.at("cruise_power_w").flights, 5U);
    EXPECT_EQ(trends.at("cruise_power_w").per_day, 0.0);
    EXPECT_EQ(trends.at("capacity_percent").flights, 9U);
    for (auto& flight : flights) flight.only_hovers = true;
    trends = by_quantity(estimate_trends(flights));
    EXPECT_EQ(trends.at("cruise_power_w").flights, 9U) << "all hover";
}

TEST(Trends, OfCapacitiesAreInPercentOfTheirMean) {
    std::vector<FlightTrendData> flights(5);
    for (std::size_t f = 0; f < flights.size(); ++f) {
        flights[f].aircraft = "7 Wing";
        flights[f].facts.start_clock_s = seconds_per_day * static_cast<double>(f);
        flights[f].capacity_percent = 100.0 - 2.0 * (static_cast<double>(f) - 2.0);
    }
    const auto trends = estimate_trends(flights);
    EXPECT_THAT(to_text(table_of(trends)), HasSubstr("-60"));
    LatexTables tables;
    EXPECT_THAT(trends_json(trends, {}, tables).dump(), HasSubstr("\"falls\""));
}

TEST(PackWear, TakesTheCapacityThatIsKnown) {
    auto aged = test::aged_flights({0.0001, 0.001, 5}, 3);
    auto guessed = flown(aged, 0.0, 3);
    auto known = guessed;
    auto refused = guessed;
    add_health(guessed);
    constexpr double mean_ah = 2.3;
    EXPECT_TRUE(add_health(known, {.capacity_ah = mean_ah}).notes.empty());
    double logarithms = 0.0;
    for (std::size_t f = 0; f < known.size(); ++f) {
        EXPECT_NE(guessed[f].capacity_ah, known[f].capacity_ah);
        logarithms += std::log(known[f].capacity_ah.value() / mean_ah);
    }
    EXPECT_NEAR(logarithms, 0.0, 0.01);
    EXPECT_THROW(add_health(refused, {.capacity_ah = 0.2}), UsageError);
}

TEST(PackWear, IsShownAsALedger) {
    auto flights = flown(test::aged_flights({0.001, 0.0, 7}, 5), 0.0, 5);
    auto uses = take_uses(flights);
    for (auto& use : uses) {
        use.pack = "A<1>";
        use.named_by = answer::PackNaming::file;
    }
    const auto ledger = add_state_of_health(flights, std::move(uses));
    LatexTables tables;
    const auto packs = trends_json(estimate_trends(flights), ledger, tables)["packs"];
    ASSERT_EQ(packs.size(), 1U);
    EXPECT_EQ(packs[0]["pack"], "A<1>");
    EXPECT_EQ(packs[0]["named_by"], "packs.toml");
}

}  // namespace
}  // namespace flightwatt::report
