#include "helpers/generated_motion.h"
#include "report/model_section.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;

std::vector<mechanical::MeasuredFlight> measured_motions(std::size_t count) {
    std::vector<mechanical::MeasuredFlight> flights;
    for (auto& motion : test::made_up_motions(count, 40, {}, 1)) {
        flights.emplace_back();
        flights.back().motion = std::move(motion);
    }
    return flights;
}

TEST(PhysicalSection, ShowsConstantsTrialsAndFigure) {
    const auto section = physical_section(measured_motions(4));
    ASSERT_TRUE(section.has_value());
    EXPECT_THAT(section->html, HasSubstr("drag"));
    EXPECT_THAT(section->html, HasSubstr("W s^3/m^3"));
    EXPECT_THAT(section->html, HasSubstr("half the 95 % interval"));
    EXPECT_THAT(section->html, HasSubstr("kept"));
    ASSERT_EQ(section->figures.size(), 1u);
    EXPECT_THAT(section->figures.front().description, HasSubstr("160 stretches of 4 flights"));
    EXPECT_EQ(section->figures.front().spec["layer"].size(), 2u);
}

TEST(PhysicalTables, AreThoseOfTheSection) {
    const auto tables = physical_tables(measured_motions(4));
    ASSERT_EQ(tables.size(), 2U);
    EXPECT_EQ(tables[0].label, "tab:physical");
    EXPECT_FALSE(tables[0].table.rows.empty());
    EXPECT_FALSE(tables[1].table.rows.empty());
    EXPECT_TRUE(physical_tables({}).empty());
}

TEST(PhysicalSection, PromisesNoIntervalFromASingleFlight) {
    const auto section = physical_section(measured_motions(1));
    ASSERT_TRUE(section.has_value());
    EXPECT_THAT(section->html, testing::Not(HasSubstr("half the 95 % interval")));
}

TEST(PhysicalSection, IsAbsentWhereNoMotionWasMeasured) {
    EXPECT_FALSE(physical_section({}).has_value());
    EXPECT_FALSE(physical_section(std::vector<mechanical::MeasuredFlight>(2)).has_value());
}

}  // namespace
}  // namespace flightwatt::report
