#include "report/sections/tracks_section.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "flight/load_flight.h"
#include "flight/select.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"
#include "report/sections/battery_section.h"
#include "report/sections/page_data.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;

BatchContent sample_batch() {
    ReportFlight flight;
    flight.data = select_tracks(flight::read_flight(test::source_dir() / "logs/opterra_synthetic_01.data"));
    flight.phases = segment(flight.data);
    flight.name = flight.data.flight;
    BatchContent batch;
    batch.flights = {flight};
    return batch;
}

VegaJson data_of(const Section& section, const std::string& name = "tracks") {
    const std::string begin = "id=\"data-" + name + "\">";
    const auto at = section.html.find(begin) + begin.size();
    return VegaJson::parse(section.html.substr(at, section.html.find("</script>", at) - at));
}

TEST(TracksSection, DrawsPhasesBrokenAtGapsWithMarksEvery5Minutes) {
    const auto section = tracks_section(sample_batch(), nullptr);
    ASSERT_TRUE(section);
    const auto data = data_of(*section)[0];
    EXPECT_EQ(data["title"], "1 January 2020, 10:00");
    EXPECT_EQ(data["lines"].size(), 12U) << "three phases and nine gaps";
    EXPECT_EQ(data["lines"].front()["phase"], "take-off");
    ASSERT_EQ(data["marks"].size(), 2U);
    EXPECT_EQ(data["marks"][1]["text"], "10 min") << "no battery is known";
}

TEST(TracksSection, PlacesOutlinesByAPositionInDegrees) {
    auto batch = sample_batch();
    const auto section = tracks_section(batch, nullptr, {{{10.39, 63.42}, {10.4, 63.42}}});
    EXPECT_EQ(data_of(*section, "outlines").dump(), "[[[10.39,63.42],[10.4,63.42]]]");
    const auto place = data_of(*section)[0]["place"];
    ASSERT_EQ(place.size(), 4U);
    EXPECT_NEAR(place[2].get<double>(), 10.39, 0.1);
    batch.flights[0].data.longitude_deg = {};
    EXPECT_TRUE(data_of(*tracks_section(batch, nullptr))[0]["place"].is_null());
}

TEST(TracksSection, ShowsTheChargeOfAnIdentifiedBattery) {
    const auto batch = sample_batch();
    const auto battery = identify_for_report(batch.flights, {}, 1);
    if (!battery.identified) GTEST_SKIP() << battery.no_result_reason;
    const auto data = data_of(*tracks_section(batch, &battery))[0];
    EXPECT_THAT(data["marks"][1]["text"].get<std::string>(), testing::MatchesRegex("10 min: [0-9]+ %"));
}

TEST(TracksSection, IsAbsentWithoutPositions) {
    auto batch = sample_batch();
    batch.flights[0].data.east_m = {};
    EXPECT_FALSE(tracks_section(batch, nullptr));
}

}  // namespace
}  // namespace flightwatt::report
