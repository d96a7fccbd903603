#include "flight/load_flight.h"

#include "base/atomic_file.h"
#include "base/number.h"
#include "flight/phases_file.h"
#include "flight/series_file.h"
#include "flight/telemetry_series.h"
#include "helpers/binary_frames.h"
#include "helpers/flown_points.h"
#include "helpers/rejected.h"
#include "helpers/selected_tracks.h"
#include "helpers/test_paths.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::HasSubstr;

/// A plain flight whose sensor reads 0 throughout.
FlightSeries unmeasured_flight() {
    auto series = test::series_of(test::sortie(100));
    for (auto& track : series.tracks) {
        if (track.name != "power_w") continue;
        track.source = "ENERGY.power";
        track.value.assign(track.value.size(), 0.0);
    }
    return series;
}

LoadOptions without_power() {
    LoadOptions options;
    options.power_required = false;
    return options;
}

TEST(LoadFlight, CountsNoOtherSortieAsPowerOutsideOfTheRequestedOne) {
    auto points = test::sortie(100);
    for (const double begin_s : {700.0, 1300.0})
        for (const auto& point : test::sortie(begin_s)) points.push_back(point);
    for (const std::size_t number : {1U, 2U, 3U}) {
        LoadOptions options;
        options.sortie = number;
        const auto flight = segment_and_check(test::series_of(points), options);
        ASSERT_EQ(flight.phases.sorties.size(), 1U);
        EXPECT_THAT(texts_of(flight.diagnostics), testing::Not(testing::Contains(HasSubstr("drawn outside"))))
            << number;
        const auto& part = flight.phases.part;
        if (number > 1) {
            EXPECT_NEAR(part.start_s, number == 3 ? 1070.0 : 470.0, 15.0);
        }
        EXPECT_EQ(std::isinf(part.start_s), number == 1);
        EXPECT_EQ(std::isinf(part.end_s), number == 3);
    }
}

TEST(LoadFlight, SegmentsAFlightWithoutPowerWhereNoneIsRequired) {
    const auto plain = segment(select_tracks(test::series_of(test::sortie(100))));
    const auto flight = segment_and_check(unmeasured_flight(), without_power());
    ASSERT_EQ(flight.phases.sorties.size(), 1u);
    EXPECT_NEAR(flight.phases.sorties[0].start_s(), plain.sorties[0].start_s(), 1.0);
    EXPECT_NEAR(flight.phases.sorties[0].end_s(), plain.sorties[0].end_s(), 1.0);
    EXPECT_EQ(flight.lacks_power, "no measured power (ENERGY.power is 0 throughout)");
    EXPECT_EQ(flight.exclusion, flight.lacks_power);
    EXPECT_THAT(texts_of(flight.diagnostics), testing::Contains(HasSubstr(": the energy of its phases is unknown")));
    EXPECT_THAT(phases_csv(flight.data, flight.phases), HasSubstr("\n1,takeoff,"));
    EXPECT_THAT(phases_csv(flight.data, flight.phases), HasSubstr(",,,,,,,true,")) << "empty, not 0";
    EXPECT_THAT(test::rejected([] { segment_and_check(unmeasured_flight(), {}); }), HasSubstr("has no measured power"));
}

TEST(LoadFlight, LabelsAircraftOfTheSimulatorNps) {
    const FlightFile file(test::write_text(test::scratch_dir() / "x.data",
                                           "1 20 ENERGY 60 12. 1. 12. 0. 0.\n1 20 NPS_RATE_ATTITUDE 1 2 3 4 5 6\n"
                                           "1 7 ENERGY 60 12. 1. 12. 0. 0.\n1 7 INFO_MSG \"NPS_\"\n"));
    const auto candidates = read_candidates(file, std::nullopt);
    ASSERT_EQ(candidates.size(), 2U);
    EXPECT_EQ(candidates[0].aircraft_name, "NPS");
    EXPECT_EQ(candidates[1].aircraft_name, "");
    EXPECT_EQ(read_candidates(file, "20").at(0).aircraft_name, "NPS");
    EXPECT_EQ(simulation_reason("NPS", {}), "a simulator flew it (NPS); --simulated uses such flights");
}

