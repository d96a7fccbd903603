#include "flight/load_flight.h"
#include "helpers/test_paths.h"
#include "mechanical/measured_flight.h"
#include "report/figures/flight_figures.h"
#include "report/sections/sections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

/// A batch of sample logs, without its folder.
BatchContent content_of(int flights) {
    BatchContent content;
    for (int i = 1; i <= flights; ++i) {
        ReportFlight flight;
        flight.series =
            flight::read_flight(test::source_dir() / "logs" / ("opterra_synthetic_0" + std::to_string(i) + ".data"));
        flight.phases = segment(flight.series);
        flight.name = flight.series.flight;
        for (auto& measured : mechanical::extract_flights(flight.series, flight.phases, 1).flights)
            content.measured.push_back(std::move(measured));
        content.flights.push_back(std::move(flight));
    }
    content.fit.emplace();
    return content;
}

TEST(PredictEachMinute, ComesToWhatWasMeasured) {
    const auto content = content_of(3);
    const auto flights = predict_each_minute(content, 30);
    ASSERT_EQ(flights.size(), 3U);
    for (const auto& [name, flight] : flights) {
        EXPECT_EQ(flight.others, 2U);
        EXPECT_NEAR(static_cast<double>(flight.moments.size()), 9.5, 0.6) << name << ": a cruise of ten minutes";
        EXPECT_NEAR(flight.measured_wh, 5.2, 0.4);
        const auto& last = flight.moments.back();
        EXPECT_NEAR(last.energy_wh, flight.measured_wh, 0.1) << name;
        EXPECT_TRUE(last.interval.contains(flight.measured_wh)) << name;
        const auto figure = in_flight_figure(name, flight, "f");
        EXPECT_THAT(figure.caption, testing::HasSubstr("a model of the 2 other flights"));
    }
}

TEST(PredictEachMinute, IsATableOfItsFirstMiddleAndLastMoment) {
    PredictedFlight flight;
    flight.measured_wh = 5.0;
    for (const double energy_wh : {4.0, 4.5, 4.9, 5.1})
        flight.moments.push_back({60.0, energy_wh, {energy_wh - 0.3, energy_wh + 0.3}});
    const auto table = predictions_table({{"f", flight}});
    ASSERT_EQ(table.rows.size(), 1U);
    EXPECT_EQ(table.rows[0], (std::vector<std::string>{"f", "5.00", "4.00", "3.70 to 4.30", "4.90", "4.60 to 5.20",
                                                       "5.10", "4.80 to 5.40", "50"}));
    EXPECT_EQ(table.header.size(), table.rows[0].size());
    EXPECT_TRUE(predictions_table({}).rows.empty());
}

TEST(PredictEachMinute, LooksAtNothingThatComesLater) {
    auto content = content_of(3);
    const auto whole = predict_each_minute(content, 30);
    auto& flight = content.flights.front();
    const double take_off_s = flight.phases.sorties.front().phases.front().start.time_s;
    const auto& moments = whole.at(flight.name).moments;
    flight.series = truncate_series(flight.series, take_off_s + moments[3].flown_s + 20.0);
    const auto cut = predict_each_minute(content, 30);
    const auto& fewer = cut.at(flight.name).moments;
    ASSERT_GE(fewer.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(fewer[i].energy_wh, moments[i].energy_wh) << i;
}

TEST(PredictEachMinute, NeedsOthersToLearnFrom) {
    EXPECT_TRUE(predict_each_minute(content_of(2), 30).empty());
    EXPECT_TRUE(predict_each_minute(content_of(3), 2).empty()) << "more than are to be predicted";
}

}  // namespace
}  // namespace flightwatt::report
