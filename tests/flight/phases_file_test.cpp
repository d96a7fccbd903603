#include "flight/phases_file.h"

#include "base/atomic_file.h"
#include "flight/load_flight.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

TEST(PhasesCsvReader, ReadsBackWhatWasWritten) {
    const auto series = read_flight(test::source_dir() / "logs" / "opterra_synthetic_01.data");
    const auto written = phases_csv(select_tracks(series), segment(select_tracks(series)));
    const auto file = test::scratch_dir() / "phases.csv";
    write_file_atomically(file, written);
    const auto phases = read_phases_csv(file);
    ASSERT_EQ(phases.sorties.size(), 1U);
    EXPECT_EQ(phases_csv(select_tracks(series), phases), written);
}

TEST(PhasesCsv, HasTheTimeThatARotorcraftHovers) {
    FlightSeries series;
    Track altitude{.name = "altitude_m", .source = "plain"};
    Track speed{.name = "ground_speed_m_per_s", .source = "plain"};
    for (int i = 0; i <= 100; ++i) {
        for (auto* track : {&altitude, &speed}) track->time_s.push_back(i);
        altitude.value.push_back(20.0);
        speed.value.push_back(i < 30 ? 0.5 : 8.0);
    }
    series.tracks = {altitude, speed};
    FlightPhases phases;
    phases.sorties.emplace_back();
    PhaseSpan cruise;
    cruise.start.time_s = 10.0;
    cruise.end.time_s = 90.0;
    phases.sorties[0].phases.push_back(cruise);
    EXPECT_TRUE(phases_csv(select_tracks(series), phases).ends_with(",\n")) << "unknown kind";
    series.firmware = "rotorcraft";
    EXPECT_TRUE(phases_csv(select_tracks(series), phases).ends_with(",19\n"));
}

std::string refusal(const std::string& from, const std::string& to) {
    const auto series = read_flight(test::source_dir() / "logs" / "opterra_synthetic_01.data");
    auto text = phases_csv(select_tracks(series), segment(select_tracks(series)));
    text.replace(text.find(from), from.size(), to);
    const auto file = test::scratch_dir() / "phases.csv";
    write_file_atomically(file, text);
    return test::rejected([&] { read_phases_csv(file); });
}

TEST(PhasesCsvReader, RefusesWhatIsNoPhase) {
    EXPECT_THAT(refusal("1,cruise", "1,glide"), testing::HasSubstr("phase is 'glide', expected takeoff"));
    EXPECT_THAT(refusal("1,cruise", "3,cruise"), testing::HasSubstr("sortie is '3', expected sorties"));
    EXPECT_THAT(refusal(",true,", ",perhaps,"), testing::HasSubstr("complete is 'perhaps'"));
    EXPECT_THAT(refusal("start_mode", "start_mood"), testing::HasSubstr("start_mode"));
}

}  // namespace
}  // namespace flightwatt::flight
