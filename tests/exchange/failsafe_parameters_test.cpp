// Failsafes against what the autopilots make of them.

#include "exchange/failsafe_parameters.h"

#include "base/error.h"
#include "base/number.h"
#include "battery/battery_toml.h"
#include "helpers/test_paths.h"

#include <map>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

namespace flightwatt::exchange {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

EstimatorInput wing_input() {
    EstimatorInput input;
    input.model = mechanical::read_predicting_model(test::source_dir() / "fits/mechanical/synthetic-wing.toml");
    input.battery = battery::read_battery(test::source_dir() / "fits/battery/synthetic-3s.toml");
    return input;
}

answer::FailsafeCard wing_card(std::optional<double> distance_m = 2000.0) {
    answer::FailsafeRequest request;
    request.model = wing_input().model.value();
    request.battery = wing_input().battery.value();
    request.home_distance_m = distance_m;
    request.reserve_percent = 20.0;
    return make_failsafe_card(request);
}

/// Values by name of lines that have them at these words.
std::map<std::string, double> values_of(const std::string& text, std::size_t name_at, std::size_t value_at) {
    std::map<std::string, double> values;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream words(line);
        std::vector<std::string> all{std::istream_iterator<std::string>(words), {}};
        values[all.at(name_at)] = number_or_nan(all.at(value_at));
    }
    return values;
}

TEST(FailsafeArdupilot, HasRemainingChargeAndPackVoltage) {
    const auto card = wing_card();
    const auto result = to_failsafe_ardupilot(wing_input(), card);
    const auto values = values_of(result.text, 0, 1);
    EXPECT_EQ(values.at("BATT_CAPACITY"), 3200.0);
    EXPECT_EQ(values.at("BATT_LOW_MAH"), 3200.0 - card.low->used_mah);
    EXPECT_GT(values.at("BATT_LOW_MAH"), values.at("BATT_CRT_MAH")) << "or ArduPilot does not arm";
    EXPECT_GT(values.at("BATT_LOW_VOLT"), values.at("BATT_CRT_VOLT"));
    EXPECT_EQ(values.at("BATT_FS_VOLTSRC"), 0.0) << "voltages under load";
    EXPECT_THAT(result.notes, IsEmpty());
}

TEST(FailsafeArdupilot, OfSeveralMonitorsHasThePartOfEach) {
    const auto card = wing_card();
    auto input = wing_input();
    input.battery->monitors = {{1, 0.55}, {2, 0.45}};
    const auto result = to_failsafe_ardupilot(input, card);
    const auto values = values_of(result.text, 0, 1);
    EXPECT_EQ(values.at("BATT_CAPACITY"), 1760.0);
    EXPECT_EQ(values.at("BATT2_CAPACITY"), 1440.0);
    for (const auto* name : {"LOW", "CRT"}) {
        const auto& action = name == std::string("LOW") ? *card.low : card.critical;
        // The packs together are used as far as the card states when their monitors act.
        const double left_mah =
            values.at(fmt::format("BATT_{}_MAH", name)) + values.at(fmt::format("BATT2_{}_MAH", name));
        EXPECT_NEAR(left_mah, action.remaining_mah + 1.0, 1.0);
        EXPECT_NEAR(values.at(fmt::format("BATT2_{}_MAH", name)), 0.45 * action.remaining_mah, 1.0);
        EXPECT_EQ(values.at(fmt::format("BATT2_{}_VOLT", name)), values.at(fmt::format("BATT_{}_VOLT", name)));
    }
    EXPECT_THAT(result.text, HasSubstr("# packs: the charge is that of all together, of which battery monitor 1 counts "
                                       "55.0 % and battery monitor 2 counts 45.0 %: each has values, and an action"));
    EXPECT_THAT(result.notes, SizeIs(1));
}

TEST(FailsafeFormats, HaveNoChargeWhereThePartsOfMonitorsAreNotKnown) {
    const auto card = wing_card();
    auto input = wing_input();
    input.battery->monitors = {{1, 0.0}, {2, 0.0}};
    const auto ardupilot = to_failsafe_ardupilot(input, card);
    const auto values = values_of(ardupilot.text, 0, 1);
    EXPECT_THAT(ardupilot.text, Not(HasSubstr("BATT_CAPACITY")));
    EXPECT_FALSE(values.contains("BATT_LOW_MAH") || values.contains("BATT2_CRT_MAH"));
    EXPECT_NEAR(values.at("BATT2_LOW_VOLT"), card.low->voltage_alone->voltage_v, 0.006) << "without a count";
    const auto px4 = to_failsafe_px4(input, card);
    EXPECT_THAT(values_of(px4.text, 2, 3), IsEmpty());
    for (const auto& result : {ardupilot, px4}) {
        EXPECT_THAT(result.text,
                    HasSubstr("count parts that are not known, as the flights differ: values of charge are"));
        EXPECT_THAT(result.notes, SizeIs(1));
    }
}

