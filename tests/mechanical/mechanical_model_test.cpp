#include "mechanical/mechanical_model.h"

#include "base/csv.h"
#include "helpers/made_up_flights.h"
#include "helpers/test_paths.h"

#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

/// The paper's figure, digitised: RMS difference to the model's curve [W].
double rms_from_figure_w(const FourierModel& model, const std::string& file) {
    const auto table = read_csv(test::shared_dir() / "paper" / file);
    const auto time = column_index(table, "time_s");
    const auto power = column_index(table, "power_w");
    double sum = 0.0;
    for (const auto& row : table.rows) {
        sum += std::pow(power_w(model, cell_number(table, row, time)) - cell_number(table, row, power), 2);
    }
    return std::sqrt(sum / static_cast<double>(table.rows.size()));
}

TEST(MechanicalModel, IsTheSeriesOfEquationOne) {
    const FourierModel model{0.5, 10.0, {1.0, 2.0}, {3.0, 4.0}};
    const double expected = 10.0 + std::cos(1.0) + 3.0 * std::sin(1.0) + 2.0 * std::cos(2.0) + 4.0 * std::sin(2.0);
    EXPECT_DOUBLE_EQ(power_w(model, 2.0), expected);
    EXPECT_DOUBLE_EQ(power_w(model, 0.0), 13.0);
}

TEST(MechanicalModel, TableOneIsTheCurveOfFigureTwo) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto model = test::published_model();
    EXPECT_LT(rms_from_figure_w(model.phases[flight::Phase::takeoff].fourier, "fig2_takeoff.csv"), 0.03);
    EXPECT_LT(rms_from_figure_w(model.phases[flight::Phase::cruise].fourier, "fig2_cruise.csv"), 0.03);
    EXPECT_LT(rms_from_figure_w(model.phases[flight::Phase::landing].fourier, "fig2_landing.csv"), 0.03);
}

TEST(MechanicalModel, EnergyIsTheIntegralOfPower) {
    const auto published = test::published_model();
    for (const auto phase : flight::all_phases) {
        const auto& [fourier, duration_s] =
            std::tie(published.phases[phase].fourier, published.phases[phase].duration_s);
        constexpr int steps = 20000;  // Simpson's rule
        double integral = power_w(fourier, 0.0) + power_w(fourier, duration_s);
        for (int i = 1; i < steps; ++i) integral += (i % 2 == 1 ? 4.0 : 2.0) * power_w(fourier, duration_s * i / steps);
        integral *= duration_s / steps / 3.0;
        EXPECT_NEAR(energy_j(fourier, duration_s), integral, 1e-9 * integral) << to_string(phase);
    }
    EXPECT_DOUBLE_EQ(energy_j(published.phases[flight::Phase::cruise].fourier, 0.0), 0.0);
}

TEST(MechanicalModel, PublishedPhasesTakeTheirKnownEnergies) {
    const auto published = test::published_model();
    const auto energy = [&](flight::Phase phase) {
        return energy_j(published.phases[phase].fourier, published.phases[phase].duration_s);
    };
    // As summed up from the figures: four digits are theirs.
    EXPECT_NEAR(energy(flight::Phase::takeoff), 803.9, 1e-4 * 803.9);
    EXPECT_NEAR(energy(flight::Phase::cruise), 16385.9, 1e-4 * 16385.9);
    EXPECT_NEAR(energy(flight::Phase::landing), 1686.2, 1e-4 * 1686.2);
}

TEST(MechanicalModel, AStretchedPhaseEndsWhereTheModelEnds) {
    const auto phase = test::published_model().phases[flight::Phase::landing];
    const auto longer = time_scaled_model(phase, 2.0 * phase.duration_s, PhaseTimeScaling::scaled);
    EXPECT_NEAR(power_w(longer, 2.0 * phase.duration_s), power_w(phase.fourier, phase.duration_s), 1e-12);
    EXPECT_NEAR(energy_j(longer, 2.0 * phase.duration_s), 2.0 * energy_j(phase.fourier, phase.duration_s), 1e-9);
    const auto absolute = time_scaled_model(phase, 2.0 * phase.duration_s, PhaseTimeScaling::absolute);
    EXPECT_EQ(absolute.omega_rad_per_s, phase.fourier.omega_rad_per_s);
}

