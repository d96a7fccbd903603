#include "mechanical/model_check.h"

#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

MechanicalModel published() {
    return read_mechanical_model(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml");
}

TEST(ModelCheck, SaysNothingOfThePublishedModel) { EXPECT_THAT(model_warnings(published()), IsEmpty()); }

TEST(ModelCheck, TellsWhereACurveFallsBelowZero) {
    auto model = published();
    auto& landing = model.phases[flight::Phase::landing];
    landing.duration_s = 40.0;
    landing.fourier = {0.157, 3.0, {5.0}, {0.0}};  // from 8 W to -2 W and back
    EXPECT_THAT(
        model_warnings(model),
        ElementsAre(HasSubstr("landing: the curve falls to -2 W (20.0 s after the phase began), below 0 for 11")));
    landing.fourier = {0.157, -27.84, {}, {}};
    EXPECT_THAT(model_warnings(model), ElementsAre(HasSubstr("below 0 for 40.0 of 40.0 s")));
}

TEST(ModelCheck, TellsWhereErrorsAreNoMoreThanABound) {
    auto model = published();
    auto& errors = model.phases[flight::Phase::takeoff].errors.emplace();
    EXPECT_THAT(model_warnings(model), IsEmpty());
    errors.noise_lasts = true;
    EXPECT_THAT(model_warnings(model), ElementsAre(HasSubstr("takeoff: the noise of neighbouring samples")));
}

TEST(ModelCheck, TellsWhatWasDoneToTheCurve) {
    auto model = published();
    auto& landing = model.phases[flight::Phase::landing];
    landing.edge_samples = 2;
    landing.mean_curve = true;
    landing.not_negative = true;
    EXPECT_THAT(model_warnings(model), IsEmpty());
    EXPECT_THAT(fit_notes(model), ElementsAre(HasSubstr("landing: 2 samples were left out at its ends"),
                                              HasSubstr("landing: the samples leave the frequency open"),
                                              HasSubstr("landing: the curve would fall below 0 W")));
}

}  // namespace
}  // namespace flightwatt::mechanical
