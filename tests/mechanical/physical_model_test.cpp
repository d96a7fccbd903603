#include "mechanical/physical_model.h"

#include "helpers/generated_motion.h"

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

PhysicalModel some_model() {
    auto model = test::drag_and_climb_model();
    model.covariance = {{1e-8, 2e-5}, {2e-5, 0.25}};
    model.level_sd = 0.05;
    return model;
}

TEST(PhysicalModel, SumsItsTerms) {
    const auto model = some_model();
    EXPECT_DOUBLE_EQ(power_w(model, {.airspeed_m_per_s = 10.0}), 10.0);
    EXPECT_DOUBLE_EQ(power_w(model, {.airspeed_m_per_s = 10.0, .climb_m_per_s = 2.0}), 34.0);
    EXPECT_DOUBLE_EQ(power_w(model, {.airspeed_m_per_s = 20.0, .climb_m_per_s = -1.0}), 68.0);
}

TEST(PhysicalModel, NeverTakesPowerBack) {
    const FlightState dive{.airspeed_m_per_s = 10.0, .climb_m_per_s = -5.0};
    EXPECT_EQ(power_w(some_model(), dive), 0.0);
    EXPECT_DOUBLE_EQ(sum_of_terms_w(some_model(), term_values(dive)), -50.0);
}

TEST(PhysicalModel, HasTheTermsOfPhysics) {
    const auto values = term_values({.airspeed_m_per_s = 20.0, .climb_m_per_s = -3.0, .load_factor = 2.0});
    EXPECT_DOUBLE_EQ(values[PowerTerm::drag], 8000.0);
    EXPECT_DOUBLE_EQ(values[PowerTerm::induced], 0.05);
    EXPECT_DOUBLE_EQ(values[PowerTerm::turn], 0.15);
    EXPECT_DOUBLE_EQ(values[PowerTerm::climb], -3.0);
    EXPECT_DOUBLE_EQ(values[PowerTerm::descent], -3.0);
    EXPECT_DOUBLE_EQ(values[PowerTerm::constant], 1.0);
    EXPECT_DOUBLE_EQ(term_values({.airspeed_m_per_s = 20.0, .climb_m_per_s = 3.0})[PowerTerm::descent], 0.0);
}

TEST(PhysicalModel, HasAPowerInHover) {
    const auto hover = term_values({.airspeed_m_per_s = 0.0}, {0.5, RotorLoading{2.0, 0.4}});
    EXPECT_DOUBLE_EQ(hover[PowerTerm::drag], 0.0);
    EXPECT_DOUBLE_EQ(hover[PowerTerm::induced], 1.0) << "of a wing at 1 m/s: it does not carry";
    EXPECT_DOUBLE_EQ(hover[PowerTerm::hover], induced_power_w({0.5, RotorLoading{2.0, 0.4}}, 0.0));
    EXPECT_DOUBLE_EQ(term_values({.airspeed_m_per_s = 1.0})[PowerTerm::induced], 1.0);
}

TEST(PhysicalModel, RefusesAMotionThatIsNone) {
    EXPECT_THROW(term_values({.airspeed_m_per_s = -1.0}), std::invalid_argument);
    EXPECT_THROW(term_values({.airspeed_m_per_s = std::nan("")}), std::invalid_argument);
    EXPECT_THROW(term_values({.airspeed_m_per_s = 10.0, .climb_m_per_s = 0.0, .load_factor = -1.0}),
                 std::invalid_argument);
}

TEST(PhysicalModel, NamesEachTermOnce) {
    std::set<std::string> names;
    for (const auto term : all_power_terms) {
        names.insert(std::string(to_string(term)));
        EXPECT_EQ(power_term_from(to_string(term)), term);
        EXPECT_FALSE(unit_of(term).empty());
    }
    EXPECT_EQ(names.size(), power_term_count);
    EXPECT_FALSE(power_term_from("lift").has_value());
}

