#include "mission/disturbance.h"

#include "helpers/rejected.h"
#include "mission/simulation.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::rejected;
using test::scratch_dir;
using test::write_text;

const flight::PerPhase<double> durations{{100.0, 600.0, 50.0}};

/// 100 % are 10 Wh, or 36 kJ; 15 W to compute and 5 W mechanical over 1000 s take 55.6 points.
Mission steady_flight() {
    Mission mission;
    mission.setup.name = "steady";
    mission.setup.duration_s[flight::Phase::cruise] = 1000.0;
    mission.setup.battery = {"", 10.0, 0.0, 1.0};
    mission.setup.compute.components.push_back({"load", compute::make_power_profile("load", {}, {{{}, 15.0, {}}})});
    mission.schedule = {{flight::Phase::cruise, 0.0, 1000.0, {{0, {}}}}};
    mission.setup.mechanical = mechanical::MechanicalModel();
    mission.setup.mechanical->phases[flight::Phase::cruise].fourier = {0.01, 5.0, {}, {}};
    mission.setup.mechanical->phases[flight::Phase::cruise].duration_s = 1000.0;
    return mission;
}

double final_soc(const std::vector<Disturbance>& disturbances) {
    return *simulate(steady_flight(), {}, disturbances).summary.final_soc_percent;
}

TEST(Disturbance, ChangesTheDepletion) {
    const double calm = 100.0 - 20.0 * 1000.0 / 360.0;
    Disturbance wind;
    wind.start_s = 200.25;
    wind.end_s = 700.25;
    wind.mechanical_factor = 1.4;
    EXPECT_NEAR(final_soc({wind}), calm - 2.0 * 500.0 / 360.0, 1e-9);
    Disturbance load;
    load.compute_factor = 2.0;
    load.compute_w = -1.0;
    EXPECT_NEAR(final_soc({load}), calm - 14.0 * 1000.0 / 360.0, 1e-9);
    EXPECT_NEAR(final_soc({wind, wind}), calm - (1.96 - 1.0) * 5.0 * 500.0 / 360.0, 1e-9);
    Disturbance weak;
    weak.capacity_factor = 0.8;
    EXPECT_NEAR(final_soc({weak}), 100.0 - 20.0 * 1000.0 / 360.0 / 0.8, 1e-9);
    for (const double at_s : {0.0, 333.3, 500.0}) {
        Disturbance drop;
        drop.start_s = at_s;
        drop.soc_drop_percent = 3.0;
        EXPECT_NEAR(final_soc({drop}), calm - 3.0, 1e-9) << at_s;
    }
}

TEST(Disturbance, TogetherMultiplyFirstAndAddThenInAnyOrder) {
    const double calm = 100.0 - 20.0 * 1000.0 / 360.0;
    Disturbance wind;
    wind.mechanical_factor = 2.0;
    wind.compute_w = 1.0;
    Disturbance payload;
    payload.mechanical_w = 3.0;
    payload.compute_factor = 1.2;
    const double expected = calm - (5.0 + 3.0 + 3.0 + 1.0) * 1000.0 / 360.0;  // 2 * 5 + 3, 1.2 * 15 + 1
    EXPECT_NEAR(final_soc({wind, payload}), expected, 1e-9);
    EXPECT_NEAR(final_soc({payload, wind}), expected, 1e-9);
}

TEST(Disturbance, AddsPowerWhereNothingFlew) {
    auto mission = steady_flight();
    mission.setup.mechanical.reset();
    Disturbance wind;
    wind.mechanical_factor = 2.0;
    wind.mechanical_w = 3.0;
    wind.end_s = 500.0;
    const auto soc = simulate(mission, {}, {wind}).summary.final_soc_percent;
    EXPECT_NEAR(*soc, 100.0 - (15.0 * 1000.0 + 3.0 * 500.0) / 360.0, 1e-9);
}

