// What is printed of a battery that was identified from synthetic flights.

#include "cli/output/battery_output.h"

#include "helpers/synthetic_discharge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

class BatteryTables : public testing::Test {
  protected:
    BatteryTables() {
        battery::IdentificationOptions options;
        options.capacity_ah = test::known_pack().capacity_ah;
        for (const std::uint64_t seed : {1U, 2U}) {
            records_.push_back(test::discharge_record(test::synthetic_discharge(test::known_pack(), {}, seed)));
        }
        identified_ = identify_battery(records_, options);
        checks_ = leave_one_out(records_, options);
    }
    /// A line each.
    std::string remarks() const {
        std::string text;
        for (const auto& remark : battery_remarks(identified_))
            text += (remark.is_warning ? "warning: " : "") + remark.text + "\n";
        return text;
    }
    std::vector<battery::DischargeRecord> records_;
    battery::BatteryIdentification identified_;
    std::vector<battery::LeaveOneOutCheck> checks_;
};

TEST_F(BatteryTables, HasARowAParameterAndAFlight) {
    const auto parameters = pack_table(identified_.battery);
    ASSERT_EQ(parameters.rows.size(), 5U);
    EXPECT_EQ(parameters.rows[0][0], "capacity [Ah]");
    EXPECT_EQ(parameters.rows[1][0], "resistance [ohm]");
    EXPECT_EQ(parameters.rows[2][0], "resistance between flights, sd [ohm]");
    const auto flights = flights_table(identified_, checks_);
    ASSERT_EQ(flights.rows.size(), 2U);
    EXPECT_EQ(flights.rows[0].size(), flights.header.size());
    EXPECT_EQ(flights_table(identified_, {}).header.size() + 4, flights.header.size());
}

TEST_F(BatteryTables, HasTheTemperatureOfTheAirWhereItWasLogged) {
    const auto columns = flights_table(identified_, {}).header.size();
    identified_.flights[1].air_temperature_c = 21.5;
    const auto table = flights_table(identified_, {});
    EXPECT_EQ(table.header.size(), columns + 1);
    EXPECT_THAT(table.rows[1], testing::Contains("21.5"));
    EXPECT_THAT(table.rows[0], testing::Contains("-"));
    const auto json = record_json(cli::BatteryOutput{&identified_, &checks_});
    EXPECT_EQ(json["leave_one_out"][1]["load_voltage_rms_mv"], 1e3 * checks_[1].load_rms_v);
}

TEST_F(BatteryTables, HasNoRowOfAnAbsentRcPair) {
    identified_.fit.rc_resistance_ohm = 0.0;
    identified_.battery.thevenin->rc_resistance_ohm = 0.0;
    EXPECT_EQ(pack_table(identified_.battery).rows.size(), 3U) << "the capacity, the resistance and how flights differ";
    EXPECT_TRUE(record_json(cli::BatteryOutput{&identified_, &checks_})["rc_time_constant_s"].is_null());
}

TEST_F(BatteryTables, IsNullInJsonWhereNothingIsKnown) {
    const auto json = record_json(cli::BatteryOutput{&identified_, &checks_});
    EXPECT_EQ(json["capacity_ah"], test::known_pack().capacity_ah);
    EXPECT_TRUE(json["capacity_ah_interval_95"].is_null()) << "it was given";
    EXPECT_EQ(json["flights"].size(), 2U);
    EXPECT_EQ(json["leave_one_out"][1]["flight"], "synthetic_2");
}

TEST_F(BatteryTables, ComparesAGivenCapacity) {
    auto& pack = identified_.battery;
    EXPECT_THAT(remarks(), testing::AllOf(HasSubstr("using the given capacity of 2.4 Ah; the flights indicate "),
                                          HasSubstr(" Ah in 95 %)")));
    EXPECT_THAT(provenance(identified_), testing::Not(HasSubstr("Warning")));
    EXPECT_EQ(record_json(cli::BatteryOutput{&identified_, &checks_})["flight_estimate_ah"],
              pack.flight_estimate->capacity_ah);
    EXPECT_THAT(pack_table(pack).rows,
                testing::Not(testing::Contains(testing::Contains("capacity by its flights [Ah]"))));
    pack.capacity_ah = 50.0;
    EXPECT_THAT(provenance(identified_), HasSubstr("\n# Warning: the capacity of 50 Ah contradicts the flights"));
    EXPECT_THAT(pack_table(pack).rows, testing::Contains(testing::Contains("capacity by its flights [Ah]")));
    pack.flight_estimate.reset();
    EXPECT_THAT(remarks(),
                HasSubstr("using the given capacity of 50 Ah; the flights drew too little to estimate it\n"));
    EXPECT_TRUE(record_json(cli::BatteryOutput{&identified_, &checks_})["flight_estimate_ah"].is_null());
}

TEST_F(BatteryTables, WarnsOfAVoltageThatCellsDoNotHave) {
    EXPECT_THAT(remarks(), testing::Not(HasSubstr("cells rest")));
    identified_.cells = 4;
    EXPECT_THAT(remarks(), HasSubstr(": 4 cells rest at 3.09 V each before take-off, below an empty LiPo cell"));
    EXPECT_THAT(provenance(identified_), HasSubstr(": 4 cells rest"));
}

TEST_F(BatteryTables, NamesTheFlightsAtTheHeadOfItsFile) {
    const auto head = provenance(identified_);
    EXPECT_THAT(head, HasSubstr("from synthetic_1 synthetic_2."));
    for (std::size_t line = 0; line < head.size(); line = head.find('\n', line) + 1) {
        EXPECT_EQ(head[line], '#') << "not a comment: " << head.substr(line, 40);
    }
}

}  // namespace
}  // namespace flightwatt::cli