/// A return from next to home: no more than the landing.
answer::FailsafeCard equal_card() {
    auto card = wing_card();
    card.low = card.critical;
    return card;
}

TEST(FailsafeFormats, RaiseTheLowActionAboveAnEqualCriticalOne) {
    auto input = wing_input();
    input.battery->monitors = {{1, 0.7}, {2, 0.3}};
    const auto card = equal_card();
    const auto ardupilot = to_failsafe_ardupilot(input, card);
    const auto values = values_of(ardupilot.text, 0, 1);
    for (const auto* prefix : {"BATT", "BATT2"}) {
        const auto value = [&](const char* name) { return values.at(fmt::format("{}_{}", prefix, name)); };
        EXPECT_NEAR(value("LOW_VOLT"), value("CRT_VOLT") + 0.01, 1e-9) << "or ArduPilot does not arm";
        EXPECT_EQ(value("LOW_MAH"), value("CRT_MAH") + 1.0);
        EXPECT_NEAR(value("CRT_VOLT"), card.critical.voltage->voltage_v, 1e-9);
    }
    EXPECT_THAT(ardupilot.text, HasSubstr("# BATT2_LOW_VOLT is raised to a step above BATT2_CRT_VOLT"));
    const auto px4 = to_failsafe_px4(wing_input(), card).text;
    EXPECT_NEAR(values_of(px4, 2, 3).at("BAT_CRIT_THR"), values_of(px4, 2, 3).at("BAT_EMERGEN_THR") + 0.01, 1e-9);
    EXPECT_THAT(px4, HasSubstr("# BAT_CRIT_THR is raised to a step above BAT_EMERGEN_THR"));
    const auto inav = to_failsafe_inav(wing_input(), card).text;
    const auto alarms = values_of(inav, 1, 3);
    EXPECT_EQ(alarms.at("battery_capacity_warning"), alarms.at("battery_capacity_critical") + 1.0);
    EXPECT_EQ(alarms.at("vbat_warning_cell_voltage"), alarms.at("vbat_min_cell_voltage") + 1.0);
    EXPECT_THAT(inav, HasSubstr("# vbat_warning_cell_voltage is raised to a step above vbat_min_cell_voltage"));
    const auto paparazzi = to_failsafe_paparazzi(wing_input(), card).text;
    EXPECT_THAT(paparazzi, HasSubstr("<!-- LOW_BAT_LEVEL is raised to a step above CRITIC_BAT_LEVEL"));
    EXPECT_THAT(paparazzi, HasSubstr(R"(name="LOW_BAT_LEVEL" value="11.3")"));
    EXPECT_THAT(paparazzi, HasSubstr(R"(name="CRITIC_BAT_LEVEL" value="11.2")"));
}

TEST(FailsafeFormats, StateNothingRaisedWhereTheActionsDiffer) {
    for (const auto write : {to_failsafe_ardupilot, to_failsafe_px4, to_failsafe_inav, to_failsafe_paparazzi})
        EXPECT_THAT(write(wing_input(), wing_card()).text, Not(HasSubstr("raised")));
}

TEST(FailsafePx4, OfSeveralMonitorsHasTheCapacityOfEach) {
    auto input = wing_input();
    input.battery->monitors = {{2, 0.6}, {3, 0.4}};
    const auto values = values_of(to_failsafe_px4(input, wing_card()).text, 2, 3);
    EXPECT_NEAR(values.at("BAT2_CAPACITY"), 1920.0, 1e-6);
    EXPECT_NEAR(values.at("BAT3_CAPACITY"), 1280.0, 1e-6);
    EXPECT_FALSE(values.contains("BAT1_CAPACITY"));
}

