#include "helpers/generated_motion.h"
#include "helpers/made_up_flights.h"
#include "helpers/rejected.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/physical_fit.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

MechanicalModel read_text(const std::string& text) {
    return read_mechanical_model(test::write_text(test::scratch_dir() / "model.toml", text));
}

std::string text_with(const PhysicalModel& physical) {
    auto model = test::published_model();
    model.physical = physical;
    return to_toml(model);
}

std::string some_text() {
    const auto flights = test::made_up_motions(3, 20, {}, 1);
    return text_with(fit_power_terms(flights, {PowerTerm::drag, PowerTerm::climb, PowerTerm::descent}));
}

/// The text with one thing changed.
std::string with(const std::string& found, const std::string& instead) {
    auto text = some_text();
    const auto at = text.find(found);
    EXPECT_NE(at, std::string::npos) << found;
    return text.replace(at, found.size(), instead);
}

void expect_rejected(const std::string& text, const std::string& because) {
    const auto printed = test::rejected([&] { read_text(text); }, test::scratch_dir());
    EXPECT_THAT(printed, testing::HasSubstr(because));
    EXPECT_THAT(printed, testing::StartsWith("model.toml:"));
}

TEST(PhysicalToml, KeepsTheTermsOfTheSpeedToFly) {
    const auto model = fit_physical_model(test::made_up_motions(3, 20, {}, 1)).model;
    const auto read = read_text(text_with(model)).physical.value();
    EXPECT_EQ(text_with(read), text_with(model));
    ASSERT_TRUE(read.speed_terms.has_value());
    EXPECT_GT(read.speed_terms->terms.size(), read.terms.size());
    EXPECT_EQ(read.speed_terms->covariance, model.speed_terms->covariance);
    EXPECT_EQ(read.speed_terms->degrees_of_freedom, model.speed_terms->degrees_of_freedom);
}

TEST(PhysicalToml, KeepsTheErrorOfAnEstimatedAirspeed) {
    auto flights = test::made_up_motions(3, 20, {}, 1);
    for (auto& flight : flights) flight.airspeed_sd_m_per_s = 0.5;
    const auto model = fit_power_terms(flights, {PowerTerm::drag, PowerTerm::climb});
    const auto read = read_text(text_with(model)).physical.value();
    EXPECT_EQ(read.airspeed_sd_m_per_s, model.airspeed_sd_m_per_s);
    EXPECT_EQ(read.covariance, model.covariance);
    EXPECT_FALSE(read_text(some_text()).physical->airspeed_sd_m_per_s);
}

TEST(PhysicalToml, LosesNothing) {
    const auto text = some_text();
    const auto read = read_text(text).physical.value();
    EXPECT_EQ(text_with(read), text);
    EXPECT_EQ(read.flights.size(), 3u);
    EXPECT_EQ(read.bins, 60u);
    EXPECT_EQ(read.terms.size(), 3u);
    EXPECT_TRUE(read.level_sd.has_value());
    const auto one = text_with(fit_power_terms(test::made_up_motions(1, 20, {}, 1), {PowerTerm::drag}));
    EXPECT_EQ(to_toml(read_text(one)), one);
    EXPECT_FALSE(read_text(one).physical->level_sd.has_value());
}

TEST(PhysicalToml, RefusesWhatCannotBe) {
    expect_rejected(with("\"climb\"", "\"lift\""), "there is no term 'lift'");
    expect_rejected(with("\"climb\"", "\"drag\""), "given twice");
    expect_rejected(with("bins = 60", "bins = 0"), "bins");
    expect_rejected(with("bins = 60", "bins = 60\nlift = 3"), "lift");
    expect_rejected(with("covariance = [", "covariance = [1.0, "), "expected 3");
    expect_rejected(with("drift = { sd_w = ", "drift = { sd_w = -"), "sd_w");
    expect_rejected(with("level = { sd = ", "level = { sd = -"), "sd");
    expect_rejected(to_toml(test::published_model()) +
                        "[physical]\nflights = []\nbins = 1\nbin_s = 30\nsamples = 3\nmean_airspeed_m_per_s = 1\n"
                        "airspeed_m_per_s = { low = 1, high = 2 }\nclimb_m_per_s = { low = 1, high = 2 }\n"
                        "drift = { sd_w = 1, correlation_s = 1, degrees_of_freedom = 2 }\n",
                    "no terms");
}

TEST(PhysicalToml, RefusesCovariancesThatAreNone) {
    const std::string head = to_toml(test::published_model()) +
                             "[physical]\nflights = []\nbins = 1\nbin_s = 30\nsamples = 3\nmean_airspeed_m_per_s = 1\n"
                             "airspeed_m_per_s = { low = 1, high = 2 }\nclimb_m_per_s = { low = 1, high = 2 }\n"
                             "drift = { sd_w = 1, correlation_s = 1, degrees_of_freedom = 2 }\n";
    const auto terms = [&](const std::string& first, const std::string& second) {
        return head + "[[physical.terms]]\nterm = \"drag\"\ncoefficient = 1\ncovariance = " + first +
               "\n[[physical.terms]]\nterm = \"climb\"\ncoefficient = 1\ncovariance = " + second + "\n";
    };
    EXPECT_EQ(read_text(terms("[1, 0.5]", "[0.5, 1]")).physical->terms.size(), 2u);
    expect_rejected(terms("[1, 0.5]", "[0.4, 1]"), "symmetric");
    expect_rejected(terms("[-1, 0.5]", "[0.5, 1]"), "variance of drag");
}

}  // namespace
}  // namespace flightwatt::mechanical
