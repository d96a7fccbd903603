#include "compute/profile_interpolation.h"

#include "base/error.h"
#include "compute/profile_reader.h"
#include "helpers/grid_points.h"
#include "helpers/test_paths.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

TEST(GridInterpolation, LeavesOutBetweenNeighbours) {
    const auto profile = make_power_profile("p", {"x"}, {{{0}, 1.0, {}}, {{1}, 5.0, {}}, {{4}, 9.0, {}}});
    const auto error = leave_one_out(profile);
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

TEST(GridInterpolation, OfTheRealProfiles) {
    FLIGHTWATT_NEEDS_SHARED();
    for (const auto& profile : {real_grid(), real_recordings()}) {
        const auto errors = interpolation_errors(profile);
        ASSERT_EQ(errors.size(), 2U);
        EXPECT_EQ(errors[0].nodes, profile.power_w.size() == 25 ? 21U : 4U);
        EXPECT_LT(errors[0].mean_absolute_percent, 4.0);
        EXPECT_EQ(errors[1].nodes, profile.power_w.size());
        EXPECT_LT(errors[1].mean_absolute_percent, 6.0);
    }
}

TEST(LeaveOneOut, SummarizesTheNodesThatWereFound) {
    const auto summary = summarize_errors("m", {1.0, std::nan(""), -3.0}, {10.0, 5.0, 20.0});
    EXPECT_EQ(summary.nodes, 2U);
    EXPECT_DOUBLE_EQ(summary.mean_absolute_w, 2.0);
    EXPECT_DOUBLE_EQ(summary.mean_absolute_percent, 12.5);
    EXPECT_DOUBLE_EQ(summary.rms_w, std::sqrt(5.0));
    EXPECT_DOUBLE_EQ(summary.largest_w, 3.0);
}

TEST(LeaveOneOut, OfNoNodeIsZero) { EXPECT_EQ(summarize_errors("m", {std::nan("")}, {1.0}).rms_w, 0.0); }

using test::grid;
using test::Points;

TEST(ThinPlate, IsAPlaneWhereTheNodesLieOnOneAndExactAtAnyNodes) {
    const auto known = grid({0, 1, 3, 4}, {0, 2, 5});
    std::vector<double> plane;
    std::vector<double> product;
    for (const auto& p : known) {
        plane.push_back(2.0 + 3.0 * p[0] - p[1]);
        product.push_back(plane.back() + 0.5 * p[0] * p[1]);
    }
    const auto found = interpolate_thin_plate(AxisScale::value, known, plane, {{2.0, 1.0}, {3.5, 4.0}});
    EXPECT_NEAR(found[0], 7.0, 1e-9);
    EXPECT_NEAR(found[1], 8.5, 1e-9);
    const auto again = interpolate_thin_plate(AxisScale::rank, known, product, known);
    for (std::size_t i = 0; i < known.size(); ++i) EXPECT_NEAR(again[i], product[i], 1e-9);
    EXPECT_EQ(choose_scale(known, plane).value().scale, AxisScale::value);
}

/// The formula against doing it: interpolating from the others, one node after the other.
TEST(ThinPlate, FindsEachNodeFromTheOthersAsIfDoneByHand) {
    const auto known = grid({1, 2, 4, 8}, {0, 1, 3});
    std::vector<double> power_w;
    for (const auto& p : known) power_w.push_back(5.0 + std::sin(p[0]) + p[1] * std::sqrt(p[0]));
    for (const auto scale : {AxisScale::value, AxisScale::rank}) {
        const auto errors = leave_one_out(scale, known, power_w);
        ASSERT_TRUE(errors);
        EXPECT_EQ(errors->nodes, known.size());
        for (std::size_t k = 0; k < known.size(); ++k) {
            auto others = known;
            auto others_w = power_w;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
            others_w.erase(others_w.begin() + static_cast<std::ptrdiff_t>(k));
            const double by_hand = interpolate_thin_plate(scale, others, others_w, {known[k]}).front() - power_w[k];
            EXPECT_NEAR(errors->error_w[k], by_hand, 1e-8) << " node " << k;
        }
    }
}

TEST(ThinPlate, SaysNothingFromTooFewNodes) {
    EXPECT_FALSE(choose_scale({{1}, {2}}, {1, 2}));
    EXPECT_FALSE(choose_scale(grid({0, 1}, {0}), {1, 2}));
    EXPECT_FALSE(choose_scale({{0, 0}, {1, 0}, {0, 1}}, {1, 2, 3}));
    EXPECT_TRUE(choose_scale(grid({0, 1}, {0, 1}), {1, 2, 3, 4}));
    EXPECT_THROW(interpolate_thin_plate(AxisScale::value, {{0, 0}, {1, 1}}, {1, 2}, {{1, 0}}), NoResultError);
}

/// Of the real grid of 25 some are taken as trials: the error at the others, known here, beside its estimate.
TEST(ThinPlate, ErrorOnTheRealGridIsWhatWasEstimated) {
    FLIGHTWATT_NEEDS_SHARED();
    ProfileNaming naming;
    naming.columns = {"first", "second", "power_w"};
    const auto profile = read_power_profile(test::shared_dir() / "powprofiler" / "tx2_two_component_power.csv", naming);
    const auto points = grid_points(profile);
    for (const std::size_t trials : {9, 13}) {
        Points known;
        Points others;
        std::vector<double> known_w;
        std::vector<double> others_w;
        const auto chosen = select_maximin(points, trials);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const bool is_chosen = std::find(chosen.begin(), chosen.end(), k) != chosen.end();
            (is_chosen ? known : others).push_back(points[k]);
            (is_chosen ? known_w : others_w).push_back(profile.power_w[k]);
        }
        const auto best = choose_scale(known, known_w, others).value();
        auto errors = interpolate_thin_plate(best.scale, known, known_w, others);
        for (std::size_t i = 0; i < errors.size(); ++i) errors[i] -= others_w[i];
        const auto truth = summarize_errors("true error", errors, others_w);
        EXPECT_LT(truth.rms_w, 2.0 * best.error.rms_w);
        EXPECT_LT(truth.mean_absolute_percent, 5.0);
    }
}

}  // namespace
}  // namespace flightwatt::compute
