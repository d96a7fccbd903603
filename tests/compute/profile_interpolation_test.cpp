#include "compute/profile_interpolation.h"

#include "base/error.h"
#include "compute/profile_reader.h"
#include "helpers/test_paths.h"

#include <cmath>
#include <iostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using Points = std::vector<std::vector<double>>;

Points grid(const std::vector<double>& xs, const std::vector<double>& ys) {
    Points points;
    for (const double x : xs) {
        for (const double y : ys) points.push_back({x, y});
    }
    return points;
}

TEST(SpreadNodes, TakesCornersFirstThenTheFarthest) {
    const auto points = grid({1, 2, 4, 8, 16}, {0, 1, 2, 3, 4});
    const auto four = spread_nodes(points, 4);
    EXPECT_THAT(four, testing::UnorderedElementsAre(0U, 4U, 20U, 24U));
    EXPECT_EQ(four[1], 24U);                         // opposite to the first
    EXPECT_EQ(spread_nodes(points, 5).back(), 12U);  // the middle, by rank
    EXPECT_EQ(spread_nodes(points, 99).size(), 25U);
    EXPECT_THAT(spread_nodes({{7.0}}, 3), testing::ElementsAre(0U));
    EXPECT_THAT(spread_nodes({{}}, 3), testing::ElementsAre(0U));
}

constexpr ScatteredMethod every_method[] = {ScatteredMethod::plane, ScatteredMethod::products,
                                            ScatteredMethod::thin_plate, ScatteredMethod::inverse_distance};

TEST(ScatteredInterpolation, FindsWhatItCanRepresent) {
    const auto known = grid({0, 1, 3, 4}, {0, 2, 5});
    std::vector<double> plane;
    std::vector<double> product;
    for (const auto& p : known) {
        plane.push_back(2.0 + 3.0 * p[0] - p[1]);
        product.push_back(plane.back() + 0.5 * p[0] * p[1]);
    }
    const Points at{{2.0, 1.0}, {3.5, 4.0}};
    for (const auto method : every_method) {
        const ScatteredChoice choice{method, AxisScale::value};
        if (method == ScatteredMethod::inverse_distance) continue;  // represents constants alone
        const auto found = interpolate_scattered(choice, known, plane, at);
        EXPECT_NEAR(found[0], 7.0, 1e-9) << to_string(choice);
        EXPECT_NEAR(found[1], 8.5, 1e-9) << to_string(choice);
    }
    EXPECT_NEAR(interpolate_scattered({ScatteredMethod::products, AxisScale::value}, known, product, at)[1],
                15.5, 1e-9);
    for (const auto method : {ScatteredMethod::thin_plate, ScatteredMethod::inverse_distance}) {
        const auto found = interpolate_scattered({method, AxisScale::rank}, known, product, known);
        for (std::size_t i = 0; i < known.size(); ++i) EXPECT_NEAR(found[i], product[i], 1e-9);
    }
    EXPECT_EQ(ranked_methods(known, product).front().first.method, ScatteredMethod::products);
    EXPECT_THROW(
        interpolate_scattered({ScatteredMethod::plane, AxisScale::value}, {{0, 0}, {1, 1}}, {1, 2}, at),
        NoAnswerError);
}

/// The formulas against doing it: leaving out and interpolating, one node after the other.
TEST(ScatteredInterpolation, LeavesOutAsIfDoneByHand) {
    const auto known = grid({1, 2, 4, 8}, {0, 1, 3});
    std::vector<double> power_w;
    for (const auto& p : known) power_w.push_back(5.0 + std::sin(p[0]) + p[1] * std::sqrt(p[0]));
    for (const auto method : every_method) {
        for (const auto scale : {AxisScale::value, AxisScale::rank}) {
            const ScatteredChoice choice{method, scale};
            const auto errors = leave_one_out(choice, known, power_w);
            ASSERT_TRUE(errors);
            EXPECT_EQ(errors->nodes, known.size());
            for (std::size_t k = 0; k < known.size(); ++k) {
                auto others = known;
                auto others_w = power_w;
                others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
                others_w.erase(others_w.begin() + static_cast<std::ptrdiff_t>(k));
                const double by_hand =
                    interpolate_scattered(choice, others, others_w, {known[k]}).front() - power_w[k];
                EXPECT_NEAR(errors->error_w[k], by_hand, 1e-8) << to_string(choice) << " node " << k;
            }
        }
    }
}