TEST(PhysicalModel, AddsTheCausesOfItsUncertainty) {
    const auto values = term_values({.airspeed_m_per_s = 10.0, .climb_m_per_s = 1.0});  // 22 W
    const auto of = predicted_power(some_model(), values, 6000.0);
    EXPECT_NEAR(of.mean_w, 22.0, 1e-9);
    const double level_w2 = std::pow(0.05 * 22.0, 2);
    const double coefficients_w2 = 1e6 * 1e-8 + 2.0 * 1000.0 * 2e-5 + 0.25;
    // 100 correlation times: 2 sd^2 / 100, less a hundredth of that.
    const double drift_w2 = 2.0 * 9.0 / 100.0 * 0.99;
    EXPECT_NEAR(of.sd_w.value(), std::sqrt(level_w2 + coefficients_w2 + drift_w2), 1e-6);
    EXPECT_GT(of.degrees_of_freedom, 4.0);
    EXPECT_LT(of.degrees_of_freedom, 10.0);
    EXPECT_GT(predicted_power(some_model(), values, 60.0).sd_w, of.sd_w);
    const DriftProcess drift{some_model().drift_sd_w, some_model().correlation_s};
    EXPECT_DOUBLE_EQ(drift_variance_w2(some_model(), 15.0), 2.0 * variance_of_mean_w2(drift, 15.0)) << "half a bin";
    auto single = some_model();
    single.level_sd.reset();
    EXPECT_FALSE(predicted_power(single, values, 600.0).sd_w.has_value());
}

TEST(PhysicalModel, KnowsWhatWasFlown) {
    EXPECT_TRUE(is_within_flown_range(some_model(), {.airspeed_m_per_s = 12.0, .climb_m_per_s = 1.0}));
    EXPECT_FALSE(is_within_flown_range(some_model(), {.airspeed_m_per_s = 9.0}));
    EXPECT_FALSE(is_within_flown_range(some_model(), {.airspeed_m_per_s = 12.0, .climb_m_per_s = 4.0}));
}

TEST(PhysicalModel, PredictsNoMotionFarFromWhatWasFlown) {
    const auto model = some_model();  // 10 to 20 m/s
    EXPECT_TRUE(may_predict_power(model, {.airspeed_m_per_s = 12.0, .climb_m_per_s = 1.0}, false));
    const double high = model.airspeed_m_per_s.high;
    EXPECT_TRUE(may_predict_power(model, {.airspeed_m_per_s = 1.25 * high}, false)) << "1.95 times the power";
    EXPECT_FALSE(may_predict_power(model, {.airspeed_m_per_s = 1.27 * high}, false)) << "2.05 times the power";
    EXPECT_FALSE(may_predict_power(model, {.airspeed_m_per_s = 300.0}, false));
    EXPECT_FALSE(may_predict_power(model, {.airspeed_m_per_s = 0.1}, false));
    EXPECT_FALSE(may_predict_power(model, {.airspeed_m_per_s = 12.0, .climb_m_per_s = -20.0}, false));
    EXPECT_FALSE(may_predict_power(model, {.airspeed_m_per_s = 12.0, .climb_m_per_s = 20.0}, false));
}

/// Lift n times the weight takes n^2 times the induced drag.
TEST(PhysicalModel, TurnsTakeInducedDragWhereTheyHaveNoTerm) {
    PhysicalModel model;
    model.terms = {PowerTerm::drag, PowerTerm::induced};
    model.coefficients[PowerTerm::drag] = 0.01;
    model.coefficients[PowerTerm::induced] = 90.0;
    model.covariance = {{1e-8, 2e-6}, {2e-6, 4.0}};
    auto turning = model;
    add_turns_of_induced_drag(turning);
    EXPECT_DOUBLE_EQ(power_w(turning, {15.0, 0.0, 1.0}), power_w(model, {15.0}));
    EXPECT_NEAR(power_w(turning, {15.0, 0.0, 1.4}), 0.01 * 3375.0 + 1.4 * 1.4 * 90.0 / 15.0, 1e-9);
    const double square = 1.4 * 1.4 / 15.0;
    EXPECT_NEAR(coefficient_variance_w2(turning, term_values({15.0, 0.0, 1.4})),
                1e-8 * 3375.0 * 3375.0 + 2.0 * 2e-6 * 3375.0 * square + 4.0 * square * square, 1e-9);
    add_turns_of_induced_drag(turning);
    EXPECT_EQ(turning.terms.size(), 3U);
    PhysicalModel drag_alone;
    drag_alone.terms = {PowerTerm::drag};
    add_turns_of_induced_drag(drag_alone);
    EXPECT_EQ(drag_alone.terms.size(), 1U);
}

}  // namespace
}  // namespace flightwatt::mechanical
