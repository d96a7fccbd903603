#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/made_up_flights.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"
#include "mechanical/mechanical_model.h"

#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using testing::HasSubstr;

constexpr std::string_view sound_text = R"(name = "made up"
[takeoff]
duration_s = 28.0
omega_rad_per_s = 0.15
a0_w = 30.0
cos_w = [1.0, 2.0]
sin_w = [3.0, 4.0]
[cruise]
duration_s = 600.0
omega_rad_per_s = 0.01
a0_w = 27.0
cos_w = []
sin_w = []
[landing]
duration_s = 60.0
omega_rad_per_s = 0.06
a0_w = 26.0
cos_w = [1.0]
sin_w = [-1.0]
samples = 12
omega_duration = { low_rad = 3.0, high_rad = 30.0, at_bound = "none" }
[[flights]]
flight = "one"
landing = { weight = 1.0, duration_s = 60.0, rms_w = 0.5, samples = 12 }
)";

std::filesystem::path written(std::string_view text) {
    auto path = test::scratch_dir() / "model.toml";
    write_file_atomically(path, text);
    return path;
}

/// Reads sound_text with one part replaced, and states what the reader states.
InputError refusal_of(std::string_view part, std::string_view replacement) {
    std::string text(sound_text);
    const auto place = text.find(part);
    EXPECT_NE(place, std::string::npos) << part;
    text.replace(place, part.size(), replacement);
    const auto path = written(text);
    try {
        read_mechanical_model(path);
    } catch (const InputError& error) {
        EXPECT_EQ(error.where().file, path.string());
        EXPECT_GT(error.where().column, 0U);
        return error;
    }
    ADD_FAILURE() << "read without complaint: " << replacement;
    return InputError({}, "");
}

void expect_equal(const FourierModel& a, const FourierModel& b) {
    EXPECT_EQ(a.omega_rad_per_s, b.omega_rad_per_s);
    EXPECT_EQ(a.a0_w, b.a0_w);
    EXPECT_EQ(a.cos_w, b.cos_w);
    EXPECT_EQ(a.sin_w, b.sin_w);
}

MechanicalModel made_up_model() {
    auto model = test::published_model();
    model.name = "quoted \"name\"";
    model.description = "one line\nand another";
    model.weighting = "agreement";
    model.phases[flight::Phase::cruise].rms_w = 0.1 + 0.2;  // a number that needs all its digits
    model.phases[flight::Phase::cruise].range = FrequencyRange{3.0, 40.0};
    model.phases[flight::Phase::cruise].samples = 545;
    model.phases[flight::Phase::cruise].flights = 2;
    model.phases[flight::Phase::takeoff].heights = PhaseHeights{50.0, 30.0, 70.0, 2.5};
    model.flights = {{"first", {}}, {"second", {}}};
    model.flights[0].phases[flight::Phase::cruise] = PhaseContribution{0.25, 580.0, 0.5, 300};
    model.flights[1].phases[flight::Phase::cruise] = PhaseContribution{0.75, 610.0, 1.0 / 3.0, 245, 25.0 / 3.0};
    return model;
}

TEST(MechanicalModelToml, ReadsBackWhatItWrote) {
    const auto model = made_up_model();
    const auto text = to_toml(model);
    const auto again = read_mechanical_model(written(text));
    EXPECT_EQ(again.name, model.name);
    EXPECT_EQ(again.description, model.description);
    EXPECT_EQ(again.weighting, model.weighting);
    for (const auto phase : flight::all_phases) {
        expect_equal(again.phases[phase].fourier, model.phases[phase].fourier);
        EXPECT_EQ(again.phases[phase].duration_s, model.phases[phase].duration_s);
        EXPECT_EQ(again.phases[phase].rms_w, model.phases[phase].rms_w);
    }
    const auto& cruise = again.phases[flight::Phase::cruise];
    EXPECT_EQ(cruise.samples, 545U);
    EXPECT_EQ(cruise.flights, 2U);
    ASSERT_TRUE(cruise.range);
    EXPECT_EQ(cruise.range->high_rad, 40.0);
    EXPECT_FALSE(again.phases[flight::Phase::takeoff].range);
    EXPECT_FALSE(cruise.heights);
    const auto& takeoff = again.phases[flight::Phase::takeoff];
    EXPECT_NEAR(duration_at_height_s(takeoff, 100.0), takeoff.duration_s + 20.0, 1e-9);
    EXPECT_NEAR(duration_at_height_s(takeoff, 10.0), takeoff.duration_s - 8.0, 1e-9) << "that of 30 m";
    ASSERT_EQ(again.flights.size(), 2U);
    EXPECT_EQ(again.flights[1].flight, "second");
    EXPECT_FALSE(again.flights[1].phases[flight::Phase::takeoff]);
    EXPECT_FALSE(again.flights[0].phases[flight::Phase::cruise]->mean_power_w);
    EXPECT_EQ(again.flights[1].phases[flight::Phase::cruise]->mean_power_w, 25.0 / 3.0);
    EXPECT_EQ(again.flights[1].phases[flight::Phase::cruise]->rms_w, 1.0 / 3.0);
    EXPECT_EQ(to_toml(again), text);
}