TEST(ScatteredInterpolation, SaysNothingFromTooFewNodes) {
    EXPECT_TRUE(ranked_methods({{1}, {2}}, {1, 2}).empty());
    EXPECT_FALSE(leave_one_out({ScatteredMethod::plane, AxisScale::value}, grid({0, 1}, {0}), {1, 2}));
    const auto corners = grid({0, 1}, {0, 1});
    EXPECT_FALSE(leave_one_out({ScatteredMethod::products, AxisScale::value}, corners, {1, 2, 3, 4}));
    EXPECT_TRUE(leave_one_out({ScatteredMethod::plane, AxisScale::value}, corners, {1, 2, 3, 4}));
}

TEST(GridInterpolation, LeavesOutBetweenNeighbours) {
    const auto profile = make_power_profile("p", {"x"}, {{{0}, 1.0, {}}, {{1}, 5.0, {}}, {{4}, 9.0, {}}});
    const auto error = leave_grid_nodes_out(profile);
    EXPECT_EQ(error.nodes, 1U);
    EXPECT_TRUE(std::isnan(error.error_w[0]));
    EXPECT_DOUBLE_EQ(error.error_w[1], 3.0 - 5.0);
    EXPECT_DOUBLE_EQ(error.mean_absolute_percent, 40.0);
}

PowerProfile real_grid() {
    ProfileNaming naming;
    naming.columns = {"first", "second", "power_w"};
    return read_power_profile(test::shared_dir() / "powprofiler" / "tx2_two_component_power.csv", naming);
}

/// The eight recordings as their config4.cfg joins them; it names them without the prefix they are kept with.
PowerProfile real_recordings() {
    const auto folder = test::scratch_dir();
    for (const auto& entry : std::filesystem::directory_iterator(test::shared_dir() / "powprofiler")) {
        const auto name = entry.path().filename().string();
        if (name.starts_with("tracking_")) std::filesystem::copy(entry.path(), folder / name.substr(9));
    }
    ProfileNaming naming;
    naming.parameters = {"yolo_fps", "nfold_fps"};
    return read_power_profile(folder / "config4.cfg", naming);
}

void print(const LeaveOneOut& error) {
    std::cout << error.method << ": " << error.nodes << " nodes, mean " << error.mean_absolute_w << " W ("
              << error.mean_absolute_percent << " %), RMS " << error.rms_w << " W, largest "
              << error.largest_w << " W\n";
}

TEST(GridInterpolation, OfTheRealProfiles) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto& profile : {real_grid(), real_recordings()}) {
        const auto linear = leave_grid_nodes_out(profile);
        print(linear);
        EXPECT_EQ(linear.nodes, profile.power_w.size() == 25 ? 21U : 4U);
        EXPECT_LT(linear.mean_absolute_percent, 4.0);
        const auto ranked = ranked_methods(grid_points(profile), profile.power_w);
        ASSERT_FALSE(ranked.empty());
        for (const auto& [choice, error] : ranked) print(error);
        EXPECT_EQ(ranked.front().second.nodes, profile.power_w.size());
        EXPECT_LT(ranked.front().second.mean_absolute_percent, 5.0);
    }
}

/// Of the real grid of 25 some are taken as trials: the error at the others, known here, beside its estimate.
TEST(Trials, ErrorOnTheRealGridIsWhatWasEstimated) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto profile = real_grid();
    const auto points = grid_points(profile);
    for (const std::size_t trials : {9, 13}) {
        Points known;
        Points others;
        std::vector<double> known_w;
        std::vector<double> others_w;
        const auto chosen = spread_nodes(points, trials);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const bool is_chosen = std::find(chosen.begin(), chosen.end(), k) != chosen.end();
            (is_chosen ? known : others).push_back(points[k]);
            (is_chosen ? known_w : others_w).push_back(profile.power_w[k]);
        }
        const auto best = ranked_methods(known, known_w, others).front();
        auto errors = interpolate_scattered(best.first, known, known_w, others);
        for (std::size_t i = 0; i < errors.size(); ++i) errors[i] -= others_w[i];
        const auto truth = summarize_left_out("true error", errors, others_w);
        std::cout << trials << " trials of 25\n";
        print(best.second);
        print(truth);
        EXPECT_LT(truth.rms_w, 2.0 * best.second.rms_w);
        EXPECT_LT(truth.mean_absolute_percent, 5.0);
    }
}

}  // namespace
}  // namespace flightwatt::compute