TEST(PhaseCurve, IsTheSeriesAtTheMiddlesOfEqualParts) {
    const auto phase = test::published_model().phases[flight::Phase::takeoff];
    const auto curve = curve_w(phase.fourier, phase.duration_s, 7);
    ASSERT_EQ(curve.size(), 7U);
    EXPECT_DOUBLE_EQ(curve[0], power_w(phase.fourier, 2.0));
    EXPECT_DOUBLE_EQ(curve[6], power_w(phase.fourier, 26.0));
}

TEST(PhaseCurve, DifferenceIsThatOfTheCurvesWhateverTheSeconds) {
    const auto phase = test::published_model().phases[flight::Phase::takeoff];
    EXPECT_EQ(rms_difference_w(phase, phase), 0.0);
    auto slower = phase;
    slower.duration_s *= 3.0;
    slower.fourier.omega_rad_per_s /= 3.0;
    EXPECT_NEAR(rms_difference_w(phase, slower), 0.0, 1e-12);
    auto higher = phase;
    higher.fourier.a0_w += 0.25;
    EXPECT_NEAR(rms_difference_w(phase, higher), 0.25, 1e-12);
}

TEST(PhaseCurve, ResolvesTheFastestHarmonic) {
    // 250 periods, the third harmonic only: an RMS of 2 / sqrt 2, and no point for it to hide between.
    auto flat = test::cruise_of(250.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
    auto wave = test::cruise_of(250.0, {0.0, 0.0, 2.0}, {0.0, 0.0, 0.0});
    EXPECT_GE(curve_point_count(wave.fourier, wave.duration_s), 12000U);
    EXPECT_NEAR(rms_difference_w(flat, wave), std::numbers::sqrt2, 1e-9);
}

/// Take-offs of three flights, of which one has no weight, and a cruise without flights.
MechanicalModel decided_model(PowerBasis basis) {
    auto model = test::published_model();
    for (auto& phase : model.phases.values) phase.power = {basis, "made up"};
    model.flights = {{"a", {}}, {"b", {}}, {"c", {}}};
    const std::vector<PhaseContribution> parts{
        {0.75, 28.0, 0.1, 20, 30.0}, {0.25, 29.0, 0.1, 20, 26.0}, {0.0, 27.0, 0.1, 20, 90.0}};
    for (std::size_t i = 0; i < parts.size(); ++i) model.flights[i].phases[flight::Phase::takeoff] = parts[i];
    model.phases[flight::Phase::takeoff].errors.emplace();
    return model;
}

TEST(WithDecidedPower, IsTheMeanPowerOfPhasesWithoutACurve) {
    const auto model = with_decided_power(decided_model(PowerBasis::mean));
    const auto& takeoff = model.phases[flight::Phase::takeoff];
    EXPECT_DOUBLE_EQ(takeoff.fourier.a0_w, 28.0);
    EXPECT_TRUE(takeoff.fourier.cos_w.empty() && takeoff.fourier.sin_w.empty());
    EXPECT_FALSE(takeoff.errors) << "they were the curve's";
    EXPECT_DOUBLE_EQ(energy_j(takeoff.fourier, 10.0), 280.0);
    for (const auto& [flight, weight] : {std::pair(0U, 0.5), std::pair(1U, 0.5), std::pair(2U, 0.0)})
        EXPECT_EQ(model.flights[flight].phases[flight::Phase::takeoff]->weight, weight);
    const auto published = test::published_model();
    EXPECT_EQ(model.phases[flight::Phase::cruise].fourier.cos_w, published.phases[flight::Phase::cruise].fourier.cos_w)
        << "of no flight is the mean power known";
    const auto by_curve = decided_model(PowerBasis::curve);
    EXPECT_EQ(to_toml(with_decided_power(by_curve)), to_toml(by_curve));
    EXPECT_EQ(to_toml(with_decided_power(published)), to_toml(published)) << "without a decision";
}

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

MechanicalModel published() {
    return read_mechanical_model(test::source_dir() / "fits" / "mechanical" / "opterra-table1.toml");
}

TEST(PowerBeyondStraightFlight, IsNoneOfSlowAndFastFlightsStraightAhead) {
    MechanicalModel model;
    model.phases[flight::Phase::cruise].duration_s = 600.0;
    model.phases[flight::Phase::cruise].fourier.a0_w = 0.5 * (10.0 + 80.0);
    model.physical.emplace();
    model.physical->terms = {PowerTerm::drag};
    model.physical->coefficients[PowerTerm::drag] = 0.01;
    model.physical->mean_airspeed_m_per_s = 15.0;
    model.physical->airspeed_spread_m_per_s = 5.0;
    EXPECT_NEAR(power_beyond_straight_flight_w(model), 0.0, 1e-9);
    model.phases[flight::Phase::cruise].fourier.a0_w += 7.0;
    EXPECT_NEAR(power_beyond_straight_flight_w(model), 7.0, 1e-9);
}

TEST(PowerBeyondStraightFlight, OfLegsBetweenHoversKnowsTheirMeanAirspeed) {
    MechanicalModel model;
    model.phases[flight::Phase::cruise].duration_s = 600.0;
    model.physical.emplace();
    model.physical->terms = {PowerTerm::drag, PowerTerm::constant};
    model.physical->coefficients[PowerTerm::drag] = 0.01;
    model.physical->coefficients[PowerTerm::constant] = 100.0;
    model.physical->mean_airspeed_m_per_s = 2.5;  // a quarter at 10 m/s
    model.physical->airspeed_spread_m_per_s = std::sqrt(0.25 * 100.0 - 2.5 * 2.5);
    model.phases[flight::Phase::cruise].fourier.a0_w = 103.0 + 0.25 * 10.0;
    EXPECT_NEAR(power_beyond_straight_flight_w(model), 3.0, 1e-9);
}

TEST(ModelCheck, SaysNothingOfThePublishedModel) { EXPECT_THAT(model_warnings(published()), IsEmpty()); }

TEST(ModelCheck, TellsWhereACurveFallsBelowZero) {
    auto model = published();
    auto& landing = model.phases[flight::Phase::landing];
    landing.duration_s = 40.0;
    landing.fourier = {0.157, 3.0, {5.0}, {0.0}};  // from 8 W to -2 W and back
    EXPECT_THAT(model_warnings(model), ElementsAre(HasSubstr("landing: the curve falls to -2 W")));
    landing.fourier = {0.157, -27.84, {}, {}};
    EXPECT_THAT(model_warnings(model), ElementsAre(HasSubstr("falls to -27.8 W")));
}

TEST(ModelCheck, TellsWhatWasDoneToTheCurve) {
    auto model = published();
    auto& landing = model.phases[flight::Phase::landing];
    landing.edge_samples = 2;
    landing.open_frequency = true;
    landing.not_negative = true;
    landing.range = FrequencyRange{landing.fourier.omega_rad_per_s * landing.duration_s, 100.0};
    EXPECT_THAT(model_warnings(model), IsEmpty());
    EXPECT_THAT(fit_notes(model), ElementsAre(HasSubstr("landing: 2 samples were left out at its ends"),
                                              HasSubstr("landing: the frequency is at its low bound"),
                                              HasSubstr("landing: the samples do not determine the frequency"),
                                              HasSubstr("landing: the curve would fall below 0 W")));
}

}  // namespace
}  // namespace flightwatt::mechanical
