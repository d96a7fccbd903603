#include "report/document/model_document.h"

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

TEST(ModelDocument, HasCurvesAndTable) {
    ReportModel model{test::published_model(), "Read from a file."};
    const auto without = model_json(model);
    EXPECT_EQ(without["origin"], "Read from a file.");
    ASSERT_EQ(without["curves"].size(), 3U);
    EXPECT_EQ(without["curves"][0]["phase"], "takeoff");
    EXPECT_EQ(without["curves"][0]["time_s"].size(), without["curves"][0]["power_w"].size());
    EXPECT_TRUE(without["curves"][0]["band"].is_null()) << "its errors are not known";
    EXPECT_TRUE(without["table_one"].is_null());
    EXPECT_EQ(without["name"], model.model.name);
    model.table_one = table_one(model.model);
    const auto with = model_json(model);
    EXPECT_FALSE(with["table_one"]["rows"].empty());
    EXPECT_THAT(with["table_text"].get<std::string>(), Not(HasSubstr("the 95 % intervals")));
}

TEST(ValidationDocument, HasScoresAndErrorsAndWarnsOfFewFlights) {
    LatexTables tables;
    const auto json = validation_json(mechanical::leave_one_out(test::generated(4, 7)), true, tables);
    EXPECT_TRUE(json["scores"]["total"].contains("constant_mean"));
    EXPECT_EQ(json["errors"][0]["flight"].size(), 4U);
    EXPECT_THAT(json["warning"].get<std::string>(), HasSubstr("SYNTHETIC"));
    EXPECT_EQ(json["note"], "Coverage of 4 flights is coarse: each counts for 25 percent.");
    EXPECT_THAT(tables.text, HasSubstr("\\label{tab:validation}"));
}

std::vector<mechanical::MeasuredFlight> measured_motions(std::size_t count) {
    std::vector<mechanical::MeasuredFlight> flights;
    for (auto& motion : test::made_up_motions(count, 40, {}, 1)) {
        flights.emplace_back();
        flights.back().motion = std::move(motion);
    }
    return flights;
}

TEST(PhysicalDocument, HasConstantsTrialsAndCurves) {
    LatexTables tables;
    const auto json = physical_json(measured_motions(4), tables);
    EXPECT_EQ(json["fit"]["bins"], 160);
    EXPECT_THAT(json["fit"]["terms"].dump(), HasSubstr("W s^3/m^3"));
    EXPECT_THAT(json["speeds"].dump(), HasSubstr("best endurance: below the range flown"));
    EXPECT_THAT(json["speeds"].dump(), HasSubstr("level legs of 2 min"));
    EXPECT_EQ(json["level"].size(), 2U) << "flown, and slower";
    EXPECT_EQ(json["bins"].size(), 4U);
    EXPECT_EQ(json["bins"][0]["level_power_w"].size(), 40U);
    EXPECT_EQ(json["best"].size(), 2U);
    EXPECT_THAT(tables.text, HasSubstr("\\label{tab:physical}"));
    EXPECT_THAT(tables.text, HasSubstr("\\label{tab:physical-terms}"));
}

TEST(PhysicalDocument, HasNoIntervalFromASingleFlight) {
    LatexTables tables;
    EXPECT_THAT(physical_json(measured_motions(1), tables)["speeds"].dump(), HasSubstr("without a bound"));
}

TEST(PhysicalDocument, IsAbsentWhereNoMotionWasMeasured) {
    LatexTables tables;
    EXPECT_TRUE(physical_json({}, tables).is_null());
    EXPECT_TRUE(physical_json(std::vector<mechanical::MeasuredFlight>(2), tables).is_null());
    EXPECT_EQ(tables.text, "");
}

}  // namespace
}  // namespace flightwatt::report
