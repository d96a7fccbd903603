#include "flight/checks/power_record.h"

#include "helpers/power_records.h"
#include "helpers/sample_columns.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

TEST(PowerRecord, KnowsTheUsualPowerInTwoStepsOfThrottleWithTenSamples) {
    const auto knows = [](double throttle_percent, std::size_t samples) {
        auto record = test::sound_record();
        for (std::size_t i = 200; i < 200 + samples; ++i) record.throttle_percent[i] = throttle_percent;
        derive_facts(record, test::resting());
        return !std::isnan(record.usual_w[200]);
    };
    EXPECT_TRUE(knows(60.0, 10));
    EXPECT_FALSE(knows(60.0, 9));
    EXPECT_TRUE(knows(55.1, 100)) << "the next step of 5 %";
    EXPECT_FALSE(knows(54.9, 100)) << "the same step";
}

TEST(PowerRecord, KnowsTheCurrentAtRestFromTenSamplesOfWhichThoseFarAwayAreLeftOut) {
    const auto samples_of = [](std::size_t samples, double last_a) {
        auto record = test::sound_record();
        for (std::size_t i = 0; i < samples; ++i) record.current_a[i] = 0.03 + 0.01 * static_cast<double>(i % 3);
        record.current_a[samples - 1] = last_a;
        derive_facts(record, test::resting(samples));
        return record.at_rest ? record.at_rest->samples : 0;
    };
    EXPECT_EQ(samples_of(10, 0.04), 10U);
    EXPECT_EQ(samples_of(9, 0.04), 0U);
    EXPECT_EQ(samples_of(20, 0.089), 20U) << "five times the median distance is 0.05 A";
    EXPECT_EQ(samples_of(20, 0.091), 19U);
}

TEST(PowerRecord, TakesTwoStepsOfACounterForItsRounding) {
    test::SampleColumns columns;
    for (int i = 0; i <= 100; ++i) {
        columns.time_s.push_back(i);
        columns.power_w.push_back(20.0 + i % 2);
        columns.energy_wh.push_back(1.1 * i);
    }
    PowerRecord flown;
    flown.time_s = columns.time_s;
    flown.in_flight = {{0, columns.time_s.size()}};
    FlightPhases phases;
    phases.sorties = {test::sortie_of(flown)};
    const auto series = test::series_of(columns);
    const auto record = make_power_record(select_tracks(series), phases, {});
    EXPECT_NEAR(record.energy_wh.rounding_percent, 100.0 * 2.0 * 0.1 / 110.0, 1e-6);
}

TEST(PowerRecord, TakesATwentiethOfTheUpperQuartileForNoPower) {
    const auto powerless_w = [](std::size_t strong) {
        auto record = test::sound_record();
        for (std::size_t i = 200; i < 200 + strong; ++i) record.power_w[i] *= 2.0;
        derive_facts(record, test::resting());
        return record.powerless_w;
    };
    EXPECT_NEAR(powerless_w(260), 2.0, 0.03);
    EXPECT_NEAR(powerless_w(240), 1.0, 0.03);
}

}  // namespace
}  // namespace flightwatt::flight
