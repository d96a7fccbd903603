#include "mission/disturbance_file.h"

#include "helpers/rejected.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

using test::rejected;
using test::scratch_dir;
using test::write_text;

const flight::PerPhase<double> durations{{100.0, 600.0, 50.0}};

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
              "d.toml:3:1: `from` stands with `capacity_factor`: a pack is weaker from the start on; make "
              "two entries of it, or remove one");
    EXPECT_NE(refused("phase = \"cruise\"").find("d.toml:1:1: this entry changes nothing"),
              std::string::npos);
    EXPECT_NE(refused("compute_w = 1\n[[disturbance]]\nformat = 2").find("unknown key 'format'"),
              std::string::npos);
    const auto folder = scratch_dir();
    const auto path = write_text(folder / "empty.toml", "");
    EXPECT_NE(rejected([&] { read_disturbances(path, durations); }, folder).find("there are no disturbances"),
              std::string::npos);
}

}  // namespace
}  // namespace flightwatt::mission