TEST(Disturbance, DropsBelowEmptyEndTheFlight) {
    Disturbance drop;
    drop.start_s = 400.0;
    drop.soc_drop_percent = 90.0;
    const auto summary = simulate(steady_flight(), {}, {drop}).summary;
    EXPECT_EQ(summary.depleted_at_s, 400.0);
    EXPECT_FALSE(summary.feasible);
}

TEST(Disturbance, KeepsToItsPartOfAPhase) {
    Disturbance wind;
    wind.start_s = 400.0;
    wind.end_s = 725.0;
    const auto moved = rescale_to_flown_durations({wind}, durations, {{100.0, 900.0, 25.0}}).front();
    EXPECT_DOUBLE_EQ(moved.start_s, 550.0);
    EXPECT_DOUBLE_EQ(moved.end_s, 1012.5);
}

std::vector<Disturbance> read(const std::string& text) {
    return read_disturbances(write_text(scratch_dir() / "d.toml", text), durations);
}

std::string refused(const std::string& entry) {
    const auto folder = scratch_dir();
    const auto path = write_text(folder / "d.toml", "[[disturbance]]\n" + entry + "\n");
    return rejected([&] { read_disturbances(path, durations); }, folder);
}

TEST(DisturbanceFile, PlacesThemInTheMission) {
    const auto read_back = read(
        "[[disturbance]]\nphase = \"cruise\"\nfrom = \"10 %\"\nto = 120\nmechanical_factor = 1.1\n"
        "[[disturbance]]\nphase = \"landing\"\nat = 20\nsoc_drop_percent = 3\n"
        "[[disturbance]]\ncapacity_factor = 0.9\n");
    ASSERT_EQ(read_back.size(), 3U);
    EXPECT_DOUBLE_EQ(read_back[0].start_s, 160.0);
    EXPECT_DOUBLE_EQ(read_back[0].end_s, 220.0);
    EXPECT_EQ(read_back[0].mechanical_factor, 1.1);
    EXPECT_DOUBLE_EQ(read_back[1].start_s, 720.0);
    EXPECT_EQ(read_back[1].soc_drop_percent, 3.0);
    EXPECT_EQ(read_back[2].start_s, 0.0);
    EXPECT_DOUBLE_EQ(read_back[2].end_s, 750.0);
}

TEST(DisturbanceFile, RefusesWhatMakesNoSense) {
    EXPECT_EQ(refused("mechanical_faktor = 2"),
              "d.toml:2:1: unknown key 'mechanical_faktor'; did you mean 'mechanical_factor'?");
    EXPECT_EQ(refused("phase = \"cruise\"\nfrom = 700\ncompute_w = 1"),
              "d.toml:3:1: from = 700 s is not within cruise; it takes 600 s in this mission");
    EXPECT_EQ(refused("phase = \"climb\"\ncompute_w = 1"),
              "d.toml:2:1: there is no phase 'climb'; the phases are takeoff, cruise and landing");
    EXPECT_EQ(refused("from = 30\nto = 30\ncompute_w = 1"),
              "d.toml:2:1: the segment is empty; it must start before it ends");
    EXPECT_EQ(refused("mechanical_factor = -1"), "d.toml:2:1: mechanical_factor = -1, expected 0 to 100");
    EXPECT_EQ(refused("soc_drop_percent = 3"),
              "d.toml:2:1: a drop happens at one moment, and none is given; add at = SECONDS");
    EXPECT_EQ(refused("capacity_factor = 0.9\nfrom = 10"),
              "d.toml:3:1: `from` cannot be given with `capacity_factor`: a pack is weaker from the start on; make "
              "two entries of it, or remove one");
    EXPECT_NE(refused("phase = \"cruise\"").find("d.toml:1:1: this entry changes nothing"), std::string::npos);
    EXPECT_NE(refused("compute_w = 1\n[[disturbance]]\nformat = 2").find("unknown key 'format'"), std::string::npos);
    const auto folder = scratch_dir();
    const auto path = write_text(folder / "empty.toml", "");
    EXPECT_NE(rejected([&] { read_disturbances(path, durations); }, folder).find("empty.toml: is empty"),
              std::string::npos);
}

}  // namespace
}  // namespace flightwatt::mission
