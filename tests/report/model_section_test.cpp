// The sections of a model and of its validation.

#include "report/model_section.h"

#include "helpers/generated_flights.h"
#include "mechanical/table_one.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(ModelSection, ShowsCurvesAndTable) {
    ReportModel model{test::published_model(), "Read from a file."};
    const auto without = model_section(model, {}, "model");
    ASSERT_EQ(without.figures.size(), 1U);
    EXPECT_EQ(without.figures[0].id, "model-curves");
    EXPECT_THAT(without.html, HasSubstr("Read from a file."));
    EXPECT_THAT(without.html, Not(HasSubstr("<h3>Table I</h3>")));
    model.table_one = table_one(model.model);
    const auto with = model_section(model, {}, "model");
    EXPECT_THAT(with.html, HasSubstr("<h3>Table I</h3>"));
    EXPECT_THAT(with.html, Not(HasSubstr("the 95 % intervals"))) << "its errors are not known";
}

TEST(ValidationSection, ShowsScoresAndWarnsOfFewFlights) {
    const auto section = validation_section(mechanical::leave_one_out(test::generated(4, 7)));
    ASSERT_EQ(section.figures.size(), 1U);
    EXPECT_EQ(section.figures[0].id, "validation-errors");
    EXPECT_THAT(section.html, HasSubstr("constant_mean"));
    EXPECT_THAT(section.html, HasSubstr("Coverage over 4 flights means little: each counts for 25 points."));
}

}  // namespace
}  // namespace flightwatt::report
