#include "compute/compute_model.h"

#include "compute/profile_reader.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::compute {
namespace {

using test::rejected;

PowerProfile line() {
    return make_power_profile("line.csv", {"fps"}, {{{10.0}, 24.0, {}}, {{5.0}, 20.0, {}}, {{30.0}, 36.0, {}}});
}

/// power = 1 + 2 a + 30 b + 5 a b: multilinear, so interpolation must give it back everywhere.
double bilinear(double a, double b) { return 1.0 + 2.0 * a + 30.0 * b + 5.0 * a * b; }

PowerProfile plane() {
    std::vector<ProfileNode> nodes;
    for (const double b : {0.5, 0.0, 2.0}) {
        for (const double a : {4.0, 1.0, -1.0, 9.0}) nodes.push_back({{a, b}, bilinear(a, b), {}});
    }
    return make_power_profile("plane.csv", {"a", "b"}, nodes);
}

TEST(PowerProfile, SortsNodesIntoAGrid) {
    const auto profile = plane();
    EXPECT_EQ(profile.axes, (std::vector<std::vector<double>>{{-1.0, 1.0, 4.0, 9.0}, {0.0, 0.5, 2.0}}));
    ASSERT_EQ(profile.power_w.size(), 12U);
    EXPECT_EQ(profile.power_w[5], bilinear(1.0, 2.0));  // the last parameter runs fastest
}

TEST(PowerProfile, IsExactAtNodes) {
    for (const auto& [fps, power] : {std::pair{5.0, 20.0}, {10.0, 24.0}, {30.0, 36.0}}) {
        EXPECT_EQ(power_w(line(), {fps}), power);
    }
    for (const double a : {-1.0, 1.0, 4.0, 9.0}) {
        for (const double b : {0.0, 0.5, 2.0}) EXPECT_EQ(power_w(plane(), {a, b}), bilinear(a, b));
    }
}

TEST(PowerProfile, IsLinearBetweenNodes) {
    EXPECT_DOUBLE_EQ(power_w(line(), {7.5}), 22.0);
    EXPECT_DOUBLE_EQ(power_w(line(), {15.0}), 27.0);
    for (const double a : {-0.3, 1.7, 3.999, 8.2}) {
        for (const double b : {0.01, 0.49, 1.3}) EXPECT_NEAR(power_w(plane(), {a, b}), bilinear(a, b), 1e-12);
    }
}

TEST(PowerProfile, InterpolatesThreeParameters) {
    std::vector<ProfileNode> nodes;
    const auto f = [](double a, double b, double c) { return 2.0 + a - 3.0 * b + 0.5 * c + a * b * c; };
    for (const double a : {0.0, 1.0, 3.0}) {
        for (const double b : {0.0, 2.0}) {
            for (const double c : {1.0, 2.0, 5.0}) nodes.push_back({{a, b, c}, f(a, b, c), {}});
        }
    }
    const auto profile = make_power_profile("cube.csv", {"a", "b", "c"}, nodes);
    EXPECT_NEAR(power_w(profile, {2.2, 0.7, 4.1}), f(2.2, 0.7, 4.1), 1e-12);
}

TEST(PowerProfile, MayHaveNoParametersOrOneValue) {
    EXPECT_EQ(power_w(make_power_profile("p.csv", {}, {{{}, 3.5, {}}}), {}), 3.5);
    const auto single = make_power_profile("p.csv", {"fps"}, {{{8.0}, 3.5, {}}});
    EXPECT_EQ(power_w(single, {8.0}), 3.5);
    EXPECT_NE(rejected([&] { power_w(single, {8.1}); }), "");
}

TEST(PowerProfile, RefusesToExtrapolate) {
    const Location asked{"mission.toml", 12, 5};
    const std::string expected =
        "mission.toml:12:5: fps = 4.9 is outside of the profiled range 5 .. 30 of line.csv; choose a value "
        "within it, "
        "or profile the component there";
    EXPECT_EQ(rejected([&] { require_in_range(line(), 0, 4.9, asked); }), expected);
    EXPECT_EQ(rejected([&] { require_in_range(line(), 0, 30.0, asked); }), "");
    EXPECT_THROW(power_w(line(), {30.0001}), InputError);
    EXPECT_THROW(power_w(line(), {std::nan("")}), InputError);
    EXPECT_THROW(power_w(line(), {}), std::invalid_argument);
}

TEST(PowerProfile, NamesTheNodeThatIsMissing) {
    std::vector<ProfileNode> nodes{{{1.0, 10.0}, 3.0, {}}, {{1.0, 20.0}, 4.0, {}}, {{2.0, 20.0}, 5.0, {}}};
    EXPECT_EQ(rejected([&] {
                  make_power_profile("p.csv", {"fps", "bits"}, nodes);
              }),
              "p.csv: the grid is incomplete: there is no node at fps = 2, bits = 10; profile every "
              "combination of the "
              "values, here 2 x 2 nodes");
    std::swap(nodes[2].qos[1], nodes[0].qos[1]);  // now the last of the grid is missing
    EXPECT_EQ(rejected([&] {
                  make_power_profile("p.csv", {"fps", "bits"}, {nodes[1], {{1.0, 10.0}, 1.0, {}}, nodes[2]});
              }),
              "p.csv: the grid is incomplete: there is no node at fps = 2, bits = 20; profile every "
              "combination of the "
              "values, here 2 x 2 nodes");
}

TEST(PowerProfile, RefusesAGridOfNonsenseWithoutBuildingIt) {
    std::vector<ProfileNode> diagonal;
    diagonal.reserve(1000);
    for (int i = 0; i < 1000; ++i) diagonal.push_back({std::vector<double>(6, i), 1.0, {}});
    EXPECT_NE(rejected([&] {
                  make_power_profile("p.csv", {"a", "b", "c", "d", "e", "f"}, diagonal);
              }).find("no node at a = 0, b = 0, c = 0, d = 0, e = 0, f = 1;"),
              std::string::npos);
}

TEST(PowerProfile, RefusesDuplicates) {
    EXPECT_EQ(rejected([] {
                  make_power_profile(
                      "p.csv", {"fps"},
                      {{{1.0}, 3.0, {"p.csv", 2}}, {{2.0}, 3.0, {"p.csv", 3}}, {{1.0}, 3.0, {"p.csv", 4}}});
              }),
              "p.csv:4: fps = 1 has a second node, the first is in line 2; keep one row for each configuration");
    EXPECT_EQ(rejected([] { make_power_profile("p.csv", {"fps"}, {}); }),
              "p.csv: has no nodes, expected at least one profiled configuration");
}

ComputeModel paper_model() {
    const auto fits = test::source_dir() / "fits" / "compute";
    return {{{"detection", read_power_profile(fits / "tx2-detection.csv")},
             {"encryption", read_power_profile(fits / "tx2-encryption.csv")}}};
}

TEST(ComputeModel, ComponentsAdd) {
    const auto model = paper_model();
    for (const double fps : {5.8, 7.0, 10.0, 30.0, 32.0}) {
        for (const double key_bits : {32.0, 100.0, 448.0}) {
            const double together = power_w(model, {{0, {fps}}, {1, {key_bits}}});
            EXPECT_DOUBLE_EQ(together, power_w(model, {{0, {fps}}}) + power_w(model, {{1, {key_bits}}}));
        }
    }
}

TEST(PowerProfile, HasNoPowerBelow0) {
    auto above = line();
    EXPECT_EQ(remove_negative_power(above), "");
    auto below = make_power_profile("below.csv", {"fps"}, {{{5.0}, -0.2, {}}, {{10.0}, 24.0, {}}});
    EXPECT_EQ(
        remove_negative_power(below),
        "below.csv: -0.2 W at fps = 5: software does not return power, and counts as 0; state may_charge = true if "
        "a source aboard charges the battery");
    EXPECT_EQ(below.power_w, (std::vector{0.0, 24.0}));
}

TEST(ComputeModel, DrawsNothingWhenNothingRuns) { EXPECT_EQ(power_w(paper_model(), {}), 0.0); }

TEST(ComputeModel, HoldsThePaperProfile) {
    // The three configurations of Fig. 3, in watts as Fig. 4 gives them.
    const auto model = paper_model();
    EXPECT_NEAR(power_w(model, {{0, {5.8}}, {1, {32.0}}}), 22.40, 0.005);
    EXPECT_NEAR(power_w(model, {{0, {10.0}}, {1, {240.0}}}), 24.28 + 3.11, 0.005);
    EXPECT_NEAR(power_w(model, {{0, {32.0}}, {1, {448.0}}}), 35.08 + 5.16, 0.005);
    EXPECT_NEAR(power_w(model, {{0, {25.0}}, {1, {136.0}}}), 31.01 + 1.69, 0.005);
    EXPECT_NEAR(power_w(model, {{1, {344.0}}}), 4.87, 0.005);
    EXPECT_EQ(model.components[0].profile.parameters, std::vector<std::string>{"fps"});
    EXPECT_EQ(model.components[1].profile.parameters, std::vector<std::string>{"key_bits"});
}

TEST(Describe, NamesWhatRuns) {
    const auto model = paper_model();
    EXPECT_EQ(describe(model, {{0, {10.0}}, {1, {240.0}}}), "detection fps 10, encryption key_bits 240");
    EXPECT_EQ(describe(model, {{0, {5.8}}}, "="), "detection fps=5.8");
    EXPECT_EQ(describe(model, {}), "nothing");
}

TEST(GridInterpolation, LeavesOutBetweenNeighbours) {
    const auto profile = make_power_profile("p", {"x"}, {{{0}, 1.0, {}}, {{1}, 5.0, {}}, {{4}, 9.0, {}}});
    const auto error = leave_one_out(profile);
    EXPECT_EQ(error.nodes, 1U);
    EXPECT_DOUBLE_EQ(error.mean_absolute_w, 2.0);
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
        const auto error = leave_one_out(profile);
        EXPECT_EQ(error.nodes, profile.power_w.size() == 25 ? 21U : 4U);
        EXPECT_LT(error.mean_absolute_percent, 4.0);
    }
}

TEST(LeaveOneOut, SummarizesTheNodesThatHaveNeighbours) {
    const auto error = leave_one_out(
        make_power_profile("p", {"x"}, {{{0}, 10.0, {}}, {{1}, 10.0, {}}, {{2}, 12.0, {}}, {{3}, 8.0, {}}}));
    EXPECT_EQ(error.nodes, 2U);  // errors of 1 and -3 W
    EXPECT_DOUBLE_EQ(error.mean_absolute_w, 2.0);
    EXPECT_DOUBLE_EQ(error.mean_absolute_percent, 17.5);
    EXPECT_DOUBLE_EQ(error.rms_w, std::sqrt(5.0));
    EXPECT_DOUBLE_EQ(error.largest_w, 3.0);
    EXPECT_EQ(leave_one_out(make_power_profile("p", {"x"}, {{{0}, 1.0, {}}})).rms_w, 0.0);
}

}  // namespace
}  // namespace flightwatt::compute