TEST(MechanicalModelToml, ReadsBackItsValidation) {
    auto model = made_up_model();
    for (const std::string name : {"fourier", "constant_mean", "by_phase"}) {
        model.phases[flight::Phase::landing].power = {PowerBasis::mean, "of one flight"};
        model.validation = {name, {{"constant_mean", 4, 55.9 / 3.0}, {"physical", 3, 2.7}}};
        const auto text = to_toml(model);
        const auto again = read_mechanical_model(written(text));
        ASSERT_TRUE(again.validation);
        EXPECT_EQ(again.validation->default_model, name);
        EXPECT_EQ(again.phases[flight::Phase::landing].power.by, PowerBasis::mean);
        EXPECT_EQ(again.phases[flight::Phase::landing].power.reason, "of one flight");
        EXPECT_EQ(again.phases[flight::Phase::cruise].power.by, PowerBasis::curve);
        ASSERT_EQ(again.validation->scores.size(), 2U);
        EXPECT_EQ(again.validation->scores[0].mean_absolute_error_percent, 55.9 / 3.0);
        EXPECT_EQ(again.validation->scores[1].model, "physical");
        EXPECT_EQ(again.validation->scores[1].flights, 3U);
        EXPECT_EQ(to_toml(again), text);
    }
    EXPECT_FALSE(read_mechanical_model(written(sound_text)).validation) << "files of fit and of earlier versions";
    const auto unknown = refusal_of("[[flights]]", "[validation]\ndefault_model = \"best\"\n[[flights]]");
    EXPECT_THAT(unknown.what(), HasSubstr("default_model = 'best', expected fourier, constant_mean or by_phase"));
}

TEST(MechanicalModelToml, ReadsTheDecisionOfEarlierVersionsOnAllPhasesTogether) {
    auto model = made_up_model();
    for (const auto& [name, basis] : {std::pair{"fourier", PowerBasis::curve}, {"constant_mean", PowerBasis::mean}}) {
        model.validation = {name, {}};
        const auto again = read_mechanical_model(written(to_toml(model)));
        for (const auto phase : flight::all_phases) EXPECT_EQ(again.phases[phase].power.by, basis) << name;
    }
}

TEST(MechanicalModelToml, PredictsByNoCurveThatItsFlightsDoNotDetermine) {
    auto model = made_up_model();
    const auto read_with = [&](double mean_power_w) {
        for (auto& flight : model.flights)
            for (auto& part : flight.phases.values)
                if (part) part->mean_power_w = mean_power_w;
        return test::rejected([&] { read_predicting_model(written(to_toml(model))); });
    };
    const double cruise_w = model.phases[flight::Phase::cruise].fourier.a0_w;
    model.phases[flight::Phase::cruise].fourier = {0.01, 100.0 * cruise_w, {}, {}};
    EXPECT_THAT(read_with(cruise_w), HasSubstr("[cruise]: its curve has a mean of"));
    model.phases[flight::Phase::cruise].power = {PowerBasis::mean, "made up"};
    EXPECT_THAT(read_with(cruise_w), testing::Not(HasSubstr("[cruise]")));
}