TEST(FailsafePx4, ReturnsAtCriticalAndLandsAtEmergency) {
    const auto card = wing_card();
    const auto result = to_failsafe_px4(wing_input(), card);
    const auto values = values_of(result.text, 2, 3);
    EXPECT_NEAR(values.at("BAT_CRIT_THR"), card.low->soc_percent / 100.0, 1e-9);
    EXPECT_NEAR(values.at("BAT_EMERGEN_THR"), card.critical.soc_percent / 100.0, 1e-9);
    EXPECT_NEAR(values.at("BAT_LOW_THR"), values.at("BAT_CRIT_THR") + 0.05, 1e-9);
    EXPECT_THAT(result.notes, Not(IsEmpty())) << "11 % are above the 10 % of the document";
    EXPECT_THAT(result.notes.front(), HasSubstr("BAT_EMERGEN_THR = 0.11 is above the 0.1"));
}

TEST(FailsafePx4, KeepsOrderAndLeastValues) {
    auto card = wing_card();
    card.low->soc_percent = 3;
    card.critical.soc_percent = 2;
    const auto values = values_of(to_failsafe_px4(wing_input(), card).text, 2, 3);
    EXPECT_EQ(values.at("BAT_EMERGEN_THR"), 0.03);
    EXPECT_EQ(values.at("BAT_CRIT_THR"), 0.05);
    EXPECT_EQ(values.at("BAT_LOW_THR"), 0.12);
    card.critical.soc_percent = 8;
    EXPECT_NEAR(values_of(to_failsafe_px4(wing_input(), card).text, 2, 3).at("BAT_CRIT_THR"), 0.09, 1e-9);
}

TEST(FailsafeInav, HasHundredthsOfAVoltACell) {
    const auto card = wing_card();
    auto input = wing_input();
    const auto values = values_of(to_failsafe_inav(input, card).text, 1, 3);
    EXPECT_EQ(values.at("battery_capacity_warning"), card.low->remaining_mah);
    EXPECT_EQ(values.at("battery_capacity_critical"), card.critical.remaining_mah);
    EXPECT_GE(values.at("vbat_warning_cell_voltage") * 0.03, card.low->voltage->voltage_v - 1e-9);
    EXPECT_NEAR(values.at("vbat_warning_cell_voltage") * 0.03, card.low->voltage->voltage_v, 0.03);
    input.cells_in_series = 1;
    EXPECT_THROW(to_failsafe_inav(input, card), InputError);
}

TEST(FailsafePaparazzi, HasASectionOfFallingVoltages) {
    const auto text = to_failsafe_paparazzi(wing_input(), wing_card()).text;
    pugi::xml_document xml;
    ASSERT_TRUE(xml.load_string(text.c_str())) << text;
    std::map<std::string, double> values;
    for (const auto& define : xml.child("section").children("define"))
        values[define.attribute("name").value()] = define.attribute("value").as_double();
    EXPECT_STREQ(xml.child("section").attribute("name").value(), "BAT");
    EXPECT_GT(values.at("LOW_BAT_LEVEL"), values.at("CRITIC_BAT_LEVEL"));
    EXPECT_GT(values.at("CRITIC_BAT_LEVEL"), values.at("CATASTROPHIC_BAT_LEVEL"));
    EXPECT_NEAR(values.at("CATASTROPHIC_BAT_LEVEL"), 9.7, 1e-9) << "9.86 V at rest, less 0.13 V";
    auto input = wing_input();
    auto card = wing_card();
    card.critical.voltage_alone.reset();
    EXPECT_THROW(to_failsafe_paparazzi(input, card), InputError);
}

TEST(FailsafeFormats, OmitTheReturnWithoutADistance) {
    const auto card = wing_card(std::nullopt);
    for (const auto write : {to_failsafe_ardupilot, to_failsafe_inav, to_failsafe_paparazzi}) {
        const auto result = write(wing_input(), card);
        EXPECT_THAT(result.text, Not(HasSubstr("LOW_MAH")));
        EXPECT_THAT(result.text, Not(HasSubstr("set battery_capacity_warning")));
        EXPECT_THAT(result.text, Not(HasSubstr("name=\"LOW_BAT_LEVEL")));
        ASSERT_THAT(result.notes, SizeIs(1));
        EXPECT_THAT(result.notes.front(), HasSubstr("the distance to home is not known"));
    }
    EXPECT_THAT(to_failsafe_px4(wing_input(), card).text, Not(HasSubstr("\tBAT_CRIT_THR")));
}

}  // namespace
}  // namespace flightwatt::exchange
