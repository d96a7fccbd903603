// What is printed of a battery that was identified from synthetic flights.

#include "cli/output/battery_output.h"

#include "helpers/synthetic_discharge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

class BatteryOutput : public testing::Test {
  protected:
    BatteryOutput() {
        battery::IdentificationOptions options;
        options.capacity_ah = test::known_pack().capacity_ah;
        for (const std::uint64_t seed : {1U, 2U}) {
            records_.push_back(test::discharge_record(test::synthetic_discharge(test::known_pack(), {}, seed)));
        }
        identified_ = identify_battery(records_, options);
        checks_ = leave_each_out(records_, options);
    }
    std::vector<battery::DischargeRecord> records_;
    battery::BatteryIdentification identified_;
    std::vector<battery::LeftOutCheck> checks_;
};

TEST_F(BatteryOutput, HasARowAParameterAndAFlight) {
    const auto parameters = parameters_table(identified_);
    ASSERT_EQ(parameters.rows.size(), 3U);
    EXPECT_EQ(parameters.rows[0][0], "resistance_ohm");
    EXPECT_LT(std::stod(parameters.rows[0][2]), std::stod(parameters.rows[0][3])) << "low and high";
    const auto flights = flights_table(identified_, checks_);
    ASSERT_EQ(flights.rows.size(), 2U);
    EXPECT_EQ(flights.rows[0].size(), flights.header.size());
    EXPECT_EQ(flights_table(identified_, {}).header.size() + 2, flights.header.size());
}

TEST_F(BatteryOutput, HasNoRowOfAnAbsentRcPair) {
    identified_.fit.rc_resistance_ohm = 0.0;
    EXPECT_EQ(parameters_table(identified_).rows.size(), 1U);
    EXPECT_TRUE(to_json(identified_, checks_)["rc_time_constant_s"]["value"].is_null());
}

TEST_F(BatteryOutput, IsNullInJsonWhereNothingIsKnown) {
    const auto json = to_json(identified_, checks_);
    EXPECT_EQ(json["capacity_ah"], test::known_pack().capacity_ah);
    EXPECT_TRUE(json["capacity_interval_ah"].is_null()) << "it was given";
    EXPECT_EQ(json["flights"].size(), 2U);
    EXPECT_EQ(json["left_out"][1]["flight"], "synthetic_2");
}

TEST_F(BatteryOutput, NamesTheFlightsAtTheHeadOfItsFile) {
    const auto head = provenance(identified_);
    EXPECT_THAT(head, HasSubstr("from synthetic_1 synthetic_2."));
    for (std::size_t line = 0; line < head.size(); line = head.find('\n', line) + 1) {
        EXPECT_EQ(head[line], '#') << "not a comment: " << head.substr(line, 40);
    }
}

}  // namespace
}  // namespace flightwatt::cli
