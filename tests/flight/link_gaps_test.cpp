#include "flight/link_gaps.h"

#include "flight/phase_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

constexpr double lost_from_s = 100.0;

/// 36 W in every second, but 72 W while nothing is received: for `lost_s`, with both counters.
FlightData interrupted_flight(double lost_s) {
    FlightData data;
    const auto add = [](Track& track, double time_s, double value) {
        track.time_s.push_back(time_s);
        track.value.push_back(value);
    };
    double energy_wh = 0.0;
    for (double time_s = 0.0; time_s <= 2000.0; ++time_s) {
        const bool is_lost = time_s > lost_from_s && time_s < lost_from_s + lost_s;
        if (!is_lost) {
            add(data.power_w, time_s, 36.0);
            add(data.voltage_v, time_s, 10.0);
            add(data.energy_wh, time_s, energy_wh);
            add(data.charge_ah, time_s, energy_wh / 10.0);
        }
        const bool is_next_lost = time_s >= lost_from_s && time_s < lost_from_s + lost_s;
        energy_wh += (is_next_lost ? 72.0 : 36.0) / 3600.0;
    }
    return data;
}

double energy_of(const FlightData& data) { return integrated_energy_wh(data.power_w, 0.0, 2000.0); }

std::vector<Sortie> one_sortie(double start_s, double end_s) {
    Sortie sortie;
    PhaseSpan cruise;
    cruise.start.time_s = start_s;
    cruise.end.time_s = end_s;
    sortie.phases = {cruise};
    return {sortie};
}

TEST(LinkGaps, TakeTheirEnergyFromACounter) {
    for (const double lost_s : {61.0, 600.0, 1800.0}) {
        const double true_wh = (2000.0 + lost_s) * 36.0 / 3600.0;
        for (const bool has_energy : {true, false}) {
            auto data = interrupted_flight(lost_s);
            EXPECT_NEAR(energy_of(data), 20.0, 1e-9) << "a straight line";
            if (!has_energy) data.energy_wh = {};
            const auto gaps = bridge_link_gaps(data);
            ASSERT_EQ(gaps.size(), 1U);
            EXPECT_TRUE(gaps.front().is_counted);
            EXPECT_NEAR(energy_of(data), true_wh, 0.05) << lost_s << ": the straight lines to both sides remain";
            EXPECT_TRUE(std::ranges::is_sorted(data.power_w.time_s));
            EXPECT_TRUE(bridge_link_gaps(data).empty());
            const auto sorties = one_sortie(50.0, 2000.0);
            EXPECT_EQ(unknown_energy_reason(gaps, sorties), "");
            EXPECT_THAT(gap_warnings(gaps, sorties),
                        testing::ElementsAre(testing::HasSubstr("its energy is by the on-board counter")));
        }
    }
}

TEST(LinkGaps, OfAMinuteAreAStraightLine) {
    auto data = interrupted_flight(60.0);
    EXPECT_TRUE(bridge_link_gaps(data).empty());
    EXPECT_NEAR(energy_of(data), 20.0, 1e-9);
}

TEST(LinkGaps, HaveUnknownEnergyWithoutACounterThatCounts) {
    const auto expect_unknown = [](FlightData data, const char* why) {
        const auto before = data.power_w;
        const auto gaps = bridge_link_gaps(data);
        ASSERT_EQ(gaps.size(), 1U) << why;
        EXPECT_EQ(data.power_w, before) << why;
        EXPECT_THAT(unknown_energy_reason(gaps, one_sortie(50.0, 2000.0)),
                    testing::HasSubstr("gap of 600 s from 100.0 s on"))
            << why;
        EXPECT_EQ(unknown_energy_reason(gaps, one_sortie(800.0, 2000.0)), "") << "on the ground before the flight";
    };
    auto data = interrupted_flight(600.0);
    data.energy_wh = {};
    data.charge_ah = {};
    expect_unknown(data, "no counter");
    data = interrupted_flight(600.0);
    data.energy_wh = {};
    for (std::size_t i = 0; i < data.charge_ah.time_s.size(); ++i)
        if (data.charge_ah.time_s[i] > lost_from_s) data.charge_ah.value[i] -= 5.0;
    expect_unknown(data, "it restarted");
    data = interrupted_flight(600.0);
    data.energy_wh = {};
    data.circuits.resize(2);
    expect_unknown(data, "it is of one of two circuits");
}

}  // namespace
}  // namespace flightwatt::flight
