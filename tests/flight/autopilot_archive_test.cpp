// Logs of ArduPilot and PX4 from public archives: the edges that were seen in them, and their energies.

#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

/// What was seen in a log, to a tolerance [s]. The edges are lift-off and the ends of the phases.
struct SeenLog {
    const char* log;
    double energy_wh;  ///< of the whole log; 0 if unknown
    std::vector<std::pair<double, double>> edges = {};
    bool ends_in_the_air = false;
    const char* refusal = "";
};

constexpr double any_s = 1e6;

const std::vector<SeenLog>& seen_logs() {
    static const std::vector<SeenLog> logs{
        {"ardupilot/y6_2004.bin", 37.1760, {{322.8, 1}, {330, any_s}, {618, 3}, {643, 1}}},
        {"ardupilot/y6_2044.bin", 33.5688, {{58.3, 1}, {67, any_s}, {316, 2}, {346.3, 1}}},
        {"ardupilot/y6_2119.bin", 8.4362, {{38, 1}, {74, 4}, {84, 2}, {105.6, 0.5}}, true},
        {"ardupilot/quad_0036.bin", 8.5430, {{241.5, 1.5}, {260, any_s}, {370, any_s}, {374, 1}}},
        {"ardupilot/indoor_yl1.bin", 16.1226, {{1487, 2}, {1490, any_s}, {1735, any_s}, {1739.5, 1}}},
        {"ardupilot/indoor_yl2.bin", 3.0079, {{65, 1}, {67, any_s}, {112.9, 0.5}}, true},
        {"ardupilot/indoor_diaven1.bin", 1.8781, {{79.5, 1}, {82, any_s}, {112, any_s}, {115, 1}}},
        {"ardupilot/sitl_plane.bin", 2.7350, {{72.4, 0.5}, {79, 1}, {112.6, 0.5}}, true},
        {"ardupilot/plane_cut.bin", 0.0033, {}, false, "has no flight"},
        {"px4/copter_upgrade.ulg", 0.7707, {{1095.2, 0.1}, {1107, 1}, {1110.5, 1}, {1123.7, 0.1}}},
        {"px4/wing_proto9.ulg", 17.3678, {{341.7, 0.1}, {368, 3}, {827, 2}, {848, 2}}},
        {"px4/vtol_ground.ulg", 0.1282, {}, false, "has no flight"},
        {"px4/appended.ulg", 0.0, {}, false, "has no flight"},
    };
    return logs;
}

TEST(AutopilotArchive, HasTheEdgesAndEnergiesThatWereSeen) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto archive = test::shared_dir() / "archives" / "autopilots";
    for (const auto& seen : seen_logs()) {
        SCOPED_TRACE(seen.log);
        if (*seen.refusal != '\0') {
            LoadOptions options;
            options.power_required = false;
            EXPECT_THAT(test::rejected([&] { load_flight(archive / seen.log, options); }),
                        testing::HasSubstr(seen.refusal));
            continue;
        }
        const auto series = read_flight(archive / seen.log);
        const auto power = power_track(series);
        EXPECT_NEAR(integrated_energy_wh(power, power.time_s.front(), power.time_s.back()), seen.energy_wh,
                    1e-4 * seen.energy_wh + 5e-5);
        const auto phases = segment(select_tracks(series));
        ASSERT_EQ(phases.sorties.size(), 1U);
        const auto& spans = phases.sorties[0].phases;
        ASSERT_EQ(spans.size() + 1, seen.edges.size());
        EXPECT_NEAR(spans[0].start.time_s, seen.edges[0].first, seen.edges[0].second);
        for (std::size_t i = 0; i < spans.size(); ++i)
            EXPECT_NEAR(spans[i].end.time_s, seen.edges[i + 1].first, seen.edges[i + 1].second) << i;
        EXPECT_EQ(!spans.back().complete, seen.ends_in_the_air);
    }
}

/// Of a benchmark's multirotor, which states neither arming nor landing: complete flights, hovers, and no flight.
TEST(AutopilotArchive, SegmentsAMultirotorByItsPower) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto phases_of = [](const char* flight) {
        const auto series = read_flight(test::shared_dir() / "m100" / (std::string(flight) + ".csv"));
        std::string names;
        for (const auto& sortie : segment(select_tracks(series)).sorties)
            for (const auto& span : sortie.phases)
                names += std::string(to_string(span.phase)) + (span.complete ? " " : "* ");
        return names;
    };
    EXPECT_EQ(phases_of("5"), "takeoff cruise landing ") << "recorded from arming";
    EXPECT_EQ(phases_of("19"), "takeoff cruise landing ") << "recorded from lift-off";
    EXPECT_EQ(phases_of("158"), "cruise* ") << "hovers all the time";
    EXPECT_EQ(phases_of("161"), "cruise* landing ");
    EXPECT_EQ(phases_of("155"), "") << "idles on the ground, without a fix";
}

}  // namespace
}  // namespace flightwatt::flight
