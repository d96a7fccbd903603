#include "answer/pack_temperature.h"

#include "helpers/synthetic_discharge.h"

#include <cmath>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::answer {
namespace {

using testing::HasSubstr;

/// A pack of 0.08 ohm, with flights of these temperatures of the battery and resistances.
FoundPack flown(const std::vector<std::pair<double, double>>& flights) {
    FoundPack pack;
    pack.battery = test::known_pack();
    pack.answer.resistance_ohm = known(pack.battery.resistance_ohm, "measured");
    pack.battery.intervals.resistance_scatter = {0.01, flights.size()};
    pack.identified.emplace();
    pack.identified->errors.resistance_ohm = {0.07, 0.09};
    for (const auto& [at_c, ohm] : flights) {
        auto& flight = pack.identified->flights.emplace_back();
        flight.battery_start_c = at_c;
        flight.resistance = {ohm, 0.02 * ohm, 20.0, {0.96 * ohm, 1.04 * ohm}};
    }
    if (!flights.empty()) pack.answer.battery_start_c = Interval{flights.front().first, flights.back().first};
    return pack;
}

TEST(SetTemperature, OfFlightsNearItIsTheirs) {
    auto pack = flown({{18.0, 0.08}, {22.0, 0.08}});
    set_temperature(pack, 12.5, {});
    EXPECT_NEAR(pack.answer.resistance_at_ohm.value.value(), 0.08, 1e-12);
    EXPECT_THAT(pack.answer.resistance_at_ohm.basis, HasSubstr("as measured at 18 to 22 degC, within 8 K"));
}

TEST(SetTemperature, FartherAwayIsAnAssumptionWithAWiderInterval) {
    auto pack = flown({{18.0, 0.08}, {22.0, 0.08}});
    set_temperature(pack, 0.0, {});
    EXPECT_NEAR(pack.battery.resistance_ohm, 0.08 * std::exp(0.6), 1e-12);
    EXPECT_NEAR(pack.battery.intervals.resistance_ohm->low, 0.07 * std::exp(0.3), 1e-12);
    EXPECT_NEAR(pack.battery.intervals.resistance_ohm->high, 0.09 * std::exp(0.9), 1e-12);
    EXPECT_NEAR(pack.battery.intervals.resistance_scatter->sd_ohm, 0.01 * std::exp(0.6), 1e-12);
    EXPECT_NEAR(pack.battery.thevenin->rc_resistance_ohm, 0.05 * std::exp(0.6), 1e-12);
    EXPECT_EQ(pack.answer.resistance_at_ohm.basis, "assumed: 3 % (1.5 to 4.5) a kelvin colder, from 20 degC on");
    auto warm = flown({{18.0, 0.08}, {22.0, 0.08}});
    set_temperature(warm, 40.0, {});
    EXPECT_NEAR(warm.battery.resistance_ohm, 0.08 * std::exp(-0.6), 1e-12);
}

/// Series resistance and RC pair fall by 4 % a kelvin. As all flights have one RC pair, of 0.05 ohm, their own resistances
/// fall by what both do.
TEST(SetTemperature, IsMeasuredWhereFlightsDifferInTemperature) {
    const auto ohm = [](double at_c) { return 0.08 * std::exp(-0.04 * (at_c - 20.0)); };
    const auto own = [&](double at_c) { return ohm(at_c) * 0.13 / 0.08 - 0.05; };
    const std::vector<std::pair<double, double>> flights{
        {4.0, own(4.0)}, {5.0, own(5.0)}, {21.0, own(21.0)}, {22.0, own(22.0)}};
    auto pack = flown(flights);
    set_temperature(pack, 0.0, {});
    EXPECT_NEAR(pack.battery.resistance_ohm, ohm(0.0), 1e-9);
    EXPECT_NEAR(pack.battery.thevenin->rc_resistance_ohm, ohm(0.0) * 0.05 / 0.08, 1e-9);
    EXPECT_LT(pack.answer.resistance_at_interval_ohm->low, ohm(0.0));
    EXPECT_EQ(pack.answer.resistance_at_ohm.basis, "measured at 4 to 22 degC, if on one pack");
    pack = flown(flights);
    set_temperature(pack, -20.0, std::vector<Pack>(1));
    EXPECT_NEAR(pack.battery.resistance_ohm, ohm(4.0) * std::exp(0.03 * 24.0), 1e-9);
    EXPECT_THAT(pack.answer.resistance_at_ohm.basis, HasSubstr("assumed: 3 %"));
    pack = flown(flights);
    set_temperature(pack, 4.0, std::vector<Pack>(2));
    EXPECT_THAT(pack.answer.resistance_at_ohm.basis, HasSubstr("assumed: 3 %")) << "they may differ by pack";
}

TEST(SetTemperature, IsUnknownWithoutATemperatureOrAResistance) {
    auto pack = flown({});
    set_temperature(pack, 0.0, {});
    EXPECT_EQ(pack.battery.resistance_ohm, 0.08);
    EXPECT_THAT(missing_of(pack.answer), "") << "of the capacity, which is unknown, first";
    pack.answer.capacity_ah = known(2.4, "as given");
    EXPECT_THAT(missing_of(pack.answer), HasSubstr("no log states a temperature"));
    pack.answer.resistance_ohm = unknown("its interval reaches 0");
    set_temperature(pack, 0.0, {});
    EXPECT_THAT(missing_of(pack.answer), HasSubstr("the flights determine no resistance"));
}

}  // namespace
}  // namespace flightwatt::answer