TEST(MechanicalModelToml, ReadsASoundFile) {
    const auto model = read_mechanical_model(written(sound_text));
    EXPECT_EQ(model.phases[flight::Phase::takeoff].fourier.sin_w, (std::vector<double>{3.0, 4.0}));
    EXPECT_EQ(model.phases[flight::Phase::landing].samples, 12U);
}

TEST(MechanicalModelToml, RefusesAMissingKeyAndNamesTheNearestThatIsThere) {
    const auto missing = refusal_of("duration_s = 600.0\n", "");
    EXPECT_EQ(missing.where().line, 8U);
    EXPECT_THAT(missing.what(), HasSubstr("has no key 'duration_s'"));
    const auto misspelt = refusal_of("a0_w = 27.0", "a0_kw = 27.0");
    EXPECT_EQ(misspelt.where().line, 11U);
    EXPECT_THAT(misspelt.what(), HasSubstr("has no key 'a0_w'"));
    EXPECT_THAT(misspelt.hint(), HasSubstr("a0_kw"));
    EXPECT_THAT(refusal_of("[landing]", "[landings]").what(), HasSubstr("has no key 'landing'"));
}

TEST(MechanicalModelToml, RefusesAnUnknownKey) {
    const auto unknown = refusal_of("samples = 12\n", "samples = 12\nrms_kw = 0.1\n");
    EXPECT_EQ(unknown.where().line, 21U);
    EXPECT_THAT(unknown.what(), HasSubstr("unknown key 'rms_kw'"));
    EXPECT_THAT(unknown.hint(), HasSubstr("rms_w"));
}

TEST(MechanicalModelToml, RefusesUnequalCoefficients) {
    const auto unequal = refusal_of("sin_w = [3.0, 4.0]", "sin_w = [3.0, 4.0, 5.0]");
    EXPECT_EQ(unequal.where().line, 7U);
    EXPECT_THAT(unequal.what(), HasSubstr("sin_w has 3 coefficients and cos_w 2"));
}

TEST(MechanicalModelToml, RefusesNumbersThatMakeNoSense) {
    const auto negative = refusal_of("duration_s = 28.0", "duration_s = -28.0");
    EXPECT_EQ(negative.where().line, 3U);
    EXPECT_THAT(negative.what(), HasSubstr("duration_s = -28, expected more than 0"));
    EXPECT_THAT(refusal_of("omega_rad_per_s = 0.01", "omega_rad_per_s = 0.0").what(),
                HasSubstr("expected more than 0"));
    EXPECT_THAT(refusal_of("a0_w = 27.0", "a0_w = nan").what(), HasSubstr("expected a finite number"));
    EXPECT_THAT(refusal_of("a0_w = 27.0", "a0_w = \"27\"").what(), HasSubstr("expected a finite number"));
    EXPECT_THAT(refusal_of("samples = 12\n", "samples = 12.5\n").what(), HasSubstr("expected a whole number"));
    EXPECT_THAT(refusal_of("samples = 12\n", "samples = -12\n").what(),
                HasSubstr("samples = -12, expected a whole number, 0 or more"));
    EXPECT_THAT(refusal_of("weight = 1.0", "weight = 1.5").what(), HasSubstr("weight = 1.5, expected 0 to 1"));
    EXPECT_THAT(refusal_of("rms_w = 0.5", "rms_w = -0.5").what(), HasSubstr("rms_w = -0.5, expected 0 or more"));
    EXPECT_THAT(refusal_of("high_rad = 30.0", "high_rad = 2.0").what(), HasSubstr("high_rad = 2, expected 3 or more"));
}

TEST(MechanicalModelToml, RefusesANewerFormat) {
    EXPECT_THAT(to_toml(made_up_model()), HasSubstr("\nformat = 1\n"));
    EXPECT_EQ(refusal_of("name = ", "format = 2\nname = ").where().line, 1U);
}

TEST(MechanicalModelToml, RefusesAFileThatIsNotThere) {
    EXPECT_THROW(read_mechanical_model(test::scratch_dir() / "absent.toml"), InputError);
}

}  // namespace
}  // namespace flightwatt::mechanical
