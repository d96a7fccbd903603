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
    EXPECT_THAT(table_text(small, "folder.csv/t.tex"), HasSubstr("\\begin{tabular}"));
}

TEST(TableText, RefusesAnotherEnding) {
    EXPECT_THROW(table_text(small, "t.pdf"), UsageError);
    EXPECT_THROW(table_text(small, "csv"), UsageError);
}

TEST(TableOf, StandsBesideAPublishedModelWhereThereIsOne) {
    const auto model = test::published_model();
    const auto alone = table_of(model, std::nullopt);
    const auto beside = table_of(model, model);
    EXPECT_EQ(alone.header.size(), 4U) << "a name and three phases";
    EXPECT_EQ(beside.header.size(), 7U);
    EXPECT_GT(beside.rows.size(), alone.rows.size()) << "durations and differences stand below";
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

nlohmann::ordered_json json_of_phases() {
    nlohmann::ordered_json json;
    for (const auto phase : flight::all_phases) json["phases"][std::string(to_string(phase))] = {};
    return json;
}

TEST(AddErrorsJson, PutsIntervalsAboutTheEstimates) {
    auto fit = fit_model(recorded_flights());
    analyse_model(fit);
    auto json = json_of_phases();
    add_errors_json(json, fit.model);
    const auto& cruise = fit.model.phases[flight::Phase::cruise];
    const auto& entry = json["phases"]["cruise"];
    EXPECT_EQ(entry["errors"]["standard_error"]["a0_w"], cruise.errors->a0_w);
    const double low = entry["errors"]["interval_95"]["a0_w"]["low"];
    const double high = entry["errors"]["interval_95"]["a0_w"]["high"];
    EXPECT_LT(low, cruise.fourier.a0_w);
    EXPECT_GT(high, cruise.fourier.a0_w);
    EXPECT_GT(high - low, 2.0 * 1.8 * cruise.errors->a0_w) << "a 95 % interval";
    EXPECT_EQ(entry["spread"]["counted_flights"], cruise.spread->effective_flights);
}

}  // namespace
}  // namespace flightwatt::cli