TEST(LoadFlight, OfASeriesFileWithoutPowerIsTheSame) {
    const auto series = unmeasured_flight();
    const auto again = parse_series_csv(to_csv(series), series.file);
    EXPECT_TRUE(again == series);
    const auto flight = segment_and_check(series, without_power());
    const auto reread = segment_and_check(again, without_power());
    EXPECT_EQ(phases_csv(reread.data, reread.phases), phases_csv(flight.data, flight.phases));
    EXPECT_EQ(reread.diagnostics, flight.diagnostics);
}

TEST(LoadFlight, ReadsACsvOfAltitudeAlone) {
    auto columns = test::columns_of(test::sortie(100));
    std::string text = "time_s,altitude_m\n";
    for (std::size_t i = 0; i < columns.time_s.size(); ++i) {
        text += fmt::format("{},{}\n", columns.time_s[i], columns.altitude_m[i]);
    }
    const auto flight = segment_and_check(parse_series_csv(text, "mine.csv"), without_power());
    ASSERT_EQ(flight.phases.sorties.size(), 1u);
    EXPECT_EQ(flight.phases.sorties[0].phases.size(), 3u);
    EXPECT_EQ(flight.lacks_power, "no measured power");
    EXPECT_THAT(test::rejected([&] { parse_series_csv("time_s,throttle_percent\n1,2\n2,3\n", "mine.csv"); }),
                HasSubstr("has no column 'power_w'"));
}

/// The flights of the archive without a current sensor, in the log's own seconds: where TAKEOFF was sent, and where
/// the log states that the aircraft stands again (its altitude stays, its ground speed is that of a GPS at rest).
TEST(LoadFlight, FindsEachFlightOfTheArchiveWithoutPower) {
    FLIGHTWATT_NEEDS_SHARED();
    struct Flown {
        double lift_off_s;
        double touchdown_s;
        bool has_takeoff;
    };
    const std::map<std::string, Flown> flights{{"12_05_16__07_20_45", {245.8, 460, true}},
                                               {"12_05_17__07_18_57", {104.0, 494, false}},  // its fix came in the air
                                               {"12_05_21__07_04_51", {295.4, 480, true}},
                                               {"12_05_21__07_06_15", {211.1, 396, true}}};
    for (const auto& [name, flown] : flights) {
        SCOPED_TRACE(name);
        const auto flight =
            load_flight(test::shared_dir() / "archives" / "no-power" / (name + ".data"), without_power());
        ASSERT_EQ(flight.phases.sorties.size(), 1u);
        const auto& sortie = flight.phases.sorties[0];
        EXPECT_NEAR(sortie.start_s(), flown.lift_off_s, 3.0);
        EXPECT_NEAR(sortie.end_s(), flown.touchdown_s, 5.0);
        EXPECT_EQ(sortie.phases.front().phase, flown.has_takeoff ? Phase::takeoff : Phase::cruise);
        EXPECT_EQ(sortie.phases.back().phase, Phase::landing);
        EXPECT_THAT(flight.lacks_power, HasSubstr("BAT.voltage * BAT.amps is 0 throughout"));
    }
}

/// A .data as the SD card of the aircraft would have stored it, and what convert makes of that.
struct CardAndText {
    std::filesystem::path card;
    std::filesystem::path text;
};

CardAndText stored_on_card(const std::filesystem::path& data, test::LinkVersion version) {
    const auto folder = test::scratch_dir();
    const auto log = telemetry::find_log_file(data).value();
    const auto messages = telemetry::read_message_dictionary(log);
    const auto source = telemetry::read_data_file(data);
    const auto bytes = test::card_log(source, messages, version);
    std::string text;
    telemetry::LinkDecoder decoder(messages);
    const auto sink = [&](const telemetry::LinkMessage& message) {
        text += fmt::format("{:.4f} {}\n", message.time_s.value(), message.text);
    };
    decoder.push(bytes, sink);
    decoder.flush(sink);
    CardAndText made{folder / "card" / "x.LOG", folder / "text" / "x.data"};
    const auto put = [&](const std::filesystem::path& path, const std::string& content) {
        std::filesystem::create_directories(path.parent_path());
        write_file_atomically(path, content);
        std::filesystem::copy_file(log, path.parent_path() / "x.log");
    };
    put(made.card, bytes);
    put(made.text, text);
    return made;
}

