// The sections of a model and of its validation.

#include "report/sections/model_section.h"

#include "helpers/generated_flights.h"
#include "helpers/generated_motion.h"
#include "mechanical/table_one.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(ModelSection, ShowsCurvesAndTable) {
    ReportModel model{test::published_model(), "Read from a file."};
    const auto without = model_section(model, "model");
    ASSERT_EQ(without.figures.size(), 1U);
    EXPECT_EQ(without.figures[0].id, "model-curves");
    EXPECT_THAT(without.html, HasSubstr("Read from a file."));
    EXPECT_THAT(without.html, Not(HasSubstr("<h3>Table I</h3>")));
    model.table_one = table_one(model.model);
    const auto with = model_section(model, "model");
    EXPECT_THAT(with.html, HasSubstr("<h3>Table I</h3>"));
    EXPECT_THAT(with.html, Not(HasSubstr("the 95 % intervals"))) << "its errors are not known";
}

TEST(ValidationSection, ShowsScoresAndWarnsOfFewFlights) {
    const auto section = validation_section(mechanical::leave_one_out(test::generated(4, 7)));
    ASSERT_EQ(section.figures.size(), 1U);
    EXPECT_EQ(section.figures[0].id, "validation-errors");
    EXPECT_THAT(section.html, HasSubstr("constant_mean"));
    EXPECT_THAT(section.html, HasSubstr("Coverage of 4 flights is coarse: each counts for 25 percent."));
}

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
    EXPECT_THAT(section->html, HasSubstr("best endurance: below the range flown"));
    EXPECT_THAT(section->html, HasSubstr("level legs of 2 min"));
    EXPECT_THAT(section->html, HasSubstr("kept"));
    ASSERT_EQ(section->figures.size(), 1u);
    EXPECT_THAT(section->figures.front().description, HasSubstr("160 bins of 4 flights"));
    EXPECT_THAT(section->figures.front().description, HasSubstr("best range: "));
    EXPECT_EQ(section->figures.front().spec["layer"].size(), 10u);
}

TEST(PhysicalSection, KeepsItsTables) {
    const auto latex = physical_section(measured_motions(4)).value().latex;
    EXPECT_THAT(latex, HasSubstr("\\label{tab:physical}"));
    EXPECT_THAT(latex, HasSubstr("\\label{tab:physical-terms}"));
    EXPECT_FALSE(physical_section({}));
}

TEST(PhysicalSection, PromisesNoIntervalFromASingleFlight) {
    const auto section = physical_section(measured_motions(1));
    ASSERT_TRUE(section.has_value());
    EXPECT_THAT(section->html, HasSubstr("without a bound"));
}

TEST(PhysicalSection, IsAbsentWhereNoMotionWasMeasured) {
    EXPECT_FALSE(physical_section({}).has_value());
    EXPECT_FALSE(physical_section(std::vector<mechanical::MeasuredFlight>(2)).has_value());
}

}  // namespace
}  // namespace flightwatt::report
