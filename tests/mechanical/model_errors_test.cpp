#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "helpers/made_up_flights.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/model_fit.h"
#include "mechanical/table_one.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::mechanical {
namespace {

using testing::HasSubstr;

std::vector<FlightSamples> made_up_flights(std::size_t count, double noise_w) {
    std::vector<FlightSamples> flights(count);
    for (const auto phase : flight::all_phases) {
        const auto samples = test::record_flights(phase, count, noise_w, 1);
        for (std::size_t i = 0; i < count; ++i) {
            flights[i].flight = samples[i].flight;
            flights[i].phases[phase] = samples[i];
        }
    }
    return flights;
}

std::filesystem::path written(const std::string& text) {
    auto path = test::scratch_dir() / "file";
    write_file_atomically(path, text);
    return path;
}

TEST(ModelErrors, ChangeNothingElseOfTheModel) {
    auto fit = fit_model(made_up_flights(3, 0.1));
    const auto plain = to_toml(fit.model);
    analyse_model(fit);
    auto model = fit.model;
    EXPECT_NE(to_toml(model), plain);
    for (const auto phase : flight::all_phases) {
        EXPECT_TRUE(model.phases[phase].errors && model.phases[phase].spread);
        model.phases[phase].errors.reset();
        model.phases[phase].spread.reset();
    }
    EXPECT_EQ(to_toml(model), plain);
}

TEST(ModelErrors, AreReadBackFromTheModelFile) {
    auto fit = fit_model(made_up_flights(3, 0.1));
    analyse_model(fit);
    const auto text = to_toml(fit.model);
    const auto again = read_mechanical_model(written(text));
    EXPECT_EQ(to_toml(again), text);
    EXPECT_EQ(again.phases[flight::Phase::cruise].errors->cos_w, fit.model.phases[flight::Phase::cruise].errors->cos_w);
    EXPECT_EQ(again.phases[flight::Phase::landing].spread->high_w,
              fit.model.phases[flight::Phase::landing].spread->high_w);
}

TEST(ModelErrors, AFileWithImpossibleErrorsIsRefused) {
    auto fit = fit_model(made_up_flights(2, 0.1));
    analyse_model(fit);
    const auto refusal = [&](auto change) -> std::string {
        auto model = fit.model;
        change(model.phases[flight::Phase::cruise]);
        try {
            read_mechanical_model(written(to_toml(model)));
        } catch (const InputError& error) {
            return fmt::format("{}{}", error.where().line > 0 ? "" : "no line: ", error.what());
        }
        return "read without complaint";
    };
    EXPECT_THAT(refusal([](auto& phase) { phase.errors->a0_w = -1.0; }), HasSubstr("a0_w = -1, expected 0 or more"));
    EXPECT_THAT(refusal([](auto& phase) { phase.errors->cos_w.pop_back(); }),
                HasSubstr("cos_w has 2 numbers, expected 3"));
    EXPECT_THAT(refusal([](auto& phase) { phase.errors->sin_w[1] = -0.5; }), HasSubstr("negative"));
    EXPECT_THAT(refusal([](auto& phase) { phase.errors->r2 = 1.5; }), HasSubstr("r2 = 1.5, expected at most 1"));
    EXPECT_THAT(refusal([](auto& phase) { phase.spread->high_w.pop_back(); }), HasSubstr("does not fit low_w"));
    EXPECT_THAT(refusal([](auto& phase) { std::swap(phase.spread->low_w, phase.spread->high_w); }),
                HasSubstr("does not fit low_w"));
    const auto typo = [&] {
        auto text = to_toml(fit.model);
        text.replace(text.find("curve_w ="), 7, "cruve_w");
        return written(text);
    };
    EXPECT_THROW(read_mechanical_model(typo()), InputError);
}

TEST(ModelErrors, CurvesAreATableOfBothBands) {
    auto fit = fit_model(made_up_flights(3, 0.1));
    const auto analyses = analyse_model(fit);
    const auto table = parse_csv(curves_csv(fit, analyses), "curves.csv");
    ASSERT_EQ(table.columns.size(), 12U);
    ASSERT_GE(table.rows.size(), 603U);
    for (const auto& row : table.rows) {
        const auto number = [&](std::string_view name) { return cell_number(table, row, column_index(table, name)); };
        EXPECT_LE(number("low_95_w"), number("power_w"));
        EXPECT_GE(number("high_95_w"), number("power_w"));
        EXPECT_LE(number("flights_low_w"), number("power_w") + 1e-4);
        EXPECT_GE(number("flights_high_w"), number("power_w") - 1e-4);
    }
    auto alone = fit_model(made_up_flights(1, 0.1));
    EXPECT_THAT(curves_csv(alone, analyse_model(alone)), HasSubstr(",,,,,\n"));
}

TEST(ModelErrors, BandsOfPowersThatDifferDoNotReachBelowZero) {
    auto flights = made_up_flights(2, 0.1);
    for (const auto phase : flight::all_phases)
        for (double& power_w : flights[1].phases[phase]->power_w) power_w *= 4.0;
    auto fit = fit_model(flights);
    const auto table = parse_csv(curves_csv(fit, analyse_model(fit)), "curves.csv");
    bool was_cut = false;
    for (const auto& row : table.rows) {
        for (const auto* name : {"low_95_w", "flights_low_w", "population_low_95_w"})
            EXPECT_GE(cell_number(table, row, column_index(table, name)), 0.0) << name;
        was_cut = was_cut || cell_number(table, row, column_index(table, "population_low_95_w")) == 0.0;
    }
    EXPECT_TRUE(was_cut);
}

TEST(TableOne, CanHaveIntervals) {
    auto model = test::published_model();
    model.phases[flight::Phase::cruise].errors =
        PhaseErrors{1e-5, 0.05, {0.01, 0.02, 0.03}, {0.04, 0.05, 0.06}, 0.02, 1e9, false, 0.9, 0.1, 400.0};
    const auto table = table_one(model, TableIntervals::present);
    ASSERT_EQ(table.header.size(), 8U);
    EXPECT_EQ(table.header[4], "cruise 95 %");
    EXPECT_EQ(table.rows[0][4], "27.12 to 27.32");    // 1.96 standard errors
    EXPECT_EQ(table.rows[7][4], "0.1795 to 0.1803");  // of xi = omega * 600 / 28
    EXPECT_EQ(table.rows[0][2], "no errors known");
    model.phases[flight::Phase::cruise].errors->frequency_is_fixed = true;
    EXPECT_EQ(table_one(model, TableIntervals::present).rows[7][4], "not fitted");
    const auto compared = table_one_comparison(test::published_model(), model, TableIntervals::present);
    EXPECT_EQ(compared.header.size(), 11U);
    for (const auto& row : compared.rows) EXPECT_EQ(row.size(), 11U);
}

TEST(TableOneLatex, StatesInTheCaptionWhyAPhaseHasNoIntervals) {
    auto model = test::published_model();
    auto& cruise = model.phases[flight::Phase::cruise];
    cruise.errors = PhaseErrors{1e-5, 0.05, {0.01, 0.02, 0.03}, {0.04, 0.05, 0.06}, 0.02, 1e9, false, 0.9, 0.1, 400.0};
    auto text = to_latex(table_one(model, TableIntervals::present));
    EXPECT_THAT(text, HasSubstr("(in brackets: 95 \\% intervals; no interval of the take-off: no errors known; no "
                                "interval of the landing: no errors known)}"));
    EXPECT_THAT(text, HasSubstr(" & take-off & cruise &  & landing & unit \\\\\n"));
    cruise.open_frequency = true;
    text = to_latex(table_one(model, TableIntervals::present));
    EXPECT_THAT(text, HasSubstr("no interval of the cruise: other frequencies fit;"));
    EXPECT_THAT(text, Not(HasSubstr("brackets")));
}

TEST(TableOneLatex, IsThePapersTable) {
    EXPECT_EQ(to_latex(table_one(test::published_model())),
              R"(% needs \usepackage{booktabs}
\begin{table}
\centering
\caption{Constants for the mechanical energy model}
\label{tab:mechanical-energy-model}
\begin{tabular}{lrrrl}
\toprule
 & take-off & cruise & landing & unit \\
\midrule
$a_{0}$ & $29.97$ & $27.22$ & $27.21$ & W \\
$a_{1}$ & $1.57$ & $0.3737$ & $-0.9512$ & W \\
$b_{1}$ & $-1.963$ & $1.194$ & $1.276$ & W \\
$a_{2}$ & $0.3876$ & $0.6513$ & $0.9357$ & W \\
$b_{2}$ & $-1.552$ & $0.2954$ & $0.965$ & W \\
$a_{3}$ & $-0.2869$ & $0.5039$ & $0.4913$ & W \\
$b_{3}$ & $-0.547$ & $-0.2864$ & $-0.1192$ & W \\
$\xi$ & $0.1525$ & $0.1799$ & $0.1296$ & rad \\
\bottomrule
\end{tabular}
\end{table}
)");
}

TEST(TableOneLatex, LeavesNothingThatTexReadsOtherwise) {
    const auto text =
        to_latex({{"coefficient", "take-off", "take-off 95 %"},
                  {{"a0", "1.5e-05", "-0.012 to 3e-05"}, {"a0 difference [%]", "-", "-"}, {"x_y", "&", "#"}}});
    EXPECT_THAT(text, HasSubstr(R"($a_{0}$ & $1.5 \times 10^{-5}$ & $[-0.012,\, 3 \times 10^{-5}]$ \\)"));
    EXPECT_THAT(text, HasSubstr(R"(a0 difference {[}\%] & -- & -- \\)"));
    EXPECT_THAT(text, HasSubstr(R"(x\_y & \& & \# \\)"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '$') % 2, 0);
}

/// Flights of constant power.
PhaseFit flights_of(const std::vector<double>& powers_w) {
    PhaseFit fit;
    fit.theta_rad = 4.0;
    for (const double power_w : powers_w) {
        fit.flights.push_back({"flight", 100.0, {0.04, power_w, {}, {}}, 0.1, 50});
    }
    return fit;
}

TEST(FlightEnvelope, OfEqualWeightsIsTheUsualStandardDeviation) {
    const auto spread = compute_envelope(flights_of({20.0, 22.0, 24.0, 30.0}), std::vector(4, 0.25), 5);
    ASSERT_TRUE(spread);
    ASSERT_EQ(spread->low_w.size(), 5U);
    const double standard_deviation_w = std::sqrt((16.0 + 4.0 + 0.0 + 36.0) / 3.0);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_DOUBLE_EQ(spread->low_w[i], 20.0);
        EXPECT_DOUBLE_EQ(spread->high_w[i], 30.0);
        EXPECT_NEAR(spread->standard_deviation_w[i], standard_deviation_w, 1e-12);
    }
    EXPECT_DOUBLE_EQ(spread->effective_flights, 4.0);
}

TEST(FlightEnvelope, OfASingleFlightIsNone) {
    EXPECT_FALSE(compute_envelope(flights_of({20.0}), std::vector{1.0}));
    EXPECT_EQ(compute_envelope(flights_of({20.0, 22.0}), std::vector{0.5, 0.5})->low_w.size(), envelope_points);
}

TEST(FlightEnvelope, ComparesFlightsAtEqualPartsOfThePhase) {
    PhaseFit fit;
    fit.theta_rad = 4.0;
    for (const double duration_s : {80.0, 120.0}) {
        fit.flights.push_back({"flight", duration_s, {4.0 / duration_s, 25.0, {2.0}, {-1.0}}, 0.1, 50});
    }
    const auto spread = compute_envelope(fit, std::vector{0.5, 0.5});
    for (const double deviation_w : spread->standard_deviation_w) EXPECT_NEAR(deviation_w, 0.0, 1e-12);
    EXPECT_NEAR(spread->high_w.front(), 27.0, 1e-12);
}

}  // namespace
}  // namespace flightwatt::mechanical