std::string everything_of(const std::filesystem::path& log) {
    const auto flight = load_flight(log);
    return fmt::format("{}\n{}\n{}", to_csv(flight.series), phases_csv(flight.data, flight.phases),
                       fmt::join(texts_of(flight.diagnostics), "\n"));
}

TEST(LoadFlight, ComesToTheSameOnABinaryLogAndItsText) {
    for (const auto version : {test::LinkVersion::v1, test::LinkVersion::v2}) {
        const auto made = stored_on_card(test::source_dir() / "logs" / "opterra_synthetic_01.data", version);
        EXPECT_EQ(everything_of(made.card), everything_of(made.text));
        std::filesystem::remove_all(made.card.parent_path());
        std::filesystem::remove_all(made.text.parent_path());
    }
}

TEST(LoadFlight, ReadsARealFlightFromACardOfV2) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto data = test::shared_dir() / "flights" / "20_07_10__06_53_03.data";
    const auto made = stored_on_card(data, test::LinkVersion::v2);
    EXPECT_EQ(everything_of(made.card), everything_of(made.text));
    const auto card = load_flight(made.card);
    const auto ground = load_flight(data);
    ASSERT_EQ(card.phases.sorties.size(), ground.phases.sorties.size());
    EXPECT_NEAR(card.phases.sorties[0].start_s(), ground.phases.sorties[0].start_s(), 0.1);
    EXPECT_NEAR(card.phases.sorties[0].end_s(), ground.phases.sorties[0].end_s(), 0.1);
    EXPECT_EQ(power_track(card.series).time_s.size(), power_track(ground.series).time_s.size());
}

TEST(FlightFile, OfABinaryLogNeedsDefinitions) {
    const auto folder = test::scratch_dir();
    const auto made = stored_on_card(test::source_dir() / "logs" / "opterra_synthetic_01.data", test::LinkVersion::v2);
    const auto bare = folder / "bare.tlm";
    std::filesystem::copy_file(made.card, bare);
    EXPECT_EQ(FlightFile(bare).framing(), telemetry::Framing::card);
    EXPECT_THAT(test::rejected([&] { load_flight(bare); }, folder),
                HasSubstr("bare.tlm: is a binary log, and no .log defines its messages; name the"));
    LoadOptions options;
    options.messages = made.text.parent_path() / "x.log";
    EXPECT_EQ(load_flight(bare, options).phases.sorties.size(), 1u);
    std::filesystem::copy_file(*options.messages, folder / "bare.LOG");
    EXPECT_EQ(load_flight(bare).phases.sorties.size(), 1u) << "bare.LOG is XML";
}

/// A damaged .log ends nothing where others replace it, and is warned of.
TEST(FlightFile, TakesNamedDefinitionsForADamagedLog) {
    const auto made = stored_on_card(test::source_dir() / "logs" / "opterra_synthetic_01.data", test::LinkVersion::v2);
    const auto sound = test::source_dir() / "logs" / "opterra_synthetic_01.log";
    const auto definitions = read_file(sound);
    LoadOptions options;
    options.messages = sound;
    for (const auto& log : {made.card, made.text}) {
        write_file_atomically(log.parent_path() / "x.log", definitions.substr(0, definitions.size() / 2));
        EXPECT_THROW(load_flight(log), InputError) << "damaged, and nothing else is named";
        const auto flight = load_flight(log, options);
        EXPECT_THAT(texts_of(flight.diagnostics), testing::Contains(HasSubstr("x.log")));
        EXPECT_THAT(texts_of(flight.diagnostics),
                    testing::Contains(HasSubstr("the definitions are those of " + sound.string())));
        EXPECT_EQ(flight.phases.sorties.size(), 1u);
    }
    write_file_atomically(made.card.parent_path() / "x.log", definitions);
    EXPECT_EQ(load_flight(made.card, options).diagnostics, load_flight(made.card).diagnostics);
}

}  // namespace
}  // namespace flightwatt::flight
