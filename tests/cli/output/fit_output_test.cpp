// Tables and JSON of a fit.

#include "cli/output/fit_output.h"

#include "base/error.h"
#include "helpers/made_up_flights.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;

const TextTable small{{"name", "a0"}, {{"cruise", "24.5"}}};

TEST(TableText, FollowsTheEndingOfTheFile) {
    EXPECT_EQ(table_text(small, "t.csv"), "name,a0\ncruise,24.5\n");
    EXPECT_EQ(table_text(small, "t.txt"), "name      a0\ncruise  24.5\n");
    EXPECT_THAT(table_text(small, "t.md"), HasSubstr("| cruise | 24.5 |"));
    EXPECT_THAT(table_text(small, "folder.csv/t.tex"), HasSubstr("\\label{tab:t}"));
    EXPECT_THAT(table_text(small, "c.tex", "Constants"), HasSubstr("\\caption{Constants}\n\\label{tab:c}"));
}

TEST(TableText, RefusesAnotherEnding) {
    EXPECT_THROW(table_text(small, "t.pdf"), UsageError);
    EXPECT_THROW(table_text(small, "csv"), UsageError);
}

TEST(TableOf, StandsBesideAPublishedModelWhereThereIsOne) {
    const auto model = test::published_model();
    const auto alone = model_table(model, std::nullopt);
    const auto compared = model_table(model, model);
    EXPECT_EQ(alone.header.size(), 5U) << "a name, three phases and the unit";
    EXPECT_EQ(compared.header.size(), 8U);
    EXPECT_GT(compared.rows.size(), alone.rows.size()) << "durations and differences are below";
}

std::vector<mechanical::FlightSamples> recorded_flights() {
    std::vector<mechanical::FlightSamples> flights(3);
    for (const auto phase : flight::all_phases) {
        const auto samples = test::record_flights(phase, flights.size(), 0.5, 1);
        for (std::size_t i = 0; i < flights.size(); ++i) {
            flights[i].flight = samples[i].flight;
            flights[i].phases[phase] = samples[i];
        }
    }
    return flights;
}

TEST(FitJson, HasIntervalsAboutTheEstimates) {
    auto fit = fit_model(recorded_flights());
    analyse_model(fit);
    const auto json = record_json(FitOutput{&fit.model, nullptr, true});
    const auto& cruise = fit.model.phases[flight::Phase::cruise];
    const auto& entry = json["phases"]["cruise"];
    const double low = entry["a0_w_interval_95"]["low"];
    const double high = entry["a0_w_interval_95"]["high"];
    EXPECT_LT(low, cruise.fourier.a0_w);
    EXPECT_GT(high, cruise.fourier.a0_w);
    EXPECT_GT(high - low, 2.0 * 1.8 * cruise.errors->a0_w) << "a 95 % interval";
    EXPECT_FALSE(record_json(FitOutput{&fit.model})["phases"]["cruise"].contains("a0_w_interval_95"));
}

}  // namespace
}  // namespace flightwatt::cli
