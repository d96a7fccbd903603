#include "mechanical/covariates.h"

#include "flight/segmentation.h"
#include "flight/selected_track.h"
#include "helpers/sample_columns.h"

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

TEST(CovariatesOf, TakesWhatWasKnownBeforeTheCruiseAndEarlyInIt) {
    test::SampleColumns series;
    for (int i = 0; i < 300; ++i) {
        series.time_s.push_back(i);
        series.voltage_v.push_back(i < 100 ? 12.5 : 11.0);
        series.throttle_percent.push_back(i < 100 ? 0.0 : 70.0);
        series.wind_speed_m_per_s.push_back(i <= 130 + 60 ? 3.0 : 9.0);
    }
    flight::Sortie sortie;
    sortie.height_m = 85.0;
    sortie.phases.resize(2);
    sortie.phases[0].phase = flight::Phase::takeoff;
    sortie.phases[0].start.time_s = 100.0;
    sortie.phases[1].phase = flight::Phase::cruise;
    sortie.phases[1].start.time_s = 130.0;
    const auto flown = test::series_of(series);
    const auto covariates = covariates_of(flight::SelectedTracks(flown), sortie);
    EXPECT_EQ(covariates[Covariate::height], 85.0);
    EXPECT_EQ(covariates[Covariate::initial_voltage], 12.5);
    EXPECT_EQ(covariates[Covariate::wind], 3.0);
    EXPECT_FALSE(covariates[Covariate::airspeed]);
}

TEST(Covariate, IsFoundByItsName) {
    for (const auto covariate : all_covariates) EXPECT_EQ(covariate_from(to_string(covariate)), covariate);
    EXPECT_FALSE(covariate_from("height"));
}

}  // namespace
}  // namespace flightwatt::mechanical
